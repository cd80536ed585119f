// A folder with a small mesh, and a qtet-server over it, for the scripts of this folder.

import {spawn, spawnSync} from 'node:child_process';
import {mkdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import net from 'node:net';
import {join} from 'node:path';
import {setTimeout as sleep} from 'node:timers/promises';
import {freePort} from '../support/free_port.mjs';

/**
 * May write meshes whose names begin with "up"; those that begin with "s" nobody may read, all
 * others everybody.
 */
export const kToken = 'aSecretOfTwentyTwoChars';

function run(program, words) {
  const done = spawnSync(program, words, {encoding: 'utf8'});
  if (done.status !== 0) throw new Error(`${program} ${words.join(' ')}: ${done.stderr}`);
}

/** A cell with a field whose name is longer than a .msh takes. */
const kLongNamed = `# vtk DataFile Version 3.0
one cell
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 4 float
0 0 0 1 0 0 0 1 0 0 0 1
CELLS 1 5
4 0 1 2 3
CELL_TYPES 1
10
POINT_DATA 4
SCALARS ${'n'.repeat(253)} float
LOOKUP_TABLE default
1 2 3 4
`;

/**
 * Empties the folder `out` and makes logs/fin.qtet, other.qtet, long.qtet, tokens, viewer/ in it.
 * `bin` holds the programs.
 */
export function prepare({bin, out}) {
  rmSync(out, {recursive: true, force: true});
  for (const folder of ['logs', 'viewer']) mkdirSync(join(out, folder), {recursive: true});
  const mesh = join(out, 'fin.vtu');
  run(join(bin, 'qtet'), ['sample', 'fin', '--cells', '3000', '-o', mesh]);
  run(join(bin, 'qtet'), ['simplify', mesh, '-o', join(out, 'logs/fin.qtet')]);
  run(join(bin, 'qtet'), ['simplify', mesh, '-o', join(out, 'other.qtet'), '--field-bits', '8']);
  writeFileSync(join(out, 'long.vtk'), kLongNamed);
  run(join(bin, 'qtet'), ['simplify', join(out, 'long.vtk'), '-o', join(out, 'long.qtet')]);
  writeFileSync(join(out, 'tokens'), `write up* ${kToken}\nread [!s]* anyone\n`);
  writeFileSync(join(out, 'viewer/index.html'), '<!doctype html><title>viewer</title>');
}

/** The process, and the port that it listens on. `more` are options of the server. */
export function startServer({bin, out}, more = ['--cache', join(out, 'cache')]) {
  const words = [
    join(out, 'logs'),
    '--port',
    '0',
    '--viewer',
    join(out, 'viewer'),
    '--tokens',
    join(out, 'tokens'),
    '--max-upload-bytes',
    '1000000',
    ...more,
  ];
  const child = spawn(join(bin, 'qtet-server'), words, {stdio: ['ignore', 'pipe', 'inherit']});
  return new Promise((ready, failed) => {
    child.stdout.once('data', (line) => ready({child, port: Number(/:(\d+)\//.exec(line)?.[1])}));
    child.once('exit', (code) => failed(new Error(`qtet-server ended with ${code}`)));
  });
}

const answers = (port) =>
  new Promise((done) =>
    net
      .connect(port, '127.0.0.1', function () {
        this.destroy();
        done(true);
      })
      .on('error', () => done(false)),
  );

/**
 * Starts nginx in `folder` with the nginx.conf that `configure(port)` writes there, and again with
 * another port where that one is taken. Gives the process and the port.
 */
export async function startNginx(program, folder, configure) {
  const errors = join(folder, 'error.log');
  for (;;) {
    const port = freePort();
    rmSync(errors, {force: true});
    configure(port);
    const words = ['-e', errors, '-p', folder, '-c', join(folder, 'nginx.conf')];
    const child = spawn(program, words, {stdio: 'inherit'});
    while (child.exitCode === null) {
      if (await answers(port)) return {child, port};
      await sleep(50);
    }
    const said = readFileSync(errors, 'utf8');
    if (!said.includes('Address already in use')) throw new Error(`nginx ended: ${said}`);
  }
}
