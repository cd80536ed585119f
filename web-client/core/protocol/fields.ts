// The fields of a mesh, as its manifest has them, and the keys that name them.

/** A field's place in a series. */
export interface Instant {
  /** The series' key. No other series and no field outside of this one has it. */
  series: string;
  /** The series' name: the field's without its time. */
  name: string;
  /** The series' fields, by time. */
  fields: readonly number[];
  time: number;
  /** The time as the field's name has it. */
  text: string;
  /** The series' key means this instant now. */
  isShown: boolean;
  /** By component: the values that the series' instants can have. */
  ranges: [number, number][];
  /** The same of this instant alone, and its FieldInfo.range. */
  own: SeriesRanges;
  /**
   * The same of the instants that are like this one: the usual ones, or an outlying one alone.
   * Absent where all instants are alike.
   */
  alike?: SeriesRanges;
}

/** That of the values, or of the magnitudes if components > 1; and by component of what can be. */
export interface SeriesRanges {
  range: [number, number];
  ranges: [number, number][];
}

export interface FieldInfo {
  name: string;
  components: number;
  association: 'point' | 'cell';
  /** value of component c = minimum[c] + step * integer */
  step: number;
  minimum: number[];
  /** of the integers */
  bits?: number;
  /** The number of the input's type (codec/FORMAT.md, "Manifest"). */
  type?: number;
  /** The input held whole numbers. */
  isWhole?: boolean;
  /** of the values; of the magnitudes if components > 1; of all instants of a series */
  range: [number, number];
  /** The manifest's; absent where it has none. */
  unit?: string;
  /**
   * It says what a cell is, such as its material (codec/MANIFEST.md, "Labels"): what its values are
   * called, as far as that is known. Absent: it is no label.
   */
  labels?: ReadonlyMap<number, string>;
  /** Only a series' instants have it. */
  instant?: Instant;
  /** It is computed from others, whose values bound its range or do not. */
  derived?: 'bounded' | 'unbounded';
  /** Instead of its name; absent: that is the title, too. */
  title?: string;
  /** The key of the field that it is a quantity of. */
  of?: string;
}

const kFloat32 = 0;

/**
 * The most that a value of the last level may differ from the original's, in the field's unit. It
 * is half a step and the rounding of the type (proto/rounding_error.h). 0: it is the original's.
 */
export function largestRoundingError(info: FieldInfo): number {
  const {bits = 0, components, instant, isWhole, minimum, step, type} = info;
  const [low, high] = instant?.own.range ?? info.range;
  const isOneValue = components === 1 && low === high && low === minimum[0];
  if (isWhole ? step === 1 : isOneValue) return 0;
  const span = step * (2 ** bits - 1);
  const magnitude = Math.max(...minimum.flatMap((x) => [Math.abs(x), Math.abs(x + span)]));
  const ofType = type === kFloat32 ? magnitude * 2 ** -24 + 2 ** -150 : isWhole ? 0.5 : 0;
  return step / 2 + magnitude * 2 ** -49 + ofType;
}

/**
 * The width that known errors are parts of (codec/MANIFEST.md, "Known error"): that of the values.
 * For several components it is the diagonal of the box that the values can have. That is no smaller
 * than the box that they have.
 */
export function widthOfValues({
  components,
  instant,
  minimum,
  range,
  step,
  bits = 0,
}: FieldInfo): number {
  const [low, high] = instant?.own.range ?? range;
  if (components === 1) return high - low;
  return Math.sqrt(minimum.length) * step * (2 ** bits - 1);
}

/**
 * The server's key for each field: its name, or `cell:NAME` for the cell field if two fields share
 * a name (proto/PROTOCOL.md).
 */
export function fieldKeys(fields: readonly FieldInfo[]): string[] {
  const points = new Set(
    fields.filter(({association}) => association === 'point').map(({name}) => name),
  );
  return fields.map(({association, name}) =>
    association === 'cell' && points.has(name) ? `cell:${name}` : name,
  );
}
