// The mesh of a view: its parts, its volume, and the camera that sees them.

import type {LatticeChange} from '../core/protocol/geometry';
import type {Snapshot} from '../core/session/worker_messages';
import type {Picture} from './cell_drawer';
import type {Graphics} from './gl/graphics';
import type {Target} from './gl/target';
import type {Lens} from './lens';
import type {MeshCamera} from './mesh_camera';
import {MeshParts} from './mesh_parts';
import type {Size} from './pose';
import {partsOf, tileOf} from './tiles';
import type {Frame, Look, Rendered, Tile} from './view';
import type {VolumeLook, VolumeView} from './volume_view';

export class Scene {
  readonly parts: MeshParts;
  /** It is loaded with the first cells. */
  volume: VolumeView | null = null;
  private readonly volumeLook: VolumeLook = {transfer: null, range: null};
  /** The last words of setLook and setRange as texts, and what isMerelyFiner has seen. */
  private readonly last = {look: '', range: '', quantity: '', cells: 0};

  constructor(
    readonly graphics: Graphics,
    readonly camera: MeshCamera,
    private readonly newVolume: (its: typeof VolumeView) => VolumeView,
  ) {
    this.parts = new MeshParts(graphics);
  }

  get hasVolume(): boolean {
    return this.volume?.hasCells ?? false;
  }
  get drawsVolume(): boolean {
    return this.hasVolume && this.camera.hasMesh;
  }

  /**
   * Loads what draws this picture and is not here. Gives the picture without what the network did
   * not bring, or null if all is here.
   */
  awaits(snapshot: Snapshot): Promise<Snapshot> | null {
    const {parts} = this;
    const {arrows, surface, cuts, streamlines, volume, warp} = snapshot;
    if (volume && !this.volume)
      return loaded(import('./volume_view'), snapshot, {volume: null}, ({VolumeView}) => {
        this.volume ??= this.newVolume(VolumeView);
        this.volume.setLook(this.volumeLook);
      });
    if (streamlines && !parts.flow)
      return loaded(import('./flow_lines'), snapshot, {streamlines: null}, ({FlowLines}) => {
        parts.flow ??= new FlowLines(this.graphics);
      });
    if (arrows && !parts.arrows)
      return loaded(import('./arrow_view'), snapshot, {arrows: null}, ({ArrowView}) => {
        parts.arrows ??= new ArrowView(this.graphics);
      });
    if (warp?.restEdges && !parts.restEdges) {
      const plain = {...warp};
      delete plain.restEdges;
      return loaded(import('./line_parts'), snapshot, {warp: plain}, ({LineParts}) => {
        parts.restEdges ??= new LineParts(this.graphics);
      });
    }
    // Without an order triangles that are seen through are drawn as they come.
    if (!parts.order && [surface, ...cuts].some((soup) => soup?.hasClear))
      return import('./clear_order').catch(reportError).then((order) => {
        parts.order = order ? order.backToFront : () => null;
        return snapshot;
      });
    return null;
  }

  /** The next mesh lies on another lattice, in the same place. */
  changeLattice(change: LatticeChange): void {
    this.parts.clear(); // the picture may lack what the last one had
    this.camera.changeLattice(change);
  }

  show(snapshot: Snapshot): void {
    if (snapshot.volume !== undefined) this.volume?.take(snapshot.volume);
    this.volume?.setClip(snapshot.planes);
    // A cap would hide the volume behind it. A slice is drawn inside it.
    this.parts.show(snapshot, !this.hasVolume || snapshot.planes.length === 0);
    if (snapshot.bounds.length > 0) this.camera.growTo(snapshot);
  }

  /** The volume of before with another count of cells. REQUIRES: called once for each picture. */
  isMerelyFiner({color, statistics, warp}: Snapshot): boolean {
    const before = {...this.last};
    this.last.quantity = JSON.stringify([color, warp?.scale]);
    this.last.cells = statistics.tetrahedra;
    const isSame = before.quantity === this.last.quantity;
    return this.hasVolume && isSame && before.cells !== this.last.cells;
  }

  clear(): void {
    this.camera.clear();
    this.parts.clear();
    this.volume?.take(null);
  }

  /** Returns false if it is the same as before: a picture costs more than a comparison. */
  setLook(next: Look): boolean {
    const {map, reversed, edges, creases, opacity, beyond, volume, onDark, lines, moves} = next;
    const look = JSON.stringify([
      ...[map, reversed, edges, creases, opacity, beyond, volume, onDark, lines, moves],
    ]);
    if (look === this.last.look) return false;
    this.last.look = look;
    this.parts.setLook(next);
    if (volume) this.volumeLook.transfer = [volume, map, reversed, onDark];
    this.volume?.setLook(this.volumeLook);
    return true;
  }

  /** As MeshParts.setRange. Returns false if it is the same as before. */
  setRange(low: number, high: number, scaleRange: [number, number], logarithmic: boolean): boolean {
    const text = [low, high, scaleRange, logarithmic].join();
    if (text === this.last.range) return false;
    this.last.range = text;
    const range = this.parts.setRange(low, high, scaleRange, logarithmic);
    this.volumeLook.range = [range, scaleRange, logarithmic];
    this.volume?.setLook(this.volumeLook);
    return true;
  }

  /** Without a target it is the canvas's. */
  pictureOf(lens: Lens, target: Target | null = null): Picture {
    const {parts, camera} = this;
    camera.orbit.setDepths(lens);
    return {parts, eyeOfParts: camera.eyeOf(lens), target, ...camera.sightOf(lens)};
  }

  /** As MeshParts.fadeLines. */
  fadeLines(lens: Lens, canvas: Size): void {
    this.camera.orbit.setDepths(lens);
    this.parts.fadeLines(this.camera.sightOf(lens).toCanvas, canvas);
  }

  /** Draws the parts onto the canvas. */
  drawSurface(lens: Lens, canvas: Size): void {
    const {graphics} = this;
    const {gl} = graphics;
    this.fadeLines(lens, canvas);
    if (this.parts.moves) this.parts.flow?.tick();
    graphics.beginCanvas();
    graphics.use({depths: 'written'});
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.parts.draw(this.camera.eyeOf(lens));
  }

  /** As View.render. REQUIRES: there is a mesh. */
  async render(frame: Frame): Promise<Rendered> {
    const tiles: Tile[] = [];
    const {camera} = this;
    const {width, height, pixelRatio} = frame;
    const whole = camera.lensFor(frame, {x: 0, y: 0, width, height});
    this.fadeLines(whole, {clientWidth: width / pixelRatio, clientHeight: height / pixelRatio});
    const {toCanvas} = camera.sightOf(whole);
    for (const part of partsOf(frame)) {
      const lens = camera.lensFor(frame, part);
      tiles.push(await tileOf(this.graphics, part, (target) => this.drawTile(lens, target, frame)));
    }
    return {tiles, toCanvas};
  }

  private async drawTile(
    lens: Lens,
    target: Target,
    {pixelRatio, onDark = false}: Frame,
  ): Promise<void> {
    const {parts} = this;
    parts.frame = {pixelRatio, onDark};
    try {
      if (this.drawsVolume) return await this.volume!.drawWhole(this.pictureOf(lens, target));
      target.begin();
      target.clear();
      parts.draw(this.camera.eyeOf(lens));
    } finally {
      parts.frame = null;
    }
  }

  dispose(): void {
    this.camera.dispose();
    this.parts.dispose();
    this.volume?.dispose();
  }
}

async function loaded<Module>(
  coming: Promise<Module>,
  snapshot: Snapshot,
  without: Partial<Snapshot>,
  use: (its: Module) => void,
): Promise<Snapshot> {
  const its = await coming.catch(reportError);
  if (!its) return {...snapshot, ...without};
  use(its);
  return snapshot;
}
