// The files of a page as a WebAssembly module sees them: WASI's functions for reading one folder.
// https://github.com/WebAssembly/WASI/blob/main/legacy/preview1/docs.md

/** A file that is read by ranges. */
export interface PageFile {
  readonly name: string;
  readonly size: number;
  /** The bytes from `at` on, at most `length` of them. */
  read(at: number, length: number): Uint8Array;
}

/** WASI's numbers. */
const kOk = 0;
const kBadFile = 8;
const kNotFound = 44;
const kNotSupported = 58;
const kIsFolder = 3;
const kIsFile = 4;
const kNanosecondsAMs = 1e6;
/** The descriptor of the folder, behind those of input, output and errors. */
const kFolder = 3;
const kWhence = {set: 0, current: 1, end: 2};
/** All rights: what is not answered for here is refused. */
const kRights = (1n << 64n) - 1n;

interface OpenFile {
  file: PageFile;
  at: number;
}

export class PageFiles {
  private readonly open: (OpenFile | null)[] = [];
  private readonly decoder = new TextDecoder();
  private memory!: WebAssembly.Memory;

  constructor(private readonly files: readonly PageFile[]) {}

  /** Must be called before the module runs. */
  attach(memory: WebAssembly.Memory): void {
    this.memory = memory;
  }

  /** The module `wasi_snapshot_preview1`. */
  get imports(): WebAssembly.ModuleImports {
    return {
      environ_get: () => kOk,
      environ_sizes_get: (count: number, bytes: number) => this.answer(count, 0, bytes, 0),
      clock_time_get: (_clock: number, _precision: bigint, into: number) => {
        const now = BigInt(Math.round(performance.now() * kNanosecondsAMs));
        this.view.setBigUint64(into >>> 0, now, true);
        return kOk;
      },
      fd_prestat_get: (fd: number, into: number) =>
        fd === kFolder ? this.answer(into, 0, into + 4, 1) : kBadFile,
      fd_prestat_dir_name: (_fd: number, into: number) => {
        this.view.setUint8(into >>> 0, '/'.charCodeAt(0));
        return kOk;
      },
      fd_fdstat_get: (fd: number, into: number) => this.describe(fd, into >>> 0),
      fd_fdstat_set_flags: () => kOk,
      fd_filestat_get: (fd: number, into: number) =>
        this.with(fd, ({file}) => this.status(file, into >>> 0)),
      path_filestat_get: (
        _fd: number,
        _flags: number,
        path: number,
        length: number,
        into: number,
      ) => {
        const file = this.named(path, length);
        return file ? this.status(file, into >>> 0) : kNotFound;
      },
      // Behind the path: how to open, rights, inherited rights, flags, and where the answer goes.
      path_open: (_fd: number, _lookup: number, path: number, ...more: [number, ...unknown[]]) => {
        const file = this.named(path, more[0]);
        if (!file) return kNotFound;
        return this.answer(more.at(-1) as number, kFolder + this.open.push({file, at: 0}));
      },
      fd_close: (fd: number) =>
        this.with(fd, () => {
          this.open[fd - kFolder - 1] = null;
          return kOk;
        }),
      fd_seek: (fd: number, by: bigint, whence: number, into: number) =>
        this.with(fd, (opened) => {
          if (whence === kWhence.set) opened.at = 0;
          if (whence === kWhence.end) opened.at = opened.file.size;
          opened.at += Number(by);
          this.view.setBigUint64(into >>> 0, BigInt(opened.at), true);
          return kOk;
        }),
      fd_read: (fd: number, vectors: number, count: number, into: number) =>
        this.with(fd, (opened) => {
          const got = this.fill(opened.file, opened.at, vectors, count);
          opened.at += got;
          return this.answer(into, got);
        }),
      fd_pread: (fd: number, vectors: number, count: number, at: bigint, into: number) =>
        this.with(fd, ({file}) => this.answer(into, this.fill(file, Number(at), vectors, count))),
      fd_write: () => kNotSupported,
      proc_exit: (code: number) => {
        throw new WebAssembly.RuntimeError(`exit ${code}`);
      },
    };
  }

  private get view(): DataView {
    return new DataView(this.memory.buffer);
  }

  /** Writes pairs of an address and a number of 32 bits. */
  private answer(...pairs: number[]): number {
    for (let i = 0; i < pairs.length; i += 2)
      this.view.setUint32(pairs[i]! >>> 0, pairs[i + 1]!, true);
    return kOk;
  }

  private with(fd: number, use: (opened: OpenFile) => number): number {
    const opened = this.open[fd - kFolder - 1];
    return opened ? use(opened) : kBadFile;
  }

  /** A page learns no folders: a file of the same name stands for one in any of them. */
  private named(path: number, length: number): PageFile | undefined {
    const bytes = new Uint8Array(this.memory.buffer, path >>> 0, length);
    const name = this.decoder.decode(bytes).replace(/^.*\//s, '');
    return this.files.find((file) => file.name === name);
  }

  /** An fdstat: the kind, flags, and rights. */
  private describe(fd: number, into: number): number {
    if (fd !== kFolder && !this.open[fd - kFolder - 1]) return kBadFile;
    const {view} = this;
    view.setUint8(into, fd === kFolder ? kIsFolder : kIsFile);
    view.setUint16(into + 2, 0, true);
    view.setBigUint64(into + 8, kRights, true);
    view.setBigUint64(into + 16, kRights, true);
    return kOk;
  }

  /** A filestat of 64 bytes: device, number, kind, links, size and three times. */
  private status(file: PageFile, into: number): number {
    const {view} = this;
    for (let at = 0; at < 64; at += 8) view.setBigUint64(into + at, 0n, true);
    view.setUint8(into + 16, kIsFile);
    view.setBigUint64(into + 24, 1n, true);
    view.setBigUint64(into + 32, BigInt(file.size), true);
    return kOk;
  }

  /** Reads into `count` pairs of an address and a length. Returns the bytes read. */
  private fill(file: PageFile, at: number, vectors: number, count: number): number {
    let got = 0;
    for (let i = 0; i < count; ++i) {
      const pair = (vectors >>> 0) + 8 * i;
      const into = this.view.getUint32(pair, true);
      const length = Math.min(this.view.getUint32(pair + 4, true), file.size - at - got);
      if (length <= 0) break;
      const bytes = file.read(at + got, length);
      new Uint8Array(this.memory.buffer, into, bytes.length).set(bytes);
      got += bytes.length;
      if (bytes.length < length) break;
    }
    return got;
  }
}
