// A canvas that shows a progressive mesh: surface, cuts and isosurfaces. Draws only when something changed.

import {Frustum, Group, Matrix4, Quaternion, Raycaster, Scene, Vector2, Vector3, WebGLRenderer} from 'three';
import type {Ray, Vector} from '../core/cell_ray';
import type {ColorMapName} from '../core/color_maps';
import {kMostPlanes} from '../core/display';
import {transferTables} from '../core/transfer';
import type {CellOrder, VolumeCells} from '../core/volume';
import type {Plane} from '../core/slice';
import type {Snapshot} from '../core/worker_messages';
import {OrbitCamera, type CameraState} from './camera';
import type {Direction} from './directions';
import {DeepTarget} from './deep_target';
import {FrameBudget} from './frame_budget';
import {SoupMesh} from './soup_mesh';
import {VolumeMesh} from './volume_mesh';

/** How dark cell edges are: enough to follow, not enough to change what a colour says. */
const kEdgeStrength = 0.52;
/** How much time a costly picture gets. */
type Pace = 'moving' | 'resting' | 'whole';
/** A picture is at rest so long after its last change. */
const kRestMs = 150;
/** Pixels beyond two a point cost more than they show. */
const kMostPixelRatio = 2;

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

/** `drawn`: after each frame, with the camera's rotation. `lost`: the browser took the graphics away, or gave them back. */
export interface ViewListeners {
  drawn?(rotation: Quaternion): void;
  lost?(lost: boolean): void;
  /** Client.order: without it no volume is shown. */
  order?(eye: Vector): Promise<CellOrder>;
}

export class MeshView {
  readonly orbit: OrbitCamera;
  /** What the last frame took on this thread. */
  frameMs = 0;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  /** From lattice coordinates to a ball of radius 1 round the origin. */
  private readonly lattice = new Group();
  private readonly surface = new SoupMesh(true);
  private readonly isosurface = new SoupMesh(true, true);
  private readonly cuts = Array.from({length: kMostPlanes}, () => new SoupMesh(false));
  private readonly volume = new VolumeMesh();
  private readonly deep = new DeepTarget();
  private readonly budget = new FrameBudget();
  /** Until a picture of few pixels is drawn again with all. */
  private restTimer: ReturnType<typeof setTimeout> | undefined;
  private waiting = false;
  private cells: VolumeCells | null = null;
  /** Where the cells were last sorted for; null: an order is under way or none is needed. */
  private sortedFor: string | null = '';
  private transfer = '';
  private readonly resizes: ResizeObserver;
  private bounds: number[] = [];
  private insets: Insets = {left: 0, right: 0, top: 0, bottom: 0};
  private startState: CameraState | null = null;
  private frame = 0;
  private afterFrame: (() => void)[] = [];

  /** Throws when the browser has no WebGL 2. */
  constructor(readonly canvas: HTMLCanvasElement, private readonly listeners: ViewListeners = {}) {
    this.renderer = new WebGLRenderer({canvas, antialias: true, alpha: true, powerPreference: 'high-performance'});
    this.renderer.setClearColor(0, 0);
    this.orbit = new OrbitCamera(canvas, () => this.invalidate());
    this.lattice.add(this.surface, this.isosurface, ...this.cuts, this.volume);
    this.scene.add(this.lattice);
    canvas.addEventListener('webglcontextlost', this.onLost);
    canvas.addEventListener('webglcontextrestored', this.onRestored);
    this.resizes = new ResizeObserver(() => this.resize());
    this.resizes.observe(canvas);
    this.resize();
  }

  /** Shows the picture; `drawn` is called after the frame that holds it. */
  show(snapshot: Snapshot, drawn: () => void): void {
    if (snapshot.surface) this.surface.show(snapshot.surface);
    if (snapshot.isosurface) this.isosurface.show(snapshot.isosurface);
    for (const mesh of [this.surface, this.isosurface]) mesh.material.setClip(snapshot.planes);
    if (snapshot.volume !== undefined) this.takeCells(snapshot.volume);
    this.volume.setClip(snapshot.planes);
    this.cuts.forEach((mesh, i) => {
      // A cap would hide the volume behind it; a slice stands in it.
      mesh.show(this.cells && snapshot.planes.length > 0 ? null : snapshot.cuts[i] ?? null);
      mesh.material.setClip(snapshot.planes.filter((_, k) => k !== i));
    });
    if (this.bounds.length === 0 && snapshot.bounds.length > 0) {
      this.bounds = snapshot.bounds;
      this.placeLattice();
      if (this.startState) this.orbit.state = this.startState;
      else this.look(null);
      this.startState = null;
    }
    this.afterFrame.push(drawn);
    this.invalidate();
  }

  /** Forgets the mesh; the next one is fitted anew. */
  clear(): void {
    this.bounds = [];
    for (const mesh of this.meshes()) mesh.show(null);
    this.takeCells(null);
    this.invalidate();
  }

  setLook({map, reversed, edges, opacity, volume}: Look): void {
    for (const mesh of this.meshes()) {
      mesh.material.setColorMap(map, reversed);
      // An isosurface's polygons are the cells' sections, not the mesh: their edges would hide its shape.
      mesh.material.setEdges(edges && mesh !== this.isosurface ? kEdgeStrength : 0);
    }
    this.surface.material.setOpacity(opacity);
    const transfer = volume ? `${map} ${reversed} ${volume.join()}` : '';
    if (volume && transfer !== this.transfer) this.volume.setTransfer(transferTables(volume, map, reversed));
    this.transfer = transfer;
    this.invalidate();
  }

  /** FieldMaterial.setRange for all. */
  setRange(low: number, high: number, scaleRange: [number, number], logarithmic: boolean): void {
    for (const mesh of this.meshes()) mesh.material.setRange(low, high, scaleRange, logarithmic);
    const {range, logarithmic: log} = this.surface.material.uniforms;
    this.volume.setRange(range!.value as [number, number], scaleRange, log!.value as boolean);
    this.invalidate();
  }

  setInsets(insets: Insets): void {
    const {left, right, top, bottom} = this.insets;
    if (left === insets.left && right === insets.right && top === insets.top && bottom === insets.bottom) return;  // resizing empties the canvas
    this.insets = insets;
    this.resize();
  }

  // ---- camera

  /** A standard view, or the one that a mesh is first seen in (null): as near as its bounding box allows. */
  look(direction: Direction | null): void {
    if (this.bounds.length === 0) return;
    this.orbit.look(direction, () => this.fittingDistance());
    this.invalidate();
  }

  setParallel(parallel: boolean): void {
    this.orbit.parallel = parallel;
    this.invalidate();
  }

  get cameraState(): CameraState { return this.orbit.state; }
  /** Before there is a mesh it waits for one. */
  set cameraState(state: CameraState) {
    if (this.bounds.length === 0) this.startState = state;
    else this.orbit.state = state;
    this.invalidate();
  }

  /** Turns the camera round its target, in radians. */
  turn(horizontal: number, vertical: number): void {
    this.orbit.orbit(horizontal, vertical);
    this.invalidate();
  }

  /** Moves the camera: below 1 nearer, above 1 farther. */
  zoom(factor: number): void {
    this.orbit.zoom(factor);
    this.invalidate();
  }

  /** Where the camera looks, as a unit normal in lattice coordinates. */
  get viewDirection(): Vector { return this.orbit.camera.getWorldDirection(new Vector3()).toArray(); }

  /** What is in sight, as planes in lattice coordinates with the inside above; none while all of the mesh is fitted into the picture. */
  get frustum(): Plane[] {
    if (this.orbit.fitted || this.bounds.length === 0) return [];
    const {camera} = this.orbit;
    camera.updateMatrixWorld();
    const seen = new Frustum().setFromProjectionMatrix(new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));
    const scale = this.lattice.scale.x;
    // normal . (scale p + position) + constant >= 0
    return seen.planes.map(({normal, constant}) => ({normal: normal.toArray(), offset: -(constant + normal.dot(this.lattice.position)) / scale}));
  }

  // ---- between the picture and the lattice

  /** The line of sight through a point of the canvas, in CSS pixels from its corner. */
  rayAt(x: number, y: number): Ray {
    const pointer = new Vector2((2 * x) / this.canvas.clientWidth - 1, 1 - (2 * y) / this.canvas.clientHeight);
    const caster = new Raycaster();
    caster.setFromCamera(pointer, this.orbit.camera);
    const scale = this.lattice.scale.x;
    const origin = caster.ray.origin.sub(this.lattice.position).divideScalar(scale);
    return {origin: origin.toArray(), direction: caster.ray.direction.toArray()};
  }

  /** Where a point of the lattice is on the canvas, in CSS pixels. */
  project(point: Vector): {x: number; y: number} {
    const {x, y} = new Vector3(...point).multiply(this.lattice.scale).add(this.lattice.position).project(this.orbit.camera);
    return {x: (x + 1) / 2 * this.canvas.clientWidth, y: (1 - y) / 2 * this.canvas.clientHeight};
  }

  /** The picture as it stands, on `background` (CSS colour). */
  async picture(background: string): Promise<Blob> {
    this.draw('whole');
    const copy = new OffscreenCanvas(this.canvas.width, this.canvas.height);
    const context = copy.getContext('2d')!;
    context.fillStyle = background;
    context.fillRect(0, 0, copy.width, copy.height);
    context.drawImage(this.canvas, 0, 0);
    return copy.convertToBlob({type: 'image/png'});
  }

  dispose(): void {
    cancelAnimationFrame(this.frame);
    clearTimeout(this.restTimer);
    this.resizes.disconnect();
    this.canvas.removeEventListener('webglcontextlost', this.onLost);
    this.canvas.removeEventListener('webglcontextrestored', this.onRestored);
    this.orbit.dispose();
    for (const mesh of this.meshes()) mesh.dispose();
    this.volume.dispose();
    this.deep.dispose();
    this.renderer.dispose();
  }

  // ---- helpers

  private readonly onLost = (event: Event): void => {
    event.preventDefault();  // else it never comes back
    this.listeners.lost?.(true);
  };
  private readonly onRestored = (): void => {
    this.listeners.lost?.(false);
    this.invalidate();
  };

  private meshes(): SoupMesh[] { return [this.surface, this.isosurface, ...this.cuts]; }

  private takeCells(cells: VolumeCells | null): void {
    this.cells = cells;
    if (cells) this.sortedFor = '';
    else this.volume.show(null, new Uint32Array(0));
    this.invalidate();
  }

  /** Asks for the cells' order as the camera stands; the last one serves until it comes. */
  private sort(): void {
    if (!this.cells || !this.listeners.order || this.bounds.length === 0) return;
    const eye = this.orbit.camera.position.clone().sub(this.lattice.position).divide(this.lattice.scale);
    const low = new Vector3(...this.bounds.slice(0, 3) as Vector);
    this.volume.setEye(eye, low.distanceTo(new Vector3(...this.bounds.slice(3, 6) as Vector)));
    const where = eye.toArray().map((x) => Math.round(x)).join();
    if (this.sortedFor === null || this.sortedFor === where) return;
    this.sortedFor = null;
    this.listeners.order(eye.toArray()).then(({version, order}) => {
      const fits = this.cells?.version === version;
      this.sortedFor = fits ? where : '';
      if (fits) this.volume.show(this.cells, order);
      this.invalidate();
    }, () => void (this.sortedFor = where));
  }

  private placeLattice(): void {
    const low = new Vector3(...this.bounds.slice(0, 3) as Vector);
    const high = new Vector3(...this.bounds.slice(3, 6) as Vector);
    const scale = 2 / Math.max(low.distanceTo(high), 1);
    this.lattice.scale.setScalar(scale);
    this.lattice.position.copy(low.add(high)).multiplyScalar(-0.5 * scale);
  }

  private fittingDistance(): number {
    const corners = Array.from({length: 8}, (_, i) =>
      new Vector3(this.bounds[i & 1 ? 3 : 0], this.bounds[i & 2 ? 4 : 1], this.bounds[i & 4 ? 5 : 2]).multiply(this.lattice.scale).add(this.lattice.position));
    return this.orbit.fittingDistance(corners, 1 - this.insets.left - this.insets.right, 1 - this.insets.top - this.insets.bottom);
  }

  private resize(): void {
    const width = Math.max(this.canvas.clientWidth, 1);
    const height = Math.max(this.canvas.clientHeight, 1);
    const ratio = Math.min(window.devicePixelRatio, kMostPixelRatio);
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    for (const mesh of this.meshes()) mesh.material.setPixelRatio(ratio);
    const {camera} = this.orbit;
    camera.aspect = width / height;
    // Shifts the picture's centre into the middle of what the panels leave free.
    const right = (this.insets.right - this.insets.left) / 2 * width;
    const down = (this.insets.bottom - this.insets.top) / 2 * height;
    camera.setViewOffset(width, height, right, down, width, height);
    if (this.orbit.fitted && this.bounds.length > 0) this.orbit.fit(() => this.fittingDistance());
    this.draw();  // at once: a resized canvas is empty until it is drawn
  }

  /** The volume, as fine as there is time for: coarse while something changes, then once more at rest. */
  private drawDeep(pace: Pace): void {
    const share = pace === 'whole' ? 1 : this.budget.share(pace === 'moving');
    this.deep.render(this.renderer, this.scene, this.orbit.camera, share);
    this.budget.measure(this.renderer.getContext() as WebGL2RenderingContext, share, () => {
      if (this.waiting) this.invalidate();
      else if (pace === 'moving' && share < 1) this.restTimer = setTimeout(() => this.draw('resting'), kRestMs);
    });
  }

  private invalidate(): void {
    clearTimeout(this.restTimer);
    this.waiting = true;
    // The graphics have one picture in hand at a time; when it is done, the next comes as things stand then.
    if (this.frame === 0 && !this.budget.busy) this.frame = requestAnimationFrame(() => this.draw());
  }

  private draw(pace: Pace = 'moving'): void {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    this.waiting = false;
    const start = performance.now();
    this.orbit.setDepths();
    this.sort();
    if (this.volume.visible) this.drawDeep(pace);
    else this.renderer.render(this.scene, this.orbit.camera);
    this.frameMs = performance.now() - start;
    this.listeners.drawn?.(this.orbit.camera.quaternion);
    const done = this.afterFrame;
    this.afterFrame = [];
    for (const drawn of done) drawn();
  }
}
