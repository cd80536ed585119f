// Checks the npm package's types as another project's compiler sees them. The package is packed,
// unpacked into an empty project and compiled strictly, libraries included, with every module
// resolution that knows `exports`.
//   node types.mjs --wasm FILE --out DIR

import assert from 'node:assert/strict';
import {execFileSync, spawnSync} from 'node:child_process';
import {mkdirSync, readFileSync, rmSync, symlinkSync, writeFileSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';
import {parseArgs} from 'node:util';

const {values: options} = parseArgs({options: {wasm: {type: 'string'}, out: {type: 'string'}}});
if (!options.wasm || !options.out) {
  console.error('Usage: node types.mjs --wasm FILE --out DIR');
  process.exit(2);
}
const client = fileURLToPath(new URL('../../web-client/', import.meta.url));
const out = resolve(options.out);
const built = join(out, 'package');
const project = join(out, 'project');

/** Names whose types come from files deep in the package; the last line must be an error. */
const kScript = `import 'qtet/element';
import {QtetViewer} from 'qtet';
import {Client, kPlainDisplay, type Display, type Snapshot} from 'qtet/core';
import {SoupMesh} from 'qtet/three';
import {MeshView} from 'qtet/webgl';
const display: Display = {...kPlainDisplay, color: {field: 0, component: -1}};
const positions = (snapshot: Snapshot): Float32Array | undefined => snapshot.surface?.positions;
const viewer: QtetViewer = document.querySelector('qtet-viewer')!;
export const parts = [Client, MeshView, display, positions, viewer.statistics.tetrahedra];
// @ts-expect-error the types are more than any
export const wrong: string = viewer.statistics.tetrahedra;
`;

const kResolutions = [
  {moduleResolution: 'bundler', module: 'esnext'},
  {moduleResolution: 'node16', module: 'node16'},
  {moduleResolution: 'nodenext', module: 'nodenext'},
];

rmSync(out, {recursive: true, force: true});
mkdirSync(join(project, 'node_modules/qtet'), {recursive: true});
execFileSync(process.execPath, ['pack.mjs', resolve(options.wasm), built], {
  cwd: client,
  stdio: 'inherit',
});
const packed = JSON.parse(
  execFileSync('npm', ['pack', '--json', '--loglevel=error'], {cwd: built, encoding: 'utf8'}),
);
const {files, filename} = packed[0];
assert.ok(
  files.some(({path}) => path === 'third-party.txt'),
  'the licences of what is bundled are missing',
);
execFileSync('tar', ['-xzf', join(built, filename), '--strip-components=1'], {
  cwd: join(project, 'node_modules/qtet'),
});
// The range of three is bounded, and the version that is tested lies in it.
const {peerDependencies} = JSON.parse(readFileSync(join(built, 'package.json'), 'utf8'));
const {devDependencies} = JSON.parse(readFileSync(join(client, 'package.json'), 'utf8'));
assert.equal(peerDependencies.three, `^${devDependencies.three}`);

for (const name of ['three', '@types'])
  symlinkSync(join(client, 'node_modules', name), join(project, 'node_modules', name));
writeFileSync(join(project, 'package.json'), '{"private": true, "type": "module"}');
writeFileSync(join(project, 'main.ts'), kScript);
const compiler = join(client, 'node_modules/typescript/bin/tsc');
for (const resolution of kResolutions) {
  const compilerOptions = {
    ...resolution,
    target: 'es2022',
    lib: ['es2022', 'dom', 'dom.iterable'],
    strict: true,
    noEmit: true,
    skipLibCheck: false,
    types: [],
  };
  const file = join(project, 'tsconfig.json');
  writeFileSync(file, JSON.stringify({compilerOptions, files: ['main.ts']}));
  const {status, stdout} = spawnSync(process.execPath, [compiler, '--project', file], {
    encoding: 'utf8',
  });
  assert.equal(status, 0, `moduleResolution ${resolution.moduleResolution}:\n${stdout}`);
  console.log(`ok    moduleResolution ${resolution.moduleResolution}`);
}
