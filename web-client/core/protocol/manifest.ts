// The manifest of a log (codec/FORMAT.md, "Manifest"), as far as a viewer reads it.

import {QtetError} from './errors';
import type {FieldInfo} from './fields';
import {instantName, markSeries} from './series';

/** A mean or rms, and a maximum. */
export interface Spread {
  mean: number;
  max: number;
}

/**
 * How far a level is from the last one: distances over the diagonal, fields over their range. Never
 * understated.
 */
export interface LevelError {
  toLevel: Spread;
  toOriginal: Spread;
  /** The part of the original that is not covered, over its volume. */
  volumeLost: number;
  /** The part that lies outside of the original, over the original's volume. */
  volumeGained: number;
  /** One for each field; `mean` is the rms. */
  fields: Spread[];
}

/** Which levels have a known error. */
export type KnownErrors = 'none' | 'some';

export interface LevelInfo {
  level: number;
  tetrahedra: number;
  vertices: number;
  boundaryTriangles: number;
  /** Absent where it was not measured. If a level has one, the first and the last do. */
  error?: LevelError;
}

export interface Manifest {
  source: string;
  lattice: {bits: number; step: number; origin: [number, number, number]};
  /**
   * The box round the place where the original's cells are small, in lattice coordinates: low
   * corner, high corner. Absent if they are spread over the mesh.
   */
  focus?: number[];
  /** The first picture that shows something; absent: the first field on the surface. */
  opening?: Opening;
  /** By a field's name without @TIME; that of times by ''. Absent without any. */
  units?: ReadonlyMap<string, string>;
  /** The names of a label's values, by a field's name without @TIME. Absent without any label. */
  labels?: ReadonlyMap<string, ReadonlyMap<number, string>>;
  /** The mesh that the last level was reduced from before the log was made. Absent: it is whole. */
  original?: OriginalSize;
  fields: FieldInfo[];
  levels: LevelInfo[];
  /** How many fields are to come (addLater). */
  later: number;
}

export interface OriginalSize {
  tetrahedra: number;
  vertices: number;
}

export interface Opening {
  /** An index into `fields`. */
  field: number;
  /** The axis across which the mesh is cut open in the middle; null for none. */
  cut: number | null;
}

/** Offsets in the front of a log (codec/FORMAT.md, "Header", "Chunk table"). */
const kHeaderBytes = 64;
const kPositionBitsAt = 13;
const kManifestBytesAt = 24;
const kFieldsAt = 44;
/** Behind the number of later fields in the table. */
const kChecksumBytes = 4;
/**
 * Added to a field's association and to its type if values may be missing. FieldScale says which
 * ones.
 */
const kMissingFlag = 128;
/** Added to a field's association if it is predicted from others in time (RECORDS.md, "Series"). */
const kPredictedFlag = 64;
/** Varints: all bytes but the last have this bit. */
const kMoreFollows = 128;
const kOfCells = 1;
/** codec/FORMAT.md, "Manifest" and "Level columns". */
const kMaxNameBytes = 256;
const kFieldTypes = 10;
const kFirstWholeType = 2;
const kMaxFieldBits = 28;
const kErrorsFollow = 1;
const kFocusFollows = 2;
const kOpeningFollows = 4;
const kUnitsFollow = 8;
const kLabelsFollow = 16;
const kOriginalFollows = 32;
const kMaxUnitBytes = 64;
const kMaxLabelNames = 4096;
const kNoCut = 3;
const kShareBytes = 2;
const kCountColumns = 3;
const kKnownColumn = 3;
/** Behind the two columns of the volume. */
const kFirstPairColumn = kKnownColumn + 3;
const kVolumeFigure = 1e6;
const kErrorFigureDigits = 14;

interface Shape {
  components: number;
  association: number;
}

/** Components and association of so many fields. Predictions in time lie between them. */
function readShapes(reader: ManifestReader, count: number): Shape[] {
  return Array.from({length: count}, () => {
    const [components, association] = [reader.byte(), reader.byte()];
    if ((association & kPredictedFlag) !== 0) {
      for (let parents = reader.byte(); parents > 0; --parents) {
        reader.varint(); // the parent's number
        reader.byte(); // its weight
      }
    }
    return {components, association: association & ~kPredictedFlag};
  });
}

/** Decodes the figures of all levels for so many fields, `columns` numbers a level. */
export type LevelColumns = (
  bytes: Uint8Array,
  errors: KnownErrors,
  fields: number,
  columns: number,
) => Uint32Array;

/**
 * Reads the manifest of a head. REQUIRES: the codec has opened the head, and so has checked its
 * counts and checksums; `levelColumns` belongs to that codec. `least` is that of markSeries. Throws
 * `truncated`, `bad-value`, and the errors of `levelColumns`.
 */
export function readManifest(
  head: Uint8Array,
  levelColumns: LevelColumns,
  least?: number,
): Manifest {
  const header = new DataView(head.buffer, head.byteOffset, head.byteLength);
  const tableAt = kHeaderBytes + header.getUint32(kManifestBytesAt, true);
  const table = new ManifestReader(head.subarray(tableAt));
  const later = table.varint();
  if (later > 0) table.bytes(kChecksumBytes);
  const shapes = readShapes(table, header.getUint32(kFieldsAt, true) - later);
  const reader = new ManifestReader(head.subarray(kHeaderBytes, tableAt));
  reader.text(); // the program that wrote it
  const source = reader.text();
  const lattice = {
    bits: head[kPositionBitsAt]!,
    step: reader.step(),
    origin: reader.numbers(3) as [number, number, number],
  };
  const fields = readFields(reader, shapes);
  const flags = reader.byte();
  const errors = knownErrorsOf(flags);
  const focus = flags & kFocusFollows ? readFocus(reader, lattice.bits) : undefined;
  const opening = flags & kOpeningFollows ? readOpening(reader, fields.length) : undefined;
  const units = flags & kUnitsFollow ? readUnits(reader) : undefined;
  const labels = flags & kLabelsFollow ? readLabels(reader) : undefined;
  const original = flags & kOriginalFollows ? readOriginal(reader) : undefined;
  const levels = readLevels(reader.rest(), errors, fields.length, levelColumns);
  checkOriginal(original, levels.at(-1)!);
  const manifest = {
    source,
    lattice,
    ...(units && {units}),
    ...(labels && {labels}),
    ...(original && {original}),
    ...(focus && {focus}),
    ...(opening && {opening}),
  };
  settle(fields, manifest, later, least);
  return {...manifest, fields, levels, later};
}

/**
 * Adds the fields of the part of later instants, which are the last ones (codec/FORMAT.md, "Later
 * instants"). REQUIRES and throws as readManifest.
 */
export function addLater(
  manifest: Manifest,
  part: Uint8Array,
  levelColumns: LevelColumns,
  least?: number,
): void {
  const {levels, later} = manifest;
  const table = new ManifestReader(part);
  const shapes = readShapes(table, later);
  const reader = new ManifestReader(table.bytes(table.varint()));
  const fields = [...manifest.fields, ...readFields(reader, shapes)];
  const more = levels[0]!.error ? readLevels(reader.rest(), 'some', later, levelColumns) : [];
  if (!levels[0]!.error && reader.rest().length > 0) throw damaged('has bytes behind its end');
  if (more.some(({error}, level) => !error !== !levels[level]!.error))
    throw damaged('has errors of other levels');
  settle(fields, manifest, 0, least);
  // from here on nothing throws
  manifest.fields = fields;
  manifest.later = 0;
  more.forEach(({error}, level) => levels[level]!.error?.fields.push(...(error?.fields ?? [])));
}

/** Once the fields are known, `later` more of them to come. */
function settle(
  fields: FieldInfo[],
  {units, labels}: Pick<Manifest, 'units' | 'labels'>,
  later: number,
  least = 2,
): void {
  if (new Set(fields.map(({association, name}) => `${association}:${name}`)).size < fields.length)
    throw damaged('has a field twice');
  for (const info of fields) {
    const name = nameWithoutTime(info);
    const unit = units?.get(name);
    if (unit !== undefined) info.unit = unit;
    const names = mayBeLabel(info) ? labels?.get(name) : undefined;
    if (names) info.labels = names;
  }
  markSeries(fields, later > 0 ? 1 : least);
}

const nameWithoutTime = ({name}: FieldInfo): string => instantName(name)?.series ?? name;

/** A cell field of one component and of integers that are stored as they are. */
function mayBeLabel({association, components, isWhole, step}: FieldInfo): boolean {
  return association === 'cell' && components === 1 && isWhole === true && step === 1;
}

function readFields(reader: ManifestReader, shapes: readonly Shape[]): FieldInfo[] {
  return shapes.map(({components, association}) => readField(reader, components, association));
}

function readLevels(
  bytes: Uint8Array,
  errors: KnownErrors,
  fields: number,
  levelColumns: LevelColumns,
): LevelInfo[] {
  const columns = errors === 'none' ? kCountColumns : kFirstPairColumn + 2 * (2 + fields);
  return levelsOf(levelColumns(bytes, errors, fields, columns), columns, errors);
}

function knownErrorsOf(flags: number): KnownErrors {
  if (flags >= 2 * kOriginalFollows) throw damaged('has flags that this viewer does not know');
  return flags & kErrorsFollow ? 'some' : 'none';
}

function readOpening(reader: ManifestReader, fields: number): Opening {
  const [field, cut] = [reader.byte(), reader.byte()];
  if (field >= fields || cut > kNoCut)
    throw damaged('opens with a field or an axis that is not there');
  return {field, cut: cut === kNoCut ? null : cut};
}

function readOriginal(reader: ManifestReader): OriginalSize {
  const [tetrahedra, vertices] = reader.numbers(2) as [number, number];
  if (![tetrahedra, vertices].every((count) => Number.isInteger(count) && count >= 0))
    throw damaged('has a count of the original that is no whole number');
  return {tetrahedra, vertices};
}

function checkOriginal(original: OriginalSize | undefined, last: LevelInfo): void {
  if (original && (original.tetrahedra < last.tetrahedra || original.vertices < last.vertices))
    throw damaged('has a last level of more cells or vertices than its original');
}

function readUnits(reader: ManifestReader): Map<string, string> {
  const units = new Map<string, string>();
  for (let left = reader.varint(); left > 0; --left) {
    const [name, unit] = [reader.text(), reader.text()];
    const {length} = new TextEncoder().encode(unit);
    if (length < 1 || length > kMaxUnitBytes || units.has(name))
      throw damaged('has a unit that is empty, too long, or there twice');
    units.set(name, unit);
  }
  return units;
}

/** Later fields may be labels, too, so that a name may be of no field yet. */
function readLabels(reader: ManifestReader): Map<string, Map<number, string>> {
  const labels = new Map<string, Map<number, string>>();
  let last = '';
  for (let left = reader.varint(); left > 0; --left) {
    const name = reader.text();
    if (!isBehind(name, last)) throw damaged('has labels that are in no order');
    last = name;
    labels.set(name, readLabelNames(reader));
  }
  return labels;
}

function readLabelNames(reader: ManifestReader): Map<number, string> {
  const names = new Map<number, string>();
  let last = -Infinity;
  for (let left = reader.varint(); left > 0; --left) {
    const [value, name] = [reader.integer(), reader.text()];
    if (value <= last || name === '' || names.size === kMaxLabelNames)
      throw damaged('has names of a label that are in no order, empty or too many');
    last = value;
    names.set(value, name);
  }
  return names;
}

/** In the order of the bytes of UTF-8, which is not that of UTF-16. */
function isBehind(text: string, last: string): boolean {
  const [its, before] = [text, last].map((word) => new TextEncoder().encode(word));
  const at = its!.findIndex((byte, i) => byte !== before![i]);
  return at >= 0 && its![at]! > (before![at] ?? -1);
}

/** In shares of the lattice's span in the file. */
function readFocus(reader: ManifestReader, bits: number): number[] {
  const corners = Array.from({length: 6}, () => reader.share() * 2 ** bits);
  if (corners.slice(0, 3).some((low, axis) => low >= corners[axis + 3]!))
    throw damaged('has a focus that is an empty box');
  return corners;
}

function readField(
  reader: ManifestReader,
  components: number,
  associationAndMissing: number,
): FieldInfo {
  const association = (associationAndMissing & ~kMissingFlag) === kOfCells ? 'cell' : 'point';
  const name = reader.text();
  if (name === '') throw damaged('has a field without a name');
  const typeAndMissing = reader.byte();
  if ((typeAndMissing & kMissingFlag) !== (associationAndMissing & kMissingFlag))
    throw damaged('contradicts itself in whether a field has missing values');
  const type = typeAndMissing & ~kMissingFlag;
  if (type >= kFieldTypes) throw damaged('has a field of an unknown type');
  const bits = reader.byte();
  if (bits < 1 || bits > kMaxFieldBits) throw damaged(`has a field of ${bits} bits`);
  return {
    name,
    components,
    association,
    isWhole: type >= kFirstWholeType,
    type,
    bits,
    step: reader.step(),
    minimum: reader.numbers(components),
    range: reader.numbers(2) as [number, number],
  };
}

function levelsOf(numbers: Uint32Array, columns: number, errors: KnownErrors): LevelInfo[] {
  const levels = numbers.length / columns;
  return Array.from({length: levels}, (_, level) => {
    const at = (column: number): number => numbers[column * levels + level]!;
    const info: LevelInfo = {level, tetrahedra: at(0), vertices: at(1), boundaryTriangles: at(2)};
    if (errors === 'none' || at(kKnownColumn) === 0) return info;
    const pairs: Spread[] = [];
    for (let column = kFirstPairColumn; column < columns; column += 2)
      pairs.push({mean: errorOf(at(column)), max: errorOf(at(column + 1))});
    const [toLevel, toOriginal, ...fields] = pairs;
    info.error = {
      toLevel: toLevel!,
      toOriginal: toOriginal!,
      volumeLost: at(kKnownColumn + 1) / kVolumeFigure,
      volumeGained: at(kKnownColumn + 2) / kVolumeFigure,
      fields,
    };
    return info;
  });
}

/** Decodes three significant digits (codec/error_figure.h). Parsing a decimal rounds only once. */
export function errorOf(figure: number): number {
  if (figure === 0) return 0;
  return Number(
    `${100 + ((figure - 1) % 900)}e${Math.floor((figure - 1) / 900) - kErrorFigureDigits}`,
  );
}

class ManifestReader {
  private at = 0;
  private readonly view: DataView;

  constructor(private readonly all: Uint8Array) {
    this.view = new DataView(all.buffer, all.byteOffset, all.byteLength);
  }

  byte(): number {
    return this.view.getUint8(this.take(1));
  }

  /** In [0, 1). */
  share(): number {
    return this.view.getUint16(this.take(kShareBytes), true) / 2 ** (8 * kShareBytes);
  }

  varint(): number {
    for (let value = 0, scale = 1; ; scale *= kMoreFollows) {
      const byte = this.byte();
      value += (byte % kMoreFollows) * scale;
      if (byte >= kMoreFollows) continue;
      if (byte === 0 && scale > 1)
        throw damaged('has a length that is not written in its shortest form');
      return value;
    }
  }

  integer(): number {
    return this.view.getInt32(this.take(4), true);
  }

  bytes(count: number): Uint8Array {
    const from = this.take(count);
    return this.all.subarray(from, from + count);
  }

  text(): string {
    const size = this.varint();
    if (size > kMaxNameBytes) throw damaged('has a name that is too long');
    return new TextDecoder().decode(this.bytes(size));
  }

  numbers(count: number): number[] {
    return Array.from({length: count}, () => this.number());
  }

  step(): number {
    const step = this.number();
    if (!(step > 0)) throw damaged('has a step that is not above 0');
    return step;
  }

  rest(): Uint8Array {
    return this.all.subarray(this.at);
  }

  private number(): number {
    const value = this.view.getFloat64(this.take(8), true);
    if (!Number.isFinite(value)) throw damaged('has a number that is not finite');
    return value;
  }

  private take(count: number): number {
    if (this.at + count > this.all.length)
      throw new QtetError('truncated', "The mesh's description ends too early.");
    this.at += count;
    return this.at - count;
  }
}

function damaged(what: string): QtetError {
  return new QtetError('bad-value', `The mesh's description is damaged: it ${what}.`);
}
