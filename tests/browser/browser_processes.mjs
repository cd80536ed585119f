// The processes of the browser that this program has started: memory and processor time.

import {readdirSync, readFileSync} from 'node:fs';

/**
 * The browser's processes of this kind that this process has started: process id and resident
 * megabytes.
 */
function browsers(kind) {
  const processes = readdirSync('/proc')
    .filter((name) => /^\d+$/.test(name))
    .flatMap((pid) => {
      try {
        const status = readFileSync(`/proc/${pid}/status`, 'utf8');
        return [
          {
            pid,
            parent: /PPid:\s+(\d+)/.exec(status)[1],
            resident: Number(/VmRSS:\s+(\d+)/.exec(status)?.[1] ?? 0) / 1024,
            words: readFileSync(`/proc/${pid}/cmdline`, 'utf8'),
          },
        ];
      } catch {
        return []; // the process has ended
      }
    });
  const parents = new Map(processes.map(({pid, parent}) => [pid, parent]));
  const isOurs = (pid) =>
    pid === String(process.pid) || (parents.has(pid) && isOurs(parents.get(pid)));
  return processes.filter(({pid, words}) => words.includes(`--type=${kind}`) && isOurs(pid));
}

/** Resident memory of the largest page. */
export const rendererMegabytes = () =>
  Math.max(0, ...browsers('renderer').map(({resident}) => resident));

const kTicks = 100; // per second: USER_HZ
const ticksOf = (path) =>
  readFileSync(path, 'utf8')
    .replace(/.*\) /, '')
    .split(' ')
    .slice(11, 13)
    .reduce((sum, text) => sum + Number(text), 0);

/** The processor time of the graphics. */
export const graphicsSeconds = () =>
  browsers('gpu-process').reduce((sum, {pid}) => sum + ticksOf(`/proc/${pid}/stat`) / kTicks, 0);

/** The processor time of the pages' workers, without other programs on this machine. */
export function workerSeconds() {
  let ticks = 0;
  for (const {pid} of browsers('renderer')) {
    for (const thread of readdirSync(`/proc/${pid}/task`)) {
      const path = `/proc/${pid}/task/${thread}/stat`;
      if (/\(DedicatedWorker/.test(readFileSync(path, 'utf8'))) ticks += ticksOf(path);
    }
  }
  return ticks / kTicks;
}
