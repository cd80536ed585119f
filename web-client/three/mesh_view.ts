// A canvas that shows a progressive mesh: surface, cuts and layers. It draws only after
// changes.

import {Frustum, Group, Matrix4, Scene, Vector3, WebGLRenderer} from 'three';
import type {Vector} from '../core/protocol/geometry';
import type {Ray} from '../core/picture/cell_ray';
import {kLayers} from '../core/layers/layers';
import {soupOf} from '../core/layers/shown';
import {kMaxPlanes} from '../core/picture/display';
import {transferTables} from '../core/picture/transfer';
import type {VolumeCells} from '../core/picture/volume';
import type {TriangleSoup} from '../core/picture/triangle_soup';
import type {Snapshot} from '../core/session/worker_messages';
import {kRow, maxRows} from './cell_textures';
import {OrbitCamera, type CameraState, type Framing} from './camera';
import {checkedDirection, type Direction} from './directions';
import {cornersOf, outlineOf} from './outline';
import {pixelRatioOf, surfaceOf, watchSize, type ViewCanvas} from './worker_canvas';
import {whenDrawn} from './frame_budget';
import {checkedCamera, project, rayAt, type Pose} from './pose';
import {SoupMesh} from './soup_mesh';
import type {Insets, Look, View, ViewListeners} from './view';
import {VolumeView, type Picture} from './volume_view';

/** The darkness of cell edges: enough to follow them, too little to change what a colour says. */
const kEdgeStrength = 0.52;
/** An eye at this distance from the middle, in radii of the bounds, is hardly in the mesh. */
const kOutside = 0.6;
/** More than two pixels a point cost more than they show. */
const kMaxPixelRatio = 2;

export class MeshView implements View {
  readonly orbit: OrbitCamera;
  private frameMs = 0;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  /** Maps lattice coordinates to a ball of radius 1 round the origin. */
  private readonly lattice = new Group();
  private readonly surface = new SoupMesh(true);
  private readonly layers = kLayers.flatMap((layer) =>
    layer.draw ? [{layer, draw: layer.draw, mesh: new SoupMesh(true, true)}] : [],
  );
  private readonly cuts = Array.from({length: kMaxPlanes}, () => new SoupMesh(false));
  private readonly volume: VolumeView;
  /** The user has changed something since the last picture; new levels alone do not count. */
  private moved = false;
  private shownLook = '';
  private transfer = '';
  private range = '';
  private readonly endWatch: () => void;
  private readonly surfaceCanvas: HTMLCanvasElement | OffscreenCanvas;
  private bounds: number[] = [];
  /** Lattice points that the mesh lies between. */
  private outline: Vector[] = [];
  private focus: number[] | null = null;
  private insets: Insets = {left: 0, right: 0, top: 0, bottom: 0};
  /** The next mesh is seen from here first; null: its first view. */
  private start: CameraState | Direction | null = null;
  private frame = 0;
  private afterFrame: ((ms: number) => void)[] = [];

  /** Throws when the browser has no WebGL 2. */
  constructor(
    readonly canvas: ViewCanvas,
    private readonly listeners: ViewListeners = {},
  ) {
    this.surfaceCanvas = surfaceOf(canvas);
    this.renderer = new WebGLRenderer({
      canvas: this.surfaceCanvas,
      antialias: true,
      alpha: true,
      powerPreference: 'high-performance',
    });
    this.renderer.setClearColor(0, 0);
    this.volume = new VolumeView(
      (moved) => this.invalidate(moved),
      listeners.coarse?.bind(listeners),
      (working) => listeners.works?.(working),
    );
    this.orbit = new OrbitCamera(canvas as HTMLCanvasElement, () => this.invalidate());
    this.lattice.add(...this.meshes());
    this.scene.add(this.lattice);
    this.surfaceCanvas.addEventListener('webglcontextlost', this.onLost);
    this.surfaceCanvas.addEventListener('webglcontextrestored', this.onRestored);
    this.endWatch = watchSize(canvas, () => this.resize());
    this.resize();
  }

  /** Shows the picture. `drawn` is called after the frame that contains it. */
  show(snapshot: Snapshot, drawn: (ms: number) => void): void {
    this.afterFrame.push(drawn);
    this.invalidate(snapshot.volume == null);
    if (snapshot.surface) this.surface.show(snapshot.surface);
    for (const {layer, mesh} of this.layers) {
      const soup = soupOf(snapshot, layer);
      if (soup) mesh.show(soup);
      mesh.material.setClip(snapshot.planes);
    }
    this.surface.material.setClip(snapshot.planes);
    if (snapshot.volume !== undefined) this.volume.take(this.fitting(snapshot.volume));
    this.volume.setClip(snapshot.planes);
    this.cuts.forEach((mesh, i) => {
      // A cap would hide the volume behind it. A slice is drawn inside it.
      mesh.show(
        this.volume.hasCells && snapshot.planes.length > 0 ? null : (snapshot.cuts[i] ?? null),
      );
      mesh.material.setClip(snapshot.planes.filter((_, k) => k !== i));
    });
    if (snapshot.bounds.length > 0) this.growTo(snapshot.bounds, snapshot.surface);
  }

  /**
   * A camera's state is relative to the largest mesh so far. A coarse mesh is a little smaller, and
   * the line decides which one comes first. So only the whole mesh gives a state, or a link, the
   * same picture everywhere.
   */
  private growTo(seen: number[], surface: TriangleSoup | undefined): void {
    const isFirst = this.bounds.length === 0;
    const bounds = isFirst
      ? seen
      : this.bounds.map((end, i) => (i < 3 ? Math.min : Math.max)(end, seen[i]!));
    if (!isFirst && bounds.every((end, i) => end === this.bounds[i])) return;
    this.bounds = bounds;
    this.outline = outlineOf(surface, bounds);
    this.placeLattice();
    if (!isFirst) {
      if (this.orbit.fitted) this.orbit.fit(() => this.framing());
      return;
    }
    if (Array.isArray(this.start)) this.orbit.state = this.start;
    else this.look(this.start);
    this.start = null;
  }

  /** Forgets the mesh; the next one is fitted again. */
  clear(): void {
    this.bounds = [];
    for (const mesh of this.meshes()) mesh.show(null);
    this.volume.take(null);
    this.invalidate();
  }

  setLook(next: Look): void {
    const {map, reversed, edges, opacity, volume} = next;
    const look = JSON.stringify([map, reversed, edges, opacity, volume]);
    // it is called with every attribute change, and a picture costs more than a comparison
    if (look === this.shownLook) return;
    this.shownLook = look;
    for (const mesh of this.meshes()) {
      mesh.material.setColorMap(map, reversed);
      mesh.material.setEdges(edges ? kEdgeStrength : 0);
    }
    for (const {draw, mesh} of this.layers) if (!draw.edges) mesh.material.setEdges(0);
    this.surface.material.setOpacity(opacity);
    const transfer = volume ? `${map} ${reversed} ${volume.join()}` : '';
    if (volume && transfer !== this.transfer)
      this.volume.setTransfer(transferTables(volume, map, reversed));
    this.transfer = transfer;
    this.invalidate();
  }

  /** FieldMaterial.setRange for all. */
  setRange(low: number, high: number, scaleRange: [number, number], logarithmic: boolean): void {
    const text = [low, high, scaleRange, logarithmic].join();
    if (text === this.range) return; // it is called with every picture
    this.range = text;
    for (const mesh of this.meshes()) mesh.material.setRange(low, high, scaleRange, logarithmic);
    const {range, logarithmic: log} = this.surface.material.uniforms;
    this.volume.setRange(range!.value as [number, number], scaleRange, log!.value as boolean);
    this.invalidate();
  }

  setInsets(insets: Insets): void {
    const {left, right, top, bottom} = this.insets;
    if (
      left === insets.left &&
      right === insets.right &&
      top === insets.top &&
      bottom === insets.bottom
    )
      return; // resizing clears the canvas
    this.insets = insets;
    this.resize();
  }

  setFocus(focus: number[] | null): void {
    this.focus = focus;
  }

  // ---- camera

  /**
   * Shows a standard view, or (null) the first view of a mesh, as near as its bounding box allows.
   * Waits for a mesh if there is none.
   */
  look(direction: Direction | null): void {
    checkedDirection(direction);
    if (this.bounds.length === 0) {
      this.start = direction;
      return;
    }
    this.orbit.look(direction, () => this.framing());
    this.invalidate();
  }

  setParallel(parallel: boolean): void {
    if (parallel === this.orbit.parallel) return;
    this.orbit.parallel = parallel;
    this.invalidate();
  }

  get cameraState(): CameraState {
    return this.orbit.state;
  }
  /** Waits for a mesh if there is none. */
  set cameraState(state: CameraState) {
    checkedCamera(state);
    if (this.bounds.length === 0) this.start = state;
    else this.orbit.state = state;
    this.invalidate();
  }

  /** Turns the camera round its target, in radians. */
  turn(horizontal: number, vertical: number): void {
    this.orbit.orbit(horizontal, vertical);
    this.invalidate();
  }

  /** Moves the camera by shares of the picture's height: the mesh goes right and up. */
  pan(right: number, up: number): void {
    this.orbit.pan(right, up);
    this.invalidate();
  }

  /** Moves the camera so that this lattice point is in the middle of the free area. */
  centre([x, y, z]: Vector): void {
    const {position, scale} = this.lattice;
    this.orbit.aimAt(new Vector3(x, y, z).multiply(scale).add(position));
    this.invalidate();
  }

  /** Moves the camera: below 1 nearer, above 1 farther. */
  zoom(factor: number): void {
    this.orbit.zoom(factor);
    this.invalidate();
  }

  /** The pose of now, drawn or not. */
  get pose(): Pose {
    const {camera, fitted} = this.orbit;
    camera.updateMatrixWorld();
    this.lattice.updateMatrixWorld();
    const toCanvas = new Matrix4().multiplyMatrices(
      camera.projectionMatrix,
      camera.matrixWorldInverse,
    );
    // A point is in sight if normal . (scale p + position) + constant >= 0.
    const scale = this.lattice.scale.x;
    const frustum =
      fitted || this.bounds.length === 0
        ? []
        : new Frustum().setFromProjectionMatrix(toCanvas).planes.map(({normal, constant}) => ({
            normal: normal.toArray(),
            offset: -(constant + normal.dot(this.lattice.position)) / scale,
          }));
    toCanvas.multiply(this.lattice.matrixWorld);
    const {x, y, z, w} = camera.quaternion;
    return {
      toCanvas: toCanvas.toArray(),
      fromCanvas: toCanvas.clone().invert().toArray(),
      rotation: {x, y, z, w},
      camera: this.orbit.state,
      fitted,
      direction: camera.getWorldDirection(new Vector3()).toArray(),
      frustum,
      frameMs: this.frameMs,
    };
  }

  rayAt(x: number, y: number): Ray {
    return rayAt(this.pose, this.canvas, x, y);
  }
  project(point: Vector): {x: number; y: number} {
    return project(this.pose, this.canvas, point);
  }

  /** The current picture on `background` (a CSS colour). */
  async picture(background: string): Promise<Blob> {
    if (this.volume.hasCells && this.bounds.length > 0)
      await this.volume.drawWhole(this.volumePicture);
    // Drawing and copying share a task: a canvas that has been shown is empty.
    if (this.volume.hasCells) this.volume.present(this.renderer);
    else this.draw();
    const copy = new OffscreenCanvas(this.surfaceCanvas.width, this.surfaceCanvas.height);
    const context = copy.getContext('2d')!;
    context.fillStyle = background;
    context.fillRect(0, 0, copy.width, copy.height);
    context.drawImage(this.surfaceCanvas, 0, 0);
    return copy.convertToBlob({type: 'image/png'});
  }

  dispose(): void {
    cancelAnimationFrame(this.frame);
    this.endWatch();
    this.surfaceCanvas.removeEventListener('webglcontextlost', this.onLost);
    this.surfaceCanvas.removeEventListener('webglcontextrestored', this.onRestored);
    this.orbit.dispose();
    for (const mesh of this.meshes()) mesh.dispose();
    this.volume.dispose();
    this.renderer.dispose();
  }

  // ---- helpers

  private readonly onLost = (event: Event): void => {
    event.preventDefault(); // otherwise it never comes back
    this.listeners.lost?.(true);
  };
  private readonly onRestored = (): void => {
    this.listeners.lost?.(false);
    this.invalidate();
  };

  private meshes(): SoupMesh[] {
    return [this.surface, ...this.layers.map(({mesh}) => mesh), ...this.cuts];
  }

  private placeLattice(): void {
    const low = new Vector3(...(this.bounds.slice(0, 3) as Vector));
    const high = new Vector3(...(this.bounds.slice(3, 6) as Vector));
    const scale = 2 / Math.max(low.distanceTo(high), 1);
    this.lattice.scale.setScalar(scale);
    this.lattice.position.copy(low.add(high)).multiplyScalar(-0.5 * scale);
  }

  /** Frames the mesh itself, not its box: a box leaves its corners empty. */
  private framing(): Framing {
    const whole = this.framed(this.outline);
    if (!this.focus || this.orbit.isStandard) return whole;
    const near = this.framed(cornersOf(this.focus));
    // From inside of the mesh one would see nothing but its walls.
    return this.orbit.eyeOf(near).length() > kOutside ? near : whole;
  }

  private framed(corners: Vector[]): Framing {
    const {position, scale} = this.lattice;
    const points = corners.map(([x, y, z]) => new Vector3(x, y, z).multiply(scale).add(position));
    const {left, right, top, bottom} = this.insets;
    return this.orbit.framing(points, 1 - left - right, 1 - top - bottom);
  }

  private resize(): void {
    const width = Math.max(this.canvas.clientWidth, 1);
    const height = Math.max(this.canvas.clientHeight, 1);
    const ratio = Math.min(pixelRatioOf(this.canvas), kMaxPixelRatio);
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    for (const mesh of this.meshes()) mesh.material.setPixelRatio(ratio);
    const {camera} = this.orbit;
    camera.aspect = width / height;
    // Shifts the picture's centre into the middle of the free area.
    const right = ((this.insets.right - this.insets.left) / 2) * width;
    const down = ((this.insets.bottom - this.insets.top) / 2) * height;
    camera.setViewOffset(width, height, right, down, width, height);
    if (this.orbit.fitted && this.bounds.length > 0) this.orbit.fit(() => this.framing());
    // Draws at once: a resized canvas is empty until it is drawn.
    if (!this.volume.hasCells) return this.draw();
    this.volume.present(this.renderer);
    this.invalidate();
  }

  /** `moved`: the user did it and should see something at once. */
  private invalidate(moved = true): void {
    if (moved) this.volume.interrupt();
    this.moved ||= moved;
    // The graphics draw one picture at a time. The next begins after it, from the state of then.
    if (this.volume.busy) this.volume.waiting = true;
    else if (this.frame === 0) this.frame = requestAnimationFrame(() => this.draw());
  }

  /** The volume's picture. */
  private get volumePicture(): Picture {
    this.orbit.setDepths();
    const {toCanvas, fromCanvas} = this.pose;
    const {
      renderer,
      scene,
      orbit: {camera},
      lattice: {position, scale},
    } = this;
    return {
      renderer,
      scene,
      camera,
      toCanvas,
      fromCanvas,
      eye: camera.position.clone().sub(position).divide(scale).toArray(),
      diagonal: 2 / scale.x,
    };
  }

  /** Returns null and reports an error if the cells do not fit into the graphics' textures. */
  private fitting(cells: VolumeCells | null): VolumeCells | null {
    const maxSize = this.renderer.capabilities.maxTextureSize;
    if (!cells || maxRows(cells) <= maxSize) return cells;
    reportError(
      new Error(
        `the graphics take no volume of more than ${((maxSize * kRow) / 4e6).toFixed(1)} million ` +
          'cells; set Refine to fewer',
      ),
    );
    return null;
  }

  private draw(): void {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    if (this.volume.busy) return void (this.volume.waiting = true);
    const start = performance.now();
    const done = this.afterFrame;
    this.afterFrame = [];
    // Graphics without a GPU draw long after the call. Failures are reported, too, or a caller
    // would wait for ever.
    const tell = (ms: number): void => done.forEach((drawn) => drawn(ms));
    try {
      this.orbit.setDepths();
      if (this.volume.hasCells && this.bounds.length > 0)
        this.volume.draw(this.volumePicture, this.moved);
      else this.renderer.render(this.scene, this.orbit.camera);
      this.moved = false;
      this.frameMs = performance.now() - start;
      this.listeners.drawn?.(this.pose);
    } finally {
      if (done.length > 0)
        void whenDrawn(this.renderer.getContext() as WebGL2RenderingContext, start).then(tell);
    }
  }
}
