// The command `qtet` of the npm package beside the program: the same words, bytes, texts and exit
// codes. Skips where the package has none.
//   node tool.mjs --bin DIR --wasm FILE --out DIR

import assert from 'node:assert/strict';
import {execFile, execFileSync, spawnSync} from 'node:child_process';
import {
  chmodSync,
  closeSync,
  copyFileSync,
  existsSync,
  fstatSync,
  mkdirSync,
  openSync,
  readdirSync,
  readFileSync,
  rmSync,
  statSync,
  truncateSync,
  writeFileSync,
  writeSync,
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

// Runs at a time do not take each other's temporary files for abandoned.
const program = [join(built, 'qtet.js'), 'check', 'packed.vtu.gz'];
const runs = await Promise.all(
  [1, 2, 3, 4].map(
    () =>
      new Promise((end) => {
        execFile(process.execPath, program, settings, (error, said) => end({error, said}));
      }),
  ),
);
for (const {error, said} of runs) assert.equal(error, null, said);

// A pipe with a name, one that nobody reads, permissions, and sizes beyond 32 bits.
const shell = (line) => {
  const env = {...settings.env, NODE: process.execPath, QTET: join(built, 'qtet.js')};
  const {status, stdout, stderr} = spawnSync('bash', ['-c', line], {...settings, env});
  return {status, said: `${stdout}${stderr}`};
};
const piped = shell('"$NODE" "$QTET" check <(cat box.vtu) --format vtu');
assert.equal(piped.status, 0, piped.said);
const unread = shell('"$NODE" "$QTET" check box.vtu | true; exit ${PIPESTATUS[0]}');
assert.deepEqual(unread, {status: 141, said: ''});
chmodSync(join(out, 'tool_coarse.vtu'), 0o600);
assert.equal(
  tool(['extract', 'native_fin.qtet', '--level', '0', '-o', 'tool_coarse.vtu']).status,
  0,
);
assert.equal(statSync(join(out, 'tool_coarse.vtu')).mode & 0o777, 0o600);
const long = join(out, 'long.qtet');
copyFileSync(join(out, 'native_fin.qtet'), long);
truncateSync(long, 2 ** 32 + statSync(long).size);
const tooLong = tool(['info', 'long.qtet']);
assert.ok(tooLong.status === 1 && /32 bits/.test(tooLong.said), tooLong.said);
rmSync(long);
const array = (type, words, offset) =>
  `<DataArray type="${type}" ${words} format="appended" offset="${offset}"/>`;
const kPoints = 1e8;
const large = openSync(join(out, 'large.vtu'), 'w');
writeSync(
  large,
  '<VTKFile type="UnstructuredGrid" byte_order="LittleEndian" header_type="UInt64">' +
    `<UnstructuredGrid><Piece NumberOfPoints="${kPoints}" NumberOfCells="0">` +
    `<Points>${array('Float64', 'NumberOfComponents="3"', 0)}</Points><Cells>` +
    array('Int64', 'Name="connectivity"', 8 + 24 * kPoints) +
    array('Int64', 'Name="offsets"', 8 + 24 * kPoints) +
    array('UInt8', 'Name="types"', 8 + 24 * kPoints) +
    '</Cells></Piece></UnstructuredGrid><AppendedData encoding="raw">_',
);
const {size: at} = fstatSync(large);
writeSync(large, BigUint64Array.of(BigInt(24 * kPoints)), 0, 8, at);
writeSync(large, new Uint8Array(8), 0, 8, at + 8 + 24 * kPoints);
writeSync(large, '</AppendedData></VTKFile>', at + 16 + 24 * kPoints);
closeSync(large);
const tooLarge = tool(['check', 'large.vtu']);
assert.ok(tooLarge.status === 1 && /not fit into memory/.test(tooLarge.said), tooLarge.said);
rmSync(join(out, 'large.vtu'));

for (const words of [['--help'], ['missing.vtu']]) tool(['view', ...words]);
assert.deepEqual(readdirSync(temporary), [], 'temporary files are left behind');
const viewed = tool(['view', 'box.vtu', '--no-open']);
assert.equal(viewed.status, 0, viewed.said);
const page = /file:\S+/.exec(viewed.said)[0];
const {size} = statSync(new URL(page));
assert.ok(readFileSync(new URL(page), 'utf8').includes('src="data:image/webp'), `${size} bytes`);
rmSync(new URL('.', page), {recursive: true});
assert.ok(page.startsWith(pathToFileURL(temporary).href));
assert.deepEqual(readdirSync(temporary), [], 'temporary files are left behind');
