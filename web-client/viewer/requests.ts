// A viewer's requests to its worker: what to show. A request is sent only if it has changed.

import {parseScalar, sharesOf} from '../core/layers/field_values';
import {fieldLayers} from '../core/layers/layers';
import {kPlainDisplay, type Display} from '../core/picture/display';
import type {Plane} from '../core/protocol/geometry';
import {isEqual} from '../core/protocol/equal';
import type {Client} from '../core/session/client';
import {lateRequests} from './page/late_requests';
import type {ShownMesh} from './page/shown_mesh';
import {planeOf} from './settings/clip_plane';
import {warpOf} from './settings/warp';
import {shownScalar, type Settings, type ViewAttribute} from './settings/settings';

export class Requests {
  private display: Display | null = null;
  private mesh: ShownMesh | null = null;

  constructor(private readonly client: Client) {}

  /** Returns true if the display has changed. The worker knows none of another mesh. */
  show(display: Display, mesh: ShownMesh): boolean {
    if (mesh === this.mesh && isEqual(display, this.display)) return false;
    this.display = display;
    this.mesh = mesh;
    this.client.show(display);
    return true;
  }
}

/** The clip planes in lattice coordinates; none before there are bounds. */
export function planesOf({planes}: Settings, {base: {bounds}}: ShownMesh): Plane[] {
  return bounds.length > 0 ? planes.map((plane) => planeOf(plane, bounds)) : [];
}

/** `read` gives an attribute. REQUIRES: the manifest and the bounds are here. */
export function displayOf(
  settings: Settings,
  mesh: ShownMesh,
  read: (name: ViewAttribute) => string | null,
): Display {
  const {fields} = mesh.manifest!;
  const ahead = mesh.ahead.request(mesh.progress.here);
  const color = shownScalar(read('field'), fields, mesh.firstField);
  const display: Display = {
    ...kPlainDisplay,
    color,
    ...(settings.map === 'labels' && color && fields[color.field]!.labels && {labelColors: true}),
    body: settings.surface && settings.volume === null,
    mode: settings.planes.length > 0 ? settings.mode : 'cut',
    planes: planesOf(settings, mesh),
    warp: warpOf(settings, {manifest: mesh.manifest, ...mesh.base}),
    restEdges: settings.restEdges,
    volume: settings.volume !== null,
    flux: parseScalar(read('flux'), fields),
    ...lateRequests.read?.(read, mesh),
    ...(ahead.length > 0 && {ahead}),
  };
  const used = [color?.field];
  for (const layer of fieldLayers()) {
    const request = layer.read(read(layer.name), fields);
    layer.put(display, request && {...request, values: sharesOf(request, fields)});
    used.push(request?.scalar.field);
  }
  return {...display, ...mesh.derived?.shown(used)};
}
