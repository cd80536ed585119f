// The WebAssembly codec (codec/wasm_api.h) with types: bytes in, views of the growing mesh out. A
// codec reads one log.

import type {Counts} from '../protocol/counts';
import {kErrorCodes} from '../protocol/error_codes';
import {QtetError} from '../protocol/errors';
import type {KnownErrors} from '../protocol/manifest';

/** The codec as the session needs it. Tests bring their own. */
export interface Codec {
  open(head: Uint8Array): void;
  /** The size of the part of later instants; 0 if the log has none, or once it is read. */
  readonly laterBytes: number;
  /** Brings the fields of this part. Throws `bad-checksum`, `truncated`, `bad-value`. */
  readLater(part: Uint8Array): void;
  /** False: it decodes only the base mesh, chunk 0, and gives no digest. */
  readonly isWhole: boolean;
  /** Starts again with an empty codec after `out-of-memory`; the browser gets the memory back. */
  restart(): void;
  readonly chunkCount: number;
  /**
   * The numbers of all levels, column by column, from the end of the manifest. Throws
   * `limit-exceeded`, `truncated`, `bad-value`.
   */
  levelColumns(
    bytes: Uint8Array,
    errors: KnownErrors,
    fields: number,
    columns: number,
  ): Uint32Array;
  /** Byte offset in the file. */
  blockOffset(chunk: number, part: number): number;
  blockSize(chunk: number, part: number): number;
  /** How many tuples the value block holds. */
  blockValues(chunk: number, part: number): number;
  blockCodec(chunk: number, part: number): number;
  /** Throws `bad-checksum` when the bytes are not the block's. */
  checkBlock(chunk: number, part: number, bytes: Uint8Array): void;
  apply(chunk: number, structure: Uint8Array, positions: BlockValues): void;
  applyField(field: number, chunk: number, values: BlockValues): void;
  brings(chunk: number): Counts;
  /** The fields that this one is predicted from: their values come first. */
  parents(field: number): number[];
  readonly chunksApplied: number;
  fieldChunksApplied(field: number): number;
  readonly level: number;
  readonly vertexCount: number;
  readonly tetrahedronCount: number;
  readonly boundaryCount: number;
  /** Views into the codec's memory, valid until the next apply. */
  points(): Int32Array;
  tetrahedra(): Uint32Array;
  boundary(): Uint32Array;
  /** The cell across the face opposite to a corner; kOutside at the boundary. REQUIRES: isWhole. */
  across(cell: number, corner: number): number;
  /** One tuple a vertex, or a tetrahedron for a cell field; null while the field has no chunk. */
  field(field: number, components: number): Int32Array | null;
  /** SHA-256 of the mesh, lower-case hexadecimal. */
  digest(): string;
}

/**
 * The two parts of a value block (FORMAT.md, "Value blocks"): what Draco decodes, and the digits
 * behind it. An adaptive or a lifted block is all digits.
 */
export interface BlockValues {
  symbols: Int32Array;
  digits: Uint8Array;
}

/** CodecId of codec/log_index.h. */
export const kDracoCodec = 2;
export const kAdaptiveCodec = 3;
export const kLiftedCodec = 4;
/** Association of codec/log_index.h. */
const kOfCells = 1;

/** By the numbers of KnownErrors of codec/coding/level_columns.h. */
const kKnownErrors: readonly KnownErrors[] = ['none', 'some'];

interface Exports {
  memory: WebAssembly.Memory;
  _initialize?(): void;
  qtet_alloc(bytes: number): number;
  qtet_free(address: number): void;
  qtet_open(head: number, bytes: number): number;
  qtet_later_bytes(): number;
  qtet_read_later(part: number, bytes: number): number;
  qtet_error(): number;
  qtet_chunk_count(): number;
  qtet_level_count(): number;
  qtet_level_columns(bytes: number, size: number, errors: number, fields: number): number;
  qtet_level_numbers(): number;
  qtet_block_offset(chunk: number, part: number): number;
  qtet_block_size(chunk: number, part: number): number;
  qtet_block_values(chunk: number, part: number): number;
  qtet_field_association(field: number): number;
  qtet_block_codec(chunk: number, part: number): number;
  qtet_check_block(chunk: number, part: number, bytes: number, size: number): number;
  qtet_apply(
    chunk: number,
    structure: number,
    size: number,
    symbols: number,
    count: number,
    digits: number,
    digitBytes: number,
  ): number;
  qtet_apply_field(
    field: number,
    chunk: number,
    symbols: number,
    count: number,
    digits: number,
    digitBytes: number,
  ): number;
  qtet_chunk_brings(chunk: number): number;
  qtet_field_parents(field: number): number;
  qtet_field_parent(field: number, parent: number): number;
  qtet_chunks_applied(): number;
  qtet_field_chunks_applied(field: number): number;
  qtet_level(): number;
  qtet_vertex_count(): number;
  qtet_tetrahedron_count(): number;
  qtet_boundary_count(): number;
  qtet_points(): number;
  qtet_tetrahedra(): number;
  qtet_boundary(): number;
  qtet_across(cell: number, corner: number): number;
  qtet_field(field: number): number;
  qtet_digest(out: number): void;
}

export class WasmCodec implements Codec {
  private module!: WebAssembly.Module;
  private wasm!: Exports;

  /** REQUIRES: without a module `become` is called before anything else. */
  constructor(module?: WebAssembly.Module) {
    if (module) this.become(module);
  }

  get isWhole(): boolean {
    return 'qtet_digest' in this.wasm;
  }
  /** Goes on with another module, and without a log. */
  become(module: WebAssembly.Module): void {
    this.module = module;
    this.restart();
  }
  restart(): void {
    this.wasm = begin(new WebAssembly.Instance(this.module, stubbedImports(this.module)));
  }

  open(head: Uint8Array): void {
    this.with([head], ([address]) => this.wasm.qtet_open(address!, head.length));
  }

  get laterBytes(): number {
    return this.wasm.qtet_later_bytes() >>> 0;
  }
  readLater(part: Uint8Array): void {
    this.with([part], ([address]) => this.wasm.qtet_read_later(address!, part.length));
  }

  get chunkCount(): number {
    return this.wasm.qtet_chunk_count() >>> 0;
  }
  levelColumns(
    bytes: Uint8Array,
    errors: KnownErrors,
    fields: number,
    columns: number,
  ): Uint32Array {
    this.with([bytes], ([address]) =>
      this.wasm.qtet_level_columns(address!, bytes.length, kKnownErrors.indexOf(errors), fields),
    );
    const count = columns * (this.wasm.qtet_level_count() >>> 0);
    return new Uint32Array(
      this.wasm.memory.buffer,
      this.wasm.qtet_level_numbers() >>> 0,
      count,
    ).slice();
  }
  blockOffset(chunk: number, part: number): number {
    return this.wasm.qtet_block_offset(chunk, part);
  }
  blockSize(chunk: number, part: number): number {
    return this.wasm.qtet_block_size(chunk, part) >>> 0;
  }
  blockValues(chunk: number, part: number): number {
    return this.wasm.qtet_block_values(chunk, part) >>> 0;
  }
  blockCodec(chunk: number, part: number): number {
    return this.wasm.qtet_block_codec(chunk, part) >>> 0;
  }

  checkBlock(chunk: number, part: number, bytes: Uint8Array): void {
    this.with([bytes], ([address]) =>
      this.wasm.qtet_check_block(chunk, part, address!, bytes.length),
    );
  }

  apply(chunk: number, structure: Uint8Array, {symbols, digits}: BlockValues): void {
    this.with([structure, bytesOf(symbols), digits], ([from, values, rest]) =>
      this.wasm.qtet_apply(
        chunk,
        from!,
        structure.length,
        values!,
        symbols.length,
        rest!,
        digits.length,
      ),
    );
  }

  applyField(field: number, chunk: number, {symbols, digits}: BlockValues): void {
    this.with([bytesOf(symbols), digits], ([values, rest]) =>
      this.wasm.qtet_apply_field(field, chunk, values!, symbols.length, rest!, digits.length),
    );
  }

  brings(chunk: number): Counts {
    const [tetrahedra, vertices, boundaryTriangles] = new Uint32Array(
      this.wasm.memory.buffer,
      this.wasm.qtet_chunk_brings(chunk) >>> 0,
      3,
    );
    return {tetrahedra: tetrahedra!, vertices: vertices!, boundaryTriangles: boundaryTriangles!};
  }
  parents(field: number): number[] {
    return Array.from({length: this.wasm.qtet_field_parents(field) >>> 0}, (_, i) =>
      this.wasm.qtet_field_parent(field, i),
    );
  }
  get chunksApplied(): number {
    return this.wasm.qtet_chunks_applied() >>> 0;
  }
  fieldChunksApplied(field: number): number {
    return this.wasm.qtet_field_chunks_applied(field) >>> 0;
  }
  get level(): number {
    return this.wasm.qtet_level() >>> 0;
  }
  get vertexCount(): number {
    return this.wasm.qtet_vertex_count() >>> 0;
  }
  get tetrahedronCount(): number {
    return this.wasm.qtet_tetrahedron_count() >>> 0;
  }
  get boundaryCount(): number {
    return this.wasm.qtet_boundary_count() >>> 0;
  }

  points(): Int32Array {
    return new Int32Array(
      this.wasm.memory.buffer,
      this.wasm.qtet_points() >>> 0,
      3 * this.vertexCount,
    );
  }
  tetrahedra(): Uint32Array {
    return new Uint32Array(
      this.wasm.memory.buffer,
      this.wasm.qtet_tetrahedra() >>> 0,
      4 * this.tetrahedronCount,
    );
  }
  boundary(): Uint32Array {
    return new Uint32Array(
      this.wasm.memory.buffer,
      this.wasm.qtet_boundary() >>> 0,
      3 * this.boundaryCount,
    );
  }
  across(cell: number, corner: number): number {
    return this.wasm.qtet_across(cell, corner) >>> 0;
  }
  field(field: number, components: number): Int32Array | null {
    const address = this.wasm.qtet_field(field) >>> 0;
    const tuples =
      this.wasm.qtet_field_association(field) === kOfCells
        ? this.tetrahedronCount
        : this.vertexCount;
    return address === 0
      ? null
      : new Int32Array(this.wasm.memory.buffer, address, components * tuples);
  }

  digest(): string {
    const out = this.wasm.qtet_alloc(32) >>> 0;
    this.wasm.qtet_digest(out);
    const bytes = [...new Uint8Array(this.wasm.memory.buffer, out, 32)];
    this.wasm.qtet_free(out);
    return bytes.map((byte) => byte.toString(16).padStart(2, '0')).join('');
  }

  /**
   * Copies the blocks into the module, calls `use` with their addresses and frees them. Throws the
   * error that the call reports.
   */
  private with(blocks: Uint8Array[], use: (addresses: number[]) => number): void {
    const addresses = blocks.map((bytes) => {
      const address = this.wasm.qtet_alloc(Math.max(bytes.length, 1)) >>> 0;
      if (address === 0) throw outOfMemory();
      new Uint8Array(this.wasm.memory.buffer, address, bytes.length).set(bytes);
      return address;
    });
    const result = guarded(() => use(addresses));
    for (const address of addresses) this.wasm.qtet_free(address);
    if (result !== 0) throw new QtetError(kErrorCodes[result - 1] ?? 'internal', this.lastError());
  }

  private lastError(): string {
    const from = this.wasm.qtet_error() >>> 0;
    const memory = new Uint8Array(this.wasm.memory.buffer);
    return new TextDecoder().decode(memory.slice(from, memory.indexOf(0, from)));
  }
}

function begin({exports}: WebAssembly.Instance): Exports {
  const wasm = exports as unknown as Exports;
  wasm._initialize?.();
  return wasm;
}

/** The module has no exceptions: when memory ends, it stops for good. */
function guarded(call: () => number): number {
  try {
    return call();
  } catch (thrown) {
    if (thrown instanceof WebAssembly.RuntimeError) throw outOfMemory();
    throw thrown;
  }
}

function outOfMemory(): QtetError {
  return new QtetError(
    'out-of-memory',
    'The whole mesh needs more memory than the browser gives to a page.',
  );
}

function bytesOf(values: Int32Array): Uint8Array {
  return new Uint8Array(values.buffer, values.byteOffset, values.byteLength);
}

/**
 * libc++'s abort path imports three WASI calls that never run here. Every import answers "bad
 * file".
 */
function stubbedImports(module: WebAssembly.Module): WebAssembly.Imports {
  const kBadFile = 8;
  const imports: Record<string, Record<string, () => number>> = {};
  for (const {module: from, name} of WebAssembly.Module.imports(module))
    (imports[from] ??= {})[name] = () => kBadFile;
  return imports;
}
