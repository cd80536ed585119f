// The tool and the C libraries for the Python package in Pyodide, on Pyodide's files. Python
// evaluates this file as a script (codec/python/qtet/wasm.py).

import type {HostFiles, Status, Streams} from './wasi';
import {isFull, reasonOf, runTool, started, type Tool} from './run_tool';

interface Stream {
  fd: number;
  path: string;
}

interface EmscriptenStatus extends Omit<Status, 'mtimeMs'> {
  mtime: Date;
}

/** The part of Emscripten's file system that is used here. Errors have WASI's numbers. */
export interface EmscriptenFiles {
  open(name: string, flags: number): Stream;
  close(file: Stream): void;
  read(file: Stream, into: Uint8Array, from: number, length: number, at?: number): number;
  write(file: Stream, bytes: Uint8Array, from: number, length: number, at?: number): number;
  /** Emscripten has it since 4.0. */
  fstat?(fd: number): EmscriptenStatus;
  stat(name: string): EmscriptenStatus;
  lstat(name: string): EmscriptenStatus;
  readdir(folder: string): string[];
  mkdir(name: string): void;
  rmdir(name: string): void;
  unlink(name: string): void;
  rename(from: string, to: string): void;
  readlink(name: string): string;
  readFile(name: string): Uint8Array;
}

/** Flags of musl, as Emscripten has them. */
const kConstants = {
  O_RDONLY: 0,
  O_WRONLY: 1,
  O_RDWR: 2,
  O_CREAT: 0o100,
  O_EXCL: 0o200,
  O_TRUNC: 0o1000,
  O_APPEND: 0o2000,
};

const statusOf = (status: EmscriptenStatus): Status => ({
  ...status,
  mtimeMs: status.mtime.getTime(),
});

/** Some of Emscripten's file systems take the whole buffer for the bytes. So they get that. */
const whole = (bytes: Uint8Array): [Uint8Array, number, number] => [
  new Uint8Array(bytes.buffer),
  bytes.byteOffset,
  bytes.length,
];

function hostFiles(fs: EmscriptenFiles): HostFiles<Stream> {
  return {
    open: (name, flags) => fs.open(name, flags),
    close: (file) => fs.close(file),
    read: (file, bytes, at) => fs.read(file, ...whole(bytes), at ?? undefined),
    write: (file, bytes, at) => fs.write(file, ...whole(bytes), at ?? undefined),
    sync: () => undefined,
    statusOf: (file) => statusOf(fs.fstat ? fs.fstat(file.fd) : fs.stat(file.path)),
    status: (name, followLink) => statusOf(followLink ? fs.stat(name) : fs.lstat(name)),
    names: (folder) => fs.readdir(folder).filter((name) => name !== '.' && name !== '..'),
    makeFolder: (name) => fs.mkdir(name),
    removeFolder: (name) => fs.rmdir(name),
    remove: (name) => fs.unlink(name),
    rename: (from, to) => fs.rename(from, to),
    link() {
      throw Object.assign(new Error('no hard links'), {code: 'ENOTSUP'});
    },
    readLink: (name) => fs.readlink(name),
    constants: kConstants,
  };
}

/** Keeps what is written to the output and to the errors. */
class KeptStreams implements Streams {
  private readonly decoders = {1: new TextDecoder(), 2: new TextDecoder()};
  readonly texts = {1: '', 2: ''};

  read(): number {
    return 0;
  }

  write(stream: 1 | 2, bytes: Uint8Array): void {
    this.texts[stream] += this.decoders[stream].decode(bytes, {stream: true});
  }

  isTerminal(): boolean {
    return false;
  }
}

/** The functions of the C libraries on a memory of their own. */
export class Library {
  private readonly decoder = new TextDecoder();

  constructor(private readonly tool: Tool) {}

  has(name: string): boolean {
    return name in this.tool;
  }

  /**
   * An integer of 64 bits is given as a text. Throws an error with a text for people where the
   * module ends. It must not run again then.
   */
  call(name: string, ...words: (number | string)[]): number | undefined {
    const given = words.map((word) => (typeof word === 'string' ? BigInt(word) : word));
    try {
      const result = this.tool[name]!(...given) as number | undefined;
      return typeof result === 'number' ? result >>> 0 : result;
    } catch (thrown) {
      throw new Error(reasonOf(this.tool, thrown as Error));
    }
  }

  /** Whether the module ended because it has no more memory. */
  get isFull(): boolean {
    return isFull(this.tool);
  }

  bytes(at: number, length: number): Uint8Array {
    return new Uint8Array(this.tool.memory.buffer, at, length);
  }

  /** The text up to NUL. */
  text(at: number): string {
    const rest = new Uint8Array(this.tool.memory.buffer, at);
    return this.decoder.decode(rest.subarray(0, rest.indexOf(0)));
  }
}

/** The module in the file `name`. */
export class Module {
  private readonly module: WebAssembly.Module;
  private readonly files: HostFiles<Stream>;

  constructor(fs: EmscriptenFiles, name: string) {
    this.files = hostFiles(fs);
    this.module = new WebAssembly.Module(fs.readFile(name) as Uint8Array<ArrayBuffer>);
  }

  /** Words and environment are JSON. Returns the exit code, and what was printed and said. */
  run(words: string, environment: string): [code: number, printed: string, said: string] {
    const streams = new KeptStreams();
    const host = {files: this.files, streams, environment: parsed(environment)};
    const code = runTool(this.module, JSON.parse(words) as string[], host);
    return [code, streams.texts[1], streams.texts[2]];
  }

  library(environment: string): Library {
    const host = {
      files: this.files,
      streams: new KeptStreams(),
      environment: parsed(environment),
    };
    const {tool} = started(this.module, host);
    tool._initialize();
    return new Library(tool);
  }
}

const parsed = (environment: string): Record<string, string> =>
  JSON.parse(environment) as Record<string, string>;
