// A new layer costs a file of its own, here toy_layer.ts, and a line in each of four lists.

import {readdirSync, readFileSync} from 'node:fs';
import {expect, test, vi} from 'vitest';
import {fieldLayers} from '../core/layers/layers';
import {fieldsOf, layerSoups, markedValues, soupOf} from '../core/layers/shown';
import type {MeshArrays} from '../core/picture/display';
import {FieldScale} from '../core/picture/field_scale';
import type {FieldInfo} from '../core/protocol/fields';
import type {Manifest} from '../core/protocol/manifest';
import {buffersOf} from '../core/session/snapshot_buffers';
import type {Snapshot} from '../core/session/worker_messages';
import {settingsFor, ShownMesh} from '../viewer/page/shown_mesh';
import {displayOf} from '../viewer/requests';
import {kViewAttributes, type ViewAttribute} from '../viewer/settings/settings';
import {unfittingParts, wrongParts} from '../viewer/settings/wrong_parts';
import {kControls} from '../viewer/sections';
import {toy} from './toy_layer';

vi.mock('../core/layers/layer_rules', async (actual) => {
  const its = await actual<{isFieldValues(count: number): unknown; kLayerRules: object}>();
  const isToy = its.isFieldValues(1);
  return {...its, kLayerRules: {...its.kLayerRules, toy: [isToy, 'a field, "=" and a number']}};
});
vi.mock('../core/layers/layers', async (original) => {
  const {kLayers: shipped} = await original<{kLayers: object[]}>();
  const {toy: added} = await import('./toy_layer');
  const all = [...shipped, added]; // the line
  return {kLayers: all, fieldLayers: () => all.filter((layer) => 'pointsOnly' in layer)};
});

vi.mock('../core/layers/layer_work', async (original) => {
  const {kLayerWork: shipped} = await original<{kLayerWork: object[]}>();
  const {toyWork} = await import('./toy_layer');
  return {kLayerWork: [...shipped, toyWork]}; // the other line
});

vi.mock('../viewer/panels/value_controls', async (original) => {
  const {kValueControls: shipped} = await original<{kValueControls: object}>();
  const {toyControl} = await import('./toy_layer');
  return {kValueControls: {...shipped, toy: toyControl}}; // and its controls
});

const kFields: FieldInfo[] = [
  {name: 'p', components: 1, association: 'point', step: 1, minimum: [0], range: [0, 10]},
  {name: 'c', components: 1, association: 'cell', step: 1, minimum: [0], range: [0, 10]},
];
const manifest = {fields: kFields, levels: []} as unknown as Manifest;
const read =
  (attributes: Record<string, string>) =>
  (name: ViewAttribute | 'transport'): string | null =>
    attributes[name] ?? null;

function displayFor(attributes: Record<string, string>): ReturnType<typeof displayOf> {
  const shown = new ShownMesh();
  shown.manifest = manifest;
  shown.base.bounds = [0, 0, 0, 1, 1, 1];
  return displayOf(settingsFor(shown, read(attributes)), shown, read(attributes));
}

test('hasAnAttributeThatIsCheckedAndControls', () => {
  const first = kViewAttributes.indexOf('clip');
  const layers = kViewAttributes
    .slice(first, kViewAttributes.indexOf('toy' as never) + 1)
    .join(' ');
  expect(layers).toBe(
    'clip clip-mode iso threshold parts hidden-parts part-opacity part-colors ' +
      'streamlines streamline-kind seeds streamline-look streamline-limits ' +
      'arrows arrow-places arrow-density arrow-length arrow-size arrow-color volume toy',
  );
  expect(wrongParts(read({toy: 'p=1'}))).toEqual([]);
  expect(wrongParts(read({toy: 'p=1,2'}))).toEqual([
    'toy="p=1,2" is not understood. It takes a field, "=" and a number.',
  ]);
  expect(unfittingParts(read({toy: 'c=1'}), manifest)[0]).toMatch(/^toy="c=1" is not shown/);
  for (const part of ['name="toy"', 'class="toy sub"', 'Place of the toy'])
    expect(kControls).toContain(part);
});

test('askedForItsTrianglesTravelToThePage', () => {
  const display = displayFor({field: 'c', toy: 'p=5'});
  expect(display.layers).toEqual({toy: {scalar: {field: 0, component: -1}, values: [0.5]}});
  expect(fieldsOf(display)).toEqual([1, 0]);
  const mesh: MeshArrays = {
    points: new Int32Array(0),
    tetrahedra: new Uint32Array(0),
    boundary: new Uint32Array(0),
    scale: () => new FieldScale(new Int32Array(0), kFields[0]!),
  };
  const snapshot = {cuts: [], ...layerSoups(mesh, display, null)} as unknown as Snapshot;
  const soup = soupOf(snapshot, toy)!;
  expect(soup.positions[0]).toBe(0.5);
  expect(buffersOf(snapshot)).toContain(soup.positions.buffer);
});

test('itsValuesAreMarkedOnTheLegendOfItsField', () => {
  const marked = (field: number): number[] =>
    markedValues({field, component: -1}, read({toy: 'p=5', iso: 'p=2,3'}), kFields);
  expect(marked(0)).toEqual([2, 3, 5]);
  expect(marked(1)).toEqual([]);
});

test('notAskedForItIsNotInTheDisplay', () => {
  expect(displayFor({})).not.toHaveProperty('layers');
});

/** Nothing but a layer's own file names it, so that nothing but a file and two lines add one. */
test('noOtherFileNamesALayer', () => {
  const root = new URL('../', import.meta.url);
  const paths = ['core', 'webgl', 'three', 'viewer'].flatMap((room) =>
    readdirSync(new URL(`${room}/`, root), {recursive: true}).map(
      (path) => `${room}/${String(path)}`,
    ),
  );
  const others = paths.filter((path) => path.endsWith('.ts') && !path.startsWith('core/layers/'));
  expect(others.length).toBeGreaterThan(100);
  const namesOf = (path: string): string[] => {
    const text = readFileSync(new URL(path, root), 'utf8');
    return fieldLayers()
      .map(({name}) => name)
      .filter((name) => new RegExp(`['".]${name}['"]`).test(text));
  };
  expect(others.filter((path) => namesOf(path).length > 0)).toEqual([]);
});
