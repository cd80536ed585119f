// Puts arriving blocks into the codec in the order that it wants: head, structure with positions, then fields behind the mesh.

import {kAdaptiveCodec, kDracoCodec, type BlockValues, type Codec} from './codec';
import type {ValueDecoder} from './draco';
import {QtetError} from './errors';
import {readManifest, type Manifest} from './manifest';
import {kFirstFieldPart, kHeadPart, kPositionsPart, kStructurePart, type Frame} from './protocol';
import {ByteLedger, kNoStatistics, statisticsOf, type Statistics} from './statistics';

/** The number of a value block's digit bytes stands in its last bytes. */
const kDigitCountBytes = 4;

export class Assembler {
  manifest: Manifest | null = null;
  private ledger: ByteLedger | null = null;
  /** Structure and positions of a chunk whose other half is still on its way. */
  private readonly waiting = new Map<number, {structure?: Uint8Array; positions?: Uint8Array}>();

  constructor(readonly codec: Codec, private readonly values: ValueDecoder) {}

  /** Forgets blocks of an interrupted stream that could not be applied yet: the next stream sends them again. */
  dropWaiting(): void {
    this.waiting.clear();
  }

  /** Figures of the mesh with field `field` (-1: none). */
  statistics(field: number): Statistics {
    return this.manifest && this.ledger ? statisticsOf(this.codec, this.manifest, this.ledger, field) : kNoStatistics;
  }

  /** Applies what the frame completes. Throws bad-checksum, bad-codec and what the codec refuses. */
  take(frame: Frame): void {
    if (frame.firstPart === kHeadPart) {
      this.takeHead(frame.payload);
      return;
    }
    if (!this.manifest) throw new QtetError('bad-order', 'The server sent a part of the mesh before its head.');
    if (frame.chunk >= this.codec.chunkCount) throw new QtetError('bad-message', `The server sent chunk ${frame.chunk}, which does not exist.`);
    const parts = kFirstFieldPart + this.manifest.fields.length;
    let at = 0;
    for (let part = frame.firstPart; part < frame.firstPart + frame.parts; ++part) {
      const size = part < parts ? this.codec.blockSize(frame.chunk, part) : Infinity;
      if (at + size > frame.payload.length) {
        throw new QtetError('bad-message', `Chunk ${frame.chunk} arrived in a size that differs from the chunk table's.`);
      }
      this.takeBlock(frame.chunk, part, frame.payload.subarray(at, at + size));
      at += size;
    }
  }

  private takeHead(head: Uint8Array): void {
    this.codec.open(head);
    this.manifest = readManifest(head, (bytes, columns) => this.codec.levelColumns(bytes, columns));
    this.ledger = new ByteLedger(this.codec, head.length);
    this.waiting.clear();
  }

  private takeBlock(chunk: number, part: number, bytes: Uint8Array): void {
    this.codec.checkBlock(chunk, part, bytes);
    if (part >= kFirstFieldPart) {
      const field = part - kFirstFieldPart;
      this.codec.applyField(field, chunk, this.decode(chunk, part, bytes, this.manifest!.fields[field]!.components));
      return;
    }
    const halves = this.waiting.get(chunk) ?? {};
    if (part === kStructurePart) halves.structure = bytes;
    if (part === kPositionsPart) halves.positions = bytes;
    this.waiting.set(chunk, halves);
    if (!halves.structure || !halves.positions) return;
    this.waiting.delete(chunk);
    this.codec.apply(chunk, halves.structure, this.decode(chunk, kPositionsPart, halves.positions, 3));
  }

  private decode(chunk: number, part: number, bytes: Uint8Array, components: number): BlockValues {
    const count = this.codec.blockValues(chunk, part);
    if (count === 0 && bytes.length === 0) return {symbols: new Int32Array(0), digits: bytes};
    const id = this.codec.blockCodec(chunk, part);
    if (id === kAdaptiveCodec) return {symbols: new Int32Array(0), digits: bytes};
    if (id !== kDracoCodec) throw new QtetError('bad-codec', `Chunk ${chunk} uses codec ${id}, which this viewer does not know.`);
    if (count === 0) throw new QtetError('bad-value', `Chunk ${chunk} has a value block although it has no values.`);
    const end = bytes.length - kDigitCountBytes;
    const digitBytes = end < 0 ? Infinity : new DataView(bytes.buffer, bytes.byteOffset + end).getUint32(0, true);
    if (digitBytes > end) throw new QtetError('bad-value', `Chunk ${chunk} has a value block that is shorter than its digits.`);
    const digits = bytes.subarray(end - digitBytes, end);
    return {symbols: this.values.decode(bytes.subarray(0, end - digitBytes), count, components), digits};
  }
}
