// What a viewer asks of the picture, wherever that is drawn: on the page's thread (MeshView) or in
// a worker (FarView).

import type {Ray, Vector} from '../core/cell_ray';
import type {ColorMapName} from '../core/color_maps';
import type {CoarseCells} from '../core/volume';
import type {Snapshot} from '../core/worker_messages';
import type {CameraState} from './camera';
import type {Direction} from './directions';
import type {Pose, Size} from './pose';

/** Shares of the canvas that panels cover, each in [0, 1); the mesh is centred in what remains. */
export interface Insets {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

export interface Look {
  map: ColorMapName;
  reversed: boolean;
  edges: boolean;
  /** Of the surface; cuts and isosurfaces stay solid. */
  opacity: number;
  /** Of the volume, at even shares of the range; null: it is not shown. */
  volume?: number[] | null;
}

/** `drawn`: after each frame. `lost`: the browser took the graphics away, or gave them back. */
export interface ViewListeners {
  drawn?(pose: Pose): void;
  lost?(lost: boolean): void;
  /** Something went wrong in the worker that draws; it goes on. */
  failed?(message: string): void;
  /**
   * Nothing has been heard of the worker that draws for so long that it is dead, or hangs; false:
   * it has said something after all.
   */
  silent?(silent: boolean): void;
  /** Client.coarse: without it a volume of many cells follows slowly where graphics are slow. */
  coarse?(have: number): Promise<CoarseCells>;
}

export interface View {
  readonly canvas: Size;
  readonly pose: Pose;
  /** Six numbers. Set before there is a mesh, it waits for one. */
  cameraState: CameraState;
  /**
   * Shows the picture; `drawn` is called after the frame that holds it, with what drawing that
   * took. The snapshot's arrays may be gone afterwards.
   */
  show(snapshot: Snapshot, drawn: (ms: number) => void): void;
  /** Forgets the mesh; the next one is fitted anew. */
  clear(): void;
  setLook(look: Look): void;
  /** FieldMaterial.setRange for all. */
  setRange(low: number, high: number, scaleRange: [number, number], logarithmic: boolean): void;
  setInsets(insets: Insets): void;
  /**
   * A standard view, or the one that a mesh is first seen in (null): as near as its bounding box
   * allows.
   */
  look(direction: Direction | null): void;
  setParallel(parallel: boolean): void;
  /** Turns the camera round its target, in radians. */
  turn(horizontal: number, vertical: number): void;
  /** Moves the camera: below 1 nearer, above 1 farther. */
  zoom(factor: number): void;
  /** The line of sight through a point of the canvas, in CSS pixels from its corner. */
  rayAt(x: number, y: number): Ray;
  /** Where a point of the lattice is on the canvas, in CSS pixels. */
  project(point: Vector): {x: number; y: number};
  /** The picture as it stands, on `background` (CSS colour). */
  picture(background: string): Promise<Blob>;
  dispose(): void;
}
