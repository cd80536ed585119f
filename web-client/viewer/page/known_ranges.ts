// The values of a list's fields, as far as its segments were shown: one range of colours holds for
// all of them.

type Ends = [low: number, high: number];

/** The values that occur in a segment, and most of them. */
export interface SegmentRanges {
  extent: Ends;
  middle: Ends;
}

export class KnownRanges {
  /** By field and segment. */
  private readonly ranges = new Map<string, Map<number, SegmentRanges>>();

  /** Replaces what is known of the segment. Returns the ranges of all that are known. */
  join(field: string, segment: number, its: SegmentRanges): SegmentRanges {
    const known = this.ranges.get(field) ?? new Map<number, SegmentRanges>();
    this.ranges.set(field, known);
    known.set(segment, its);
    const all = [...known.values()];
    return {
      extent: union(all.map(({extent}) => extent)),
      middle: union(all.map(({middle}) => middle)),
    };
  }
}

const union = (ranges: readonly Ends[]): Ends => [
  Math.min(...ranges.map(([low]) => low)),
  Math.max(...ranges.map(([, high]) => high)),
];
