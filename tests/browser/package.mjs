// The npm package as a stranger uses it. It is packed, installed into an empty Vite project,
// checked by the compiler, built, and viewed in Chromium with two viewers on one page. The same
// project runs the examples.
//   node package.mjs --bin DIR --wasm FILE --out DIR

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdirSync, rmSync, symlinkSync, writeFileSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';
import {parseArgs} from 'node:util';
import {Browser, kTimeoutMs} from './browser.mjs';
import {addExamples, checkExamples, waitForColor} from './examples.mjs';
import {makeLog, Server} from './programs.mjs';

const {values: options} = parseArgs({
  options: {bin: {type: 'string'}, wasm: {type: 'string'}, out: {type: 'string'}},
});
if (!options.bin || !options.wasm || !options.out) {
  console.error('Usage: node package.mjs --bin DIR --wasm FILE --out DIR');
  process.exit(2);
}
for (const name of ['bin', 'wasm', 'out']) options[name] = resolve(options[name]);
const client = fileURLToPath(new URL('../../web-client/', import.meta.url));
const built = join(options.out, 'package');
const project = join(options.out, 'project');

const kPage = `<!doctype html><html lang="en"><head><title>Two meshes</title><style>
  body { margin: 0; display: grid; grid-template-columns: 1fr 1fr; height: 100vh }
  qtet-viewer { min-width: 0 }
  qtet-viewer::part(panel) { display: none }
</style></head><body>
<qtet-viewer mesh="box" colormap="turbo"></qtet-viewer>
<qtet-viewer mesh="fin" clip="y:0.5"><p slot="poster">Loading</p></qtet-viewer>
<script type="module" src="/main.ts"></script></body></html>`;

/** Uses what the package promises, so that the compiler checks the types. */
const kScript = `import 'qtet/element';
import {QtetViewer, kViewAttributes, type QtetViewerAttributes} from 'qtet';
import {Client, colorTable, kFull, kPlainDisplay, type Display, type Snapshot} from 'qtet/core';
import {SoupMesh} from 'qtet/three';
import {MeshView} from 'qtet/webgl';
const viewers = [...document.querySelectorAll('qtet-viewer')];
const first: QtetViewer = viewers[0]!;
const display: Display = {...kPlainDisplay, color: {field: 0, component: -1}};
let triangles = 0;
const client = new Client((message) => {
  if (message.type === 'manifest') client.show(display);
  if (message.type !== 'snapshot') return;
  const snapshot: Snapshot = message.snapshot;
  if (snapshot.surface) triangles = snapshot.surface.positions.length / 9;
  client.shown();
});
const url = new URL('/v1/stream', location.href).href.replace('http', 'ws');
client.start({url, mesh: 'box', fields: null, limit: kFull});
const attributes: QtetViewerAttributes = {mesh: 'box', 'clip-mode': 'slice'};
first.addEventListener('camera-change', ({detail}) => console.log(detail[0] + detail[5]));
first.addEventListener('complete', ({detail: {total}}) => console.log(total.vertices));
// @ts-expect-error: the types show no private members
type Hidden = QtetViewer['viewing'];
export type {Hidden};
const parts = [attributes, MeshView, SoupMesh, colorTable('turbo').length, kViewAttributes.length];
Object.assign(window, {viewers, first, triangles: () => triangles, parts});
`;

function makeProject() {
  rmSync(project, {recursive: true, force: true});
  mkdirSync(project);
  writeFileSync(
    join(project, 'package.json'),
    JSON.stringify({name: 'stranger', private: true, type: 'module'}),
  );
  writeFileSync(
    join(project, 'tsconfig.json'),
    JSON.stringify({
      compilerOptions: {
        target: 'ES2022',
        module: 'ESNext',
        moduleResolution: 'Bundler',
        strict: true,
        noEmit: true,
        skipLibCheck: false,
        types: [],
        lib: ['ES2022', 'DOM', 'DOM.Iterable'],
      },
      files: ['main.ts'],
    }),
  );
  writeFileSync(join(project, 'index.html'), kPage);
  writeFileSync(join(project, 'main.ts'), kScript);
  addExamples(project);
}

const run = (folder, command, ...words) =>
  execFileSync(command, words, {
    cwd: folder,
    encoding: 'utf8',
    stdio: ['ignore', 'pipe', 'inherit'],
  });

run(client, process.execPath, 'pack.mjs', options.wasm, built);
const [{filename, files}] = JSON.parse(run(built, 'npm', 'pack', '--json', '--loglevel=error'));
assert.ok(
  files.length > 40 && !files.some(({path}) => path.endsWith('.ts') && !path.endsWith('.d.ts')),
  'the package holds sources or too little',
);
makeProject();
run(
  project,
  'npm',
  'install',
  join(built, filename),
  '--omit=peer',
  '--no-audit',
  '--no-fund',
  '--prefer-offline',
  '--loglevel=error',
);
// Packages that every such project has are here already, so that nothing is downloaded twice.
for (const name of ['three', '@kitware', 'vite', 'typescript', '@types'])
  symlinkSync(join(client, 'node_modules', name), join(project, 'node_modules', name));
run(project, process.execPath, 'node_modules/typescript/bin/tsc');
run(project, process.execPath, 'node_modules/vite/bin/vite.js', 'build', '--logLevel', 'error');

const logs = [makeLog(options.bin, 'box', options.out), makeLog(options.bin, 'fin', options.out)];
const server = new Server(options.bin, logs[0].folder, join(project, 'dist'));
const browser = await Browser.launch(options.out);
try {
  await server.start();
  const page = await browser.page(server.url);
  await page.waitForFunction(
    () =>
      window.viewers?.every((viewer) => viewer.state === 'complete' && viewer.matches('.loaded')) &&
      window.triangles() > 0,
    null,
    {timeout: kTimeoutMs},
  );
  const digests = await page.evaluate(() =>
    Promise.all(window.viewers.map((viewer) => viewer.digest())),
  );
  assert.deepEqual(
    digests,
    logs.map(({meshDigest}) => meshDigest),
  );
  await waitForColor(browser, page, 'package');
  await page.evaluate(() => window.viewers.forEach((viewer) => viewer.remove()));
  assert.equal(await page.evaluate(() => window.viewers[0].statistics.tetrahedra), 0);
  console.log(
    `ok    ${filename}: installed, type-checked, built, two viewers and a client on one page`,
  );
  await page.context().close();
  await checkExamples(browser, server);
} finally {
  await browser.close();
  server.kill();
}
