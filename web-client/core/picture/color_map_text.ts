// Colour maps as text: "viridis", "viridis/8" in eight steps, and own ones of colours at ascending
// shares, "custom:0=0000ff,0.5=ffffff,1=ff0000". An attribute may hold anything.

/** Red, green and blue from 0 to 255 at a share of the range. */
export type ColorStop = readonly [share: number, color: readonly number[]];

/** A link has room for so many. */
export const kMaxStops = 64;
const kMaxSteps = 64;
const kCustom = 'custom:';
const kHex = /^[\da-f]{6}$/i;

/** The map's name, or its own colours, and its number of steps; 0: it is continuous. */
export function splitColorMap(text: string): [name: string, steps: number] {
  const [name = '', steps] = text.split('/');
  return [name, Number(steps ?? 0)];
}

/** Whether the text is a number of steps. */
export function isSteps(text: string): boolean {
  const steps = Number(text);
  return /^\d+$/.test(text) && steps >= 2 && steps <= kMaxSteps;
}

/** Null if the text is no own map. */
export function parseStops(name: string): ColorStop[] | null {
  if (!name.startsWith(kCustom)) return null;
  const parts = name.slice(kCustom.length).split(',', kMaxStops + 1);
  const stops = parts.map((part): ColorStop => {
    const [share = '', hex = ''] = part.split('=');
    return [share === '' ? NaN : Number(share), parseHex(hex) ?? []];
  });
  const ascend = stops.every(([share], i) => share > (stops[i - 1]?.[0] ?? -1));
  const areRight = stops.every(([share, color]) => share >= 0 && share <= 1 && color.length === 3);
  return stops.length >= 2 && stops.length <= kMaxStops && ascend && areRight ? stops : null;
}

export function stopsText(stops: readonly ColorStop[]): string {
  const texts = stops.map(([share, color]) => `${Number(share.toFixed(4))}=${hexOf(color)}`);
  return `${kCustom}${texts.join()}`;
}

/** The colour at a share, mixed from the two beside it. REQUIRES: at least one stop. */
export function colorAt(stops: readonly ColorStop[], share: number): number[] {
  const above = stops.find(([at]) => at >= share) ?? stops[stops.length - 1]!;
  const below = [...stops].reverse().find(([at]) => at <= share) ?? stops[0]!;
  const part = above[0] > below[0] ? (share - below[0]) / (above[0] - below[0]) : 0;
  return below[1].map((from, i) => Math.round(from + part * (above[1][i]! - from)));
}

/** Null if the text is no colour: "ff8000". */
export function parseHex(text: string): number[] | null {
  return kHex.test(text) ? [0, 2, 4].map((at) => parseInt(text.slice(at, at + 2), 16)) : null;
}

/** "ff8000"; channels are whole. */
export const hexOf = (color: readonly number[]): string =>
  color.map((channel) => channel.toString(16).padStart(2, '0')).join('');

/** The colours below and above the range, "ff00ff,"; either may be missing. Null: no such text. */
export function parseBeyond(text: string): [number[] | null, number[] | null] | null {
  const parts = text.split(',');
  const colors = parts.map(parseHex);
  const isRight = parts.length === 2 && parts.every((part, i) => part === '' || colors[i] !== null);
  return isRight && text !== ',' ? [colors[0]!, colors[1]!] : null;
}
