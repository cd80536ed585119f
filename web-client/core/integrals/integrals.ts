// Integrals over what is drawn: the body, its outer surface, cuts and isosurfaces. Lengths are
// those of the lattice.

import {keptCells, layerSoups} from '../layers/shown';
import {infoIn} from '../picture/derived_field';
import {cutsOf, cuttingPlanes, surfaceOf, type Display, type MeshArrays} from '../picture/display';
import {kMagnitude, scalarRange, type FieldScale, type Scalar} from '../picture/field_scale';
import type {TriangleSoup} from '../picture/triangle_soup';
import {dot, type Plane, type Vector} from '../protocol/geometry';
import type {Manifest} from '../protocol/manifest';
import {
  areaVector,
  Sum,
  tetrahedraBelow,
  trianglesBelow,
  volumeOf,
  type Corner,
  type Extreme,
  type Moments,
} from './simplices';

export interface SurfaceIntegrals extends Moments {
  /** That of the coloured value times the normal; null without a colour. */
  force: Vector | null;
  /** That of a vector field times the normal; null: there is none. */
  flux: number | null;
}

export interface CutIntegrals extends Moments {
  /** The plane's, of length 1. The flux is that towards it. */
  normal: Vector;
  flux: number | null;
}

export interface Integrals {
  /** Null: it is not drawn. */
  body: Moments | null;
  /** Without the cuts; null: it is not drawn. */
  surface: SurfaceIntegrals | null;
  cuts: CutIntegrals[];
  /** All together; null: there are none. */
  isosurfaces: Moments | null;
  /** The vector field of `flux`; null if there is none. */
  vector: Scalar | null;
  /** Nothing of the mesh is hidden or cut away. */
  isWhole: boolean;
}

/** A field's values, as numbers of its own. */
interface Values {
  scale: FieldScale;
  low: number;
  span: number;
}

export class ShownIntegrals {
  private readonly kept: Uint8Array | null;
  private readonly planes: readonly Plane[];
  private readonly color: Values | null;

  constructor(
    private readonly mesh: MeshArrays,
    private readonly display: Display,
    private readonly manifest: Manifest,
  ) {
    this.kept = keptCells(mesh, display);
    this.planes = cuttingPlanes(display);
    this.color = display.color && this.valuesOf(display.color);
  }

  all(): Integrals {
    const {body, kept, planes} = this;
    return {
      body,
      surface: this.surface(),
      cuts: this.cuts(),
      isosurfaces: this.isosurfaces(),
      vector: fluxOf(this.display, this.manifest),
      isWhole: body !== null && kept === null && planes.length === 0,
    };
  }

  /** Null: it is not drawn. */
  private get body(): Moments | null {
    const {body, volume, mode} = this.display;
    return (body || volume) && mode !== 'slice' ? this.inside() : null;
  }

  private inside(): Moments {
    const {color, kept, planes} = this;
    const {points, tetrahedra} = this.mesh;
    const ofCells = color?.scale.ofCells === true;
    const values = Float64Array.from({length: color?.scale.size ?? 0}, (_, i) =>
      valueAt(color!, i),
    );
    const sum = new Sum(ofCells);
    const corners = [0, 1, 2, 3].map((): Corner => [0, 0, 0, NaN]);
    for (let cell = 0, at = 0; at < tetrahedra.length; ++cell, at += 4) {
      if (kept?.[cell] === 0 || tetrahedra[at] === tetrahedra[at + 1]) continue;
      for (let i = 0; i < 4; ++i) {
        const vertex = tetrahedra[at + i]!;
        const corner = corners[i]!;
        for (let axis = 0; axis < 3; ++axis) corner[axis] = points[3 * vertex + axis]!;
        if (color) corner[3] = values[ofCells ? cell : vertex]!;
      }
      if (planes.length === 0) sum.add(corners, volumeOf(corners));
      else for (const part of tetrahedraBelow(corners, planes)) sum.add(part, volumeOf(part));
    }
    return sum.moments();
  }

  private surface(): SurfaceIntegrals | null {
    const {display, kept, mesh, planes} = this;
    if (!display.body || display.mode === 'slice') return null;
    const soupOf = (color: Scalar | null): TriangleSoup =>
      surfaceOf(mesh, {...display, color, labelColors: false}, kept);
    const its = integrate(soupOf(display.color), this.color, planes);
    return {
      ...its.moments,
      force: this.color && its.alongNormals,
      flux: this.flux((component) => soupOf(component), planes, null),
    };
  }

  private cuts(): CutIntegrals[] {
    const {display, kept, mesh} = this;
    const soupsOf = (color: Scalar | null): TriangleSoup[] =>
      cutsOf(mesh, {...display, color, labelColors: false}, kept);
    return soupsOf(display.color).map((soup, i) => {
      const others = this.planes.filter((_, k) => k !== i);
      const normal = unit(display.planes[i]!.normal);
      return {
        ...integrate(soup, this.color, others).moments,
        normal,
        flux: this.flux((component) => soupsOf(component)[i]!, others, normal),
      };
    });
  }

  private isosurfaces(): Moments | null {
    const {display, kept, mesh, planes} = this;
    if (!display.isosurfaces) return null;
    const {isosurface} = layerSoups(mesh, {...display, labelColors: false}, kept);
    return isosurface ? integrate(isosurface, this.color, planes).moments : null;
  }

  /**
   * The vector field's through the triangles, along `normal`, or along their own if that is null.
   * `soupOf` gives them with the values of a component.
   */
  private flux(
    soupOf: (component: Scalar) => TriangleSoup,
    planes: readonly Plane[],
    normal: Vector | null,
  ): number | null {
    const flux = fluxOf(this.display, this.manifest);
    if (!flux) return null;
    let sum = 0;
    for (const component of [0, 1, 2]) {
      const scalar = {field: flux.field, component};
      const values = this.valuesOf(scalar);
      if (!values) return null;
      const {alongNormals, total} = integrate(soupOf(scalar), values, planes);
      sum += normal ? normal[component]! * total : alongNormals[component]!;
    }
    return sum;
  }

  private valuesOf(scalar: Scalar): Values | null {
    const scale = this.mesh.scale(scalar);
    const info = infoIn(this.display, this.manifest, scalar.field);
    const [low, high] = scalarRange(info, scalar.component);
    return scale && {scale, low, span: high - low};
  }
}

/** The least and the largest value of the body; of cuts and isosurfaces where none is drawn. */
export function extremesOf({body, cuts, isosurfaces}: Integrals): (Extreme | null)[] {
  const found = (body ? [body] : [...cuts, isosurfaces]).filter((its) => its !== null);
  const best = (which: 'least' | 'largest', sign: number): Extreme | null =>
    found.flatMap((its) => its[which] ?? []).sort((a, b) => sign * (a.value - b.value))[0] ?? null;
  return [best('least', 1), best('largest', -1)];
}

/** The field whose flux is asked for; null if it is none of three components. */
export function fluxOf(display: Display, manifest: Manifest): Scalar | null {
  const {field} = display.flux ?? display.color ?? {field: -1};
  const isVector = field >= 0 && infoIn(display, manifest, field).components === 3;
  return isVector ? {field, component: kMagnitude} : null;
}

const valueAt = ({scale, low, span}: Values, i: number): number => low + span * scale.at(i);

const unit = (vector: Vector): Vector => {
  const length = Math.sqrt(dot(vector, vector));
  return vector.map((x) => x / length) as Vector;
};

/** Over the part of a soup below all planes. Triangles without a value add to the area alone. */
function integrate(
  {positions, values: shares}: TriangleSoup,
  values: Values | null,
  planes: readonly Plane[],
): {moments: Moments; total: number; alongNormals: Vector} {
  const sum = new Sum(values?.scale.ofCells === true);
  const alongNormals: Vector = [0, 0, 0];
  const corners = [0, 1, 2].map((): Corner => [0, 0, 0, NaN]);
  for (let corner = 0; 3 * corner < positions.length; corner += 3) {
    for (let i = 0; i < 3; ++i) {
      for (let axis = 0; axis < 3; ++axis) corners[i]![axis] = positions[3 * (corner + i) + axis]!;
      if (values) corners[i]![3] = values.low + values.span * shares[corner + i]!;
    }
    for (const part of planes.length > 0 ? trianglesBelow(corners, planes) : [corners]) {
      const area = areaVector(part);
      sum.add(part, Math.hypot(...area));
      const mean = (part[0]![3] + part[1]![3] + part[2]![3]) / 3;
      if (Number.isNaN(mean)) continue;
      for (let axis = 0; axis < 3; ++axis) alongNormals[axis]! += mean * area[axis]!;
    }
  }
  const moments = sum.moments();
  const total = moments.valued > 0 ? moments.mean * moments.valued : 0;
  return {moments, total, alongNormals};
}
