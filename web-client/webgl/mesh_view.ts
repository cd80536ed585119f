// A canvas that shows a progressive mesh: surface, cuts and layers.

import type {LatticeChange, Vector} from '../core/protocol/geometry';
import type {Ray} from '../core/picture/cell_ray';
import type {Snapshot} from '../core/session/worker_messages';
import type {CameraState} from './camera';
import type {Direction} from './directions';
import {Frames} from './frames';
import {Graphics} from './gl/graphics';
import {MeshCamera} from './mesh_camera';
import {project, rayAt, type Pose} from './pose';
import {Scene} from './scene';
import type {Boxed, Frame, Insets, Look, Rendered, View, ViewListeners} from './view';
import {surfaceOf, usePixels, watchSize, type ViewCanvas} from './worker_canvas';

export class MeshView implements View {
  private readonly camera: MeshCamera;
  private readonly scene: Scene;
  private readonly frames: Frames;
  private readonly ended = new AbortController();
  /** Settled when the picture in tiles is drawn; null: there is none. */
  private inTiles: Promise<void> | null = null;

  /** Throws when the browser has no WebGL 2. */
  constructor(
    readonly canvas: ViewCanvas,
    listeners: ViewListeners = {},
  ) {
    const surface = surfaceOf(canvas);
    const {signal} = this.ended;
    const graphics = new Graphics(surface);
    this.camera = new MeshCamera(canvas, () => this.frames.invalidate());
    this.scene = new Scene(
      graphics,
      this.camera,
      (VolumeView) =>
        new VolumeView(
          graphics,
          (moved) => this.frames.invalidate(moved),
          listeners.coarse?.bind(listeners),
          (working) => listeners.works?.(working),
        ),
    );
    this.frames = new Frames(canvas, this.scene, () => listeners.drawn?.(this.pose));
    const lost = (event: Event): void => {
      event.preventDefault(); // otherwise it never comes back
      listeners.lost?.(true);
    };
    const restored = (): void => {
      graphics.restored();
      listeners.lost?.(false);
      this.frames.invalidate();
    };
    surface.addEventListener('webglcontextlost', lost, {signal});
    surface.addEventListener('webglcontextrestored', restored, {signal});
    signal.addEventListener(
      'abort',
      watchSize(canvas, () => this.resize()),
    );
    this.resize();
  }

  /** Makes the graphics' programs before there is a mesh: that takes as long as many pictures. */
  warmUp(): void {
    const {frames} = this;
    const {parts} = this.scene;
    parts.warmUp();
    frames.draw();
    parts.clear();
    frames.invalidate(false);
  }

  /** As View.show. */
  show(snapshot: Snapshot, drawn: (ms: number) => void, change: LatticeChange | null = null): void {
    const {frames, scene} = this;
    // A picture in tiles shows one mesh.
    if (this.inTiles) return void this.inTiles.finally(() => this.show(snapshot, drawn, change));
    const coming = scene.awaits(snapshot);
    if (coming) return void coming.then((its) => this.show(its, drawn, change));
    if (change) scene.changeLattice(change);
    frames.waiting.push(drawn);
    // While a series plays, each instant has its turn: the next one would interrupt it.
    const isAwaited = scene.isMerelyFiner(snapshot) || frames.everyMs > 0;
    frames.invalidate(snapshot.volume == null || !isAwaited);
    scene.show(snapshot);
  }

  /** Forgets the mesh; the next one is fitted again. */
  clear(): void {
    this.scene.clear();
    this.frames.invalidate();
  }

  setLook(next: Look): void {
    if (this.scene.setLook(next)) this.frames.invalidate();
  }

  /** FieldMaterial.setRange for all. */
  setRange(...words: Parameters<View['setRange']>): void {
    if (this.scene.setRange(...words)) this.frames.invalidate();
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

  /** As MeshCamera.look. */
  look(direction: Direction | null): void {
    this.camera.look(direction);
  }

  setParallel(parallel: boolean): void {
    const {orbit} = this.camera;
    if (parallel === orbit.parallel) return;
    orbit.parallel = parallel;
    this.frames.invalidate();
  }

  get cameraState(): CameraState {
    return this.camera.orbit.state;
  }
  /** Waits for a mesh if there is none. */
  set cameraState(state: CameraState) {
    this.camera.moveTo(state);
  }

  setPlaying(everyMs: number): void {
    this.frames.setPlaying(everyMs);
  }

  /** Turns the camera round its target, in radians. */
  turn(horizontal: number, vertical: number): void {
    this.camera.orbit.orbit(horizontal, vertical);
    this.frames.invalidate();
  }

  /** Moves the camera by shares of the picture's height: the mesh goes right and up. */
  pan(right: number, up: number): void {
    this.camera.orbit.pan(right, up);
    this.frames.invalidate();
  }

  /** As MeshCamera.centre. */
  centre(point: Vector): void {
    this.camera.centre(point);
  }

  /** Moves the camera: below 1 nearer, above 1 farther. */
  zoom(factor: number): void {
    this.camera.orbit.zoom(factor);
    this.frames.invalidate();
  }

  get renderer(): string {
    return this.scene.graphics.renderer;
  }

  /** The pose of now, drawn or not. */
  get pose(): Pose {
    return this.camera.pose(this.frames.ms);
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
    const {camera, scene} = this;
    const surface = surfaceOf(this.canvas);
    if (scene.drawsVolume) await scene.volume!.drawWhole(scene.pictureOf(camera.uncovered()));
    // Drawing and copying share a task: a canvas that has been shown is empty.
    if (scene.hasVolume) scene.volume!.present();
    else {
      this.frames.draw(1);
      if (camera.isCovered) scene.drawSurface(camera.uncovered(), this.canvas);
    }
    const copy = new OffscreenCanvas(surface.width, surface.height);
    const context = copy.getContext('2d')!;
    context.fillStyle = background;
    context.fillRect(0, 0, copy.width, copy.height);
    context.drawImage(surface, 0, 0);
    if (camera.isCovered) this.resize();
    return copy.convertToBlob({type: 'image/png'});
  }

  async render(frame: Frame): Promise<Rendered> {
    while (this.inTiles) await this.inTiles;
    if (!this.camera.hasMesh) return {tiles: [], toCanvas: this.pose.toCanvas};
    const picture = this.scene.render(frame);
    const ended = (): void => {
      this.inTiles = null;
      this.frames.invalidate(false);
    };
    this.inTiles = picture.then(ended, ended);
    return picture;
  }

  dispose(): void {
    this.frames.end();
    this.ended.abort();
    this.scene.dispose();
  }

  private resize(): void {
    const {camera, canvas, frames, scene} = this;
    scene.parts.setPixelRatio(usePixels(canvas, 1));
    camera.resize(Math.max(canvas.clientWidth, 1), Math.max(canvas.clientHeight, 1));
    // Draws at once: a resized canvas is empty until it is drawn.
    if (!scene.hasVolume) return frames.draw();
    scene.volume!.present();
    frames.invalidate();
  }
}
