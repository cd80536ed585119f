// The whole of it: the tool's log, the server, and the viewer in Chromium with software WebGL.
// Usage: node run.mjs --bin DIR --viewer DIR --out DIR [--only TEXT]
// Needs web-client/node_modules (playwright-core) and a Chromium: /usr/bin/chromium, or the one that QTET_CHROMIUM names.

import {mkdirSync} from 'node:fs';
import {parseArgs} from 'node:util';
import {Browser} from './browser.mjs';
import {checks} from './checks.mjs';
import {transportChecks} from './transport_checks.mjs';
import {volumeChecks} from './volume_checks.mjs';
import {makeLog, Server} from './programs.mjs';

const {values: options} = parseArgs({
  options: {bin: {type: 'string'}, viewer: {type: 'string'}, out: {type: 'string'}, only: {type: 'string', default: ''}},
});
if (!options.bin || !options.viewer || !options.out) {
  console.error('Usage: node run.mjs --bin DIR --viewer DIR --out DIR [--only TEXT]');
  process.exit(2);
}

mkdirSync(options.out, {recursive: true});
const logs = {fin: makeLog(options.bin, 'fin', options.out), box: makeLog(options.bin, 'box', options.out)};
const server = new Server(options.bin, logs.fin.folder, options.viewer);
const browser = await Browser.launch(options.out);
let failures = 0;
try {
  for (const [name, check] of Object.entries({...checks, ...transportChecks, ...volumeChecks})) {
    if (!name.includes(options.only)) continue;
    const start = Date.now();
    try {
      await server.start();
      const note = await check({server, browser, logs, viewer: options.viewer, out: options.out, bin: options.bin});
      console.log(`ok    ${name} (${Date.now() - start} ms)${note ? `: ${note}` : ''}`);
    } catch (thrown) {
      ++failures;
      console.log(`FAIL  ${name}: ${thrown.stack}`);
      await browser.saveFailure(name);
    } finally {
      await browser.closePages();
    }
  }
} finally {
  await browser.close();
  server.kill();
}
console.log(failures === 0 ? `screenshots are in ${options.out}` : `${failures} failed; screenshots are in ${options.out}`);
process.exit(failures === 0 ? 0 : 1);
