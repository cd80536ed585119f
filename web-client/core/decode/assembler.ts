// Keeps the blocks that arrive and puts them into the codec in its order: structure with positions
// first, then fields. The blocks stay (two or three bytes a cell), so that the mesh can become
// coarser and finer again without the network.

import {QtetError} from '../protocol/errors';
import type {Limit} from '../protocol/limit';
import type {LogTable} from '../protocol/log_table';
import {fieldKeys, readManifest, type Manifest} from '../protocol/manifest';
import type {Frame, Target} from '../protocol/messages';
import type {Packet} from '../protocol/packet';
import {kFirstFieldPart, kHeadPart, kPositionsPart, kStructurePart} from '../protocol/parts';
import {
  inOrder,
  kNoViewRequest,
  type WireLattice,
  type ViewRequest,
} from '../protocol/view_request';
import {ChunkQueue} from './chunk_queue';
import type {BlockValues, Codec} from './codec';
import type {ValueDecoder} from './draco';
import {targetOf, planOf, type LevelBytes} from './plan';
import {Ledger, kNoStatistics, statisticsOf, type Statistics} from './statistics';
import {readValueBlock} from './value_block';

export class Assembler implements LogTable {
  manifest: Manifest | null = null;
  codecReady = Promise.resolve();
  private ledger: Ledger | null = null;
  private head: Uint8Array | null = null;
  /** By chunk and part. */
  private blocks: (Uint8Array | undefined)[][] = [];
  private received: number[] = [];
  private packetList: Packet[] = [];
  private rank = new Map<number, number>();
  /** By chunk: those that depend on it. */
  private dependents: number[][] = [];
  /**
   * Chunks of a log of regions that can be applied now: their blocks are here, and what they depend
   * on is applied. A chunk is examined only when one of the two becomes true, so that the work for
   * a log is linear in its chunks.
   */
  private readonly ready = new ChunkQueue((chunk) => this.rankOf(chunk));
  /** The same by field: packets whose values can be applied now. */
  private readyValues: ChunkQueue[] = [];

  constructor(
    readonly codec: Codec,
    private readonly values: ValueDecoder,
  ) {}

  forget(): void {
    this.manifest = this.ledger = this.head = null;
    this.blocks = [];
    this.received = [];
    this.packetList = [];
    this.clearQueues();
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

  get packets(): readonly Packet[] {
    return this.packetList;
  }
  get lattice(): WireLattice | null {
    const lattice = this.manifest?.lattice;
    return lattice ? {origin: lattice.origin, step: lattice.step, size: 2 ** lattice.bits} : null;
  }

  // ---- blocks

  /** How many leading chunks are here: of the mesh, and of one field. */
  get receivedChunks(): number {
    return Math.min(this.leading(kStructurePart), this.leading(kPositionsPart));
  }
  receivedOfField(field: number): number {
    return Math.min(this.leading(kFirstFieldPart + field), this.receivedChunks);
  }

  /** The mesh's figures with these fields. */
  statistics(fields: readonly number[]): Statistics {
    return this.manifest && this.ledger
      ? statisticsOf(this.codec, this.manifest, this.ledger, fields)
      : kNoStatistics;
  }

  /** Where the limit lies for these fields; null means at the end. */
  target(limit: Limit, fields: readonly number[]): Target | null {
    return this.manifest && this.head
      ? targetOf(limit, this.codec, this.manifest, fields, this.head.length)
      : null;
  }

  /** planOf for this log. */
  plan(fields: readonly number[]): LevelBytes[] {
    return this.manifest && this.head
      ? planOf(this.codec, this.manifest, fields, this.head.length)
      : [];
  }

  /**
   * Applies the next block of the fields, or else, if `refine`, the next chunk of the mesh. Returns
   * false when neither is here. Throws the codec's errors.
   */
  step(fields: readonly number[], refine: boolean): boolean {
    for (const field of fields) if (this.stepField(field)) return true;
    const chunk = refine ? this.nextChunk() : -1;
    if (chunk < 0) return false;
    const [structure, positions] = this.blocks[chunk] as [Uint8Array, Uint8Array];
    this.codec.apply(chunk, structure, this.decode(chunk, kPositionsPart, positions, 3));
    this.ledger!.addChunk(chunk);
    this.afterChunk(chunk);
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
    this.ledger!.clear();
    this.clearQueues();
    this.considerChunk(0);
  }

  /** The chunks from `count` on that are here, as ranges [first, end). */
  rangesBeyond(count: number, part: number): [number, number][] {
    const ranges: [number, number][] = [];
    for (let chunk = count; chunk < this.blocks.length; ++chunk) {
      if (!this.blocks[chunk]![part] || !this.blocks[chunk]![kPositionsPart]) continue;
      const last = ranges.at(-1);
      if (last?.[1] === chunk) ++last[1];
      else ranges.push([chunk, chunk + 1]);
    }
    return ranges;
  }

  /** Decodes in the order of the view request from now on. */
  look(view: ViewRequest): void {
    const {lattice, packets} = this;
    this.rank = new Map(
      lattice ? inOrder(packets, view, lattice.size).map(({chunk}, i) => [chunk, i]) : [],
    );
    this.ready.reorder();
  }

  /** Chunks of the head come before every packet. */
  private rankOf(chunk: number): number {
    return this.rank.get(chunk) ?? chunk - this.codec.chunkCount;
  }

  /** The layout `stream`: each chunk follows the one before it. */
  private get isStream(): boolean {
    return this.codec.headChunks === this.codec.chunkCount;
  }

  /** Structure and positions are here. */
  private isHere(chunk: number): boolean {
    const parts = this.blocks[chunk];
    return parts?.[kStructurePart] !== undefined && parts[kPositionsPart] !== undefined;
  }

  /** The most urgent chunk that is here and whose parent is applied; -1 if there is none. */
  private nextChunk(): number {
    if (!this.codec.isWhole && this.codec.chunksApplied > 0) return -1;
    if (!this.isStream) return this.ready.first;
    const next = this.codec.chunksApplied;
    return this.isHere(next) ? next : -1;
  }

  private clearQueues(): void {
    this.ready.clear();
    for (const queue of this.readyValues) queue.clear();
  }

  /** Queues the chunk if it can be applied now. */
  private considerChunk(chunk: number): void {
    const {codec} = this;
    if (this.isStream || !this.isHere(chunk) || codec.applied(chunk)) return;
    if (chunk === 0 || codec.applied(codec.dependency(chunk))) this.ready.add(chunk);
  }

  /** The chunk has been applied: its values and its dependents may have waited for it. */
  private afterChunk(chunk: number): void {
    if (this.isStream) return;
    this.ready.removeFirst();
    for (const dependent of this.dependents[chunk]!) this.considerChunk(dependent);
    this.readyValues.forEach((_, field) => this.considerValues(field, chunk));
  }

  /** Queues the packet's values of the field if they can be applied now. */
  private considerValues(field: number, chunk: number): void {
    const {codec} = this;
    if (
      chunk >= codec.headChunks &&
      this.blocks[chunk]![kFirstFieldPart + field] &&
      codec.applied(chunk) &&
      !codec.fieldApplied(field, chunk) &&
      codec.fieldApplied(field, codec.dependency(chunk))
    )
      this.readyValues[field]!.add(chunk);
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
      this.keep(frame.chunk, part, frame.payload.subarray(at, at + size));
      at += size;
    }
  }

  private takeHead(head: Uint8Array): void {
    this.codec.open(head);
    this.manifest = readManifest(head, (bytes, errors, columns) =>
      this.codec.levelColumns(bytes, errors, columns),
    );
    this.ledger = new Ledger(this.codec, head.length);
    this.head = head.slice();
    this.packetList = packetsOf(this.codec);
    this.dependents = dependentsOf(this.codec);
    this.ready.clear();
    this.readyValues = this.manifest.fields.map(() => new ChunkQueue((chunk) => chunk));
    this.look(kNoViewRequest);
    this.blocks = Array.from({length: this.codec.chunkCount}, () => []);
    this.received = Array<number>(kFirstFieldPart + this.manifest.fields.length).fill(0);
  }

  private keep(chunk: number, part: number, bytes: Uint8Array): void {
    this.codec.checkBlock(chunk, part, bytes);
    this.blocks[chunk]![part] = bytes;
    if (part < kFirstFieldPart) this.considerChunk(chunk);
    else this.considerValues(part - kFirstFieldPart, chunk);
  }

  private leading(part: number): number {
    let count = this.received[part] ?? 0;
    while (this.blocks[count]?.[part]) ++count;
    return (this.received[part] = count);
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
        this.blocks[chunk]![part]!,
        this.manifest!.fields[field]!.components,
      ),
    );
    this.ledger!.addField(field, chunk);
    if (chunk >= this.codec.headChunks) this.readyValues[field]!.removeFirst();
    for (const dependent of this.dependents[chunk]!) this.considerValues(field, dependent);
    return true;
  }

  private decode(chunk: number, part: number, bytes: Uint8Array, components: number): BlockValues {
    return readValueBlock(this.codec, this.values, {chunk, part, components}, bytes);
  }

  private nextOfField(field: number): number {
    const {codec} = this;
    const part = kFirstFieldPart + field;
    const count = codec.fieldChunksApplied(field);
    if (count < codec.headChunks)
      return count < codec.chunksApplied && this.blocks[count]?.[part] ? count : -1;
    return this.readyValues[field]!.first;
  }
}

function packetsOf(codec: Codec): Packet[] {
  const packets: Packet[] = [];
  for (let chunk = codec.headChunks; chunk < codec.chunkCount; ++chunk) {
    const parent = packets[codec.dependency(chunk) - codec.headChunks];
    packets.push({chunk, depth: parent ? parent.depth + 1 : 0, box: codec.packetBox(chunk)});
  }
  return packets;
}

/** Linear in the chunks. Chunk 0 depends on itself and is nobody's dependent. */
function dependentsOf(codec: Codec): number[][] {
  const dependents = Array.from({length: codec.chunkCount}, (): number[] => []);
  for (let chunk = 1; chunk < codec.chunkCount; ++chunk)
    dependents[codec.dependency(chunk)]!.push(chunk);
  return dependents;
}
