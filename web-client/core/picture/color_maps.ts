// Colour maps as tables of 256 RGB entries. viridis (Smith, van der Walt,
// Firing 2015) and cividis (Nunez, Anderton, Renslow 2018): the published tables, dedicated to the
// public domain (CC0). cool-warm: computed from the published definition (Moreland 2009, "Diverging
// Color Maps for Scientific Visualization": Msh interpolation from (59, 76, 192) to (180, 4, 38)
// over white). turbo: the published polynomials (Mikhailov and Du 2019).

export type ColorMapName = 'viridis' | 'cividis' | 'cool-warm' | 'turbo' | 'grey' | 'labels';

/** Those that are continuous. `labels` has kLabelColors colours for as many whole numbers. */
export const kColorMapNames: readonly ColorMapName[] = [
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
export function isColorMapName(name: string | null): name is ColorMapName {
  return name === 'labels' || (kColorMapNames as readonly string[]).includes(name ?? '');
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
  const entry = name === 'labels' ? labelEntries(reversed) : entriesOf(name);
  const turns = reversed && name !== 'labels';
  for (let i = 0; i < kColorMapEntries; ++i) {
    table.set(entry(turns ? kColorMapEntries - 1 - i : i), 4 * i);
  }
  return table;
}

function labelEntries(reversed: boolean): (i: number) => readonly number[] {
  const colors = labelColors(reversed);
  return (i) => colors[Math.floor((i * kLabelColors) / kColorMapEntries)]!;
}

function entriesOf(name: Exclude<ColorMapName, 'labels'>): (i: number) => number[] {
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
  const {first, steps} = kTables[name];
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

/** A CSS gradient from left to right through `stops` evenly spaced entries. */
export function colorGradient(name: ColorMapName, reversed = false, stops = 17): string {
  const table = colorTable(name, reversed);
  const colors = Array.from({length: stops}, (_, i) => {
    const at = 4 * Math.round((i * (kColorMapEntries - 1)) / (stops - 1));
    return `rgb(${table[at]} ${table[at + 1]} ${table[at + 2]})`;
  });
  return `linear-gradient(90deg, ${colors.join(', ')})`;
}
