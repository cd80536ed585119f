// The wheel without a native library: in Pyodide it answers as libqtet.so does, and node runs its
// command. npm has no numpy for Pyodide, so a stand-in takes its place.
//   node pyodide.mjs --python PYTHON --bin DIR --library FILE --out DIR
// Exits with 77 where the module was left out.

import assert from 'node:assert/strict';
import {execFileSync, spawnSync} from 'node:child_process';
import {
  copyFileSync,
  existsSync,
  mkdirSync,
  readdirSync,
  readFileSync,
  rmSync,
  statSync,
  symlinkSync,
} from 'node:fs';
import {join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';
import {parseArgs} from 'node:util';
import {loadPyodide} from '../../web-client/node_modules/pyodide/pyodide.mjs';

const {values: options} = parseArgs({
  options: {
    python: {type: 'string'},
    bin: {type: 'string'},
    library: {type: 'string'},
    out: {type: 'string'},
  },
});
const out = resolve(options.out);
const source = fileURLToPath(new URL('../../', import.meta.url));
const tests = join(source, 'tests/codec/python');
const program = readFileSync(join(tests, 'pyodide_program.py'), 'utf8');
// The package looks for a library up to four folders above it. These are not the build's.
const site = join(out, 'site/usr/lib/python3/packages');
const kMaxBytes = 2_400_000;
if (!existsSync(resolve(options.bin, '../web-client/qtet-tool.wasm'))) {
  console.log('skipped: the WebAssembly was left out; run make setup, and build again');
  process.exit(77);
}
rmSync(out, {recursive: true, force: true});
mkdirSync(join(out, 'work'), {recursive: true});
const run = (file, words, more = {}) =>
  execFileSync(file, words, {cwd: join(out, 'work'), encoding: 'utf8', stdio: 'pipe', ...more});
const python = (words, more) => run(options.python, words, more);

/** Two builds have the same bytes. Returns the wheel's path. */
function built() {
  const [one, two] = ['a', 'b'].map((name) => {
    python([join(source, '.packaging/python_backend.py'), join(out, name), 'pure']);
    return join(out, name, readdirSync(join(out, name))[0]);
  });
  assert.match(one, /qtet-[\d.]+-py3-none-any\.whl$/);
  assert.deepEqual(readFileSync(one), readFileSync(two));
  assert.ok(statSync(one).size < kMaxBytes, `the wheel has ${statSync(one).size} bytes`);
  return one;
}

/** Those of the program and libqtet.so, with the viewer of the wheel. */
function nativeAnswers() {
  const folder = join(out, 'native');
  mkdirSync(join(folder, 'share/qtet'), {recursive: true});
  mkdirSync(join(folder, 'bin'));
  symlinkSync(join(site, 'qtet/web/viewer'), join(folder, 'share/qtet/viewer'));
  const qtet = join(folder, 'bin/qtet');
  copyFileSync(resolve(options.bin, 'qtet'), qtet);
  run(qtet, ['sample', 'box', '-o', 'box.vtu', '-q']);
  run(qtet, ['simplify', 'box.vtu', '-o', 'box.qtet', '-q']);
  const env = {
    ...process.env,
    PATH: `${join(folder, 'bin')}:${process.env.PATH}`,
    PYTHONPATH: join(source, 'codec/python'),
    PYTHONDONTWRITEBYTECODE: '1',
    QTET_LIBRARY: resolve(options.library),
  };
  return JSON.parse(python(['-c', program], {env}));
}

async function pyodideWith(wheel) {
  const pyodide = await loadPyodide();
  await pyodide.loadPackage(wheel, {messageCallback: () => undefined});
  for (const name of ['box.vtu', 'box.qtet'])
    pyodide.FS.writeFile(name, readFileSync(join(out, 'work', name)));
  const numpy = readFileSync(join(tests, 'numpy_stand_in.py'));
  pyodide.FS.writeFile('numpy.py', numpy);
  return pyodide;
}

function answersOf(pyodide) {
  let printed = '';
  pyodide.setStdout({batched: (line) => (printed += line)});
  pyodide.runPython(program);
  return JSON.parse(printed);
}

/** A module that ends in a call is replaced by another one. */
function checkBroken(pyodide) {
  pyodide.runPython(`
import qtet.library
first = qtet.open("box.qtet")
broken = qtet.library.library()
said = "QtetError: the file is damaged"
assert raised(lambda: broken.qtet_log_level(2**32 - 64)).startswith(said)
assert raised(lambda: first.refine(0)).startswith(said)
first.close()
assert qtet.library.library() is not broken
assert of_log("box.qtet")["levels"]
assert "qtet page" in raised(lambda: qtet.view("box.qtet"))
from qtet import tool
for words in (["extract", "box.qtet", "--level", "0", "-o", "-"], ["view", "box.qtet"]):
    assert "in Pyodide" in raised(lambda: tool.run(words))
`);
}

/** The front of a log behind HTTP is fetched. Node has no XMLHttpRequest, so this answers. */
function checkFetched(pyodide) {
  const log = readFileSync(join(out, 'work/box.qtet'));
  globalThis.XMLHttpRequest = class {
    open(method, url, isAsync) {
      assert.deepEqual([method, isAsync], ['GET', false]);
      this.responseURL = url;
    }
    setRequestHeader(name, value) {
      assert.equal(name, 'Range');
      [this.first, this.last] = value.match(/\d+/g).map(Number);
    }
    send() {
      assert.equal(this.responseType, 'arraybuffer');
      this.status = this.responseURL.endsWith('/box.qtet') ? 206 : 404;
      this.statusText = this.status === 404 ? 'Not Found' : '';
      this.response = new Uint8Array(log.subarray(this.first, this.last + 1)).buffer;
    }
    getResponseHeader(name) {
      return name === 'ETag' ? '"box"' : null;
    }
  };
  pyodide.runPython(`
with qtet.open("http://meshes.example/box.qtet") as there, qtet.open("box.qtet") as here:
    assert [there.refine(0), here.refine(0)] == [0, 0]
    assert of_arrays(there) == of_arrays(here)
    assert there.remote.have == here.level_info(0).prefixBytes < here.info.bytes
    assert [there.refine(there.last_level), here.refine(here.last_level)]
    assert of_arrays(there) == of_arrays(here)
assert "HTTP 404 Not Found" in raised(lambda: qtet.open("http://meshes.example/nothing.qtet"))
`);
}

/** Where there is no native library, node runs the tool. */
function checkNode() {
  const only = join(out, 'only');
  mkdirSync(only);
  const env = {PATH: only, PYTHONPATH: site, PYTHONDONTWRITEBYTECODE: '1'};
  const words = ['-m', 'qtet', 'simplify', 'box.vtu', '-o', 'node.qtet', '-q'];
  const settings = {cwd: join(out, 'work'), env, encoding: 'utf8'};
  const without = spawnSync(options.python, words, settings);
  assert.equal(without.status, 1);
  assert.match(without.stderr, /^qtet: node is not found; this package of qtet needs node 18/);
  symlinkSync(process.execPath, join(only, 'node'));
  python(words, {env});
  const [log, native] = ['node.qtet', 'box.qtet'].map((name) =>
    readFileSync(join(out, 'work', name)),
  );
  assert.deepEqual(log, native);
  const page = 'import qtet; print(qtet.show("box.vtu").told)';
  assert.match(python(['-c', page], {env}), /bytes/);
  const open = spawnSync(options.python, ['-c', 'import qtet; qtet.open("box.qtet")'], settings);
  assert.match(open.stderr, /libqtet\.so is not found/);
  const serve = spawnSync(options.python, ['-m', 'qtet', 'serve', 'box.qtet'], settings);
  assert.match(serve.stderr, /publish needs the tool/);
}

const wheel = built();
python(['-m', 'zipfile', '-e', wheel, site]);
const native = nativeAnswers();
const pyodide = await pyodideWith(wheel);
const start = performance.now();
assert.deepEqual(answersOf(pyodide), native);
const seconds = ((performance.now() - start) / 1000).toFixed(1);
checkFetched(pyodide);
checkBroken(pyodide);
checkNode();
console.log(`the wheel has ${statSync(wheel).size} bytes; Pyodide answers in ${seconds} s`);
