// Streamlines as the attributes `streamlines`, `seeds`, `streamline-look` and `streamline-limits`
// have them.

import {kMagnitude} from '../picture/field_scale';
import type {LineInstant, LineLimits, Seeds, StreamlinesRequest} from '../picture/streamlines';
import type {FieldInfo} from '../protocol/fields';
import {placeOf, type Plane, type Vector} from '../protocol/geometry';
import type {Manifest} from '../protocol/manifest';
import {parseClip, type ClipSetting} from './clip';
import {fieldOfKey, parseNumbers, scalarText} from './field_values';

type Name = 'streamlines' | 'streamline-kind' | 'seeds' | 'streamline-look' | 'streamline-limits';
export type ReadStreamlines = (name: Name) => string | null;

/** Lines at most of one kind of seeds; the grid of a plane has so many along a side. */
export const kMostLines = 2000;
export const kMostAlongPlane = 40;
/** Kinds of seeds at most: "line ...; sphere ...". */
const kMostSeeds = 32;
export const kFirstSeeds = 'even 100';
export const kLooks = ['tubes', 'lines', 'dashes'] as const;
export type LinesLook = (typeof kLooks)[number];

export const kFirstLimits: LineLimits = {steps: 1000, length: 3, time: Infinity};
const kMostLineSteps = 10_000;

/** In the mesh's own coordinates. The offset of a plane is a share of the extent. */
export type SeedsText =
  | {kind: 'even'; count: number}
  | {kind: 'line'; from: Vector; to: Vector; count: number}
  | {kind: 'plane'; plane: string; count: number}
  | {kind: 'sphere'; centre: Vector; radius: number; count: number};

/** Fields of points with so many components. A series has its shown instant. */
export function vectorFields(
  fields: readonly FieldInfo[],
  components: readonly number[] = [3],
): number[] {
  return [...fields.keys()].filter((field) => {
    const {association, components: its, instant} = fields[field]!;
    return association === 'point' && components.includes(its) && instant?.isShown !== false;
  });
}

/** The field of those that a text means; -1: none. */
export function vectorField(
  text: string | null,
  fields: readonly FieldInfo[],
  components: readonly number[] = [3],
): number {
  const field = text === null ? -1 : fieldOfKey(text, fields);
  return vectorFields(fields, components).includes(field) ? field : -1;
}

export const vectorText = (field: number, fields: readonly FieldInfo[]): string =>
  scalarText({field, component: kMagnitude}, fields);

/** "even 100", "line 0,0,0 1,0,0 20", "plane x:0.5 8", "sphere 0,0,0 0.1 50", with ";" between. */
export function parseSeeds(text: string): SeedsText[] | null {
  const all = text.split(';').map(parseOne);
  return all.length <= kMostSeeds && all.every((one) => one !== null) ? all : null;
}

function parseOne(text: string): SeedsText | null {
  const [kind, ...words] = text.trim().split(/\s+/);
  const most = kind === 'plane' ? kMostAlongPlane : kMostLines;
  const count = Number(words.at(-1));
  if (!(Number.isInteger(count) && count >= 1 && count <= most)) return null;
  const vectors = words.slice(0, -1).map(parseNumbers);
  const places = vectors.filter((numbers) => numbers.length === 3) as Vector[];
  const [from, to] = places;
  if (kind === 'even') return words.length === 1 ? {kind, count} : null;
  if (kind === 'line') return words.length === 3 && from && to ? {kind, from, to, count} : null;
  if (kind === 'plane') {
    const [plane = ''] = words;
    return words.length === 2 && parseClip(plane).length === 1 ? {kind, plane, count} : null;
  }
  const [radius = 0] = vectors[1] ?? [];
  const isSphere = kind === 'sphere' && words.length === 3 && from && vectors[1]!.length === 1;
  return isSphere && radius > 0 ? {kind, centre: from, radius, count} : null;
}

export function seedsText(all: readonly SeedsText[]): string {
  return all
    .map((seeds) => {
      switch (seeds.kind) {
        case 'even':
          return `even ${seeds.count}`;
        case 'line':
          return `line ${seeds.from.join()} ${seeds.to.join()} ${seeds.count}`;
        case 'plane':
          return `plane ${seeds.plane} ${seeds.count}`;
        case 'sphere':
          return `sphere ${seeds.centre.join()} ${seeds.radius} ${seeds.count}`;
      }
    })
    .join('; ');
}

/** "steps=500 length=2 time=0.5", each of them or none; null if it is something else. */
export function parseLimits(text: string): LineLimits | null {
  const limits = {...kFirstLimits};
  for (const word of text.split(/\s+/).filter(Boolean)) {
    const [name = '', value = '', ...more] = word.split('=');
    const number = Number(value);
    const isRight = Object.hasOwn(limits, name) && value !== '' && more.length === 0 && number > 0;
    if (!isRight || !Number.isFinite(number)) return null;
    if (name === 'steps' && !(Number.isInteger(number) && number <= kMostLineSteps)) return null;
    limits[name as keyof LineLimits] = number;
  }
  return limits;
}

/** Streamlines of the shown instant, or path lines through all instants. */
export const kLineKinds = ['stream', 'path'] as const;
/** Values of vectors that path lines may hold: 240 MB. */
const kMostHeld = 60_000_000;

export const isLineKind = (text: string): boolean =>
  (kLineKinds as readonly string[]).includes(text);

/** Instants of the field's series: all, or evenly chosen ones. None: it has no series. */
function instantsOf(field: number, {fields, levels}: Manifest): LineInstant[] {
  const series = fields[field]!.instant?.series;
  if (series === undefined) return [];
  const all = fields
    .flatMap(({instant, components}, its) =>
      instant?.series === series && components === 3 ? [{field: its, time: instant.time}] : [],
    )
    .sort((a, b) => a.time - b.time);
  const vertices = levels.at(-1)?.vertices ?? 1;
  const most = Math.max(2, Math.floor(kMostHeld / (3 * vertices)));
  const step = Math.ceil(all.length / most);
  return all.filter((its, i) => i % step === 0 || its.field === field || i === all.length - 1);
}

export const isLook = (text: string): text is LinesLook =>
  (kLooks as readonly string[]).includes(text);

/**
 * Null: no streamlines are asked for, or they do not fit the mesh. `planeOf` gives the plane of a
 * setting on the lattice.
 */
export function readStreamlines(
  read: ReadStreamlines,
  manifest: Manifest,
  planeOf: (setting: ClipSetting) => Plane,
): StreamlinesRequest | null {
  const {fields, lattice} = manifest;
  const field = vectorField(read('streamlines'), fields);
  if (field < 0) return null;
  const onLattice = (place: Vector): Vector => placeOf(lattice, place);
  const seeds = (parseSeeds(read('seeds') ?? kFirstSeeds) ?? parseSeeds(kFirstSeeds)!).map(
    (its): Seeds => {
      switch (its.kind) {
        case 'even':
          return its;
        case 'line':
          return {...its, from: onLattice(its.from), to: onLattice(its.to)};
        case 'plane':
          return {kind: 'plane', count: its.count, ...planeOf(parseClip(its.plane)[0]!)};
        case 'sphere':
          return {...its, centre: onLattice(its.centre), radius: its.radius / lattice.step};
      }
    },
  );
  const limits = parseLimits(read('streamline-limits') ?? '') ?? kFirstLimits;
  const instants = read('streamline-kind') === 'path' ? instantsOf(field, manifest) : [];
  return {field, seeds, limits, ...(instants.length > 1 && {instants})};
}
