// Proves that the judge finds faults. Each forged document is wrong in one place, and the verdict
// must say why. A sound example of each language is accepted. Usage:
//   node selftest.mjs --build build/release --out FOLDER [--python python3]

import {mkdirSync, rmSync, writeFileSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';
import {parseArgs} from 'node:util';

import {judge} from './judge.mjs';
import {Options} from './options.mjs';
import {makeInputs} from './scratch.mjs';

const fenced = (info, ...lines) => ['```' + info, ...lines, '```', ''].join('\n');

/** The broken thing, the document, and a part of the verdict on its last example. */
const kBroken = [
  ['a command that fails', fenced('sh', 'qtet info nobody.qtet'), 'nobody.qtet'],
  ['a failure inside a pipe', fenced('sh', 'false | cat'), 'ended with 1'],
  ['a variable that is not set', fenced('sh', 'echo $NEVER_SET'), 'NEVER_SET'],
  ['a failure in the second block', fenced('sh', 'true') + fenced('sh', 'exit 3'), 'with 3'],
  ['a server that refuses', fenced('sh', 'qtet-server nowhere'), 'nowhere'],
  ['a path that is 404', fenced('sh', 'curl -fsS http://127.0.0.1:8080/v1/meshes/none'), '404'],
  ['shell syntax', fenced('sh no-run: a reason', 'if true; then'), 'syntax error'],
  ['an unknown option', fenced('sh no-run: root', 'sudo qtet info a --never'), 'no option --never'],
  [
    'one behind a pipe',
    fenced('sh no-run: x', 'cat a | qtet view - --never'),
    'view has no option',
  ],
  ['one on a second line', fenced('sh no-run: x', 'qtet check a \\', '  --never'), '--never'],
  [
    'one of the server',
    fenced('sh no-run: x', 'bin/qtet-server a --never=1'),
    'qtet-server has no',
  ],
  ['an unknown command', fenced('sh no-run: x', 'qtet simplfy a.vtu'), "no command 'simplfy'"],
  ['an unknown target', fenced('sh no-run: x', 'make demmo PORT=1'), "no target 'demmo'"],
  ['an option in a sentence', 'Use `qtet info\n--never`.\n', 'qtet info has no option --never'],
  ['a server option in a sentence', 'Use `qtet-server DIR --never`.\n', 'no option --never'],
  ['a target in a sentence', 'Use `make demmo`.\n', "no target 'demmo'"],
  ['no reason', fenced('sh no-run', 'true'), 'without a reason'],
  ['an unknown note', fenced('sh later', 'true'), "what is 'later'"],
  ['a fence without a language', fenced('', 'true'), "a fence of ''"],
  ['an unknown language', fenced('cobol', 'true'), "a fence of 'cobol'"],
  ['a fence that is not closed', '```sh\ntrue\n', 'line 1: this fence is never closed'],
  ['JSON with a comma too many', fenced('json', '{"a": [1, 2,]}'), 'JSON'],
  ['JSON broken in its second value', fenced('json name', '{"a": 1}', '{b: 2}'), 'JSON'],
  ['JSON of nothing', fenced('json', ''), 'no value'],
  ['C that does not compile', fenced('c', 'int main(void) { return qtet_no(); }'), 'qtet_no'],
  ['C without a main', fenced('c', '#include <qtet/qtet.h>', 'int a = qtet_no();'), 'qtet_no'],
  ['C that fails', fenced('c', 'int main(void) { return 7; }'), 'example ended with 7'],
  ['C that is not run', fenced('c no-run: x', 'int main(void) { return }'), 'expected expression'],
  ['a package that is not there', fenced('cmake', 'find_package(qtetle REQUIRED)'), 'qtetle'],
  ['a target that is not there', fenced('cmake', 'target_link_libraries(mine q::q)'), 'q::q'],
  ['a token that is too short', fenced('tokens', 'write * short'), 'fewer than 22'],
  ['Python that raises', fenced('python', 'assert 1 == 2'), 'AssertionError'],
  ['Python syntax', fenced('python no-run: x', 'def f(:'), 'SyntaxError'],
  ['JavaScript that throws', fenced('js', "throw new Error('no more')"), 'no more'],
  ['JavaScript syntax', fenced('js no-run: x', 'const = 1'), 'SyntaxError'],
  ['a type that is not there', fenced('ts', "import {Nobody} from 'qtet/core';"), 'Nobody'],
  ['a type that does not fit', fenced('ts', "export const a: number = 'b';"), 'not assignable'],
  ['an element left open', fenced('html', '<div><p>a</div>'), 'closes another element'],
  ['an element never closed', fenced('html', '<qtet-viewer src="a>b">'), 'never closed'],
  ['a script in a page', fenced('html', '<script type="module">const = 1</script>'), 'SyntaxError'],
];

/** The sound thing, the document, and the last example's state. */
const kSound = [
  ['a shell block', fenced('sh', 'qtet info part.qtet >/tmp/a', 'test -s /tmp/a'), 'ran'],
  ['blocks that share a folder', fenced('sh', 'touch x') + fenced('sh', 'rm x'), 'ran'],
  ['a server for later blocks', fenced('sh', 'qtet-server served') + curl('part'), 'ran'],
  ['a server of the test', curl('part'), 'ran'],
  ['a block that is not run', fenced('sh no-run: x', 'qtet info a --json; exit 1'), 'checked'],
  ['JSON values in a row', fenced('json', '{"a": "}"}', '[1,', '2]'), 'ran'],
  ['a text', fenced('text', '{'), 'text'],
  ['a page', fenced('html', '<br><script>let a = 1</script>'), 'checked'],
  ['JavaScript', fenced('js', 'await 1'), 'ran'],
  ['a sentence', 'Use `qtet COMMAND --help`, `qtet info\n--json` and `make test`.\n', 'named'],
];

function curl(mesh) {
  return fenced('sh', `curl -fsS http://localhost:8080/v1/meshes/${mesh}`);
}

const {values} = parseArgs({
  options: {build: {type: 'string'}, out: {type: 'string'}, python: {type: 'string'}},
});
const root = fileURLToPath(new URL('../../', import.meta.url));
const [build, out] = [values.build, values.out].map((path) => resolve(path));
rmSync(out, {recursive: true, force: true});
mkdirSync(out, {recursive: true});
const inputs = join(out, 'inputs');
const bin = join(build, 'bin');
makeInputs(bin, inputs);
const context = {root, build, out, inputs, python: values.python, options: new Options(bin, root)};

let failures = 0;
for (const [what, text, expected] of kBroken) {
  const {state, note} = await lastVerdict(text);
  if (state === 'wrong' && note.includes(expected)) continue;
  if (note.startsWith('not even its syntax')) continue; // no Python or no compiler of TypeScript
  fail(`${what} is ${state}, and the verdict lacks '${expected}': ${note}`);
}
for (const [what, text, expected] of kSound) {
  const {state, note} = await lastVerdict(text);
  if (state !== expected) fail(`${what} is ${state} instead of ${expected}: ${note}`);
}
if (failures === 0) console.log(`documents: ${kBroken.length} forged faults are found`);
process.exit(failures === 0 ? 0 : 1);

async function lastVerdict(text) {
  const document = join(out, 'forged.md');
  writeFileSync(document, text);
  return (await judge(document, {...context, out: join(out, 'scratch')})).at(-1);
}

function fail(sentence) {
  console.error(`FAILED: ${sentence}`);
  ++failures;
}
