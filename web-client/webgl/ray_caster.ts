// Draws a volume's cells onto a DeepTarget by casting rays (ray_shaders.ts). Rays that leave the
// mesh through a hole or a concavity may enter it again. So it works in layers: it draws the next
// boundary faces and casts rays from there, until no pixel has such a face.

import {linearPart} from '../core/picture/log_scale';
import {transferTables} from '../core/picture/transfer';
import type {Plane} from '../core/protocol/geometry';
import {kMinNear} from './camera';
import type {CellTextures} from './cell_textures';
import {clipValues} from './clip_values';
import type {DeepTarget} from './deep_target';
import {Cover, kCoverShader} from './gl/cover';
import type {Graphics} from './gl/graphics';
import {Program, type Uniform} from './gl/program';
import {Target} from './gl/target';
import {Texture} from './gl/texture';
import type {Sight} from './mesh_camera';
import {kEntryFragmentShader, kEntryVertexShader, kRayFragmentShader} from './ray_shaders';
import {raysOf} from './rays';

const kNoCell = new Uint32Array(5);

export class RayCaster {
  private readonly entryProgram: Program;
  private readonly rayProgram: Program;
  private readonly cover: Cover;
  private entry: Record<string, Uniform> = {};
  private ray: Record<string, Uniform> = {};
  private entryCorners = 0;
  /** Those of setTransfer, setRange and setClip. */
  private readonly look: Record<string, Uniform> = {
    range: [0, 1],
    scaleRange: [0, 1],
    logarithmic: false,
    linear: 0,
    clipPlanes: clipValues([]),
  };
  /** The last words of setTransfer, as a text. */
  private transfer = '';
  private tables: Texture[] = [];
  /** The entries of this layer, and of the one before. */
  private targets: [Target, Target];

  constructor(private readonly graphics: Graphics) {
    this.entryProgram = new Program(graphics, kEntryVertexShader, kEntryFragmentShader);
    this.rayProgram = new Program(graphics, kCoverShader, kRayFragmentShader);
    this.cover = new Cover(graphics);
    const target = (): Target => new Target(graphics, {kind: 'rg32ui', depths: 'buffer'});
    this.targets = [target(), target()];
  }

  setTransfer(...words: Parameters<typeof transferTables>): void {
    const text = JSON.stringify(words);
    if (text === this.transfer) return;
    this.transfer = text;
    const {density, integral} = transferTables(...words);
    for (const table of this.tables) table.dispose();
    const tableOf = (values: Float32Array): Texture =>
      new Texture(this.graphics, values, values.length / 4, 1, 'rgba32f');
    const tables = {density: tableOf(density), integral: tableOf(integral)};
    Object.assign(this.look, tables);
    this.tables = Object.values(tables);
  }

  /** The range as MeshParts.setRange returns it. */
  setRange(range: [number, number], scaleRange: [number, number], logarithmic: boolean): void {
    const linear = linearPart({low: range[0], high: range[1], logarithmic});
    Object.assign(this.look, {range, scaleRange, logarithmic, linear});
  }
  setClip(planes: readonly Plane[]): void {
    this.look.clipPlanes = clipValues(planes);
  }

  /**
   * Begins a picture of these cells on `deep`. Returns true if the eye is inside a cell: rays from
   * there come first, before any layer.
   */
  begin(
    cells: CellTextures,
    {toCanvas, fromCanvas, eye, diagonal}: Sight,
    deep: DeepTarget,
  ): boolean {
    const {vertices, links, cellValues, ofCells, entries} = cells;
    const {near, far, farPerNear, distances} = raysOf(fromCanvas);
    const eyeCell = cells.eyeCell(eye);
    this.ray = {
      ...{vertices, links, cellValues, ofCells, entries},
      near: near.flat(),
      far: far.flat(),
      farPerNear,
      perPixel: [2 / deep.width, 2 / deep.height],
      depths: deep.depths,
      perDiagonal: 1 / diagonal,
      eyeCell: eyeCell ?? kNoCell,
      // not read before the first layer, but it must have its type
      layer: entries,
    };
    this.entry = {
      ...{vertices, entries, toCanvas},
      before: entries,
      picture: deep.volume.color,
      isFirst: true,
      // starts at the eye if that is close
      distances: [Math.max(0, distances[0] - kMinNear), distances[1]],
      middle: [deep.width / 2, deep.height / 2],
    };
    this.entryCorners = cells.entryCorners;
    for (const target of this.targets) target.resize(deep.width, deep.height);
    return eyeCell !== null;
  }

  /** Goes on to the next layer. */
  enter(): void {
    const [before, now] = this.targets;
    this.targets = [now, before];
    if (this.entry.isFirst === false) this.entry.before = before.color;
    now.begin();
    now.clear();
    this.graphics.use({depths: 'written', culls: true});
    this.entryProgram.use(this.entry);
    this.cover.draw(this.entryCorners);
    this.entry.isFirst = false;
    this.ray.eyeCell = kNoCell;
    this.ray.layer = now.color;
  }

  /** Casts the layer's rays in these rows of pixels. */
  cast({volume}: DeepTarget, from: number, rows: number): void {
    volume.begin();
    this.graphics.use({mix: 'behind', rows: {from, count: rows, width: volume.width}});
    this.rayProgram.use({...this.look, ...this.ray});
    this.cover.draw();
  }

  dispose(): void {
    for (const table of this.tables) table.dispose();
    for (const target of this.targets) target.dispose();
    this.entryProgram.dispose();
    this.rayProgram.dispose();
    this.cover.dispose();
  }
}
