// Makes the npm package `qtet` in a folder: modules, types, package.json, README, licence, and the
// command with its WebAssembly and the viewer for its pages. It takes these from the build that
// made the codec; a build without Debian's sources has no command.
//   node pack.mjs CODEC.wasm FOLDER

import {execFileSync} from 'node:child_process';
import {copyFileSync, cpSync, existsSync, readdirSync, readFileSync, rmSync} from 'node:fs';
import {writeFileSync} from 'node:fs';
import {dirname, join, relative, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';
import {originOf, repositoryOf} from './repository.mjs';
import {addEndings} from './typed_paths.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const [wasm, folder] = process.argv.slice(2, 4).map((path) => resolve(path));
const node = (script, ...words) =>
  execFileSync(process.execPath, [script, ...words], {
    cwd: here,
    stdio: 'inherit',
    env: {...process.env, QTET_WASM: wasm, QTET_PACKAGE_OUT: folder},
  });
node(
  'node_modules/vite/bin/vite.js',
  'build',
  '--config',
  'vite.package.config.ts',
  '--logLevel',
  'warn',
);
node(
  'node_modules/typescript/bin/tsc',
  '--project',
  'tsconfig.package.json',
  '--outDir',
  join(folder, 'types'),
);
addEndings(join(folder, 'types'));

/** A private member with its comment. A private constructor stays: it forbids `new`. */
const kPrivate = /^ +(?:\/\*\*(?:(?!\*\/)[\s\S])*\*\/\s+)?private (?!constructor)[^\n]*;\n/gm;
const types = join(folder, 'types');
for (const name of readdirSync(types, {recursive: true})) {
  const path = join(types, name);
  if (path.endsWith('.d.ts')) writeFileSync(path, readFileSync(path, 'utf8').replace(kPrivate, ''));
}

const tool = join(dirname(wasm), 'qtet-tool.wasm');
const hasTool = existsSync(tool);
if (hasTool) {
  copyFileSync(tool, join(folder, 'qtet-tool.wasm'));
  // Compressed copies are for servers. A page takes no dropped meshes.
  const viewer = join(dirname(wasm), '../share/qtet/viewer');
  const {simplifier} = JSON.parse(readFileSync(join(viewer, 'viewer.json'), 'utf8'));
  const isLeftOut = (name) => /\.(gz|br|zst)$/.test(name) || simplifier.includes(name);
  cpSync(viewer, join(folder, 'viewer'), {
    recursive: true,
    filter: (from) => !isLeftOut(relative(viewer, from).replaceAll('\\', '/')),
  });
} else {
  console.error('pack: the command qtet is left out; run make setup, and build again');
  for (const name of ['qtet.js', 'qtet-tool.third-party.txt']) rmSync(join(folder, name));
}

const own = JSON.parse(readFileSync(join(here, 'package.json'), 'utf8'));
const entry = (name, types) => ({types: `./types/${types}.d.ts`, default: `./${name}.js`});
writeFileSync(
  join(folder, 'package.json'),
  `${JSON.stringify(
    {
      name: 'qtet',
      version: own.version,
      description: own.description,
      license: 'Apache-2.0',
      repository: repositoryOf(originOf(here)), // left out where it is undefined
      type: 'module',
      ...(hasTool ? {bin: {qtet: './qtet.js'}} : {}),
      keywords: [
        'tetrahedral mesh',
        'progressive',
        'simulation',
        'CFD',
        'FEM',
        'three',
        'web component',
      ],
      exports: {
        '.': entry('viewer', 'viewer/index'),
        './element': entry('element', 'viewer/element'),
        './core': entry('core', 'core/index'),
        './webgl': entry('webgl', 'webgl/index'),
        './three': entry('three', 'three/index'),
      },
      sideEffects: ['./element.js'],
      // Any release of three may rename what we use: the one that is tested, and its corrections.
      peerDependencies: {three: `^${own.devDependencies.three}`},
      peerDependenciesMeta: {three: {optional: true}},
      dependencies: {uplot: own.dependencies.uplot},
    },
    null,
    2,
  )}\n`,
);
copyFileSync(join(here, 'docs/PACKAGE.md'), join(folder, 'README.md'));
copyFileSync(join(here, '../LICENSE'), join(folder, 'LICENSE'));
