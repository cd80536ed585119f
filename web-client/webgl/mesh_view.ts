// A canvas that shows a progressive mesh: surface, cuts and layers. It draws only after
// changes.

import type {LatticeChange, Vector} from '../core/protocol/geometry';
import type {Ray} from '../core/picture/cell_ray';
import type {Snapshot} from '../core/session/worker_messages';
import type {Picture} from './cell_drawer';
import type {CameraState, OrbitCamera} from './camera';
import type {Direction} from './directions';
import {FrameBudget, whenDrawn} from './frame_budget';
import {Graphics} from './gl/graphics';
import type {Target} from './gl/target';
import type {Lens} from './lens';
import {MeshCamera} from './mesh_camera';
import {MeshParts} from './mesh_parts';
import {project, rayAt, type Pose} from './pose';
import {partsOf, tileOf} from './tiles';
import type {Boxed, Frame, Insets, Look, Rendered, Tile, View, ViewListeners} from './view';
import type {VolumeLook, VolumeView} from './volume_view';
import {pixelRatioOf, surfaceOf, watchSize, type ViewCanvas} from './worker_canvas';

/** More than two pixels a point cost more than they show. */
const kMaxPixelRatio = 2;

export class MeshView implements View {
  private readonly graphics: Graphics;
  private readonly parts: MeshParts;
  private readonly camera: MeshCamera;
  /** It is loaded with the first cells. */
  private volume: VolumeView | null = null;
  private readonly volumeLook: VolumeLook = {transfer: null, range: null};
  private readonly surfaceCanvas: HTMLCanvasElement | OffscreenCanvas;
  private readonly endWatch: () => void;
  /** The last words of setLook and setRange as texts, and what isMerelyFiner has seen. */
  private readonly last = {look: '', range: '', quantity: '', cells: 0};
  /** The user has changed something since the last picture; new levels alone do not count. */
  private moved = false;
  /** The requested frame; 0: none is. */
  private frame = 0;
  private frameMs = 0;
  private pixelRatio = 1;
  /** 0: nothing plays. */
  private playsEveryMs = 0;
  /** The pictures without a volume learn and use it. */
  private readonly budget = new FrameBudget();
  private afterFrame: ((ms: number) => void)[] = [];
  /** Settled when the picture in tiles is drawn; null: there is none. */
  private inTiles: Promise<void> | null = null;

  /** Throws when the browser has no WebGL 2. */
  constructor(
    readonly canvas: ViewCanvas,
    private readonly listeners: ViewListeners = {},
  ) {
    this.surfaceCanvas = surfaceOf(canvas);
    this.graphics = new Graphics(this.surfaceCanvas);
    this.parts = new MeshParts(this.graphics);
    this.camera = new MeshCamera(canvas, () => this.invalidate());
    this.surfaceCanvas.addEventListener('webglcontextlost', this.onLost);
    this.surfaceCanvas.addEventListener('webglcontextrestored', this.onRestored);
    this.endWatch = watchSize(canvas, () => this.resize());
    this.resize();
  }

  /** Makes the graphics' programs before there is a mesh: that takes as long as many pictures. */
  warmUp(): void {
    this.parts.warmUp();
    this.draw();
    this.parts.clear();
    this.invalidate(false);
  }

  /** As View.show. */
  show(snapshot: Snapshot, drawn: (ms: number) => void, change: LatticeChange | null = null): void {
    // A picture in tiles shows one mesh.
    if (this.inTiles) return void this.inTiles.finally(() => this.show(snapshot, drawn, change));
    if (snapshot.volume && !this.volume)
      return void this.loadVolume().then((loaded) =>
        this.show(loaded ? snapshot : {...snapshot, volume: null}, drawn, change),
      );
    if (change) {
      this.parts.clear(); // the picture may lack what the last one had
      this.camera.changeLattice(change);
    }
    this.afterFrame.push(drawn);
    // While a series plays, each instant has its turn: the next one would interrupt it.
    const isAwaited = this.isMerelyFiner(snapshot) || this.playsEveryMs > 0;
    this.invalidate(snapshot.volume == null || !isAwaited);
    if (snapshot.volume !== undefined) this.volume?.take(snapshot.volume);
    this.volume?.setClip(snapshot.planes);
    // A cap would hide the volume behind it. A slice is drawn inside it.
    this.parts.show(snapshot, !this.hasVolume || snapshot.planes.length === 0);
    if (snapshot.bounds.length > 0) this.camera.growTo(snapshot);
  }

  /** Forgets the mesh; the next one is fitted again. */
  clear(): void {
    this.camera.clear();
    this.parts.clear();
    this.volume?.take(null);
    this.invalidate();
  }

  setLook(next: Look): void {
    const {map, reversed, edges, creases, opacity, beyond, volume, onDark} = next;
    const look = JSON.stringify([map, reversed, edges, creases, opacity, beyond, volume, onDark]);
    // it is called with every attribute change, and a picture costs more than a comparison
    if (look === this.last.look) return;
    this.parts.setLook(next);
    if (volume) this.volumeLook.transfer = [volume, map, reversed, onDark];
    this.volume?.setLook(this.volumeLook);
    this.last.look = look;
    this.invalidate();
  }

  /** FieldMaterial.setRange for all. */
  setRange(low: number, high: number, scaleRange: [number, number], logarithmic: boolean): void {
    const text = [low, high, scaleRange, logarithmic].join();
    if (text === this.last.range) return; // it is called with every picture
    this.last.range = text;
    const range = this.parts.setRange(low, high, scaleRange, logarithmic);
    this.volumeLook.range = [range, scaleRange, logarithmic];
    this.volume?.setLook(this.volumeLook);
    this.invalidate();
  }

  setInsets(insets: Insets): void {
    if (this.camera.setRoom({insets})) this.resize(); // which clears the canvas
  }

  setCovered(insets: Insets | null): void {
    if (this.camera.setRoom({covered: insets})) this.resize();
  }

  setBoxed(boxed: Boxed | null): void {
    if (this.camera.setRoom({boxed})) this.resize();
  }

  setFocus(focus: number[] | null): void {
    this.camera.focus = focus;
  }

  // ---- camera

  get orbit(): OrbitCamera {
    return this.camera.orbit;
  }

  /** As MeshCamera.look. */
  look(direction: Direction | null): void {
    this.camera.look(direction);
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
    this.camera.moveTo(state);
  }

  setPlaying(everyMs: number): void {
    if (everyMs === this.playsEveryMs) return;
    this.playsEveryMs = everyMs;
    if (everyMs === 0 && !this.hasVolume) this.invalidate();
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

  /** As MeshCamera.centre. */
  centre(point: Vector): void {
    this.camera.centre(point);
  }

  /** Moves the camera: below 1 nearer, above 1 farther. */
  zoom(factor: number): void {
    this.orbit.zoom(factor);
    this.invalidate();
  }

  get renderer(): string {
    return this.graphics.renderer;
  }

  /** The pose of now, drawn or not. */
  get pose(): Pose {
    return this.camera.pose(this.frameMs);
  }

  rayAt(x: number, y: number): Ray {
    return rayAt(this.pose, this.canvas, x, y);
  }
  project(point: Vector): {x: number; y: number} {
    return project(this.pose, this.canvas, point);
  }

  // ---- pictures

  /** The current picture on `background` (a CSS colour). */
  async picture(background: string): Promise<Blob> {
    const {camera} = this;
    if (this.drawsVolume) await this.volume!.drawWhole(this.pictureOf(camera.uncovered()));
    // Drawing and copying share a task: a canvas that has been shown is empty.
    if (this.hasVolume) this.volume!.present();
    else {
      this.draw(1);
      if (camera.isCovered) this.drawSurface(camera.uncovered());
    }
    const copy = new OffscreenCanvas(this.surfaceCanvas.width, this.surfaceCanvas.height);
    const context = copy.getContext('2d')!;
    context.fillStyle = background;
    context.fillRect(0, 0, copy.width, copy.height);
    context.drawImage(this.surfaceCanvas, 0, 0);
    if (camera.isCovered) this.resize();
    return copy.convertToBlob({type: 'image/png'});
  }

  async render(frame: Frame): Promise<Rendered> {
    while (this.inTiles) await this.inTiles;
    if (!this.camera.hasMesh) return {tiles: [], toCanvas: this.pose.toCanvas};
    const picture = this.drawTiles(frame);
    this.inTiles = picture.then(
      () => undefined,
      () => undefined,
    );
    void this.inTiles.then(() => {
      this.inTiles = null;
      this.invalidate(false);
    });
    return picture;
  }

  dispose(): void {
    cancelAnimationFrame(this.frame);
    this.endWatch();
    this.surfaceCanvas.removeEventListener('webglcontextlost', this.onLost);
    this.surfaceCanvas.removeEventListener('webglcontextrestored', this.onRestored);
    this.camera.dispose();
    this.parts.dispose();
    this.volume?.dispose();
  }

  // ---- helpers

  private readonly onLost = (event: Event): void => {
    event.preventDefault(); // otherwise it never comes back
    this.listeners.lost?.(true);
  };
  private readonly onRestored = (): void => {
    this.graphics.restored();
    this.listeners.lost?.(false);
    this.invalidate();
  };

  private resize(): void {
    const width = Math.max(this.canvas.clientWidth, 1);
    const height = Math.max(this.canvas.clientHeight, 1);
    this.usePixels(1);
    this.camera.resize(width, height);
    // Draws at once: a resized canvas is empty until it is drawn.
    if (!this.hasVolume) return this.draw();
    this.volume!.present();
    this.invalidate();
  }

  /** Gives the surface this share of the canvas's pixels, each way. */
  private usePixels(share: number): void {
    const {canvas, surfaceCanvas} = this;
    const ratio = Math.min(pixelRatioOf(canvas), kMaxPixelRatio) * share;
    const width = Math.floor(Math.max(canvas.clientWidth, 1) * ratio) || 1;
    const height = Math.floor(Math.max(canvas.clientHeight, 1) * ratio) || 1;
    this.pixelRatio = ratio;
    this.parts.setPixelRatio(ratio);
    // Setting a size clears the canvas, even if it is the same.
    if (surfaceCanvas.width !== width || surfaceCanvas.height !== height)
      Object.assign(surfaceCanvas, {width, height});
  }

  /** `moved`: the user did it and should see something at once. */
  private invalidate(moved = true): void {
    if (moved) this.volume?.interrupt();
    this.moved ||= moved;
    // The graphics draw one picture at a time. The next begins after it, from the state of then.
    if (this.volume?.busy) this.volume.waiting = true;
    else if (this.frame === 0) this.frame = requestAnimationFrame(() => this.draw());
  }

  /** The volume of before with another count of cells. REQUIRES: called once for each picture. */
  private isMerelyFiner({color, statistics, warp}: Snapshot): boolean {
    const before = {...this.last};
    this.last.quantity = JSON.stringify([color, warp?.scale]);
    this.last.cells = statistics.tetrahedra;
    const isSame = before.quantity === this.last.quantity;
    return this.hasVolume && isSame && before.cells !== this.last.cells;
  }

  private get hasVolume(): boolean {
    return this.volume?.hasCells ?? false;
  }
  private get drawsVolume(): boolean {
    return this.hasVolume && this.camera.hasMesh;
  }

  /** By default the canvas's. */
  private pictureOf(lens: Lens = this.orbit.lens, target: Target | null = null): Picture {
    this.orbit.setDepths(lens);
    const {parts, camera} = this;
    return {parts, eyeOfParts: camera.eyeOf(lens), target, ...camera.sightOf(lens)};
  }

  private async drawTiles(frame: Frame): Promise<Rendered> {
    const tiles: Tile[] = [];
    const {width, height, pixelRatio} = frame;
    const whole = this.camera.lensFor(frame, {x: 0, y: 0, width, height});
    this.orbit.setDepths(whole);
    const {toCanvas} = this.camera.sightOf(whole);
    this.parts.fadeLines(toCanvas, {
      clientWidth: width / pixelRatio,
      clientHeight: height / pixelRatio,
    });
    for (const part of partsOf(frame)) {
      const lens = this.camera.lensFor(frame, part);
      tiles.push(await tileOf(this.graphics, part, (target) => this.drawTile(lens, target, frame)));
    }
    return {tiles, toCanvas};
  }

  private async drawTile(lens: Lens, target: Target, frame: Frame): Promise<void> {
    const {parts} = this;
    parts.setPixelRatio(frame.pixelRatio);
    parts.groundOfFrame = {onDark: frame.onDark ?? false};
    if (this.drawsVolume) await this.volume!.drawWhole(this.pictureOf(lens, target));
    else {
      target.begin();
      target.clear();
      parts.draw(this.camera.eyeOf(lens));
    }
    parts.setPixelRatio(this.pixelRatio);
    parts.groundOfFrame = null;
  }

  /** Returns false and reports the error if the network fails. */
  private async loadVolume(): Promise<boolean> {
    const {graphics, listeners} = this;
    const loaded = await import('./volume_view').catch(reportError);
    if (!loaded) return false;
    this.volume ??= new loaded.VolumeView(
      graphics,
      (moved) => this.invalidate(moved),
      listeners.coarse?.bind(listeners),
      (working) => listeners.works?.(working),
    );
    this.volume.setLook(this.volumeLook);
    return true;
  }

  /** The share of the canvas's pixels that a picture of now gets, each way. */
  private get share(): number {
    const isPlaying = this.playsEveryMs > 0 && !this.hasVolume;
    return isPlaying ? this.budget.steadyShare(this.playsEveryMs) : 1;
  }

  private draw(share = this.share): void {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    if (this.volume?.busy) return void (this.volume.waiting = true);
    this.usePixels(share);
    const start = performance.now();
    const done = this.afterFrame;
    this.afterFrame = [];
    // Graphics without a GPU draw long after the call. Failures are reported, too, or a caller
    // would wait for ever.
    const tell = (ms: number): void => {
      if (!this.hasVolume) this.budget.learn(share, ms);
      done.forEach((drawn) => drawn(ms));
    };
    try {
      if (this.drawsVolume) {
        this.fadeLines(this.orbit.lens);
        this.volume!.draw(this.pictureOf(), this.moved);
      } else this.drawSurface(this.orbit.lens);
      this.moved = false;
      this.frameMs = performance.now() - start;
      this.listeners.drawn?.(this.pose);
    } finally {
      if (done.length > 0) void whenDrawn(this.graphics.gl, start).then(tell);
    }
  }

  private fadeLines(lens: Lens): void {
    this.orbit.setDepths(lens);
    this.parts.fadeLines(this.camera.sightOf(lens).toCanvas, this.canvas);
  }

  private drawSurface(lens: Lens): void {
    this.fadeLines(lens);
    const {gl} = this.graphics;
    this.graphics.beginCanvas();
    this.graphics.use({depths: 'written'});
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.parts.draw(this.camera.eyeOf(lens));
  }
}
