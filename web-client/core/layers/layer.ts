// A layer is one way of drawing the mesh, beside its surface. It holds the meaning of its
// attribute, and how it is drawn and controlled. The list is in layers.ts. Its LayerWork stands in
// the same file; pages do without it.

import type {Ray, Stretch} from '../picture/cell_ray';
import type {Display, MeshArrays} from '../picture/display';
import type {Scalar} from '../picture/field_scale';
import type {TriangleSoup} from '../picture/triangle_soup';
import type {FieldInfo} from '../protocol/fields';
import type {FieldValues} from './field_values';

/** The texts that it takes stand in layer_rules.ts. */
export interface Attribute {
  readonly name: string;
}

export interface Layer extends Attribute {
  /** Further attributes. */
  readonly more?: readonly Attribute[];
  /** The display's request to the layer; null if there is none. */
  requestOf(display: Display): unknown;
  /** How its triangles are drawn. */
  readonly draw?: Drawing;
}

/** The worker's part of a layer. The list is in layer_work.ts. */
export interface LayerWork {
  readonly layer: Layer;
  /** Clears the cells that it hides; null if it hides none. */
  hiding?(mesh: MeshArrays, display: Display): ((kept: Uint8Array) => void) | null;
  /** Its triangles, of the kept cells only; null if there are none. */
  make?(mesh: MeshArrays, display: Display, kept: Uint8Array | null): TriangleSoup | null;
  /** The t at which the ray first sees its triangles in this stretch; Infinity if it never does. */
  seenFrom?(mesh: MeshArrays, display: Display, ray: Ray, stretch: Stretch): number;
}

/**
 * A layer whose attribute is a field and values of it. Its controls have its name in
 * viewer/panels/value_controls.ts.
 */
export interface FieldLayer extends Layer {
  /** Reads the request, in the field's own values; null if the text does not fit the mesh. */
  read(text: string | null, fields: readonly FieldInfo[]): FieldValues | null;
  /** The field that the text names, before the mesh is known. */
  fieldOf(text: string): string;
  /** Puts a request with values in [0, 1] over the scalarRange into the display. */
  put(display: Display, request: FieldValues | null): void;

  /** With the quantity that it needs. */
  requestOf(display: Display): {scalar: Scalar} | null;
  /** Only fields of points can be chosen. */
  readonly pointsOnly: boolean;
}

export interface Drawing {
  /** The edges of its triangles are edges of cells. */
  edges: boolean;
  /** The published name of its triangles in a snapshot; without one they are in `layers`. */
  member?: 'isosurface';
}
