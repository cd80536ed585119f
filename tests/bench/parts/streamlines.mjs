// Streamlines in node, for ../streamlines.py.
//   streamlines.mjs MODULE.wasm LOG.qtet <JOB.json >ANSWER.json
// The job has a field, seeds in the mesh's coordinates, and limits. The answer has by line the
// places from its seed on along the vectors, and the least milliseconds of some runs.
import {createRequire} from 'node:module';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import {runInThisContext} from 'node:vm';

const client = join(
  import.meta.dirname ?? new URL('.', import.meta.url).pathname,
  '../../../web-client',
);
const require = createRequire(join(client, 'package.json'));
const kRuns = 5; // the engine compiles the module better while it runs

const script = `
import {kDraco} from './core/decode/draco';
import {remembered} from './core/lines/neighbour_memory';
import {Streamlines} from './core/lines/streamlines';
import {kLineWidth} from './core/picture/streamlines';
import {takeWholeLog} from './tests/whole_log';

globalThis.answer = async (module, log, {field: name, seeds, limits}) => {
  const assembler = await takeWholeLog(log, kDraco, module);
  const {codec} = assembler;
  const {fields, lattice} = assembler.manifest;
  const field = fields.findIndex((its) => its.name === name);
  const vectors = {values: codec.field(field, 3), info: fields[field]};
  const across = remembered(codec.tetrahedronCount, (cell, corner) => codec.across(cell, corner));
  const [points, tetrahedra, boundary] = [codec.points(), codec.tetrahedra(), codec.boundary()];
  const mesh = {points, tetrahedra, boundary, step: lattice.step, across};
  const linesOf = (its) => new Streamlines(mesh, vectors, limits, null).all(its);
  const least = (its) => {
    let ms = Infinity, soup;
    for (let run = 0; run < ${kRuns}; ++run) {
      const start = performance.now();
      soup = linesOf(its);
      ms = Math.min(ms, performance.now() - start);
    }
    return {ms, steps: soup.points.length / kLineWidth, lines: soup.lines};
  };
  const start = performance.now();
  linesOf([{kind: 'even', count: 50}]);
  const firstMs = performance.now() - start;
  const onLattice = seeds.map((place) =>
    place.map((x, axis) => (x - lattice.origin[axis]) / lattice.step));
  const each = onLattice.map((at) => ({kind: 'line', from: at, to: at, count: 1}));
  const lines = each.map((one) => {
    const {points: its} = linesOf([one]);
    const places = [];
    for (let at = 0; at < its.length; at += kLineWidth)
      if (its[at + 4] >= 0)
        places.push([0, 1, 2].map((axis) => lattice.origin[axis] + lattice.step * its[at + axis]));
    return places;
  });
  const even = least([{kind: 'even', count: 1000}]);
  return {cells: codec.tetrahedronCount, lines, firstMs, even};
};
`;

const {build} = require('esbuild');
const bundled = await build({
  stdin: {contents: script, resolveDir: client, loader: 'ts'},
  bundle: true,
  write: false,
  format: 'iife',
  platform: 'node',
  target: 'es2022',
});
globalThis.require = require;
runInThisContext(bundled.outputFiles[0].text);
const [module, log] = process.argv.slice(2);
const answer = await globalThis.answer(
  await WebAssembly.compile(readFileSync(module)),
  new Uint8Array(readFileSync(log)),
  JSON.parse(readFileSync(0, 'utf8')),
);
process.stdout.write(JSON.stringify(answer));
