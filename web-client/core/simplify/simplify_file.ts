// Makes a log from a mesh file by the simplifier in WebAssembly (simplify/api/wasm_simplify.h). It
// runs for seconds to minutes: in a worker (simplify_worker.ts), or where nobody waits.

import {kErrorCodes} from '../protocol/error_codes';
import {QtetError} from '../protocol/errors';
import {PageFiles, type PageFile} from './page_files';

/** Stage of simplify/pipeline/pipeline.h by its number, behind reading. */
const kStages = ['reading', 'cleaning', 'quantising', 'simplifying', 'measuring', 'encoding'];

export interface SimplifyProgress {
  /** "reading", "simplifying" ... */
  stage: string;
  /** The part of this stage that is done, 0 to 1. */
  fraction: number;
}

export interface SimplifiedFile {
  log: Uint8Array;
  notes: string[];
  /** Large losses of the base mesh, a sentence each. */
  warnings: string[];
  /** Cells of the mesh that was read. */
  tetrahedra: number;
}

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  qtet_alloc(bytes: number): number;
  qtet_simplify_file(name: number, cellsOfAPart: number): number;
  qtet_report(): number;
  qtet_log(): number;
  qtet_log_bytes(): number;
}

/**
 * The log that `qtet simplify NAME` makes without options, byte for byte. `files` holds the file of
 * that name and those that it names. With `cellsOfAPart` it is made in parts (simplify/PARTS.md).
 * Throws QtetError with the tool's codes and texts, or
 * `limit-exceeded` where memory ends.
 */
export function simplifyFile(
  module: WebAssembly.Module,
  files: readonly PageFile[],
  name: string,
  listen: (progress: SimplifyProgress) => void,
  cellsOfAPart = 0,
): SimplifiedFile {
  const place = new PageFiles(files);
  const progress = (stage: number, fraction: number): void =>
    listen({stage: kStages[stage + 1] ?? 'encoding', fraction});
  const {exports} = new WebAssembly.Instance(module, {
    wasi_snapshot_preview1: place.imports,
    qtet: {progress},
  });
  const wasm = exports as unknown as Exports;
  place.attach(wasm.memory);
  wasm._initialize();
  const code = named(wasm, name, cellsOfAPart);
  const report = textAt(wasm.memory, wasm.qtet_report());
  // The module sees the files in its root folder.
  if (code > 0)
    throw new QtetError(kErrorCodes[code - 1] ?? 'internal', report.replaceAll(`/${name}`, name));
  const {notes, warnings, tetrahedra} = JSON.parse(report) as SimplifiedFile;
  const log = new Uint8Array(
    wasm.memory.buffer,
    wasm.qtet_log() >>> 0,
    wasm.qtet_log_bytes() >>> 0,
  ).slice();
  return {log, notes, warnings, tetrahedra};
}

function named(wasm: Exports, name: string, cellsOfAPart: number): number {
  const bytes = new TextEncoder().encode(`${name}\0`);
  const address = wasm.qtet_alloc(bytes.length) >>> 0;
  new Uint8Array(wasm.memory.buffer, address, bytes.length).set(bytes);
  try {
    return wasm.qtet_simplify_file(address, cellsOfAPart);
  } catch (thrown) {
    // Nothing else traps: what is wrong with a mesh is an error, not a trap.
    if (!(thrown instanceof WebAssembly.RuntimeError)) throw thrown;
    throw new QtetError(
      'limit-exceeded',
      `${name} needs more memory than a page has; make a log by \`qtet simplify\` and drop that.`,
    );
  }
}

function textAt(memory: WebAssembly.Memory, address: number): string {
  const bytes = new Uint8Array(memory.buffer, address >>> 0);
  return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
}
