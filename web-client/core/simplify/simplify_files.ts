// Simplifies mesh files of this machine in a worker. Nothing leaves the machine.

import moduleUrl from 'qtet-simplify.wasm?url';
import {QtetError} from '../protocol/errors';
import type {SimplifiedFile, SimplifyProgress} from './simplify_file';
import type {SimplifyMessage, SimplifyRequest} from './simplify_worker';

/** Endings of files that name others, in the order in which they are preferred. */
const kNaming = ['.pvd', '.vtm', '.pvtu', '.pvts', '.pvtr', '.pvti', '.node'];

/** The file to read among those that were chosen together. REQUIRES: at least one. */
export function mainFile(files: readonly File[]): File {
  for (const ending of kNaming) {
    const naming = files.find(({name}) => name.toLowerCase().endsWith(ending));
    if (naming) return naming;
  }
  return files[0]!;
}

/**
 * The log of a mesh, byte for byte that of `qtet simplify` without options. `files`: the mesh's
 * file and those that it names; a .gz is inflated first. Rejects with QtetError: the tool's codes
 * and texts, `limit-exceeded` where memory ends, `no-simplifier` where it cannot be loaded,
 * `cancelled` by the signal.
 */
export async function simplifyFiles(
  files: readonly File[],
  listen: (progress: SimplifyProgress) => void,
  signal: AbortSignal,
): Promise<SimplifiedFile> {
  const inflatedFiles = await Promise.all(files.map(inflated));
  const {name} = mainFile(inflatedFiles);
  const worker = new Worker(new URL('./simplify_worker.ts', import.meta.url), {
    type: 'module',
    name: 'qtet-simplify',
  });
  try {
    return await new Promise((resolve, reject) => {
      const cancelled = (): void => reject(new QtetError('cancelled', `${name} was given up.`));
      if (signal.aborted) return cancelled();
      signal.addEventListener('abort', cancelled, {once: true});
      worker.onmessage = ({data}: MessageEvent<SimplifyMessage>) => {
        if (data.type === 'progress') listen(data);
        else if (data.type === 'done') resolve(data);
        else reject(new QtetError(data.code, data.message));
      };
      worker.onerror = ({message}) =>
        reject(new QtetError('internal', `The simplifier stopped: ${message || 'unknown cause'}.`));
      const request: SimplifyRequest = {
        moduleUrl: new URL(moduleUrl, import.meta.url).href,
        files: inflatedFiles,
        name,
      };
      worker.postMessage(request);
    });
  } finally {
    worker.terminate();
  }
}

/** The tool, too, takes a compressed file for the one within. */
async function inflated(file: File): Promise<File> {
  if (!file.name.toLowerCase().endsWith('.gz')) return file;
  const stream = file.stream().pipeThrough(new DecompressionStream('gzip'));
  try {
    return new File([await new Response(stream).blob()], file.name.slice(0, -3));
  } catch {
    throw new QtetError('bad-input', `${file.name} does not inflate. Copy it again.`);
  }
}
