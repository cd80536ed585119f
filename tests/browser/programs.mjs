// The programs under test: qtet makes logs; qtet-server serves them, and can be killed and started
// again on its port.

import {execFileSync, spawn} from 'node:child_process';
import {mkdirSync, rmSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {freePort} from '../support/free_port.mjs';

const kStartTimeoutMs = 20000;

/**
 * Makes OUT/logs/NAME.qtet from a sample and asks qtet for the digest of the whole mesh. `sample`
 * are the words of `qtet sample`, `options` further ones of `qtet simplify`.
 */
export function makeLog(bin, name, out, sample = [name], options = []) {
  const folder = join(out, 'logs');
  const mesh = join(out, `${name}.vtu`);
  const log = join(folder, `${name}.qtet`);
  const tool = join(bin, 'qtet');
  mkdirSync(folder, {recursive: true});
  const run = (...words) =>
    execFileSync(tool, words, {encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe']});
  run('sample', ...sample, '-o', mesh);
  run('simplify', mesh, '-o', log, ...options);
  const report = JSON.parse(run('verify', log, '--json'));
  return {name, folder, meshDigest: report.meshDigest};
}

/** The folders of publishedOnce. */
const published = new Set();

/** Publishes the logs to OUT/published, once for all checks: it compresses the viewer's files. */
export function publishedOnce({bin, logs, viewer, out}) {
  const folder = join(out, 'published');
  if (published.has(folder)) return folder;
  rmSync(folder, {recursive: true, force: true});
  const paths = [logs.fin, logs.box].map(({folder: at, name}) => join(at, `${name}.qtet`));
  execFileSync(join(bin, 'qtet'), ['publish', folder, ...paths, '--viewer', viewer]);
  published.add(folder);
  return folder;
}

/** Serves the mesh of a .vtu file's text as NAME, too; the server starts again for it. */
export async function serveMesh({server, logs, out, bin}, name, text, options = []) {
  const mesh = join(out, `${name}.vtu`);
  writeFileSync(mesh, text);
  const log = join(logs.fin.folder, `${name}.qtet`);
  execFileSync(join(bin, 'qtet'), ['simplify', mesh, '-o', log, ...options], {stdio: 'pipe'});
  server.kill();
  await server.start();
}

export class Server {
  #process = null;
  /** Resolves when the previous server has left its port. */
  #exited = Promise.resolve();
  port = 0;

  constructor(bin, folder, viewer, options = []) {
    this.command = join(bin, 'qtet-server');
    this.arguments = [folder, '--viewer', viewer, ...options];
  }

  get url() {
    return `http://127.0.0.1:${this.port}/`;
  }

  /** Starts the server, always on the same port, if it is not running. */
  async start() {
    if (this.#process) return;
    await this.#exited;
    if (this.port !== 0) return this.#listen();
    // The port must be below those of outgoing connections, to be free when the server comes back.
    for (;;) {
      this.port = freePort();
      try {
        return await this.#listen();
      } catch (error) {
        if (!/in use/.test(error.message)) throw error;
        this.#process = null;
      }
    }
  }

  async #listen() {
    const started = spawn(this.command, [...this.arguments, '--port', String(this.port)], {
      stdio: ['ignore', 'pipe', 'pipe'],
    });
    this.#process = started;
    let said = '';
    await new Promise((resolve, reject) => {
      const timer = setTimeout(
        () => reject(new Error(`qtet-server does not listen; it said: ${said}`)),
        kStartTimeoutMs,
      );
      const receive = (text) => {
        said += text;
        if (!said.includes('listening on http')) return;
        clearTimeout(timer);
        resolve();
      };
      started.stdout.setEncoding('utf8').on('data', receive);
      started.stderr.setEncoding('utf8').on('data', (text) => void (said += text));
      started.once('exit', (code) => {
        clearTimeout(timer);
        reject(new Error(`qtet-server ended with ${code}; it said: ${said}`));
      });
    });
  }

  /** Kills it without a chance to clean up. */
  kill() {
    const ending = this.#process;
    if (!ending) return;
    ending.removeAllListeners('exit');
    if (ending.exitCode === null)
      this.#exited = new Promise((resolve) => void ending.once('exit', resolve));
    ending.kill('SIGKILL');
    this.#process = null;
  }
}
