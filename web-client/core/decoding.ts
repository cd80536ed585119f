// Decoding in slices: applies the blocks that are here, as far as they are wanted, and knows its
// pace.

import type {Assembler} from './assembler';
import {Slices} from './slices';
import type {Wanted} from './wanted';

/** The page's commands come between two slices of so long. */
const kSliceMs = 25;
/** A display says soon what to show: decoding waits so long for the first picture. */
const kFirstPictureMs = 500;

export class Decoding {
  private readonly slices: Slices;
  /** When decoding goes on without a first picture; null: it does not wait yet. */
  private firstPictureBy: number | null = null;
  /** What has been decoded, and how long that took. */
  private pace = {bytes: 0, ms: 0};

  /** `again`: called when there may be more to decode. */
  constructor(
    private readonly assembler: Assembler,
    private readonly wanted: Wanted,
    private readonly again: () => void,
  ) {
    this.slices = new Slices(again);
  }

  /** `again` is called soon: until then nobody else needs to decode. */
  get isDue(): boolean {
    return this.slices.isDue;
  }

  /**
   * Decodes one slice. True if there was anything. `pictureFirst`: the first mesh that there is
   * goes to the page before anything finer is decoded. Throws what the codec refuses.
   */
  advance(pictureFirst: boolean): boolean {
    this.slices.drop();
    const start = performance.now();
    const {bytes} = this.wanted.statistics;
    let applied = false;
    while (!(pictureFirst && this.awaitsPicture()) && this.step()) {
      applied = true;
      if (performance.now() < start + kSliceMs) continue;
      this.slices.call();
      break;
    }
    if (!applied) return false;
    this.pace.ms += performance.now() - start;
    this.pace.bytes += this.wanted.statistics.bytes - bytes;
    return true;
  }

  /** From the empty mesh to the limit, at once. Throws what the codec refuses. */
  goBack(): void {
    this.assembler.rewind();
    while (this.step()) continue;
  }

  /** How long decoding so many bytes takes at the pace so far; Infinity: nobody knows. */
  msFor(bytes: number): number {
    return this.pace.bytes > 0 ? (bytes * this.pace.ms) / this.pace.bytes : Infinity;
  }

  stop(): void {
    this.slices.drop();
  }

  /** Another log comes. */
  forget(): void {
    this.stop();
    this.firstPictureBy = null;
    this.pace = {bytes: 0, ms: 0};
  }

  private step(): boolean {
    return this.assembler.step(this.wanted.fields, !this.wanted.isReached);
  }

  private awaitsPicture(): boolean {
    const {codec} = this.assembler;
    if (codec.chunksApplied === 0) return false;
    if (this.wanted.fields.some((field) => codec.fieldChunksApplied(field) === 0)) return false;
    const now = performance.now();
    if (this.firstPictureBy === null) {
      this.firstPictureBy = now + kFirstPictureMs;
      setTimeout(this.again, kFirstPictureMs);
    }
    return now < this.firstPictureBy;
  }
}
