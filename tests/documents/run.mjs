// The examples of the documents, run as they stand there. Usage:
//   node run.mjs --build build/release --out FOLDER [--python python3] [DOCUMENT...]
// Without documents it takes every .md of the repository.
//
// A document's blocks run in their order, in one folder that has meshes and logs (scratch.mjs). Its
// fences say the language, or `text` where there is nothing to run. If a block cannot run in a
// test, its fence gives the reason, ```sh no-run: needs root. It is checked all the same: its
// syntax, and the options that it names. Commands in sentences (`qtet info --all`) are checked
// likewise.

import {resolve} from 'node:path';
import {fileURLToPath} from 'node:url';
import {parseArgs} from 'node:util';

import {documentsIn, judge} from './judge.mjs';
import {Options} from './options.mjs';
import {makeInputs} from './scratch.mjs';

const {values, positionals} = parseArgs({
  allowPositionals: true,
  options: {build: {type: 'string'}, out: {type: 'string'}, python: {type: 'string'}},
});
if (!values.build || !values.out) {
  console.error('usage: run.mjs --build FOLDER --out FOLDER [--python PROGRAM] [DOCUMENT...]');
  process.exit(2);
}
const root = fileURLToPath(new URL('../../', import.meta.url));
const [build, out] = [values.build, values.out].map((path) => resolve(path));
const bin = resolve(build, 'bin');
const inputs = resolve(out, 'inputs');
makeInputs(bin, inputs);

const context = {root, build, out, inputs, python: values.python, options: new Options(bin, root)};
const counts = {ran: 0, checked: 0, text: 0, named: 0, wrong: 0};
const documents = positionals.length > 0 ? positionals : documentsIn(root);
for (const document of documents) {
  for (const verdict of await judge(document, context)) {
    ++counts[verdict.state];
    report(document, verdict);
  }
}
const {ran, checked, text, named, wrong} = counts;
console.log(
  `documents: of ${ran + checked + wrong} examples in ${documents.length} documents ${ran} ran, ` +
    `${checked} were only checked, ${wrong} are wrong; ` +
    `beside them ${text} texts and ${named} commands in sentences`,
);
process.exit(wrong === 0 ? 0 : 1);

function report(document, {line, language, state, note, did}) {
  const where = `${document}:${line}: ${language}`;
  if (state === 'ran') console.log(`${where} ${did}`);
  if (state === 'checked') console.log(`${where} only checked: ${note}`);
  if (state === 'wrong')
    console.log(`${where} WRONG: ${note.trimEnd().replaceAll('\n', '\n    ')}`);
}
