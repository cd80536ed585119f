// The command `qtet` of the npm package beside the program: the same words, bytes, texts and exit
// codes. Skips where the package has none.
//   node tool.mjs --bin DIR --wasm FILE --out DIR

import assert from 'node:assert/strict';
import {execFileSync, spawnSync} from 'node:child_process';
import {
  existsSync,
  mkdirSync,
  readdirSync,
  readFileSync,
  rmSync,
  statSync,
  writeFileSync,
} from 'node:fs';
import {join, resolve} from 'node:path';
import {fileURLToPath, pathToFileURL} from 'node:url';
import {parseArgs} from 'node:util';
import {gzipSync} from 'node:zlib';

const {values: options} = parseArgs({
  options: {bin: {type: 'string'}, wasm: {type: 'string'}, out: {type: 'string'}},
});
const out = resolve(options.out);
const built = join(out, 'package');
const temporary = join(out, 'temporary');
rmSync(out, {recursive: true, force: true});
mkdirSync(temporary, {recursive: true});
execFileSync(process.execPath, ['pack.mjs', resolve(options.wasm), built], {
  cwd: fileURLToPath(new URL('../../web-client/', import.meta.url)),
});
if (!existsSync(join(built, 'qtet.js'))) {
  console.log('skipped: the package has no command; run make setup, and build again');
  process.exit(77);
}

const settings = {cwd: out, env: {...process.env, TMPDIR: temporary}};
const run = (program, words, input) => {
  const {status, stdout, stderr} = spawnSync(program, words, {...settings, input});
  return {status, said: `${stdout}\n${stderr}`};
};
const native = (words, input) => run(resolve(options.bin, 'qtet'), words, input);
const tool = (words, input) => run(process.execPath, [join(built, 'qtet.js'), ...words], input);
/** Without the time that a command took. */
const timeless = (said) => said.replaceAll(/; [0-9.]+ s\b/g, '');
const both = (words, input) => {
  const [expected, found] = [native(words, input), tool(words, input)];
  assert.equal(timeless(found.said), timeless(expected.said), words.join(' '));
  assert.equal(found.status, expected.status, words.join(' '));
  return found;
};
/** `words` name the output last. */
const sameFile = (words, name) => {
  for (const [make, file] of [
    [native, `native_${name}`],
    [tool, `tool_${name}`],
  ]) {
    const {status, said} = make([...words, file]);
    assert.equal(status, 0, said);
  }
  const [expected, found] = ['native_', 'tool_'].map((by) => readFileSync(join(out, by + name)));
  assert.ok(expected.equals(found), `${words.join(' ')}: other bytes`);
};

native(['sample', 'box', '-o', 'box.vtu']);
sameFile(['sample', 'fin', '-o'], 'fin.vtu');
sameFile(['simplify', 'native_fin.vtu', '-o'], 'fin.qtet');
sameFile(['simplify', 'box.vtu', '--field-bits', '12', '--measure', 'all', '-o'], 'box.qtet');
sameFile(['extract', 'native_fin.qtet', '--ratio', '0.1', '-o'], 'coarse.vtu');
sameFile(['extract', 'native_fin.qtet', '--level', '0', '-o'], 'base.glb');
for (const words of [
  ['--version'],
  ['--help'],
  ['info', 'native_fin.qtet'],
  ['check', 'box.vtu', '--json'],
  ['verify', 'native_fin.qtet', '--against', 'native_fin.vtu'],
  ['simplify', '--help-all'],
  // each is an exception that ends a command
  ['nothing'],
  ['simplify'],
  ['simplify', 'box.vtu', '--kolour', '-o', 'x.qtet'],
  ['simplify', 'box.vtu', '--target-ratio', 'much', '-o', 'x.qtet'],
  ['simplify', 'missing.vtu', '-o', 'x.qtet'],
  ['simplify', 'box.vtu', '-o', 'no_folder/x.qtet'],
  ['info', 'box.vtu'],
])
  both(words);
const mesh = readFileSync(join(out, 'box.vtu'));
both(['check', '-', '--format', 'vtu'], mesh);
writeFileSync(join(out, 'packed.vtu.gz'), gzipSync(mesh));
both(['check', 'packed.vtu.gz']);
writeFileSync(join(out, 'cut.vtu'), mesh.subarray(0, mesh.length / 2));
both(['check', 'cut.vtu']);
for (const words of [
  ['publish', 'site', 'native_fin.qtet'],
  ['check', 'solid.vtkhdf'],
]) {
  writeFileSync(join(out, 'solid.vtkhdf'), '\x89HDF\r\n\x1a\n and more', 'latin1');
  const {status, said} = tool(words);
  assert.ok(status > 0 && /Python (or Debian )?package/.test(said), said);
}

const viewed = tool(['view', 'box.vtu', '--no-open']);
assert.equal(viewed.status, 0, viewed.said);
const page = /file:\S+/.exec(viewed.said)[0];
const {size} = statSync(new URL(page));
assert.ok(readFileSync(new URL(page), 'utf8').includes('src="data:image/webp'), `${size} bytes`);
rmSync(new URL('.', page), {recursive: true});
assert.ok(page.startsWith(pathToFileURL(temporary).href));
assert.deepEqual(readdirSync(temporary), [], 'temporary files are left behind');
