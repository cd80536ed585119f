// Decoding in node, one thread: the least milliseconds from a log's bytes to mesh and fields.
//   codec_in_node.mjs --wasm MODULE.wasm --core WEB-CLIENT/core LOG.qtet
import {readFileSync} from 'node:fs';
import {resolve} from 'node:path';
import {runInThisContext} from 'node:vm';
import {measuringScript} from './parts/measuring_script.mjs';

const kRuns = 3; // the engine compiles the module better while it runs

const args = process.argv.slice(2);
const option = (name) => args[args.indexOf(name) + 1];
const log = args.find((arg) => arg.endsWith('.qtet'));
if (!args.includes('--wasm') || !args.includes('--core') || log === undefined) {
  console.error('usage: codec_in_node.mjs --wasm MODULE.wasm --core WEB-CLIENT/core LOG.qtet');
  process.exit(2);
}
const inBase64 = (path) => readFileSync(path).toString('base64');
runInThisContext(await measuringScript(resolve(option('--core'))));
const {all} = await globalThis.measure(inBase64(option('--wasm')), inBase64(log), kRuns);
console.log(all.toFixed(3));
