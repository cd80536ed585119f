import {expect, test} from 'vitest';
import type {FieldInfo} from '../core/protocol/fields';
import type {Manifest} from '../core/protocol/manifest';
import {parseScalar} from '../core/layers/field_values';
import {scalarName} from '../viewer/panels/panel';
import {unfittingParts, unknownNames, wrongParts} from '../viewer/settings/wrong_parts';

const reading =
  (attributes: Record<string, string>) =>
  (name: string): string | null =>
    attributes[name] ?? null;
const field = (name: string, association: 'point' | 'cell'): FieldInfo => ({
  name,
  components: 1,
  association,
  step: 1,
  minimum: [0],
  range: [0, 10],
});
const manifest: Manifest = {
  source: 'test',
  lattice: {bits: 16, step: 1, origin: [0, 0, 0]},
  fields: [field('p', 'point'), field('part', 'cell')],
  levels: [{level: 0, tetrahedra: 1, vertices: 4, boundaryTriangles: 4}],
  later: 0,
};

const kRight: Record<string, string[]> = {
  transport: ['auto', 'range'],
  colormap: ['turbo', 'turbo reversed', 'cool-warm+reversed'],
  range: ['auto', 'symmetric', 'instant', '-1,2'],
  scale: ['log', 'linear'],
  edges: ['on', 'off'],
  creases: ['on', 'off'],
  'rest-edges': ['on', 'off'],
  axes: ['on', 'off'],
  ground: ['light', 'dark', 'white', '3c3c3c', 'ABCDEF'],
  points: ['', '1,2,3', '1,2,3 '.repeat(8)],
  opacity: ['0.5', '1'],
  clip: ['x', '-y:0.3 z:0.5', '1,0,1:0.4'],
  'clip-mode': ['cut', 'cells', 'slice'],
  iso: ['p=1', 'p=1,2'],
  threshold: ['p=1,2'],
  'hidden-parts': ['Steel,3', 'all but Steel'],
  'part-opacity': ['Steel=0.3,3=.5'],
  'part-colors': ['Steel=ff8800'],
  volume: ['', '0,0.5'],
  quality: ['full', '1%', 'cells:20000', 'error:0.01'],
  projection: ['parallel', 'perspective'],
  camera: ['1,2,3,0,0,0'],
};
const kWrong: Record<string, string[]> = {
  transport: ['udp'],
  colormap: ['rainbow', 'turbo backwards', 'turbo reversed twice'],
  range: ['5,1', '1', '1,2,3', 'a,b'],
  scale: ['cubic'],
  edges: ['yes'],
  creases: ['yes'],
  'rest-edges': ['yes'],
  axes: ['yes', ''],
  ground: ['black', '#3c3c3c', '3c3c3', '3c3c3g', ''],
  points: ['1,2', '1,2,x', '1,2,3 '.repeat(9)],
  opacity: ['0', '1.5', 'x'],
  clip: ['w:0.5', 'x:2', 'x y z x', 'x w'],
  'clip-mode': ['flat'],
  iso: ['p', 'p=', '1'],
  threshold: ['p=1', 'p=1,2,3'],
  'hidden-parts': [''],
  'part-opacity': ['Steel', 'Steel=0', 'Steel=2'],
  'part-colors': ['Steel=red'],
  volume: ['1', 'x', 'on', '0,2', Array(34).fill(0.5).join()],
  quality: ['0%', 'best', 'cells:-1'],
  projection: ['fish-eye'],
  camera: ['1,2,3'],
};

test.each(
  Object.entries(kRight).flatMap(([name, texts]) =>
    texts.map((text): [string, string] => [name, text]),
  ),
)('%s="%s" isUnderstood', (name, text) => expect(wrongParts(reading({[name]: text}))).toEqual([]));
test.each(
  Object.entries(kWrong).flatMap(([name, texts]) =>
    texts.map((text): [string, string] => [name, text]),
  ),
)('%s="%s" isNamedWithWhatMayStandThere', (name, text) => {
  const [sentence, ...more] = wrongParts(reading({[name]: text}));
  expect(more).toEqual([]);
  expect(sentence).toContain(`${name}="${text}"`);
  expect(sentence).toMatch(/It takes .{4,}\.$/);
});
test('everyWrongPartIsNamed', () =>
  expect(wrongParts(reading({clip: 'w', range: '2,1', opacity: '7'}))).toHaveLength(3));
test('whatTheMeshDoesNotHaveIsNamed', () => {
  const sentences = (attributes: Record<string, string>): string =>
    unfittingParts(reading(attributes), manifest).join('|');
  expect(sentences({field: 'p', iso: 'p=1', threshold: 'part=1,2', quality: '50%'})).toMatch(
    /^quality="50%" ends nowhere/,
  );
  expect(sentences({field: 'T'})).toContain('no field "T"');
  expect(sentences({field: 'T'})).toContain('It has p, part.');
  expect(sentences({iso: 'T=1'})).toContain('no field "T"');
  expect(sentences({iso: 'part=1'})).toContain('takes a field of points');
  expect(sentences({threshold: 'T=1,2'})).toContain('no field "T"');
  expect(sentences({quality: 'cells:10'})).toBe('');
});

test('aComponentThatIsNotThereIsNamedWithThoseThatAre', () => {
  const fields = [
    {...field('Stress', 'point'), components: 6},
    {...field('U', 'point'), components: 3},
    field('p', 'point'),
  ];
  const said = (attributes: Record<string, string>): string =>
    unfittingParts(reading(attributes), {...manifest, fields}).join('|');
  expect(said({field: 'Stress[6]'})).toBe(
    'field="Stress[6]" names a component that Stress does not have. ' +
      'It has Stress[0] to Stress[5]. Its magnitude is shown.',
  );
  expect(said({field: 'U[3]'})).toMatch(/It has U\[0\] to U\[2\]\. Its magnitude is shown\.$/);
  expect(said({field: 'p[0]'})).toMatch(/Its only value is called "p", which is shown\.$/);
  expect(said({iso: 'U[3]=1'})).toContain('iso="U[3]=1" names a component that U does not have.');
  for (const right of ['Stress', 'Stress[0]', 'Stress[5]', 'U[2]', 'p'])
    expect(said({field: right})).toBe('');
  expect(scalarName({field: 0, component: 5}, fields)).toBe('Stress, xz');
  expect(parseScalar('p[0]', fields)).toEqual({field: 2, component: -1});
});

test('aSlipIsAnsweredByTheNearestWord', () => {
  expect(wrongParts(reading({colormap: 'viridsi'}))[0]).toContain('Did you mean "viridis"?');
  expect(wrongParts(reading({projection: 'paralel'}))[0]).toContain('Did you mean "parallel"?');
  expect(wrongParts(reading({scale: 'cubic'}))[0]).not.toContain('Did you mean');
  expect(unfittingParts(reading({field: 'prat'}), manifest)[0]).toContain('Did you mean "part"?');
});

test('unknownParametersAreNamed', () => {
  expect(unknownNames(['mesh', 'src', 'utm_source', 'fbclid'])).toEqual([]);
  expect(unknownNames(['colourmap', 'palette'])).toEqual([
    'The address has "colourmap", which means nothing here. Did you mean "colormap"?',
    'The address has "palette", which means nothing here.',
  ]);
});

test('partsThatAreNotThereAreNamed', () => {
  const said = (texts: Record<string, string>, fields = manifest.fields): string[] =>
    unfittingParts(reading(texts), {...manifest, fields});
  const block = {...field('Block', 'cell'), labels: new Map([[1, 'Steel']])};
  const fields = [...manifest.fields, block];
  expect(said({'hidden-parts': '1'})).toEqual([
    'The mesh has no parts: none of its fields is a label of cells.',
  ]);
  expect(said({'hidden-parts': 'Steel,7'}, fields)).toEqual([]);
  expect(said({'part-opacity': 'Stel=0.5'}, fields)).toEqual([
    'part-opacity: the mesh has no part "Stel". Did you mean "Steel"?',
  ]);
  expect(said({parts: 'p'}, fields)).toEqual([
    'parts="p" is not followed: the mesh has no such label. It has Block.',
  ]);
});
