// Vectors that change from instant to instant, linearly between two.

import type {LineClock} from './trace';
import type {Vectors, VectorWalk} from './vector_walk';

export interface TimedVectors extends Vectors {
  time: number;
}

/** Times are the same if they differ by less than this share of the span of all. */
const kSameTime = 1e-9;

export class InstantsClock implements LineClock {
  /** The number of the instant before; -1: none is prepared. */
  private at = -1;
  private readonly same: number;

  /** `instants` ascend in time, and are two at least. `begin` is the time of the seeds. */
  constructor(
    private readonly walk: VectorWalk,
    private readonly instants: readonly TimedVectors[],
    private readonly begin: number,
  ) {
    this.same = kSameTime * (instants.at(-1)!.time - instants[0]!.time);
  }

  prepare(time: number, sign: number): number {
    const now = this.begin + time;
    const {instants, same} = this;
    const timeAt = (i: number): number => instants[i]!.time;
    const last = instants.length - 1;
    let at = sign > 0 ? 0 : last - 1;
    if (sign > 0) while (at < last && timeAt(at + 1) <= now + same) ++at;
    else while (at >= 0 && timeAt(at) >= now - same) --at;
    if (at < 0 || at >= last || now < timeAt(at) - same || now > timeAt(at + 1) + same) return 0;
    if (at !== this.at) this.walk.between(instants[at]!, instants[at + 1]!);
    this.at = at;
    return sign > 0 ? timeAt(at + 1) - now : now - timeAt(at);
  }

  get spacing(): number {
    return this.instants[this.at + 1]!.time - this.instants[this.at]!.time;
  }

  set(time: number): void {
    const [from, to] = [this.instants[this.at]!.time, this.instants[this.at + 1]!.time];
    this.walk.setShare(Math.min(1, Math.max(0, (this.begin + time - from) / (to - from))));
  }
}
