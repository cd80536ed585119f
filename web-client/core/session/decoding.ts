// Decodes in slices: applies the blocks that are here, as far as they are wanted, and measures its
// pace.

import type {Assembler} from '../decode/assembler';
import {Progress, type RequestedPart} from './requested_part';
import {Slices} from './slices';

/** How long a slice takes. The page's commands come between two slices. */
const kSliceMs = 25;
/** How long decoding waits for the first picture: the page sends a display soon. */
const kFirstPictureMs = 500;

export class Decoding {
  private readonly slices: Slices;
  /** When decoding continues without a first picture; null: it does not wait. */
  private firstPictureBy: number | null = null;
  /** Bytes decoded so far, and the time that took. */
  private pace = {bytes: 0, ms: 0};

  /**
   * `again` is called when there may be more to decode, `aheadFailed` with the codec's error about
   * a field that is only ahead.
   */
  constructor(
    private readonly assembler: Assembler,
    private readonly requested: RequestedPart,
    private readonly again: () => void,
    private readonly aheadFailed: (thrown: unknown) => void,
  ) {
    this.slices = new Slices(again);
  }

  /**
   * Decodes what has come, unless a slice is due. Frames come in crowds. If each took a slice, the
   * page's commands and the pictures would wait for all of them.
   */
  soon(): void {
    if (!this.slices.isDue) this.again();
  }

  /**
   * Decodes one slice. Returns true if there was anything to decode that is shown. With
   * `pictureFirst` the first mesh goes to the page before anything finer is decoded. Throws the
   * codec's errors.
   */
  advance(pictureFirst: boolean): boolean {
    this.slices.drop();
    const start = performance.now();
    const {bytes} = this.requested.statistics;
    let applied = false;
    while (!(pictureFirst && this.awaitsPicture())) {
      if (this.step()) applied = true;
      else if (!this.stepAhead()) break;
      if (performance.now() < start + kSliceMs) continue;
      this.slices.call();
      break;
    }
    if (!applied) return false;
    this.pace.ms += performance.now() - start;
    this.pace.bytes += this.requested.statistics.bytes - bytes;
    return true;
  }

  /** Decodes from the empty mesh to the limit, in one go. Throws the codec's errors. */
  goBack(): void {
    this.assembler.rewind();
    while (this.step()) continue;
  }

  /** The same in a fresh codec, which holds nothing else. */
  restart(): void {
    this.stop();
    this.assembler.codec.restart();
    this.goBack();
  }

  /** How long the rest will take at the pace so far, in ms. Infinity until it is received. */
  get msLeft(): number {
    const {limit, progress, statistics} = this.requested;
    if (progress >= Progress.decoded) return 0;
    const {bytes, ms} = this.pace;
    if (limit.kind !== 'full' || progress < Progress.received || bytes === 0) return Infinity;
    return ((statistics.bytesNeeded - statistics.bytes) * ms) / bytes;
  }

  stop(): void {
    this.slices.drop();
  }

  /** Must be called before another log. */
  forget(): void {
    this.stop();
    this.firstPictureBy = null;
    this.pace = {bytes: 0, ms: 0};
  }

  private step(): boolean {
    return this.assembler.step(this.requested.fields, !this.requested.isReached);
  }

  private stepAhead(): boolean {
    try {
      return this.assembler.step(this.requested.ahead, false);
    } catch (thrown) {
      this.aheadFailed(thrown);
      return false;
    }
  }

  private awaitsPicture(): boolean {
    const {codec} = this.assembler;
    if (codec.chunksApplied === 0) return false;
    if (this.requested.fields.some((field) => codec.fieldChunksApplied(field) === 0)) return false;
    const now = performance.now();
    if (this.firstPictureBy === null) {
      this.firstPictureBy = now + kFirstPictureMs;
      setTimeout(this.again, kFirstPictureMs);
    }
    return now < this.firstPictureBy;
  }
}
