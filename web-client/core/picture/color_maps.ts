// Colour maps as tables of 256 RGB entries. viridis (Smith, van der Walt,
// Firing 2015) and cividis (Nunez, Anderton, Renslow 2018): the published tables, dedicated to the
// public domain (CC0). cool-warm: computed from the published definition (Moreland 2009, "Diverging
// Color Maps for Scientific Visualization": Msh interpolation from (59, 76, 192) to (180, 4, 38)
// over white). turbo: the published polynomials (Mikhailov and Du 2019).

import {colorAt, isSteps, parseStops, splitColorMap} from './color_map_text';

type Named = 'viridis' | 'cividis' | 'cool-warm' | 'turbo' | 'grey' | 'labels';
/** A name, or colours of one's own; either may have steps (color_map_text.ts). */
export type ColorMapName = Named | `custom:${string}` | `${string}/${number}`;

/** Those that are continuous. `labels` has kLabelColors colours for as many whole numbers. */
export const kColorMapNames: readonly Named[] = [
  'viridis',
  'cividis',
  'cool-warm',
  'turbo',
  'grey',
];
export const kColorMapEntries = 256;

/**
 * The first entry, and the steps to the other 255: one letter each, red, then green, then blue. h
 * stands for 0. So the tables compress to a fifth of their bytes.
 */
const kTables: Record<'viridis' | 'cividis' | 'cool-warm', {first: number[]; steps: string}> = {
  viridis: {
    first: [68, 1, 84],
    steps:
      'hihihhhihhhhihhhhhhhhhhhhhhhhghhhhghhhghhghhghghhghghghghhghghghghghghghghghghghghghh' +
      'ghghghhghghhghghhghhghghhghhghhghghhghhghhhghhghhhhhhghhihhhhhihihihiiihiiiiijiiijiji' +
      'jijijjijjjjjjjjjjjjjjjjkjjjkjjkjjkjkjkjkjkjkjkkjkjkkjkkjkkjkkjkkjkkjkkjkjkkjkjkjkjjkj' +
      'ijijijijijijijiijiiijiijiiijiijiiiijiiijiiiijiiiiijiiiiiijiiiiiiiiiijiiiiiiiiiiiiiiii' +
      'iiiiiiiiihiiiiiiiiiiiiiiiiihiiiiiiiiiiiiiiiihiiiiiiiiiiiiiiihiiiiiiiiiiiihiiiiiiiiihi' +
      'iiiiihiiiiihiiiihiiihiiihiihiiihihiihiihihihihihihihihihihhihhihihhihhihhihhihhhihhih' +
      'jijijiijijiijiiijiiiiijiiiiiiihiiiihiiihiihihihihihihhihhihhhihhhihhhhhihhhhhhhhihhhh' +
      'hhhhhhhhhhhhhhhhhhhhhhhhhhhhhhhhhhhghhhhhhghhhhghhhghhghhghhghghghhgghghghgghggghgggh' +
      'ggggggggggggggggggfgggfggfggfggfgfgfgffgfgffgffgffgfffgfffgfgffggfgggghghhihiiiiijijj',
  },
  cividis: {
    first: [0, 34, 78],
    steps:
      'hhhhhhhhhhhhhhhhhhhhhhilklkkjjjjjjjijijijiijiijiiiiijiiiiiiiiiiiiiiiiiiiiiiiiiiiiihii' +
      'iiiiiiihiiiiiiihiiiiiiihiiiiiihiiiiihiiiiiiihiiiiiiiiiiiiiiiiiiiihiiiiiiiiiiiiiiiiiii' +
      'iiiiiiiiiiiijiiiiiiiiiiiiiiiiiiiiiijiiiiiiiiiiiijiiiiiiiiijiiiiiiijiiiiiijiiiijiiihhh' +
      'iiihiiihiihiihiihiihihiihiihiihiiihiihiiihiihiihiihiiihiihiihiihiiihiihiihiihiiihiihi' +
      'ihiiihiihiihiiihiihiiihiihiiihiihiiihiiihiihiiihiiihiiihiiihiiihiiihiiiihiiihiiiihiii' +
      'hiiiihiiiiihiiiihiiiiihiiiiihiiiiiihiiiiiiihiiiiiiiihiiiiiiiiiiihiiiiiiiiiiiiiiiiiiij' +
      'ijjijjijjjjijjjjjijihihhghhhhhghhhhghhhhhghhhhhhhghhhhhhhhhhhhhhhhhhhhhhhhhhhihhhhhhh' +
      'hihhhhhihhhhihhhhihhhihhhihhihhihhihihhihhhhhhhhihhhhghhhhhhhhhhhhhghhhhhghhhhghhhghh' +
      'hghhhghhghhghghhghghhghghghghghghgghgghghggghggghgggghggggggggggfggggfggfgfgfffffhiij',
  },
  'cool-warm': {
    first: [59, 76, 192],
    steps:
      'iiijiiiiijiiiijiiijiiijiiijiiijiijiijiijiijiijiijijiijiijijiijiijijiijijiijiijiijijii' +
      'jiijiijiiijiiijiiijiiijiiiiiijiiiiiiiiiiiiiiijiiiihiiiiiihiiihihiihihihihhihhihhhihhh' +
      'hhhhhhhhhhhhhghhhghhghhghghghghghgghggghggggghgggggggggggfgggggfgggfggfggfgfggfgfgfgf' +
      'jjijjijjjijjjijjijjijjijjijjijijjijijijijijijijijijiijijiijiiijiiijiiiiijiiiiiiiiiiii' +
      'iihiiiiihiiihiihihiihihihhihihhihhhihhhhihghhgghghghgghggghggggghgggggggggggfgggggfgg' +
      'gfgggfgfggfgfgfgfgfgfgffgffgffgffgffffgffffffgfffffffffffefffffefffefefefeeeeeedddcba' +
      'jijijijijijiijiijiijiiiiijiiiiiiiiiiihiiiihiiihiihihihihihhihhihhhhihhhhhhhhhhhghhhhg' +
      'hhghhghghghghgghgghggghgggggggggggggggggfgggfgfgfggfgfgfgfgfgfgfgffgfgfgffgfgfgffgfgf' +
      'gffgfgfgffgfgfgffgfgfgfgfgfgfgfgfgfgfgfgfgfggfgfggfggfggfggfgggfgggfgggfggggggfgggggg',
  },
};

export function isColorMapName(text: string | null): text is ColorMapName {
  if (text === null || text === 'labels') return text !== null;
  const [name = '', ...steps] = text.split('/');
  const isMap = (kColorMapNames as readonly string[]).includes(name) || parseStops(name) !== null;
  return isMap && steps.length <= 1 && steps.every(isSteps);
}

/** Polynomials in x from 0 to 1, lowest power first: red, green, blue. */
const kTurbo = [
  [0.13572138, 4.6153926, -42.66032258, 132.13108234, -152.94239396, 59.28637943],
  [0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604],
  [0.1066733, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973],
];
/** Twenty colours that are easy to tell apart, neighbours most of all: two of each of ten hues. */
const kLabels = (
  '1f77b4 ff7f0e 2ca02c d62728 9467bd 8c564b e377c2 17becf bcbd22 7f7f7f ' +
  'aec7e8 ffbb78 98df8a ff9896 c5b0d5 c49c94 f7b6d2 9edae5 dbdb8d c7c7c7'
)
  .split(' ')
  .map((hex) => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16)));
/**
 * The colours of the map `labels`: kLabels, and darker ones. Further labels begin again. It is a
 * prime: multiples of 10 or 100, as numbers of parts often are, meet no colour again soon.
 */
export const kLabelColors = 37;
const kDarker = 0.65;
const kNoStep = 'h'.charCodeAt(0);
/** So neither end is the colour of a background. */
const kGreyFrom = 26;
const kGreyTo = 236;

/** The colours of the map `labels`, in order; `reversed` turns those of kLabels round. */
export function labelColors(reversed = false): readonly (readonly number[])[] {
  const plain = reversed ? [...kLabels].reverse() : kLabels;
  const dark = plain.map((color) => color.map((channel) => Math.round(kDarker * channel)));
  return [...plain, ...dark].slice(0, kLabelColors);
}

/** The table as 256 opaque RGBA entries in sRGB; `reversed` turns it round. */
export function colorTable(name: ColorMapName, reversed = false): Uint8Array {
  const table = new Uint8Array(4 * kColorMapEntries).fill(255);
  const [map, steps] = splitColorMap(name);
  const entry = map === 'labels' ? labelEntries(reversed) : entriesOf(map);
  const turns = reversed && map !== 'labels';
  const last = kColorMapEntries - 1;
  for (let i = 0; i < kColorMapEntries; ++i) {
    const step = Math.floor((i * steps) / kColorMapEntries);
    const at = steps > 0 ? Math.round((step * last) / (steps - 1)) : i;
    table.set(entry(turns ? last - at : at), 4 * i);
  }
  return table;
}

function labelEntries(reversed: boolean): (i: number) => readonly number[] {
  const colors = labelColors(reversed);
  return (i) => colors[Math.floor((i * kLabelColors) / kColorMapEntries)]!;
}

/** REQUIRES: it is a map's name without steps. */
function entriesOf(name: string): (i: number) => number[] {
  const stops = parseStops(name);
  if (stops) return (i) => colorAt(stops, i / (kColorMapEntries - 1));
  if (name === 'grey') {
    return (i) =>
      Array<number>(3).fill(
        Math.round(kGreyFrom + (i * (kGreyTo - kGreyFrom)) / (kColorMapEntries - 1)),
      );
  }
  if (name === 'turbo') {
    return (i) =>
      kTurbo.map((powers) => {
        const value = powers.reduceRight(
          (sum, factor) => sum * (i / (kColorMapEntries - 1)) + factor,
          0,
        );
        return Math.round(255 * Math.min(1, Math.max(0, value)));
      });
  }
  const {first, steps} = kTables[name as keyof typeof kTables];
  const channels = first.map((start, c) => {
    const channel = [start];
    for (let i = 0; i < kColorMapEntries - 1; ++i)
      channel.push(channel[i]! + steps.charCodeAt((kColorMapEntries - 1) * c + i) - kNoStep);
    return channel;
  });
  return (i) => channels.map((channel) => channel[i]!);
}

/** A CSS gradient of the first `count` labels' colours, without transitions. */
export function labelGradient(count: number, reversed = false): string {
  const colors = labelColors(reversed);
  const stops = Array.from({length: count}, (_, i) => {
    return `rgb(${colors[i]!.join(' ')}) ${(100 * i) / count}% ${(100 * (i + 1)) / count}%`;
  });
  return `linear-gradient(90deg, ${stops.join(', ')})`;
}

/** A CSS gradient from left to right through `stops` evenly spaced entries, or the map's steps. */
export function colorGradient(name: ColorMapName, reversed = false, stops = 17): string {
  const colors = gradientStops(name, reversed, stops);
  const [, steps] = splitColorMap(name);
  const texts = colors.map(([at, color]) => (steps > 0 ? `${color} ${100 * at}%` : color));
  return `linear-gradient(90deg, ${texts.join(', ')})`;
}

/** Shares from 0 to 1 with their colours. A step has two. */
export function gradientStops(
  name: ColorMapName,
  reversed: boolean,
  stops: number,
): [share: number, color: string][] {
  const table = colorTable(name, reversed);
  const [, steps] = splitColorMap(name);
  const colorOf = (share: number): string => {
    const at = 4 * Math.round(share * (kColorMapEntries - 1));
    return `rgb(${table[at]} ${table[at + 1]} ${table[at + 2]})`;
  };
  if (steps === 0)
    return Array.from({length: stops}, (_, i) => [i / (stops - 1), colorOf(i / (stops - 1))]);
  return Array.from({length: 2 * steps}, (_, i) => {
    const step = Math.floor(i / 2);
    return [(step + (i % 2)) / steps, colorOf((step + 0.5) / steps)];
  });
}
