// Which stretches of a buffer changed, so that only they travel to the GPU.

/**
 * Floats that are compared, and sent, together: fewer calls than floats, fewer floats than a
 * buffer.
 */
export const kBlockFloats = 1024;

export interface Range {
  start: number;
  count: number;
}

/**
 * Copies `from` to the start of `to` and gives the ranges of `to` that became different, in order.
 * REQUIRES: `to` is not shorter.
 */
export function copyChanged(to: Float32Array, from: Float32Array): Range[] {
  const ranges: Range[] = [];
  for (let start = 0; start < from.length; start += kBlockFloats) {
    const end = Math.min(start + kBlockFloats, from.length);
    let i = start;
    // NaN differs from itself: a missing value is sent each time, which harms nothing.
    while (i < end && to[i] === from[i]) ++i;
    if (i === end) continue;
    to.set(from.subarray(start, end), start);
    const last = ranges.at(-1);
    if (last && last.start + last.count === start) last.count += end - start;
    else ranges.push({start, count: end - start});
  }
  return ranges;
}
