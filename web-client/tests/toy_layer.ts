// A layer that nobody ships: a triangle at the first value.

import {fieldLayer} from '../core/layers/field_layer';
import type {Control, FieldLayer, LayerWork} from '../core/layers/layer';
import type {Display, MeshArrays} from '../core/picture/display';
import type {TriangleSoup} from '../core/picture/triangle_soup';

const control: Control = {
  title: 'Toy',
  fieldLabel: 'Field of the toy',
  sliders: ['Place of the toy'],
  valuesLabel: 'Place',
  pointsOnly: true,
  firstShares: [0.5],
  areRight: (values) => values.length === 1,
  expected: 'One number',
};

const common = fieldLayer('toy', control, 1);

export const toy = {
  ...common,
  name: 'toy',
  expected: 'a field, "=" and a number',
  control,
  draw: {edges: true},
} as const satisfies FieldLayer;

export const toyWork = {
  layer: toy,
  make(mesh: MeshArrays, display: Display): TriangleSoup | null {
    const request = display.layers?.toy;
    if (!request || !mesh.scale(request.scalar)) return null;
    const positions = new Float32Array(9).fill(request.values[0]!);
    return {positions, values: new Float32Array(0), firstHalf: 1};
  },
} satisfies LayerWork;
