// Reads the tool's .usda by three.js' parser of OpenUSD text. Compares it with the numbers of cells
// in the .vtu and with the boundary in the .obj.
//   node usda.mjs --bin FOLDER --out FOLDER

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdirSync, readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';
import {parseArgs} from 'node:util';

const {values: options} = parseArgs({options: {bin: {type: 'string'}, out: {type: 'string'}}});
const require = createRequire(new URL('../../web-client/package.json', import.meta.url));
const {USDAParser} = await import(
  pathToFileURL(require.resolve('three/examples/jsm/loaders/usd/USDAParser.js')).href
);

mkdirSync(options.out, {recursive: true});
const file = (name) => join(options.out, name);
const qtet = (...words) =>
  execFileSync(join(options.bin, 'qtet'), words, {
    encoding: 'utf8',
    stdio: ['ignore', 'pipe', 'pipe'],
  });
qtet('sample', 'box', '-o', file('box.vtu'));
qtet('convert', file('box.vtu'), '-o', file('box.usda'));
qtet('convert', file('box.vtu'), '-o', file('box.obj'));
const {tetrahedra, points} = JSON.parse(qtet('check', file('box.vtu'), '--json'));

const {specsByPath} = new USDAParser().parseData(readFileSync(file('box.usda'), 'utf8'));
assert.equal(specsByPath['/'].fields.defaultPrim, 'mesh');
assert.equal(specsByPath['/mesh'].fields.typeName, 'Xform');
assert.equal(specsByPath['/mesh/tetrahedra'].fields.typeName, 'TetMesh');
const numbers = (name, width) => {
  const flat = [...specsByPath[`/mesh/tetrahedra.${name}`].fields.default].flat().map(Number);
  assert.ok(flat.every(Number.isFinite), name);
  return Array.from({length: flat.length / width}, (_, i) =>
    flat.slice(width * i, width * i + width),
  );
};
const at = numbers('points', 3),
  cells = numbers('tetVertexIndices', 4),
  faces = numbers('surfaceFaceVertexIndices', 3);
assert.deepEqual([at.length, cells.length], [points, tetrahedra]);
const minus = (a, b) => a.map((x, k) => x - b[k]);
const volume6 = ([a, b, c, d]) => {
  const [u, v, w] = [b, c, d].map((p) => minus(at[p], at[a]));
  return (
    u[0] * (v[1] * w[2] - v[2] * w[1]) -
    u[1] * (v[0] * w[2] - v[2] * w[0]) +
    u[2] * (v[0] * w[1] - v[1] * w[0])
  );
};
assert.ok(
  cells.every((cell) => volume6(cell) > 0),
  'tetrahedra are not right-handed',
);
assert.ok(
  Math.abs(cells.reduce((sum, cell) => sum + volume6(cell), 0) - 6) < 1e-6,
  'the cells do not fill the box',
);

// The boundary's triangles must have the same places and the same order of corners; any corner may
// come first.
const obj = readFileSync(file('box.obj'), 'utf8')
  .split('\n')
  .map((line) => line.split(' '));
const placesOfObj = obj
  .filter(([word]) => word === 'v')
  .map((words) => words.slice(1, 4).map(Number));
const facesOfObj = obj
  .filter(([word]) => word === 'f')
  .map((words) => words.slice(1, 4).map((corner) => placesOfObj[Number(corner) - 1]));
const turned = (corners) => {
  const texts = corners.map((p) => p.map(Math.fround).join());
  const first = texts.indexOf([...texts].sort()[0]);
  return [0, 1, 2].map((k) => texts[(first + k) % 3]).join(' ');
};
assert.deepEqual(
  faces.map((face) => turned(face.map((v) => at[v]))).sort(),
  facesOfObj.map(turned).sort(),
);
assert.equal(numbers('primvars:Scalar', 1).length, points);

// The mesh as a viewer shows it: the boundary as one mesh.
const {USDLoader} = await import(
  pathToFileURL(require.resolve('three/examples/jsm/loaders/USDLoader.js')).href
);
const shown = [];
new USDLoader()
  .parse(readFileSync(file('box.usda'), 'utf8'))
  .traverse((object) => object.isMesh && shown.push(object));
assert.deepEqual(
  shown.map((mesh) => mesh.name),
  ['boundary'],
);
const {index, attributes} = shown[0].geometry;
assert.equal(
  (index ?? attributes.position).count,
  3 * faces.length,
  'triangles that three.js shows',
);
console.log(
  `usda: three.js reads ${tetrahedra} tetrahedra, ${faces.length} faces of the boundary, and ` +
    'the field',
);
