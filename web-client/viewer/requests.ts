// A viewer's requests to its worker: what to show, and what to refine first. Each request is sent
// only if it has changed.

import type {Display} from '../core/picture/display';
import type {Vector, Plane} from '../core/protocol/geometry';
import type {Client} from '../core/session/client';
import type {ShownMesh} from './page/shown_mesh';
import {planeOf} from './settings/clip_plane';
import {
  fieldValuesOf,
  sharesOf,
  shownScalar,
  type Settings,
  type ViewAttribute,
} from './settings/settings';

export class Requests {
  /** The place that is pointed at, on the lattice. */
  point: Vector | null = null;
  private display = '';
  private view = '';

  constructor(private readonly client: Client) {}

  /** Must be called before another mesh: the worker knows nothing about it. */
  forget(): void {
    this.display = this.view = '';
  }

  /** Returns true if the display has changed. */
  show(display: Display): boolean {
    const text = JSON.stringify(display);
    if (text === this.display) return false;
    this.display = text;
    this.client.show(display);
    return true;
  }

  look(frustum: Plane[], planes: Plane[]): void {
    const view = {frustum, planes, point: this.point};
    const text = JSON.stringify(view);
    if (text !== this.view) this.client.look(view);
    this.view = text;
  }
}

/** The clip planes in lattice coordinates; none before there are bounds. */
export function planesOf({planes}: Settings, {bounds}: ShownMesh): Plane[] {
  return bounds.length > 0 ? planes.map((plane) => planeOf(plane, bounds)) : [];
}

/** `read` gives an attribute. REQUIRES: the manifest and the bounds are here. */
export function displayOf(
  settings: Settings,
  mesh: ShownMesh,
  read: (name: ViewAttribute) => string | null,
): Display {
  const {fields} = mesh.manifest!;
  const iso = fieldValuesOf('iso', read('iso'), fields);
  const threshold = fieldValuesOf('threshold', read('threshold'), fields);
  const [low, high] = threshold ? sharesOf(threshold, fields) : [];
  return {
    color: shownScalar(read('field'), fields, mesh.firstField),
    body: settings.surface && settings.volume === null,
    mode: settings.planes.length > 0 ? settings.mode : 'cut',
    planes: planesOf(settings, mesh),
    isosurfaces: iso && {scalar: iso.scalar, values: sharesOf(iso, fields)},
    volume: settings.volume !== null,
    threshold: threshold && {scalar: threshold.scalar, low: low!, high: high!},
  };
}
