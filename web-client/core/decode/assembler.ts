// Keeps the blocks that arrive and puts them into the codec in its order: structure with positions
// first, then fields. The blocks stay (two or three bytes a cell), so that the mesh can become
// coarser and finer again without the network.

import {QtetError} from '../protocol/errors';
import type {Limit} from '../protocol/limit';
import type {LogTable} from '../protocol/log_table';
import {fieldKeys} from '../protocol/fields';
import {addLater, readManifest, type LevelColumns, type Manifest} from '../protocol/manifest';
import type {Frame, Target} from '../protocol/messages';
import {kFirstFieldPart, kHeadPart, kPositionsPart, kStructurePart} from '../protocol/parts';
import {Blocks} from './blocks';
import type {BlockValues, Codec} from './codec';
import type {ValueDecoder} from './draco';
import {FieldParents} from './field_parents';
import {targetOf, planOf, type LevelBytes} from './plan';
import {Ledger, kNoStatistics, statisticsOf, type Statistics} from './statistics';
import {readValueBlock} from './value_block';

/** In the header (codec/FORMAT.md). */
const kFileBytesAt = 16;

export class Assembler implements LogTable {
  manifest: Manifest | null = null;
  codecReady = Promise.resolve();
  /** So many instants are a series: that of markSeries. */
  leastInstants = 2;
  private ledger: Ledger | null = null;
  private head: Uint8Array | null = null;
  /** The part of later instants, once it is here. */
  private later: Uint8Array | null = null;
  private blocks = new Blocks(0);
  parents = new FieldParents([]);

  constructor(
    readonly codec: Codec,
    private readonly values: ValueDecoder,
  ) {}

  forget(): void {
    this.manifest = this.ledger = this.head = this.later = null;
    this.blocks = new Blocks(0);
    this.parents = new FieldParents([]);
  }

  // ---- LogTable

  get isKnown(): boolean {
    return this.manifest !== null;
  }
  get chunkCount(): number {
    return this.codec.chunkCount;
  }
  get fieldKeys(): string[] {
    return fieldKeys(this.manifest?.fields ?? []);
  }
  blockOffset(chunk: number, part: number): number {
    return this.codec.blockOffset(chunk, part);
  }
  blockSize(chunk: number, part: number): number {
    return this.codec.blockSize(chunk, part);
  }

  // ---- blocks

  /** How many leading chunks are here: of the mesh, and of one field. */
  get receivedChunks(): number {
    const {blocks} = this;
    return Math.min(blocks.leading(kStructurePart), blocks.leading(kPositionsPart));
  }
  receivedOfField(field: number): number {
    return Math.min(this.blocks.leading(kFirstFieldPart + field), this.receivedChunks);
  }

  /** The mesh's figures with these fields. */
  statistics(fields: readonly number[]): Statistics {
    return this.manifest && this.ledger
      ? statisticsOf(this.codec, this.manifest, this.ledger, this.parents.order(fields))
      : kNoStatistics;
  }

  /** The fields whose values are here for all of the mesh. */
  get wholeFields(): number[] {
    const {codec} = this;
    const chunks = codec.chunksApplied;
    return chunks === 0
      ? []
      : this.parents.of.flatMap((_, field) =>
          codec.fieldChunksApplied(field) === chunks ? [field] : [],
        );
  }

  /** Where the limit lies for these fields; null means at the end. */
  target(limit: Limit, fields: readonly number[]): Target | null {
    return this.manifest && this.head
      ? targetOf(limit, this.codec, this.manifest, this.parents.order(fields), this.head.length)
      : null;
  }

  /** planOf for this log. */
  plan(fields: readonly number[]): LevelBytes[] {
    return this.manifest && this.head
      ? planOf(this.codec, this.manifest, this.parents.order(fields), this.head.length)
      : [];
  }

  /**
   * Applies the next block of the fields, or else, if `refine`, the next chunk of the mesh. Returns
   * false when neither is here. Throws the codec's errors.
   */
  step(fields: readonly number[], refine: boolean): boolean {
    for (const field of this.parents.order(fields)) if (this.stepField(field)) return true;
    const chunk = this.codec.chunksApplied;
    const isDue = refine && (this.codec.isWhole || chunk === 0);
    const next = isDue ? this.blocks.mesh(chunk) : null;
    if (!next) return false;
    const [structure, positions] = next;
    this.codec.apply(chunk, structure, this.decode(chunk, kPositionsPart, positions, 3));
    this.ledger!.addChunk(chunk);
    return true;
  }

  /** The codec has become a whole one, without a log: decodes what it had, the base mesh. */
  renew(fields: readonly number[]): void {
    if (!this.head) return;
    this.rewind();
    if (this.step(fields, true)) while (this.step(fields, false)) continue;
  }

  /** Back to the empty mesh; the blocks stay. */
  rewind(): void {
    if (!this.head) return;
    this.codec.open(this.head);
    if (this.later) this.codec.readLater(this.later);
    this.ledger!.clear();
  }

  /**
   * Keeps the frame's blocks. Throws bad-order, bad-message, bad-checksum, and the codec's errors
   * about a head.
   */
  take(frame: Frame): void {
    if (frame.firstPart === kHeadPart) {
      this.takeHead(frame.payload);
      return;
    }
    if (!this.manifest)
      throw new QtetError('bad-order', 'The server sent a part of the mesh before its head.');
    if (frame.chunk >= this.codec.chunkCount)
      throw new QtetError(
        'bad-message',
        `The server sent chunk ${frame.chunk}, which does not exist.`,
      );
    const parts = kFirstFieldPart + this.manifest.fields.length;
    let at = 0;
    for (let part = frame.firstPart; part < frame.firstPart + frame.parts; ++part) {
      const size = part < parts ? this.codec.blockSize(frame.chunk, part) : Infinity;
      if (at + size > frame.payload.length) {
        throw new QtetError(
          'bad-message',
          `Chunk ${frame.chunk} arrived in a size that differs from the chunk table's.`,
        );
      }
      const bytes = frame.payload.subarray(at, at + size);
      this.codec.checkBlock(frame.chunk, part, bytes);
      this.blocks.keep(frame.chunk, part, bytes);
      at += size;
    }
  }

  /** A stream that is opened again may bring the same head again. */
  private takeHead(head: Uint8Array): void {
    const {head: known} = this;
    if (known?.length === head.length && known.every((byte, at) => byte === head[at])) return;
    this.codec.open(head);
    this.manifest = readManifest(head, this.levelColumns, this.leastInstants);
    this.later = null;
    this.ledger = new Ledger(this.codec, head.length);
    this.head = head.slice();
    this.readParents();
    this.blocks = new Blocks(this.codec.chunkCount);
  }

  private readonly levelColumns: LevelColumns = (bytes, errors, fields, columns) =>
    this.codec.levelColumns(bytes, errors, fields, columns);

  /** The log's size, as its head says; 0 before that is here. */
  get fileBytes(): number {
    if (!this.head) return 0;
    const header = new DataView(this.head.buffer);
    return Number(header.getBigUint64(kFileBytesAt, true));
  }

  /** Bytes of the log's part of later instants; 0 if there is none, or once it is here. */
  get laterBytes(): number {
    return this.manifest ? this.codec.laterBytes : 0;
  }

  /**
   * Takes in the part of later instants. Their fields come behind those that are there. Throws
   * `bad-checksum`, `truncated`, `bad-value`. REQUIRES: laterBytes > 0.
   */
  takeLater(part: Uint8Array): void {
    this.codec.readLater(part);
    this.later = part.slice();
    addLater(this.manifest!, part, this.levelColumns, this.leastInstants);
    this.readParents();
  }

  private readParents(): void {
    const {fields} = this.manifest!;
    this.parents = new FieldParents(fields.map((_, field) => this.codec.parents(field)));
  }

  private stepField(field: number): boolean {
    const chunk = this.nextOfField(field);
    if (chunk < 0) return false;
    const part = kFirstFieldPart + field;
    this.codec.applyField(
      field,
      chunk,
      this.decode(
        chunk,
        part,
        this.blocks.at(chunk, part)!,
        this.manifest!.fields[field]!.components,
      ),
    );
    this.ledger!.addField(field, chunk);
    return true;
  }

  private decode(chunk: number, part: number, bytes: Uint8Array, components: number): BlockValues {
    return readValueBlock(this.codec, this.values, {chunk, part, components}, bytes);
  }

  private nextOfField(field: number): number {
    const {codec} = this;
    const next = codec.fieldChunksApplied(field);
    const isDue =
      next < codec.chunksApplied &&
      this.blocks.at(next, kFirstFieldPart + field) !== undefined &&
      this.parents.of[field]!.every((parent) => codec.fieldChunksApplied(parent) > next);
    return isDue ? next : -1;
  }
}
