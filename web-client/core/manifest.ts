// The manifest of a log (codec/FORMAT.md, "Manifest"), as far as a viewer reads it.

import {QtetError} from './errors';

export interface FieldInfo {
  name: string;
  components: number;
  association: 'point' | 'cell';
  /** value of component c = minimum[c] + step * integer */
  step: number;
  minimum: number[];
  /** of the values, or of the magnitude where components > 1 */
  range: [number, number];
}

export interface LevelInfo {
  level: number;
  tetrahedra: number;
  vertices: number;
  boundaryTriangles: number;
}

export interface Manifest {
  source: string;
  lattice: {bits: number; step: number; origin: [number, number, number]};
  fields: FieldInfo[];
  levels: LevelInfo[];
}

/** Where the manifest lies in the front of a log (codec/FORMAT.md, "Header"). */
const kHeaderBytes = 64;
const kManifestBytesAt = 24;

/** The manifest's JSON. REQUIRES: a head that the codec has opened, so that its counts and checksums are known to be right. */
export function manifestText(head: Uint8Array): string {
  const size = new DataView(head.buffer, head.byteOffset, head.byteLength).getUint32(kManifestBytesAt, true);
  return new TextDecoder().decode(head.subarray(kHeaderBytes, kHeaderBytes + size));
}

/** Throws `bad-value` with the place of what is missing. */
export function parseManifest(text: string): Manifest {
  let json: unknown;
  try {
    json = JSON.parse(text);
  } catch {
    throw wrong('', 'JSON');
  }
  const root = object(json, '');
  const lattice = object(root.lattice, '/lattice');
  return {
    source: typeof root.source === 'string' ? root.source : '',
    lattice: {
      bits: number(lattice.bits, '/lattice/bits'),
      step: number(lattice.step, '/lattice/step'),
      origin: numbers(lattice.origin, 3, '/lattice/origin') as [number, number, number],
    },
    fields: list(root.fields, '/fields').map((value, i) => parseField(object(value, `/fields/${i}`), `/fields/${i}`)),
    levels: list(root.levels, '/levels').map((value, i) => parseLevel(object(value, `/levels/${i}`), `/levels/${i}`)),
  };
}

function parseField(field: Record<string, unknown>, at: string): FieldInfo {
  const components = number(field.components, `${at}/components`);
  return {
    name: text(field.name, `${at}/name`), components, association: field.association === 'cell' ? 'cell' : 'point',
    step: number(field.step, `${at}/step`),
    minimum: numbers(field.minimum, components, `${at}/minimum`),
    range: numbers(field.range, 2, `${at}/range`) as [number, number],
  };
}

function parseLevel(level: Record<string, unknown>, at: string): LevelInfo {
  return {
    level: number(level.level, `${at}/level`), tetrahedra: number(level.tetrahedra, `${at}/tetrahedra`),
    vertices: number(level.vertices, `${at}/vertices`), boundaryTriangles: number(level.boundaryTriangles, `${at}/boundaryTriangles`),
  };
}

function object(value: unknown, at: string): Record<string, unknown> {
  if (typeof value !== 'object' || value === null || Array.isArray(value)) throw wrong(at, 'an object');
  return value as Record<string, unknown>;
}

function list(value: unknown, at: string): unknown[] {
  if (!Array.isArray(value)) throw wrong(at, 'a list');
  return value;
}

function number(value: unknown, at: string): number {
  if (typeof value !== 'number' || !Number.isFinite(value)) throw wrong(at, 'a number');
  return value;
}

function numbers(value: unknown, count: number, at: string): number[] {
  const values = list(value, at).map((item, i) => number(item, `${at}/${i}`));
  if (values.length !== count) throw wrong(at, `${count} numbers`);
  return values;
}

function text(value: unknown, at: string): string {
  if (typeof value !== 'string') throw wrong(at, 'a text');
  return value;
}

function wrong(at: string, expected: string): QtetError {
  return new QtetError('bad-value', `The mesh's description is damaged: "${at || '/'}" is not ${expected}.`);
}
