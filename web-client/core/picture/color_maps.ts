// Colour maps as tables of 256 RGB entries, base64 of 768 bytes each. viridis (Smith, van der Walt,
// Firing 2015) and cividis (Nunez, Anderton, Renslow 2018): the published tables, dedicated to the
// public domain (CC0). cool-warm: computed from the published definition (Moreland 2009, "Diverging
// Color Maps for Scientific Visualization": Msh interpolation from (59, 76, 192) to (180, 4, 38)
// over white). turbo: the published polynomials (Mikhailov and Du 2019).

export type ColorMapName = 'viridis' | 'cividis' | 'cool-warm' | 'turbo' | 'grey' | 'labels';

/** Those that are continuous. `labels` has kMaxLabels colours for as many whole numbers. */
export const kColorMapNames: readonly ColorMapName[] = [
  'viridis',
  'cividis',
  'cool-warm',
  'turbo',
  'grey',
];
export const kColorMapEntries = 256;

const kTables: Record<'viridis' | 'cividis' | 'cool-warm', string> = {
  viridis:
    'RAFURAJWRQRXRQVZRgdaRghcRgpdRgteRw1gRw5hRxBjRxFkRxNlSBRnSBZoSBdpSBhqSBpsSBttSBxuSB1vSB9wSC' +
    'BxSCFzSCN0SCR1SCV2SCZ3SCh4SCl5Ryp6Ryx6Ry17Ry58Ry99RjB+RjJ+RjN/RjSARTWBRTeBRTiCRDmDRDqDRDuE' +
    'Qz2EQz6FQj+FQkCGQkGGQUKHQUSHQEWIQEaIP0eIP0iJPkmJPkqJPkyKPU2KPU6KPE+KPFCLO1GLO1KLOlOLOlSMOV' +
    'WMOVaMOFiMOFmMN1qMN1uNNlyNNl2NNV6NNV+NNGCNNGGNM2KNM2ONMmSOMmWOMWaOMWeOMWiOMGmOMGqOL2uOL2yO' +
    'Lm2OLm6OLm+OLXCOLXGOLHGOLHKOLHOOK3SOK3WOKnaOKneOKniOKXmOKXqOKXuOKHyOKH2OJ36OJ3+OJ4COJoGOJo' +
    'KOJoKOJYOOJYSOJYWOJIaOJIeOI4iOI4mOI4qNIouNIoyNIo2NIY6NIY+NIZCNIZGMIJKMIJKMIJOMH5SMH5WLH5aL' +
    'H5eLH5iLH5mKH5qKHpuKHpyJHp2JH56JH5+IH6CIH6GIH6GHH6KHIKOGIKSGIaWFIaaFIqeFIqiEI6mDJKqDJauCJa' +
    'yCJq2BJ62BKK6AKa9/KrB/LLF+LbJ9LrN8L7R8MbV7MrZ6NLZ5Nbd5N7h4OLl3Orp2O7t1Pbx0P7xzQL1yQr5xRL9w' +
    'RsBvSMFuSsFtTMJsTsNrUMRqUsVpVMVoVsZnWMdlWshkXMhjXsliYMpgY8tfZcteZ8xcac1bbM1abs5YcM9Xc9BWdd' +
    'BUd9FTetFRfNJQf9NOgdNNhNRLhtVJidVIi9ZGjtZFkNdDk9dBldhAmNg+m9k8ndk7oNo5oto3pds2qNs0qtwyrdww' +
    'sN0vst0ttd4ruN4put4ovd8mwN8lwt8jxeAhyOAgyuEfzeEd0OEc0uIb1eIa2OIZ2uMZ3eMY3+MY4uQY5eQZ5+QZ6u' +
    'Ua7OUb7+Uc8eUd9OYe9uYg+OYh++cj/ecl',
  cividis:
    'ACJOACNPACRRACVTACVUACZWACdYAChZAChbACldACpfACphACtiACxkACxmAC1oAC5qAC5sAC9tADBvADBwADFwAD' +
    'FxATJxBTNxCDNwDDRwDzVwEjVwFDZwFjdwGDdvGjhvHDlvHjpvIDpvITtuIzxuJDxuJj1uJz5uKT9uKj9tK0BtLUFt' +
    'LkFtL0JtMUNtMkNtM0RtNEVsNUVsNkZsOEdsOUhsOkhsO0lsPEpsPUpsPktsP0xsQExsQU1sQk5sQ05sRE9sRVBsRl' +
    'FsR1FsSFJsSVNsSlNsS1RsTFVsTVVsTlZsT1dsUFdsUVhtUlltU1ptVFptVVttVVxtVlxtV11tWF5tWV5uWl9uW2Bu' +
    'XGFuXWFuXmJuXmNvX2NvYGRvYWVvYmVvY2ZwZGdwZWhwZWhwZmlwZ2pxaGpxaWtxamxxa21ybG1ybG5ybW9ybm9zb3' +
    'BzcHFzcXJ0cnJ0cnN0c3R1dHR1dXV1dnZ2d3d2d3d3eHh3eXl3enp4e3p4fHt4fXx4fnx4fn14f354gH94gX94goB5' +
    'g4F5hIJ5hYJ5hoN5h4R4iIV4iYV4ioZ4i4d4jIh4jYh4jol4j4p4kIt4kYt4kox4ko14k454lI53lY93lpB3l5F3mJ' +
    'J3mZJ3mpN2m5R2nJV2nZV2npZ2n5d1oJh1oZl1opl1o5p0pJt0pZx0ppx0p51zqJ5zqZ9zqqBzq6ByrKFyraJyrqNx' +
    'r6RxsKVxsaVws6ZwtKdvtahvtqlvt6luuKpuuattuqxtu61tvK5sva5svq9rv7BrwLFqwbJqwrNpw7NpxLRoxbVoxr' +
    'Znx7dnyLhmyblly7llzLpkzbtjzrxjz71i0L5i0b9h0sBg08Bf1MFf1cJe1sNd18Rc2cVc2sZb28da3MhZ3chY3slY' +
    '38pX4MtW4cxV4s1U5M5T5c9S5tBR59FQ6NJP6dNO6tNM69RL7dVK7tZJ79dI8NhG8dlF8tpE89tC9dxB9t0/994++N' +
    '88+eA6++E4/OI2/eM0/uQ0/uU1/uY2/ug4',
  'cool-warm':
    'O0zAPE7CPVDDPlHFQFPGQVXIQlbJQ1jLRFrMRVzOR13PSF/RSWHSSmPTS2TVTWbWTmjXT2nZUGvaUm3bU27dVHDeVX' +
    'LfV3PgWHXhWXfiWnjkXHrlXXzmXn3nX3/oYYDpYoLqY4TrZYXsZoftZ4juaYrvaovva43wbY7xbpDyb5HzcZPzcpT0' +
    'c5b1dZf2dpn2d5r3eZz4ep34fJ/5faD5fqH6gKP6gaT7gqb7hKf8haj8h6r8iKv9iaz9i639jK/+jbD+j7H+kLL+kr' +
    'T+k7X/lLb/lrf/l7j/mbn/mrv/m7z/nb3/nr7/n7//ocD/osH/o8L+pcP+psT+qMX+qcb+qsf9rMj9rcn9rsn8sMr8' +
    'scv8ssz7tM37tc76ts76t8/5udD5utH4u9H4vNL3vtP2v9P2wNT1wdT0w9X0xNbzxdbyxtfxyNfxydjwytjvy9juzN' +
    'ntzdnsztrr0Nrq0drp0tvo09vn1Nvm1dvl1tzk19zj2Nzi2dzh2tzg293e3N3d3dzc3tzb39zZ4dvY4trW49rV5NnT' +
    '5dnS5djR5tjP59fO6NbM6dbL6tXJ69TI69PG7NPF7dLD7tHC7tDA78+/78698M688c268cy48su38sq188m088iy9M' +
    'ex9Mav9MWt9cSs9cOq9cGp9sCn9r+m9r6k9r2i97yh97qf97me97ic97eb97WZ97SX97OW97KU97CT96+R962Q96yO' +
    '96uM96mL96iJ96aI9qWG9qOF9qKD9qCB9Z+A9Z1+9Zx99Jp79Jl69Jd485V385R18pJ08pBy8Y9x8Y1v8Itu8Ips74' +
    'hr74Zp7oVo7YNm7YFl7H9j631i6nxg6npf6Xhd6HZc53Ra5nJZ5XBY5W9W5G1V42tT4mlS4WdR4GVP32NO3mFN3V9L' +
    '3F1K21tJ2llH2FZG11RF1lJD1VBC1E5B00xA0Uk+0Ec9z0U8zkM7zEA5yz44yjs3yDk2xzY0xjQzxDEywy4xwSswwC' +
    'gvvyUuvSIsvB4ruhoquRYptxEotgsntAQm',
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
/** So neither end is the colour of a background. */
const kGreyFrom = 26;
const kGreyTo = 236;

/** The table as 256 opaque RGBA entries in sRGB; `reversed` turns it round. */
export function colorTable(name: ColorMapName, reversed = false): Uint8Array {
  const table = new Uint8Array(4 * kColorMapEntries).fill(255);
  const entry = entriesOf(name);
  for (let i = 0; i < kColorMapEntries; ++i) {
    table.set(entry(reversed ? kColorMapEntries - 1 - i : i), 4 * i);
  }
  return table;
}

function entriesOf(name: ColorMapName): (i: number) => number[] {
  if (name === 'labels')
    return (i) => kLabels[Math.floor((i * kLabels.length) / kColorMapEntries)]!;
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
  const packed = atob(kTables[name]);
  return (i) => [0, 1, 2].map((c) => packed.charCodeAt(3 * i + c));
}

/** A CSS gradient of the first `count` labels' colours, without transitions. */
export function labelGradient(count: number, reversed = false): string {
  const stops = Array.from({length: count}, (_, i) => {
    const color = kLabels[reversed ? kLabels.length - 1 - i : i]!.join(' ');
    return `rgb(${color}) ${(100 * i) / count}% ${(100 * (i + 1)) / count}%`;
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
