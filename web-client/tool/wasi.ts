// The files, streams, clock and chance of a host as a WebAssembly module asks for them: the
// functions of WASI that qtet-tool.wasm imports.
// https://github.com/WebAssembly/WASI/blob/main/legacy/preview1/docs.md

/** An open file, or a name, has these. */
export interface Status {
  dev: number;
  ino: number;
  mode: number;
  nlink: number;
  size: number;
  mtimeMs: number;
}

/**
 * These are in node's `fs` and in Emscripten's file system. Names begin with `/`. Each function
 * throws an error whose `code` is POSIX's name, or whose `errno` is WASI's number.
 */
export interface HostFiles<Handle> {
  /** `flags` are those of `constants`. */
  open(name: string, flags: number): Handle;
  close(file: Handle): void;
  /** Reads to `bytes`, from `at` on, or where a stream is. Returns how many; 0 is the end. */
  read(file: Handle, bytes: Uint8Array, at: number | null): number;
  write(file: Handle, bytes: Uint8Array, at: number | null): number;
  sync(file: Handle): void;
  statusOf(file: Handle): Status;
  status(name: string, followLink: boolean): Status;
  names(folder: string): string[];
  makeFolder(name: string): void;
  removeFolder(name: string): void;
  remove(name: string): void;
  rename(from: string, to: string): void;
  link(from: string, to: string): void;
  readLink(name: string): string;
  readonly constants: Readonly<Record<OpenFlag, number>>;
}

type OpenFlag = 'O_RDONLY' | 'O_WRONLY' | 'O_RDWR' | 'O_CREAT' | 'O_EXCL' | 'O_TRUNC' | 'O_APPEND';

/** The three streams of a process. */
export interface Streams {
  /** The bytes that were read; 0 is the end. */
  read(bytes: Uint8Array): number;
  /** Stream 1 is the output, 2 that of errors. */
  write(stream: 1 | 2, bytes: Uint8Array): void;
  isTerminal(stream: number): boolean;
}

const kOk = 0;
const kIo = 29;
/** WASI's numbers of POSIX's names. */
const kErrors: Readonly<Record<string, number>> = {
  EACCES: 2,
  EAGAIN: 6,
  EBADF: 8,
  EBUSY: 10,
  EEXIST: 20,
  EFBIG: 22,
  EINVAL: 28,
  EIO: kIo,
  EISDIR: 31,
  ELOOP: 32,
  EMFILE: 33,
  EMLINK: 34,
  ENAMETOOLONG: 37,
  ENFILE: 41,
  ENOENT: 44,
  ENOMEM: 48,
  ENOSPC: 51,
  ENOSYS: 52,
  ENOTDIR: 54,
  ENOTEMPTY: 55,
  ENOTSUP: 58,
  EOPNOTSUPP: 58,
  EPERM: 63,
  EPIPE: 64,
  EROFS: 69,
  ESPIPE: 70,
  EXDEV: 75,
};
const kBadFile = kErrors.EBADF!;
/** WASI has no pipes. wasi-libc takes sockets for them. */
const kFileType = {other: 0, character: 2, folder: 3, file: 4, pipe: 6, link: 7};
/** POSIX puts the kind of a file into its mode. */
const kModeType = 0o170000;
const kModeTypes = new Map([
  [0o010000, kFileType.pipe],
  [0o020000, kFileType.character],
  [0o040000, kFileType.folder],
  [0o100000, kFileType.file],
  [0o120000, kFileType.link],
]);
const kStreamStatus = {dev: 0, ino: 0, mode: 0o020000, nlink: 1, size: 0, mtimeMs: 0};
const kOpen = {create: 1, folder: 2, exclusive: 4, truncate: 8};
const kAppend = 1;
const kFollow = 1;
const kRights = {read: 1n << 1n, seek: 1n << 2n, tell: 1n << 5n, write: 1n << 6n};
const kAllRights = (1n << 28n) - 1n;
const kWhence = {set: 0, current: 1, end: 2};
const kNanosecondsAMs = 1e6;
/** The descriptor of the root, behind those of the streams. */
const kRoot = 3;
const kDirentBytes = 24;
/** `crypto` gives no more at once. */
const kMostChance = 65536;

/** A descriptor stands for one of these. */
type Opened<Handle> =
  | {kind: 'stream'; stream: number}
  | {kind: 'folder'; name: string; entries?: string[]}
  | {kind: 'file'; handle: Handle; at: number; appends: boolean; isPipe: boolean};

/** Ends the module, which gives back what it holds. */
export class Exit extends Error {
  constructor(readonly code: number) {
    super(`exit ${code}`);
  }
}

class Errno extends Error {
  constructor(readonly errno: number) {
    super(`errno ${errno}`);
  }
}

/** Null: no error of files. */
function numberOf(error: unknown): number | null {
  const {code, errno} = error as {code?: string; errno?: number};
  if (typeof code === 'string' && code in kErrors) return kErrors[code]!;
  // Errors of Emscripten's file system have WASI's numbers. Those of node are negative.
  if (typeof errno === 'number') return errno > 0 ? errno : kIo;
  return null;
}

/** A module's view of the host. One a module. */
export class Wasi<Handle> {
  private readonly open: (Opened<Handle> | null)[] = [
    {kind: 'stream', stream: 0},
    {kind: 'stream', stream: 1},
    {kind: 'stream', stream: 2},
    {kind: 'folder', name: '/'},
  ];
  private readonly decoder = new TextDecoder();
  private readonly encoder = new TextEncoder();
  private readonly environment: Uint8Array[];
  private memory!: WebAssembly.Memory;

  constructor(
    private readonly files: HostFiles<Handle>,
    private readonly streams: Streams,
    environment: Readonly<Record<string, string>>,
  ) {
    this.environment = Object.entries(environment).map(([name, value]) =>
      this.encoder.encode(`${name}=${value}\0`),
    );
  }

  /** Must be called before the module runs. */
  attach(memory: WebAssembly.Memory): void {
    this.memory = memory;
  }

  /** Gives back what the module left open. */
  close(): void {
    for (let fd = kRoot + 1; fd < this.open.length; ++fd) this.closeOne(fd);
  }

  /** The module `wasi_snapshot_preview1`. */
  get imports(): WebAssembly.ModuleImports {
    type Name = [at: number, length: number];
    const out: Record<string, (...words: never[]) => unknown> = {
      args_sizes_get: (count: number, bytes: number) => this.answer(count, 0, bytes, 0),
      args_get: () => kOk,
      environ_sizes_get: (count: number, bytes: number) => {
        const total = this.environment.reduce((sum, entry) => sum + entry.length, 0);
        return this.answer(count, this.environment.length, bytes, total);
      },
      environ_get: (pointers: number, bytes: number) => {
        let at = bytes >>> 0;
        this.environment.forEach((entry, i) => {
          this.answer((pointers >>> 0) + 4 * i, at);
          this.bytes(at, entry.length).set(entry);
          at += entry.length;
        });
        return kOk;
      },
      clock_time_get: (clock: number, _precision: bigint, into: number) => {
        const ms = clock === 0 ? Date.now() : performance.now();
        this.view.setBigUint64(into >>> 0, BigInt(Math.round(ms * kNanosecondsAMs)), true);
        return kOk;
      },
      random_get: (into: number, length: number) => {
        const chance = new Uint8Array(length >>> 0);
        for (let at = 0; at < chance.length; at += kMostChance)
          crypto.getRandomValues(chance.subarray(at, at + kMostChance));
        this.bytes(into, length).set(chance);
        return kOk;
      },
      proc_exit: (code: number) => {
        throw new Exit(code);
      },

      fd_prestat_get: (fd: number, into: number) =>
        fd === kRoot ? this.answer(into, 0, (into >>> 0) + 4, 1) : kBadFile,
      fd_prestat_dir_name: (_fd: number, into: number) => {
        this.view.setUint8(into >>> 0, '/'.charCodeAt(0));
        return kOk;
      },
      fd_fdstat_get: (fd: number, into: number) => this.describe(this.of(fd), into >>> 0),
      fd_fdstat_set_flags: () => kOk,
      fd_filestat_get: (fd: number, into: number) => {
        const opened = this.of(fd);
        if (opened.kind === 'file')
          return this.tell(this.files.statusOf(opened.handle), into >>> 0);
        if (opened.kind === 'folder')
          return this.tell(this.files.status(opened.name, true), into >>> 0);
        return this.tell(kStreamStatus, into >>> 0);
      },
      fd_close: (fd: number) => {
        this.of(fd);
        this.closeOne(fd);
        return kOk;
      },
      fd_sync: (fd: number) => {
        const opened = this.of(fd);
        if (opened.kind === 'file') this.files.sync(opened.handle);
        return kOk; // hosts flush no folders
      },
      fd_seek: (fd: number, by: bigint, whence: number, into: number) => {
        const file = this.file(fd);
        const from = {
          [kWhence.set]: 0,
          [kWhence.current]: file.at,
          [kWhence.end]: whence === kWhence.end ? this.files.statusOf(file.handle).size : 0,
        }[whence];
        const to = (from ?? -1) + Number(by);
        if (from === undefined || to < 0) return kErrors.EINVAL!;
        file.at = to;
        return this.answer64(into, file.at);
      },
      fd_tell: (fd: number, into: number) => this.answer64(into, this.file(fd).at),
      fd_read: (fd: number, vectors: number, count: number, into: number) => {
        const opened = this.of(fd);
        if (opened.kind === 'folder') return kErrors.EISDIR!;
        return this.answer(
          into,
          this.transfer(vectors, count, (bytes) => {
            if (opened.kind === 'stream') return this.streams.read(bytes);
            const got = this.files.read(opened.handle, bytes, opened.isPipe ? null : opened.at);
            opened.at += got;
            return got;
          }),
        );
      },
      fd_pread: (fd: number, vectors: number, count: number, from: bigint, into: number) => {
        const {handle} = this.file(fd);
        let at = Number(from);
        const read = (bytes: Uint8Array): number => {
          const got = this.files.read(handle, bytes, at);
          at += got;
          return got;
        };
        return this.answer(into, this.transfer(vectors, count, read));
      },
      fd_write: (fd: number, vectors: number, count: number, into: number) => {
        const opened = this.of(fd);
        if (opened.kind === 'folder') return kBadFile;
        return this.answer(
          into,
          this.transfer(vectors, count, (bytes) => {
            if (opened.kind === 'stream') {
              this.streams.write(opened.stream === 2 ? 2 : 1, bytes);
              return bytes.length;
            }
            const isNext = opened.appends || opened.isPipe;
            const done = this.files.write(opened.handle, bytes, isNext ? null : opened.at);
            opened.at += done;
            return done;
          }),
        );
      },
      fd_readdir: (fd: number, into: number, length: number, cookie: bigint, used: number) => {
        const folder = this.of(fd);
        if (folder.kind !== 'folder') return kErrors.ENOTDIR!;
        if (cookie === 0n || !folder.entries) folder.entries = this.files.names(folder.name);
        return this.answer(used, this.list(folder.entries, Number(cookie), into, length));
      },

      path_open: (
        _fd: number,
        lookup: number,
        ...more: [...Name, how: number, bigint, inherited: bigint, flags: number, into: number]
      ) => {
        const [name, length, how, rights, , flags, into] = more;
        const opened = this.openOne(this.name(name, length), lookup, how, {rights, flags});
        return this.answer(into, this.open.push(opened) - 1);
      },
      path_filestat_get: (_fd: number, lookup: number, ...more: [...Name, number]) => {
        const [name, length, into] = more;
        const status = this.files.status(this.name(name, length), (lookup & kFollow) !== 0);
        return this.tell(status, into >>> 0);
      },
      path_create_directory: (_fd: number, ...name: Name) => {
        this.files.makeFolder(this.name(...name));
        return kOk;
      },
      path_remove_directory: (_fd: number, ...name: Name) => {
        this.files.removeFolder(this.name(...name));
        return kOk;
      },
      path_unlink_file: (_fd: number, ...name: Name) => {
        this.files.remove(this.name(...name));
        return kOk;
      },
      path_rename: (_from: number, at: number, length: number, _to: number, ...to: Name) => {
        this.files.rename(this.name(at, length), this.name(...to));
        return kOk;
      },
      path_link: (_fd: number, _lookup: number, ...more: [...Name, number, ...Name]) => {
        const [at, length, , ...to] = more;
        this.files.link(this.name(at, length), this.name(...to));
        return kOk;
      },
      path_readlink: (
        _fd: number,
        ...more: [...Name, into: number, room: number, used: number]
      ) => {
        const [at, length, into, room, used] = more;
        const target = this.encoder.encode(this.files.readLink(this.name(at, length)));
        const part = target.subarray(0, room >>> 0);
        this.bytes(into, part.length).set(part);
        return this.answer(used, part.length);
      },
    };
    return Object.fromEntries(
      Object.entries(out).map(([name, run]) => [name, this.withErrors(run as never)]),
    );
  }

  private withErrors(run: (...words: unknown[]) => unknown) {
    return (...words: unknown[]): unknown => {
      try {
        return run(...words);
      } catch (error) {
        const number = numberOf(error);
        if (number === null) throw error;
        return number;
      }
    };
  }

  private get view(): DataView {
    return new DataView(this.memory.buffer);
  }

  private bytes(at: number, length: number): Uint8Array {
    return new Uint8Array(this.memory.buffer, at >>> 0, length >>> 0);
  }

  /** Writes pairs of an address and a number of 32 bits. */
  private answer(...pairs: number[]): number {
    for (let i = 0; i < pairs.length; i += 2)
      this.view.setUint32(pairs[i]! >>> 0, pairs[i + 1]!, true);
    return kOk;
  }

  private answer64(into: number, value: number): number {
    this.view.setBigUint64(into >>> 0, BigInt(value), true);
    return kOk;
  }

  /** Names are those of the root: the module makes them absolute. */
  private name(at: number, length: number): string {
    return `/${this.decoder.decode(this.bytes(at, length))}`.replace(/^\/+/, '/');
  }

  private of(fd: number): Opened<Handle> {
    const opened = this.open[fd];
    if (!opened) throw new Errno(kBadFile);
    return opened;
  }

  private file(fd: number): Extract<Opened<Handle>, {kind: 'file'}> {
    const opened = this.of(fd);
    if (opened.kind === 'folder') throw new Errno(kBadFile);
    if (opened.kind === 'stream' || opened.isPipe) throw new Errno(kErrors.ESPIPE!);
    return opened;
  }

  private closeOne(fd: number): void {
    const opened = this.open[fd];
    this.open[fd] = null;
    if (opened?.kind === 'file') this.files.close(opened.handle);
  }

  private openOne(
    name: string,
    lookup: number,
    how: number,
    {rights, flags}: {rights: bigint; flags: number},
  ): Opened<Handle> {
    const writes = (rights & kRights.write) !== 0n;
    const type = this.typeOf(name, (lookup & kFollow) !== 0);
    if (type === kFileType.link) throw new Errno(kErrors.ELOOP!);
    if (type === kFileType.folder && writes) throw new Errno(kErrors.EISDIR!);
    if (type === kFileType.folder) return {kind: 'folder', name};
    if ((how & kOpen.folder) !== 0)
      throw new Errno(type === null ? kErrors.ENOENT! : kErrors.ENOTDIR!);
    const {constants} = this.files;
    const reads = (rights & kRights.read) !== 0n;
    let bits = writes ? (reads ? constants.O_RDWR : constants.O_WRONLY) : constants.O_RDONLY;
    if ((how & kOpen.create) !== 0) bits |= constants.O_CREAT;
    if ((how & kOpen.exclusive) !== 0) bits |= constants.O_EXCL;
    if ((how & kOpen.truncate) !== 0) bits |= constants.O_TRUNC;
    const appends = (flags & kAppend) !== 0;
    if (appends) bits |= constants.O_APPEND;
    const isPipe = type === kFileType.pipe;
    return {kind: 'file', handle: this.files.open(name, bits), at: 0, appends, isPipe};
  }

  /** Null: there is nothing of that name. */
  private typeOf(name: string, followLink: boolean): number | null {
    try {
      return typeOfMode(this.files.status(name, followLink).mode);
    } catch {
      return null; // opening says why
    }
  }

  /** Reads or writes `count` pairs of an address and a length. Returns the bytes moved. */
  private transfer(vectors: number, count: number, move: (bytes: Uint8Array) => number): number {
    let moved = 0;
    for (let i = 0; i < count; ++i) {
      const pair = (vectors >>> 0) + 8 * i;
      const length = this.view.getUint32(pair + 4, true);
      if (length === 0) continue;
      const done = move(this.bytes(this.view.getUint32(pair, true), length));
      moved += done;
      if (done < length) break;
    }
    return moved;
  }

  /** An fdstat: the kind, flags, and rights. A terminal cannot be sought in. */
  private describe(opened: Opened<Handle>, into: number): number {
    const {view} = this;
    const isTerminal = opened.kind === 'stream' && this.streams.isTerminal(opened.stream);
    const types = {stream: isTerminal ? kFileType.character : kFileType.other, ...kOtherTypes};
    const rights = isTerminal ? kAllRights & ~(kRights.seek | kRights.tell) : kAllRights;
    view.setUint8(into, types[opened.kind]);
    view.setUint16(into + 2, 0, true);
    view.setBigUint64(into + 8, rights, true);
    view.setBigUint64(into + 16, rights, true);
    return kOk;
  }

  /** A filestat of 64 bytes: device, number, kind, links, size and three times. */
  private tell(status: Status, into: number): number {
    const {view} = this;
    const time = BigInt(Math.round(status.mtimeMs * kNanosecondsAMs));
    for (let at = 0; at < 64; at += 8) view.setBigUint64(into + at, 0n, true);
    view.setBigUint64(into, BigInt(status.dev), true);
    view.setBigUint64(into + 8, BigInt(status.ino), true);
    view.setUint8(into + 16, typeOfMode(status.mode));
    view.setBigUint64(into + 24, BigInt(status.nlink), true);
    view.setBigUint64(into + 32, BigInt(status.size), true);
    for (const at of [40, 48, 56]) view.setBigUint64(into + at, time, true);
    return kOk;
  }

  /** Writes dirents from the `from`th on, the last one cut where the room ends. Returns bytes. */
  private list(names: readonly string[], from: number, into: number, length: number): number {
    const room = length >>> 0;
    let used = 0;
    for (let i = from; i < names.length && used < room; ++i) {
      const name = this.encoder.encode(names[i]);
      const entry = new Uint8Array(kDirentBytes + name.length);
      const view = new DataView(entry.buffer);
      view.setBigUint64(0, BigInt(i + 1), true);
      view.setUint32(16, name.length, true);
      entry.set(name, kDirentBytes);
      const part = entry.subarray(0, room - used);
      this.bytes((into >>> 0) + used, part.length).set(part);
      used += part.length;
    }
    return used;
  }
}

const kOtherTypes = {folder: kFileType.folder, file: kFileType.file};

function typeOfMode(mode: number): number {
  return kModeTypes.get(mode & kModeType) ?? kFileType.other;
}
