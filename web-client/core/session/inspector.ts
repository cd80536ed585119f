// Answers the page's questions about the mesh as it is now: what lies under the pointer, and a
// field along a line.

import type {Assembler} from '../decode/assembler';
import {kLayers} from '../layers/layers';
import {keptCells} from '../layers/shown';
import {
  along,
  barycentric,
  below,
  stretches,
  valueAt,
  type Ray,
  type Stretch,
} from '../picture/cell_ray';
import {cuttingPlanes, type Display, type MeshArrays} from '../picture/display';
import {FieldScale, kMagnitude, scalarRange} from '../picture/field_scale';
import {histogramOf, type Axis, type Histogram} from '../picture/histogram';
import {meshArrays} from '../picture/mesh_arrays';
import type {Cells} from '../picture/section';
import type {Vector} from '../protocol/geometry';
import type {FieldInfo} from '../protocol/manifest';

/** The values of one field at a place, one a component; NaN if missing. */
export interface FieldValue {
  field: number;
  values: number[];
}

export interface Pick {
  cell: number;
  /** Its vertices. */
  corners: number[];
  /** In the mesh's own coordinates; `lattice` is the same place on the lattice. */
  position: Vector;
  lattice: Vector;
  /** Only fields that are here. */
  fields: FieldValue[];
}

/**
 * A polyline: ascending positions along the line in the mesh's unit, and the coloured value at
 * each. NaN separates cells that do not touch.
 */
export interface Probe {
  at: number[];
  values: number[];
  length: number;
}

export class Inspector {
  constructor(private readonly assembler: Assembler) {}

  /** The first visible thing that `ray` (lattice coordinates) meets; null if there is none. */
  pick(ray: Ray, display: Display): Pick | null {
    const mesh = meshArrays(this.assembler);
    if (!mesh) return null;
    const cells: Cells = {...mesh, kept: keptCells(mesh, display)};
    let best: {cell: number; t: number} | null = null;
    for (const stretch of stretches(cells, ray, 0, Infinity)) {
      const t = firstSeen(mesh, ray, stretch, display);
      if (t < (best?.t ?? Infinity)) best = {cell: stretch.cell, t};
    }
    return best && this.pickAt(cells, best.cell, along(ray, best.t));
  }

  /** The coloured field from one lattice point to another; null while there is none. */
  probe(from: Vector, to: Vector, display: Display): Probe | null {
    const mesh = meshArrays(this.assembler);
    const manifest = this.assembler.manifest;
    if (!mesh || !manifest) return null;
    const ray: Ray = {origin: from, direction: [to[0] - from[0], to[1] - from[1], to[2] - from[2]]};
    const length = manifest.lattice.step * Math.hypot(...ray.direction);
    const scale = display.color && mesh.scale(display.color);
    const probe: Probe = {at: [], values: [], length};
    if (!scale || length === 0) return probe;
    const found = stretches({...mesh, kept: keptCells(mesh, display)}, ray, 0, 1).sort(
      (a, b) => a.from - b.from,
    );
    let end = -1;
    for (const {cell, from: first, to: last} of found) {
      if (end >= 0 && first > end + 1e-6) push(probe, end * length, NaN);
      for (const t of [first, last])
        push(probe, t * length, valueAt(mesh, scale, cell, along(ray, t)));
      end = last;
    }
    return this.unscaled(probe, display);
  }

  /** Counts the values of the coloured field; null while there are none. */
  histogram(axis: Axis, {color}: Display): Histogram | null {
    const mesh = meshArrays(this.assembler);
    const info = color && this.assembler.manifest?.fields[color.field];
    const scale = color && mesh?.scale(color);
    return mesh && info && scale ? histogramOf(scale, mesh.tetrahedra, info, color, axis) : null;
  }

  private unscaled(probe: Probe, display: Display): Probe {
    const info = this.assembler.manifest!.fields[display.color!.field]!;
    const [low, high] = scalarRange(info, display.color!.component);
    return {...probe, values: probe.values.map((value) => low + value * (high - low))};
  }

  private pickAt(cells: Cells, cell: number, lattice: Vector): Pick {
    const {codec, manifest} = this.assembler;
    const {origin, step} = manifest!.lattice;
    const shares = barycentric(cells, cell, lattice);
    const corners = [...cells.tetrahedra.subarray(4 * cell, 4 * cell + 4)];
    const fields: FieldValue[] = [];
    manifest!.fields.forEach((info, field) => {
      const values = codec.field(field, info.components);
      if (values)
        fields.push({
          field,
          values: components(info, values, info.association === 'cell' ? [cell] : corners, shares),
        });
    });
    return {
      cell,
      corners,
      lattice,
      position: lattice.map((x, axis) => origin[axis]! + step * x) as Vector,
      fields,
    };
  }
}

/** The t at which the ray first sees something of this stretch; Infinity if it never does. */
function firstSeen(mesh: MeshArrays, ray: Ray, stretch: Stretch, display: Display): number {
  const visible = below(cuttingPlanes(display), ray, stretch);
  if (!visible) return Infinity;
  return Math.min(
    display.body && display.mode !== 'slice' ? visible.from : Infinity,
    ...kLayers.map((layer) => layer.seenFrom?.(mesh, display, ray, visible) ?? Infinity),
  );
}

/** `tuples` is one cell, or the four corners that `shares` weigh. */
function components(
  info: FieldInfo,
  values: Int32Array,
  tuples: number[],
  shares: number[],
): number[] {
  return Array.from({length: info.components}, (_, c) => {
    const scale = new FieldScale(values, info, c);
    const [low, high] = scalarRange(info, info.components > 1 ? c : kMagnitude);
    const value =
      tuples.length === 1
        ? scale.at(tuples[0]!)
        : tuples.reduce((sum, tuple, i) => sum + shares[i]! * scale.at(tuple), 0);
    return low + value * (high - low);
  });
}

function push(probe: Probe, at: number, value: number): void {
  probe.at.push(at);
  probe.values.push(value);
}
