// The processes that this program has started, above all the browser's: memory and processor time.

import {readdirSync, readFileSync} from 'node:fs';

/** This process and those that it has started, as {pid, resident, words}: megabytes, command. */
function ours() {
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
  return processes.filter(({pid}) => isOurs(pid));
}

/** The browser's processes of this kind that this process has started. */
const browsers = (kind) => ours().filter(({words}) => words.includes(`--type=${kind}`));

/** Resident memory of the largest page. */
export const rendererMegabytes = () =>
  Math.max(0, ...browsers('renderer').map(({resident}) => resident));

const kTicks = 100; // per second: USER_HZ
/** The time of a process or thread, also of children that have ended (`withEnded`). */
const ticksOf = (path, {withEnded = false} = {}) =>
  readFileSync(path, 'utf8')
    .replace(/.*\) /, '')
    .split(' ')
    .slice(11, withEnded ? 15 : 13)
    .reduce((sum, text) => sum + Number(text), 0);

/** The processor time of this process and all that it has started. */
export function processorSeconds() {
  let ticks = 0;
  for (const {pid} of ours()) {
    try {
      ticks += ticksOf(`/proc/${pid}/stat`, {withEnded: true});
    } catch {
      // the process has ended
    }
  }
  return ticks / kTicks;
}

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
