// A layer that nobody ships: a triangle at the first value.

import {fieldLayer} from '../core/layers/field_layer';
import type {FieldLayer, LayerWork} from '../core/layers/layer';
import type {Display, MeshArrays} from '../core/picture/display';
import type {TriangleSoup} from '../core/picture/triangle_soup';
import type {Control} from '../viewer/panels/value_controls';

export const toyControl: Control = {
  title: 'Toy',
  fieldLabel: 'Field of the toy',
  sliders: ['Place of the toy'],
  valuesLabel: 'Place',
  firstShares: [0.5],
  areRight: (values) => values.length === 1,
  expected: 'One number',
};

const common = fieldLayer('toy', {pointsOnly: true, count: 1});

export const toy = {
  ...common,
  name: 'toy',
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
