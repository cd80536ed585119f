// Parts: the cells of each value of a label, hidden, seen through and painted.

import {describe, expect, test} from 'vitest';
import {kLayerRules} from '../core/layers/layer_rules';
import * as loaded from '../core/layers/part_cells';
import {
  isHidden,
  partField,
  partsTexts,
  readParts,
  readState,
  type PartsAttribute,
} from '../core/layers/parts_text';
import {partCells} from '../core/layers/parts';
import type {PartsRequest} from '../core/picture/parts_request';
import {keptCells} from '../core/layers/shown';
import {cutsOf, kPlainDisplay, surfaceOf, type MeshArrays} from '../core/picture/display';
import {FieldScale, kMagnitude} from '../core/picture/field_scale';
import {isClear, kPlainCode, paintOf} from '../core/picture/paint';
import {countParts} from '../core/picture/part_counts';
import type {FieldInfo} from '../core/protocol/fields';
import type {Plane} from '../core/protocol/geometry';
import type {TriangleSoup} from '../core/picture/triangle_soup';
import {shorter} from '../viewer/panels/parts_list';
import {backToFront} from '../webgl/clear_order';
import {allVertices, cubes, soupArea, soupVolume} from './cubes';

Object.assign(partCells, loaded);

const {points, tetrahedra} = cubes(4, 10);
/** Four slabs across x, of 10 by 40 by 40 each. */
const slabs: FieldInfo = {
  name: 'Slab',
  association: 'cell',
  components: 1,
  step: 1,
  minimum: [1],
  range: [1, 4],
  labels: new Map([
    [1, 'Steel'],
    [2, 'Air, hot'],
    [3, '4'],
  ]),
};
const scale = new FieldScale(
  Int32Array.from({length: tetrahedra.length / 4}, (_, cell) => Math.floor(cell / 96)),
  slabs,
);
const mesh: MeshArrays = {points, tetrahedra, boundary: allVertices(points), scale: () => scale};
const request = (its: Partial<PartsRequest>): PartsRequest => ({
  scalar: {field: 0, component: kMagnitude},
  range: slabs.range,
  hidden: [],
  isInverse: false,
  opacities: [],
  colors: [],
  selected: null,
  ...its,
});
const draw = (its: Partial<PartsRequest>): TriangleSoup => {
  const parts = request(its);
  const display = {...kPlainDisplay, parts};
  const painted = {...mesh, paint: loaded.paint(mesh, parts)};
  return surfaceOf(painted, display, keptCells(mesh, display));
};
const read =
  (texts: Partial<Record<PartsAttribute, string>>) =>
  (name: PartsAttribute): string | null =>
    texts[name] ?? null;

describe('cells of parts', () => {
  const kSide = 4 * 400 + 2 * 1600;

  test('aHiddenPartLeavesClosedSurfacesAtItsInterfaces', () => {
    const soup = draw({hidden: [2]});
    expect(soupArea(soup)).toBeCloseTo(kSide + 4 * 800 + 2 * 1600, 2);
    expect(soupVolume(soup)).toBeCloseTo(6 * 48000, 1);
  });

  test('allButOneHidesWhatIsNotNamed', () => {
    expect(soupArea(draw({hidden: [4], isInverse: true}))).toBeCloseTo(kSide, 2);
  });

  test('anInterfaceOfASeenThroughPartIsDrawnOnceBySolidOne', () => {
    const soup = draw({opacities: [[2, 0.5]]});
    expect(soupArea(soup)).toBeCloseTo(4 * 1600 + 2 * 1600 + 2 * 1600, 2);
    const clear = Array.from({length: soup.paint!.length / 4}, (_, i) => soup.paint![4 * i + 3]!);
    const areaOf = (wanted: boolean): number =>
      soupArea({
        positions: soup.positions.filter((_, i) => isClear(clear[Math.floor(i / 3)]!) === wanted),
      });
    expect(areaOf(true)).toBeCloseTo(4 * 400, 2);
    expect(areaOf(false)).toBeCloseTo(4 * 1200 + 4 * 1600, 2);
    expect(soup.hasClear).toBe(true);
  });

  test('betweenTwoSeenThroughPartsOneSideIsDrawn', () => {
    const soup = draw({
      opacities: [
        [2, 0.5],
        [3, 0.5],
      ],
    });
    expect(soupArea(soup)).toBeCloseTo(4 * 1600 + 2 * 1600 + 3 * 1600, 2);
  });

  test('aColorChangesNoFaces', () => {
    const soup = draw({colors: [[1, [255, 128, 0]]], selected: 3});
    expect(soupArea(soup)).toBeCloseTo(6 * 1600, 2);
    const codes = new Set(soup.paint!.filter((_, i) => i % 4 === 3));
    expect([...codes].sort((a, b) => a - b)).toEqual([126, 190, kPlainCode]);
    expect(soup.hasClear).toBe(false);
  });

  test('capsHaveThePaintOfTheirParts', () => {
    const parts = request({hidden: [1], colors: [[2, [1, 2, 3]]]});
    const planes: Plane[] = [{normal: [0, 1, 0], offset: 15}];
    const display = {...kPlainDisplay, parts, planes};
    const painted = {...mesh, paint: loaded.paint(mesh, parts)};
    const [cap] = cutsOf(painted, display, keptCells(mesh, display));
    expect(soupArea(cap!)).toBeCloseTo(30 * 40, 2);
    const own = cap!.paint!.filter((_, i) => i % 4 === 3).filter((code) => code !== kPlainCode);
    expect(own.length).toBeCloseTo(cap!.paint!.length / 12, 5);
  });

  test('countsAndSharesAreThoseOfTheMesh', () => {
    const labelOf = loaded.labelsOfCells(mesh, request({}))!;
    expect(countParts(mesh, labelOf)).toEqual(
      [1, 2, 3, 4].map((label) => ({label, cells: 96, share: 0.25})),
    );
  });
});

describe('attributes of parts', () => {
  test('comeBackAsTheyWere', () => {
    const texts = {
      'hidden-parts': 'all but Steel,2',
      'part-opacity': 'Steel=0.3,3=0.5',
      'part-colors': '4=ff8000',
    };
    expect(partsTexts(readState(read(texts), slabs), slabs)).toEqual(texts);
  });

  test('takeNamesAndNumbersAndLeaveOutTheRest', () => {
    const texts = {'hidden-parts': 'Steel, 3,Wood', 'part-opacity': 'Steel=1,2=0.4,4=7'};
    const state = readState(read(texts), slabs);
    expect([1, 2, 3, 4].map((label) => isHidden(state, label))).toEqual([true, false, true, false]);
    expect([...state.opacities]).toEqual([[2, 0.4]]);
  });

  test('anAbsentRequestIsNone', () => {
    expect(readParts(read({}), [slabs], null)).toBeNull();
    expect(readParts(read({parts: 'Slab'}), [slabs], null)).toBeNull();
    expect(readParts(read({'hidden-parts': '1'}), [], null)).toBeNull();
    expect(readParts(read({}), [slabs], 2)?.selected).toBe(2);
  });

  test('theFieldIsTheNamedLabelOrTheFirst', () => {
    const other = {...slabs, name: 'Other'};
    const plain: FieldInfo = {...slabs, name: 'p', association: 'point'};
    expect(partField('Other', [plain, slabs, other])).toBe(2);
    expect(partField('p', [plain, slabs, other])).toBe(1);
    expect(partField(null, [plain])).toBe(-1);
  });

  test('moreHiddenThanShownPartsAreToldByTheOthers', () => {
    const state = readState(read({'hidden-parts': '1,2,3'}), slabs);
    expect(partsTexts(shorter(state, [1, 2, 3, 4]), slabs)['hidden-parts']).toBe('all but 4');
    const few = readState(read({'hidden-parts': '1,2'}), slabs);
    expect(shorter(few, [1, 2, 3, 4]).isInverse).toBe(false);
  });

  test.each([
    ['part-opacity', 'Steel=0.3,3=1', true],
    ['part-opacity', 'Steel=0', false],
    ['part-opacity', 'Steel=1.5', false],
    ['part-opacity', 'Steel=0.3,', false],
    ['part-colors', 'Steel=FF8800', true],
    ['part-colors', 'Steel=ff88', false],
    ['hidden-parts', '', false],
  ] as const)('%s="%s" %s', (name, text, isRight) =>
    expect(kLayerRules[name][0](text)).toBe(isRight),
  );
});

describe('triangles that are seen through', () => {
  test('areDrawnFromTheFarthestOn', () => {
    const at = (z: number): number[] => [0, 0, z, 1, 0, z, 0, 1, z];
    const positions = Float32Array.from([at(5), at(1), at(9), at(3)].flat());
    const clear = paintOf({color: null, opacity: 0.5, isSelected: false});
    const plain = paintOf({color: null, opacity: 1, isSelected: false});
    const paint = Uint8Array.from(
      [clear, clear, plain, clear].flatMap((its) => [...its, ...its, ...its]),
    );
    const toEye = Float64Array.from({length: 16}, (_, i) => (i % 5 === 0 ? 1 : 0));
    expect([...backToFront(positions, paint, [...toEye])]).toEqual([3, 4, 5, 9, 10, 11, 0, 1, 2]);
  });
});
