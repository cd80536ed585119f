// The tool `qtet` as WebAssembly (simplify/portable/in_node.cpp), on the files of a host.

import {Exit, type HostFiles, type Streams, Wasi} from './wasi';

/** Exit codes of the tool (simplify/words/console.h). */
export const kFailed = 1;

/** A module that wants more memory than this has met its limit of 4 GB, and nothing else. */
const kNearlyAllMemory = 3.5 * 2 ** 30;

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  malloc(bytes: number): number;
  qtet_main(count: number, words: number): number;
}

/** An instance of the module, before `_initialize`. */
export type Tool = Exports & Readonly<Record<string, (...words: (number | bigint)[]) => unknown>>;

export interface Host<Handle> {
  files: HostFiles<Handle>;
  streams: Streams;
  /** PWD is the folder in which relative names begin, TMPDIR that of temporary files. */
  environment: Readonly<Record<string, string>>;
}

/**
 * Does what `qtet WORDS...` does, and returns its exit code. Files are read by ranges. Errors are
 * written to the stream of errors.
 */
export function runTool<Handle>(
  module: WebAssembly.Module,
  words: readonly string[],
  host: Host<Handle>,
): number {
  const {tool, wasi} = started(module, host);
  try {
    tool._initialize();
    return tool.qtet_main(words.length + 1, placed(tool, ['qtet', ...words]));
  } catch (thrown) {
    if (thrown instanceof Exit) return thrown.code;
    // a stack that is full is no error of WebAssembly's own
    if (!(thrown instanceof WebAssembly.RuntimeError || thrown instanceof RangeError)) throw thrown;
    host.streams.write(2, new TextEncoder().encode(`qtet: ${reasonOf(tool, thrown)}\n`));
    return kFailed;
  } finally {
    wasi.close();
  }
}

/** The module on a host. */
export function started<Handle>(
  module: WebAssembly.Module,
  host: Host<Handle>,
): {tool: Tool; wasi: Wasi<Handle>} {
  const wasi = new Wasi(host.files, host.streams, host.environment);
  const instance = new WebAssembly.Instance(module, {wasi_snapshot_preview1: wasi.imports});
  const tool = instance.exports as unknown as Tool;
  wasi.attach(tool.memory);
  return {tool, wasi};
}

/** The words as main() takes them: pointers to texts that end in NUL, and a null pointer. */
function placed(tool: Tool, words: readonly string[]): number {
  const texts = words.map((word) => new TextEncoder().encode(`${word}\0`));
  const pointers = tool.malloc(4 * (words.length + 1)) >>> 0;
  texts.forEach((text, i) => {
    const at = tool.malloc(text.length) >>> 0;
    new Uint8Array(tool.memory.buffer, at, text.length).set(text);
    new DataView(tool.memory.buffer).setUint32(pointers + 4 * i, at, true);
  });
  new DataView(tool.memory.buffer).setUint32(pointers + 4 * words.length, 0, true);
  return pointers;
}

/** Whether the module has no more memory. */
export const isFull = (tool: Tool): boolean => tool.memory.buffer.byteLength > kNearlyAllMemory;

/** Why the module ended, for people. */
export function reasonOf(tool: Tool, thrown: Error): string {
  return isFull(tool)
    ? 'the mesh does not fit into the 4 GB that WebAssembly has; use the tool of the Python or ' +
        'Debian package'
    : `the file is damaged, or qtet has a defect: ${thrown.message}`;
}
