// The layers of a display together: the fields that they need, and what they hide and make.

import {inputsIn} from '../picture/derived_field';
import type {Display, MeshArrays} from '../picture/display';
import type {Scalar} from '../picture/field_scale';
import {noSoup, type TriangleSoup} from '../picture/triangle_soup';
import type {FieldInfo} from '../protocol/fields';
import type {Layer} from './layer';
import {kLayerWork} from './layer_work';
import {fieldLayers, type LayerAttribute} from './layers';
import {partsWork} from './parts';

/** The part of a snapshot that layers make. Parts that have not changed are absent. */
export interface LayerSoups {
  isosurface?: TriangleSoup;
  /** By name, those that have no member of their own. */
  layers?: Record<string, TriangleSoup>;
}

/** The manifest's fields that a display needs, each once. */
export function fieldsOf(display: Display): number[] {
  const scalars = [
    display.color,
    display.warp,
    display.flux,
    display.parts?.scalar,
    display.streamlines,
    ...(display.streamlines?.instants ?? []),
    display.arrows,
    ...fieldLayers().map((layer) => layer.requestOf(display)?.scalar),
  ];
  const named = scalars.filter((scalar) => scalar != null).map(({field}) => field);
  return [...new Set(named.flatMap((field) => inputsIn(display, field)))];
}

/** The values of the scalar at which layers draw or hide, to be marked on its legend. */
export function markedValues(
  {field, component}: Scalar,
  read: (name: LayerAttribute) => string | null,
  fields: readonly FieldInfo[],
): number[] {
  return fieldLayers().flatMap((layer) => {
    const request = layer.read(read(layer.name), fields);
    const isSame = request?.scalar.field === field && request.scalar.component === component;
    return isSame ? request.values : [];
  });
}

/** The cells that no layer hides; null means all. */
export function keptCells(mesh: MeshArrays, display: Display): Uint8Array | null {
  const hiding = kLayerWork
    .map((work) => work.hiding?.(mesh, display) ?? null)
    .filter((hide) => hide !== null);
  if (hiding.length === 0) return null;
  const kept = new Uint8Array(mesh.tetrahedra.length / 4).fill(1);
  for (const hide of hiding) hide(kept);
  return kept;
}

/** Layers hide cells, which leaves a jagged surface. Only that of parts has a shape. */
export function isJagged(mesh: MeshArrays, display: Display): boolean {
  return kLayerWork.some((work) => work !== partsWork && work.hiding?.(mesh, display));
}

/** Two displays with the same key hide the same cells. */
export function hidingKey(display: Display): string {
  return JSON.stringify(kLayerWork.map((work) => work.hiding && work.layer.requestOf(display)));
}

/** The triangles of all layers that have some; no triangles for those that are not shown. */
export function layerSoups(
  mesh: MeshArrays,
  display: Display,
  kept: Uint8Array | null,
): LayerSoups {
  const soups: LayerSoups = {};
  for (const work of kLayerWork) {
    const {layer} = work;
    if (!work.make || !layer.draw) continue;
    const {edges, member} = layer.draw;
    const soup = {...(work.make(mesh, display, kept) ?? noSoup()), edges};
    if (member) soups[member] = soup;
    else soups.layers = {...soups.layers, [layer.name]: soup};
  }
  return soups;
}

export function soupOf(soups: LayerSoups, {name, draw}: Layer): TriangleSoup | undefined {
  return draw?.member ? soups[draw.member] : soups.layers?.[name];
}
