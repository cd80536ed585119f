// A picture as a viewer needs it, whether it is drawn on the page's thread (MeshView) or in a
// worker (WorkerView).

import type {LatticeChange, Vector} from '../core/protocol/geometry';
import type {Ray} from '../core/picture/cell_ray';
import type {ColorMapName} from '../core/picture/color_maps';
import type {CoarseCells} from '../core/picture/volume';
import type {Snapshot} from '../core/session/worker_messages';
import type {CameraState} from './camera';
import type {Direction} from './directions';
import type {Matrix} from './matrix';
import type {Pose, Size} from './pose';

/** The shares of the canvas that panels cover, each in [0, 1). The mesh is centred in the rest. */
export interface Insets {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

/**
 * The fitted mesh's whole box is in the picture. These shares of the canvas's width and height stay
 * free on each side of it.
 */
export type Boxed = readonly [number, number];

/** A picture that is drawn apart from the canvas. */
export interface Frame {
  /** In pixels. */
  width: number;
  height: number;
  /** The shares round the mesh that stay free. */
  insets: Insets;
  /** How many pixels a cell's edge takes where it takes one on the canvas. */
  pixelRatio: number;
  /** It will lie on a dark ground: lines beside the mesh are light. */
  onDark?: boolean;
  /** As View.setBoxed. */
  boxed?: Boxed | null;
}

/** A part of such a picture, without ground. `x` and `y` are those of its upper left corner. */
export interface Tile {
  x: number;
  y: number;
  bitmap: ImageBitmap;
}

export interface Rendered {
  /** None: there is no mesh. */
  tiles: Tile[];
  /** Pose.toCanvas of the whole picture. */
  toCanvas: Matrix;
}

export interface Look {
  map: ColorMapName;
  reversed: boolean;
  edges: boolean;
  /** Lines where the surface is bent sharply. */
  creases: boolean;
  /** Opacity of the surface. Cuts and isosurfaces stay solid. */
  opacity: number;
  /** The colours of values below and above the range, from 0 to 255; null: those of its ends. */
  beyond?: readonly [readonly number[] | null, readonly number[] | null];
  /** Opacities of the volume at even shares of the range; null hides it. */
  volume?: number[] | null;
  /** One of kLooks; another text means the first. */
  lines?: string;
  /** Dashes move. */
  moves?: boolean;
  /** The canvas lies on a dark ground: creases are light, and the volume's colours stand off. */
  onDark?: boolean;
}

/**
 * `drawn` is called after each frame, `lost` when the browser takes the graphics away or gives them
 * back.
 */
export interface ViewListeners {
  drawn?(pose: Pose): void;
  lost?(lost: boolean): void;
  /** The worker that draws had an error; it continues. */
  failed?(message: string): void;
  /**
   * The worker that draws has been silent for so long that it is dead or hangs; false: it has
   * answered after all.
   */
  silent?(silent: boolean): void;
  /** A volume is being drawn, or all its cells and pixels are on the canvas. */
  works?(working: boolean): void;
  /** Client.coarse. Without it a volume of many cells follows slowly on slow graphics. */
  coarse?(have: number): Promise<CoarseCells>;
}

export interface View {
  readonly canvas: Size;
  readonly pose: Pose;
  /** As Graphics.renderer. */
  readonly renderer: string;
  /** Six numbers. If they are set before there is a mesh, they wait for one. */
  cameraState: CameraState;
  /**
   * Shows the picture. `drawn` is called after the frame that contains it, with the time of
   * drawing. The snapshot's arrays may be gone afterwards. With `change` it shows another mesh, on
   * another lattice, in the place of the last one. The camera stays.
   */
  show(snapshot: Snapshot, drawn: (ms: number) => void, change?: LatticeChange | null): void;
  /** Forgets the mesh; the next one is fitted again. */
  clear(): void;
  setLook(look: Look): void;
  /** FieldMaterial.setRange for all materials. */
  setRange(low: number, high: number, scaleRange: [number, number], logarithmic: boolean): void;
  setInsets(insets: Insets): void;
  /**
   * Cards cover more for a while. The picture goes between these insets, smaller if it must; the
   * camera and saved pictures stay as they are. Null: the picture goes back.
   */
  setCovered(insets: Insets | null): void;
  /** Numbers round the mesh's box get this room. Null: the mesh itself is fitted. */
  setBoxed(boxed: Boxed | null): void;
  /**
   * The place that the first view of the next mesh looks at: bounds in lattice coordinates; null:
   * all of it.
   */
  setFocus(focus: number[] | null): void;
  /**
   * Shows a standard view, or (null) the first view of a mesh, as near as its bounding box allows.
   */
  look(direction: Direction | null): void;
  setParallel(parallel: boolean): void;
  /**
   * Pictures follow each other, one in `everyMs`: a surface that takes longer has fewer pixels.
   * With 0 nothing plays, and all pixels come back.
   */
  setPlaying(everyMs: number): void;
  /** Turns the camera round its target, in radians. */
  turn(horizontal: number, vertical: number): void;
  /** Moves the camera by shares of the picture's height: the mesh goes right and up. */
  pan(right: number, up: number): void;
  /** Moves the camera so that this lattice point is in the middle of the free area. */
  centre(point: Vector): void;
  /** Moves the camera: below 1 nearer, above 1 farther. */
  zoom(factor: number): void;
  /** The line of sight through a point of the canvas, in CSS pixels from its corner. */
  rayAt(x: number, y: number): Ray;
  /** The place of a lattice point on the canvas, in CSS pixels. */
  project(point: Vector): {x: number; y: number};
  /** The current picture on `background` (a CSS colour). */
  picture(background: string): Promise<Blob>;
  /**
   * The mesh of now in a picture of another size, fitted between its insets. A mesh that is not
   * wholly seen between those of the canvas is not fitted: all that lies there is shown.
   */
  render(frame: Frame): Promise<Rendered>;
  dispose(): void;
}
