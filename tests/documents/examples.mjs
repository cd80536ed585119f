// How an example of each language is tested. `check` looks without running, `run` runs. Both throw
// the fault. `run` may return why it could only check, `check` why it could not.

import {existsSync, mkdirSync, readdirSync, writeFileSync} from 'node:fs';
import {dirname, join} from 'node:path';

import {jsonValuesOf} from './blocks.mjs';

/** Where the library and its header are installed for the examples of C and CMake. */
const kInstalled = 'installed';
const kEmptyMain = 'int main(void) { return 0; }\n';
const kVoidElements = ['br', 'img', 'input', 'link', 'meta', 'hr'];

/** `did`: what was done with it, where that is not running. */
export const kLanguages = {
  sh: {check: checkShell, run: runShell},
  json: {check: checkJson, run: checkJson, did: 'parsed'},
  c: {check: compileC, run: runC},
  cmake: {check: configure, run: configure, did: 'built'},
  python: {check: checkPython, run: runPython},
  html: {check: checkHtml, run: (...all) => checkHtml(...all) ?? 'needs a browser'},
  ts: {check: checkTypes, run: (...all) => checkTypes(...all) ?? 'needs a browser'},
  js: {check: checkScript, run: runScript},
  tokens: {check: checkTokens, run: checkTokens, did: 'taken by qtet-server'},
};

// ---- the shell

function checkShell({text}, {scratch, options}) {
  scratch.run('bash', ['-n'], {input: text});
  const strangers = options.strangersIn(text);
  if (strangers.length > 0) throw new Error(strangers.join('\n'));
}

function runShell(block, context) {
  checkShell(block, context);
  const {scratch} = context;
  const text = scratch.local(block.text);
  if (asksServer(text, scratch) && !/\bqtet-server\b/.test(text)) scratch.ensureServer();
  scratch.run('bash', ['-euo', 'pipefail', '-c', text]);
}

const asksServer = (text, scratch) => text.includes(`127.0.0.1:${scratch.port}`);

// ---- data

function checkJson({text}) {
  jsonValuesOf(text);
}

/** Stays in the folder as the token file of the document's server. */
function checkTokens({text}, {scratch}) {
  writeFileSync(scratch.path('tokens'), text);
  scratch.run('qtet-server', ['served', '--tokens', 'tokens', '--check-config']);
}

// ---- C and CMake, against the library as it is installed

/** The source that the document's other examples build: its first program in C. */
export function writeSource(blocks, scratch) {
  const program = blocks.find(({language}) => language === 'c');
  writeFileSync(scratch.path('mine.c'), program?.text ?? kEmptyMain);
}

function installed(scratch) {
  const prefix = scratch.path(kInstalled);
  if (existsSync(prefix)) return prefix;
  for (const component of ['library', 'development']) {
    const words = ['--install', 'build/release', '--prefix', prefix, '--component', component];
    scratch.run('cmake', words);
  }
  return prefix;
}

/** The folder of the installed library: lib, or Debian's lib/ARCHITECTURE. */
function libraryFolder(scratch) {
  const prefix = installed(scratch);
  const file = readdirSync(prefix, {recursive: true}).find((path) => path.endsWith('/qtet.pc'));
  return dirname(dirname(join(prefix, file)));
}

function compileC({text}, {scratch}, program = null) {
  const lib = libraryFolder(scratch);
  const environment = {PKG_CONFIG_PATH: join(lib, 'pkgconfig')};
  const words = scratch.run('pkg-config', ['--cflags', '--libs', 'qtet'], {environment});
  const strict = ['-std=c99', '-pedantic', '-Wall', '-Wextra', '-Werror'];
  const how = program ? ['-o', program, `-Wl,-rpath,${lib}`] : ['-fsyntax-only'];
  writeFileSync(scratch.path('example.c'), text);
  scratch.run('cc', [...strict, 'example.c', ...words.trim().split(/\s+/), ...how]);
}

function runC(block, context) {
  const hasMain = /\bmain *\(/.test(block.text);
  compileC(block, context, hasMain ? 'example' : null);
  if (!hasMain) return 'has no main';
  context.scratch.run('./example', []);
}

/** The lines in the CMakeLists.txt of a program `mine`, which is built. */
function configure({text}, {scratch}) {
  const folder = scratch.path('cmake');
  mkdirSync(folder, {recursive: true});
  const head =
    'cmake_minimum_required(VERSION 3.25)\nproject(mine C)\nadd_executable(mine ../mine.c)\n';
  writeFileSync(join(folder, 'CMakeLists.txt'), head + text);
  const prefix = `-DCMAKE_PREFIX_PATH=${installed(scratch)}`;
  scratch.run('cmake', ['-S', folder, '-B', join(folder, 'build'), prefix]);
  scratch.run('cmake', ['--build', join(folder, 'build')]);
}

// ---- Python

const kModulesMissing = `
import ast, importlib.util, sys
for node in ast.walk(ast.parse(sys.stdin.read())):
    names = [n.name for n in node.names] if isinstance(node, ast.Import) else []
    names += [node.module] if isinstance(node, ast.ImportFrom) else []
    for top in (name.split(".")[0] for name in names):
        if importlib.util.find_spec(top) is None:
            print(top)
`;

/** Modules that it imports and are not there. */
function missingModules({text}, scratch, python) {
  const environment = pythonEnvironment(scratch);
  const said = scratch.run(python, ['-B', '-c', kModulesMissing], {input: text, environment});
  return said.split('\n').filter((name) => name !== '');
}

function pythonEnvironment(scratch) {
  return {
    PYTHONPATH: join(scratch.root, 'codec/python'),
    QTET_LIBRARY: join(scratch.build, 'lib/libqtet.so'),
  };
}

function checkPython(block, {scratch, python}) {
  if (!python) return 'not even its syntax: there is no python3';
  missingModules(block, scratch, python);
}

function runPython(block, context) {
  const {scratch, python} = context;
  const unchecked = checkPython(block, context);
  if (unchecked) return unchecked;
  // The modules of ours want VTK's, and say so when they are imported.
  const modules = missingModules({text: `${block.text}\n${importsOfOurs(block)}`}, scratch, python);
  if (modules.length > 0) return `no Python module ${modules.join(', ')} here`;
  const text = scratch.local(block.text);
  if (asksServer(text, scratch)) scratch.ensureServer();
  scratch.run(python, ['-B', '-c', text], {environment: pythonEnvironment(scratch)});
}

const importsOfOurs = ({text}) => (/\bqtet\.vtk\b/.test(text) ? 'import vtkmodules' : '');

// ---- pages

function checkHtml({text}, {scratch}) {
  const open = [];
  for (const [, end, name] of text.matchAll(/<(\/?)([a-z][a-z0-9-]*)(?:"[^"]*"|[^">])*>/g)) {
    if (end === '') open.push(name);
    else if (open.pop() !== name) throw new Error(`</${name}> closes another element`);
    if (kVoidElements.includes(open.at(-1))) open.pop();
  }
  if (open.length > 0) throw new Error(`<${open.at(-1)}> is never closed`);
  for (const [, script] of text.matchAll(/<script[^>]*>([^]*?)<\/script>/g)) {
    checkScript({text: script}, {scratch});
  }
}

function checkScript({text}, {scratch}) {
  writeFileSync(scratch.path('example.mjs'), text);
  scratch.run(process.execPath, ['--check', 'example.mjs']);
}

function runScript(block, context) {
  const {scratch} = context;
  const text = scratch.local(block.text);
  if (asksServer(text, scratch)) scratch.ensureServer();
  checkScript({text}, context);
  scratch.run(process.execPath, ['example.mjs']);
}

/** Checks it as a module of the page's own sources, which stand for the package. */
function checkTypes({text}, {scratch}) {
  const page = join(scratch.root, 'web-client');
  const compiler = join(page, 'node_modules/typescript/bin/tsc');
  if (!existsSync(compiler)) return 'not even its syntax: web-client has no node_modules';
  const modules = {
    qtet: 'viewer/index.ts',
    'qtet/element': 'viewer/element.ts',
    'qtet/core': 'core/index.ts',
    'qtet/webgl': 'webgl/index.ts',
    'qtet/three': 'three/index.ts',
  };
  const paths = Object.fromEntries(
    Object.entries(modules).map(([name, file]) => [name, [join(page, file)]]),
  );
  const project = {
    extends: join(page, 'tsconfig.json'),
    compilerOptions: {paths, typeRoots: [join(page, 'node_modules')], types: ['vite/client']},
    files: ['example.ts'],
  };
  writeFileSync(scratch.path('tsconfig.json'), JSON.stringify(project));
  writeFileSync(scratch.path('example.ts'), text);
  scratch.run(process.execPath, [compiler, '--project', 'tsconfig.json']);
}
