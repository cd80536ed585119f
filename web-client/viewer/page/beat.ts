// The beat of the page's figures. Nobody reads figures that change faster. Each change makes the
// browser compose the page again, which costs slow graphics a frame: figures change together.

const kBeatMs = 250;

/** Milliseconds until figures change next. */
export function untilBeat(): number {
  return kBeatMs - (performance.now() % kBeatMs);
}
