// Finds the changed parts of a buffer, so that only they are sent to the GPU.

/**
 * The unit of comparing and sending, a compromise between the number of calls and the numbers that
 * are sent for nothing.
 */
export const kBlockFloats = 1024;

type Numbers = Float32Array | Uint8Array;

export interface Range {
  start: number;
  count: number;
}

/**
 * Copies `from` to the start of `to` and returns the ranges of `to` that have changed, in order.
 * REQUIRES: `to` is not shorter.
 */
export function copyChanged(to: Numbers, from: Numbers): Range[] {
  const ranges: Range[] = [];
  for (let start = 0; start < from.length; start += kBlockFloats) {
    const end = Math.min(start + kBlockFloats, from.length);
    let i = start;
    // NaN differs from itself, so that a missing value is sent each time. That does no harm.
    while (i < end && to[i] === from[i]) ++i;
    if (i === end) continue;
    to.set(from.subarray(start, end), start);
    const last = ranges.at(-1);
    if (last && last.start + last.count === start) last.count += end - start;
    else ranges.push({start, count: end - start});
  }
  return ranges;
}
