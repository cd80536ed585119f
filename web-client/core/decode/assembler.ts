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
import type {BlockValues, Codec} from './codec';
import type {ValueDecoder} from './draco';
import {targetOf, planOf, type LevelBytes} from './plan';
import {Ledger, kNoStatistics, statisticsOf, type Statistics} from './statistics';
import {readValueBlock} from './value_block';

export class Assembler implements LogTable {
  manifest: Manifest | null = null;
  private ledger: Ledger | null = null;
  private head: Uint8Array | null = null;
  /** By chunk and part. */
  private blocks: (Uint8Array | undefined)[][] = [];
  private received: number[] = [];
  private packetList: Packet[] = [];
  private rank = new Map<number, number>();
  /** Chunks whose structure and positions are here but not applied, in the order of arrival. */
  private readonly ready = new Set<number>();

  constructor(
    readonly codec: Codec,
    private readonly values: ValueDecoder,
  ) {}

  forget(): void {
    this.manifest = this.ledger = this.head = null;
    this.blocks = [];
    this.received = [];
    this.packetList = [];
    this.ready.clear();
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
    this.ready.delete(chunk);
    this.ledger!.addChunk(chunk);
    return true;
  }

  /** Back to the empty mesh; the blocks stay. */
  rewind(): void {
    if (!this.head) return;
    this.codec.open(this.head);
    this.ledger!.clear();
    this.blocks.forEach((parts, chunk) => {
      if (parts[kStructurePart] && parts[kPositionsPart]) this.ready.add(chunk);
    });
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
  }

  /** Chunks of the head come before every packet. */
  private rankOf(chunk: number): number {
    return this.rank.get(chunk) ?? chunk - this.codec.chunkCount;
  }

  /** The most urgent chunk that is here and whose parent is applied; -1 if there is none. */
  private nextChunk(): number {
    const {codec} = this;
    if (codec.headChunks === codec.chunkCount)
      return this.ready.has(codec.chunksApplied) ? codec.chunksApplied : -1;
    let best = -1;
    for (const chunk of this.ready) {
      if (chunk > 0 && !codec.applied(codec.dependency(chunk))) continue;
      if (best < 0 || this.rankOf(chunk) < this.rankOf(best)) best = chunk;
    }
    return best;
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
    this.manifest = readManifest(head, (bytes, columns) => this.codec.levelColumns(bytes, columns));
    this.ledger = new Ledger(this.codec, head.length);
    this.head = head.slice();
    this.packetList = packetsOf(this.codec);
    this.look(kNoViewRequest);
    this.ready.clear();
    this.blocks = Array.from({length: this.codec.chunkCount}, () => []);
    this.received = Array<number>(kFirstFieldPart + this.manifest.fields.length).fill(0);
  }

  private keep(chunk: number, part: number, bytes: Uint8Array): void {
    this.codec.checkBlock(chunk, part, bytes);
    const parts = this.blocks[chunk]!;
    parts[part] = bytes;
    if (
      part < kFirstFieldPart &&
      parts[kStructurePart] &&
      parts[kPositionsPart] &&
      !this.codec.applied(chunk)
    )
      this.ready.add(chunk);
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
    if (count === codec.chunksApplied) return -1;
    for (let chunk = codec.headChunks; chunk < codec.chunkCount; ++chunk) {
      if (
        this.blocks[chunk]![part] &&
        codec.applied(chunk) &&
        !codec.fieldApplied(field, chunk) &&
        codec.fieldApplied(field, codec.dependency(chunk))
      )
        return chunk;
    }
    return -1;
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
