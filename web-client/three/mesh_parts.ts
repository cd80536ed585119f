// The triangles of a picture: surface, cuts and layers, with the look that they share.

import {kLayers} from '../core/layers/layers';
import {soupOf} from '../core/layers/shown';
import {kMaxPlanes} from '../core/picture/display';
import type {Snapshot} from '../core/session/worker_messages';
import {edgeFade} from './edge_fade';
import type {Matrix, Size} from './pose';
import {SoupMesh} from './soup_mesh';
import type {Look} from './view';

/** The darkness of cell edges: enough to follow them, too little to change what a colour says. */
const kEdgeStrength = 0.52;

export class MeshParts {
  private readonly surface = new SoupMesh(true);
  private readonly layers = kLayers.flatMap((layer) =>
    layer.draw ? [{layer, draw: layer.draw, mesh: new SoupMesh(true, true)}] : [],
  );
  private readonly cuts = Array.from({length: kMaxPlanes}, () => new SoupMesh(false));
  readonly all: readonly SoupMesh[] = [
    this.surface,
    ...this.layers.map(({mesh}) => mesh),
    ...this.cuts,
  ];

  /** `capped`: the cuts are closed by their cells. */
  show(snapshot: Snapshot, capped: boolean): void {
    if (snapshot.surface) this.surface.show(snapshot.surface);
    for (const {layer, mesh} of this.layers) {
      const soup = soupOf(snapshot, layer);
      if (soup) mesh.show(soup);
      mesh.material.setClip(snapshot.planes);
    }
    this.surface.material.setClip(snapshot.planes);
    this.cuts.forEach((mesh, i) => {
      mesh.show(capped ? (snapshot.cuts[i] ?? null) : null);
      mesh.material.setClip(snapshot.planes.filter((_, k) => k !== i));
    });
  }

  clear(): void {
    for (const mesh of this.all) mesh.show(null);
  }

  setLook({map, reversed, edges, opacity}: Look): void {
    for (const mesh of this.all) {
      mesh.material.setColorMap(map, reversed);
      mesh.material.setEdges(edges ? kEdgeStrength : 0);
    }
    for (const {draw, mesh} of this.layers) if (!draw.edges) mesh.material.setEdges(0);
    this.surface.material.setOpacity(opacity);
  }

  /** FieldMaterial.setRange for all. Returns the range as it is drawn. */
  setRange(
    low: number,
    high: number,
    scaleRange: [number, number],
    logarithmic: boolean,
  ): {range: [number, number]; logarithmic: boolean} {
    for (const mesh of this.all) mesh.material.setRange(low, high, scaleRange, logarithmic);
    const {range, logarithmic: log} = this.surface.material.uniforms;
    return {range: range!.value as [number, number], logarithmic: log!.value as boolean};
  }

  /** Draws the edges as strong as the cells are large on a canvas of this size. */
  fadeEdges(toCanvas: Matrix, canvas: Size): void {
    const withEdges = [this.surface, ...this.cuts].map(({shown}) => shown);
    const fade = edgeFade(withEdges, toCanvas, canvas);
    for (const mesh of this.all) mesh.material.setEdgeFade(fade);
  }

  setPixelRatio(ratio: number): void {
    for (const mesh of this.all) mesh.material.setPixelRatio(ratio);
  }

  dispose(): void {
    for (const mesh of this.all) mesh.dispose();
  }
}
