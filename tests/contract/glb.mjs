// The tool's .glb by the Khronos validator: of a log's levels, and of a mesh that was no log. node
// glb.mjs --bin FOLDER --out FOLDER
import {execFileSync} from 'node:child_process';
import {mkdirSync, readFileSync} from 'node:fs';
import {join} from 'node:path';
import {parseArgs} from 'node:util';
import validator from 'gltf-validator';

const {values} = parseArgs({options: {bin: {type: 'string'}, out: {type: 'string'}}});
mkdirSync(values.out, {recursive: true});
const file = (name) => join(values.out, name);
const qtet = (...words) =>
  execFileSync(join(values.bin, 'qtet'), words, {stdio: ['ignore', 'pipe', 'pipe']});

const golden = new URL('../golden/valid/', import.meta.url).pathname;
qtet('sample', 'box', '-o', file('box.vtu'));
qtet('simplify', file('box.vtu'), '-o', file('box.qtet'));
const made = [
  ['extract', file('box.qtet'), '--level', '0'],
  ['extract', file('box.qtet'), '--ratio', '1', '--fields', 'Scalar'],
  ['extract', join(golden, 'gaps.qtet'), '--ratio', '1'],
  ['convert', file('box.vtu')],
  ['extract', file('box.qtet'), '--ratio', '1', '--fields', 'Scalar', '--no-draco'],
  ['extract', join(golden, 'gaps.qtet'), '--ratio', '1', '--no-draco'],
  ['convert', file('box.vtu'), '--no-draco'],
];
for (const words of made) {
  qtet(...words, '-o', file('skin.glb'));
  const bytes = new Uint8Array(readFileSync(file('skin.glb')));
  const report = await validator.validateBytes(bytes, {maxIssues: 20});
  const {numErrors, numWarnings, messages} = report.issues;
  if (numErrors + numWarnings > 0 || report.info.totalTriangleCount === 0)
    throw new Error(
      `qtet ${words.join(' ')}: ${numErrors} errors, ${numWarnings} ` +
        `warnings\n${JSON.stringify(messages, null, 1)}`,
    );
  const json = JSON.parse(
    new TextDecoder().decode(
      bytes.subarray(20, 20 + new DataView(bytes.buffer, bytes.byteOffset).getUint32(12, true)),
    ),
  );
  // The validator does not look into Draco's bytes, so what stands beside them is checked here.
  const {min, max} = json.accessors[json.meshes[0].primitives[0].attributes.POSITION];
  if (!min.every((low, axis) => low < max[axis]))
    throw new Error(`qtet ${words.join(' ')}: bounds ${min} to ${max}`);
  const names = Object.keys(json.meshes[0].primitives[0].attributes);
  const wanted = words.includes('--fields') ? ['POSITION', '_Scalar', 'COLOR_0'] : names;
  if (names.length < 2 || names.join() !== wanted.join())
    throw new Error(`qtet ${words.join(' ')}: attributes ${names}`);
  console.log(`qtet ${words[0]}: ${report.info.totalTriangleCount} triangles, ${names}`);
}
