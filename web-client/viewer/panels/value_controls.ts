// The controls of layers whose attribute is a field and values of it.

/** A switch, and below it a menu of fields, sliders and a line of values. */
export interface Control {
  title: string;
  fieldLabel: string;
  /** One label a slider: one slider moves the first value, two are the ends of a range. */
  sliders: readonly [string] | readonly [string, string];
  valuesLabel: string;
  /** The first values, as shares of the field's range. */
  firstShares: readonly number[];
  areRight(values: readonly number[]): boolean;
  /** Shown for values that are not. */
  expected: string;
  /** Shown while an opaque surface hides it. */
  hiddenHint?: string;
}

/** By the layer's name. */
export const kValueControls: Readonly<Record<string, Control>> = {
  iso: {
    title: 'Isosurfaces',
    fieldLabel: 'Field of the isosurfaces',
    sliders: ['First isovalue'],
    valuesLabel: 'Values',
    firstShares: [0.5],
    areRight: (values) => values.length > 0,
    expected: 'Numbers with commas between them: 0.2, 0.5',
    hiddenHint: 'The surface hides them.',
  },
  threshold: {
    title: 'Threshold',
    fieldLabel: 'Field of the threshold',
    sliders: ['Least value', 'Largest value'],
    valuesLabel: 'From, to',
    firstShares: [0.25, 1],
    areRight: (values) => values.length === 2 && values[0]! <= values[1]!,
    expected: 'Two numbers, the smaller first: 0.2, 0.5',
  },
};
