// The folder that a document's examples run in. It looks like the repository's root after a build,
// with meshes and logs under the names that the examples use. In an example /tmp and /opt mean
// places in the folder, and port 8080 a free one.

import {execFileSync, spawnSync} from 'node:child_process';
import {
  cpSync,
  existsSync,
  mkdirSync,
  readFileSync,
  readdirSync,
  rmSync,
  symlinkSync,
  writeFileSync,
} from 'node:fs';
import {delimiter, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {freePort} from '../support/free_port.mjs';

const kTimeoutMs = 300_000;
const kRooms = ['codec', 'proto', 'server', 'simplify', 'tests', 'web-client'];
const kCompilers = ['cc', 'gcc-12', 'gcc', 'clang-19', 'clang'];
const kStandIns = fileURLToPath(new URL('stand_ins/', import.meta.url));

/** Two hexahedra. */
const kVoxels = `# vtk DataFile Version 3.0
voxels
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 12 float
0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0 0 0 1 1 0 1 2 0 1 0 1 1 1 1 1 2 1 1
CELLS 2 18
8 0 1 4 3 6 7 10 9
8 1 2 5 4 7 8 11 10
CELL_TYPES 2
12 12
`;

/** The files that every document's examples find: made once, from a built-in sample. */
export function makeInputs(bin, folder) {
  rmSync(folder, {recursive: true, force: true});
  mkdirSync(join(folder, 'served'), {recursive: true});
  const qtet = (...words) => execFileSync(join(bin, 'qtet'), words, {cwd: folder, stdio: 'pipe'});
  qtet('sample', 'box', '-o', 'box.vtu');
  withFields(folder, 'part.vtu', ['Density']);
  withFields(folder, 'part-with-stress.vtu', ['Stress']);
  for (const file of ['step.vtu', 'step-17.vtu', 'step-18.vtu']) {
    withFields(folder, file, ['T', 'U']);
  }
  writeFileSync(join(folder, 'voxels.vtk'), kVoxels);
  writeFileSync(join(folder, 'bent.vtk'), kVoxels.replace('2 1 1\nCELLS', '2 1 1.2\nCELLS'));
  writeFileSync(join(folder, 'run.pvd'), collection(['step.vtu', 'step.vtu', 'step.vtu']));
  writeFileSync(join(folder, 'moving.pvd'), collection(['voxels.vtk', 'bent.vtk']));
  qtet('simplify', 'part.vtu', '-o', 'part.qtet');
  for (const copy of ['wing.qtet', 'served/part.qtet']) {
    cpSync(join(folder, 'part.qtet'), join(folder, copy));
  }
}

/** A series of these files, a quarter of a unit of time apart. */
function collection(files) {
  const sets = files.map((file, i) => `<DataSet timestep="${i / 4}" file="${file}"/>`).join('');
  return `<VTKFile type="Collection"><Collection>${sets}</Collection></VTKFile>\n`;
}

/** The box's one field under other names, in a file of its own. */
function withFields(folder, file, names) {
  const box = readFileSync(join(folder, 'box.vtu'), 'latin1');
  const renamed = box
    .replace('Scalars="Scalar"', '')
    .replace(/ *<DataArray .*Name="Scalar".*\n/, (array) =>
      names.map((name) => array.replace('"Scalar"', `"${name}"`)).join(''),
    );
  writeFileSync(join(folder, file), renamed, 'latin1');
}

export class Scratch {
  #environment;

  /** `build`: the folder of the build; `inputs`: what makeInputs has made, or null. */
  static async create({root, build, inputs, folder}) {
    rmSync(folder, {recursive: true, force: true});
    if (inputs) cpSync(inputs, folder, {recursive: true});
    for (const own of ['build/release/bin', 'tmp', 'opt']) {
      mkdirSync(join(folder, own), {recursive: true});
    }
    for (const room of kRooms) symlinkSync(join(root, room), join(folder, room));
    linkAll(build, join(folder, 'build/release'), ['bin']);
    const standIns = readdirSync(kStandIns);
    linkAll(join(build, 'bin'), join(folder, 'build/release/bin'), standIns);
    linkAll(kStandIns, join(folder, 'build/release/bin'), []);
    // Debian's g++-12 brings no cc.
    const compiler = kCompilers.map(onPath).find((path) => path !== undefined);
    if (compiler) symlinkSync(compiler, join(folder, 'build/release/bin/cc'));
    return new Scratch({root, build, folder, port: freePort()});
  }

  constructor({root, build, folder, port}) {
    Object.assign(this, {root, build, folder, port});
    const {QTET_TOKEN: _, ...inherited} = process.env;
    this.#environment = {
      ...inherited,
      LC_ALL: 'C.UTF-8',
      PATH: `${this.path('build/release/bin')}:${process.env.PATH}`,
      QTET_BIN: join(build, 'bin'),
      QTET_SCRATCH: folder,
      QTET_SERVER_PORT: String(port),
    };
  }

  path(name) {
    return join(this.folder, name);
  }

  /** An example's text with this machine's places in it. */
  local(text) {
    return text
      .replace(/(?<![\w.~/-])\/(tmp|opt)\b/g, (_, name) => this.path(name))
      .replace(/\b(127\.0\.0\.1|localhost):8080\b/g, `127.0.0.1:${this.port}`);
  }

  /** Runs a program in the folder; it must end with 0. Gives its standard output. */
  run(program, words, {input = '', environment = {}} = {}) {
    const done = spawnSync(program, words, {
      cwd: this.folder,
      input,
      encoding: 'utf8',
      env: {...this.#environment, ...environment},
      timeout: kTimeoutMs,
    });
    if (done.error) throw new Error(`${program}: ${done.error.message}`);
    if (done.status === 0) return done.stdout;
    throw new Error(`${done.stdout}${done.stderr}${program} ended with ${done.status}`);
  }

  /** Serves an example that uses the port, where none before it has started a server. */
  ensureServer() {
    if (existsSync(this.path('server.pid'))) return;
    const tokens = existsSync(this.path('tokens')) ? ['--tokens', 'tokens'] : [];
    this.run(join(kStandIns, 'qtet-server'), ['served', ...tokens]);
  }

  stopServer() {
    if (!existsSync(this.path('server.pid'))) return;
    const server = Number(readFileSync(this.path('server.pid'), 'utf8'));
    rmSync(this.path('server.pid'));
    try {
      process.kill(server);
    } catch (error) {
      if (error.code !== 'ESRCH') throw error;
    }
  }
}

function linkAll(from, to, except) {
  for (const name of readdirSync(from)) {
    if (!except.includes(name)) symlinkSync(join(from, name), join(to, name));
  }
}

function onPath(program) {
  const folders = process.env.PATH.split(delimiter);
  return folders.map((folder) => join(folder, program)).find((path) => existsSync(path));
}
