// The mesh with few cells, decoded once more from the blocks that have come: what is drawn of a
// volume while something moves and the graphics are slow.

import type {Assembler} from './assembler';
import {fieldsOf, keptCells, type Display} from './display';
import {meshNow} from './mesh_now';
import type {Frame} from './protocol';
import {kCoarseCells, volumeCells, type CoarseCells, type VolumeCells} from './volume';

export class CoarseVolume {
  private version = 0;
  private frames: Frame[] = [];
  /** What the cells are of; empty: there are none. */
  private key = '';
  private assembler: Promise<Assembler> | null = null;

  /** `makeAssembler`: with an empty codec of its own. */
  constructor(private readonly makeAssembler: () => Promise<Assembler>) {}

  /** A part of the log; its bytes are kept anyway. */
  note(frame: Frame): void {
    this.frames.push(frame);
  }

  forget(): void {
    this.frames = [];
    this.key = '';
  }

  /**
   * The cells that `display` shows, unless the asker has them: those of version `have`. Throws
   * where there are no values of the field yet.
   */
  async cells(have: number, display: Display): Promise<CoarseCells> {
    const assembler = await (this.assembler ??= this.makeAssembler());
    const key = JSON.stringify([
      display.color,
      display.threshold,
      display.mode === 'cells' && display.planes,
    ]);
    if (key === this.key && have === this.version) return {version: have};
    this.key = '';
    const cells = this.take(assembler, display);
    this.key = key;
    return {version: ++this.version, cells};
  }

  private take(assembler: Assembler, display: Display): VolumeCells {
    const {codec} = assembler;
    const fields = fieldsOf(display);
    assembler.forget();
    for (const frame of this.frames) assembler.take(frame);
    const hasRoom = (): boolean => {
      const next = codec.chunksApplied;
      return (
        next === 0 ||
        (next < codec.chunkCount &&
          codec.tetrahedronCount + codec.brings(next).tetrahedra <= kCoarseCells)
      );
    };
    while (assembler.step(fields, hasRoom())) continue;
    const mesh = meshNow(assembler);
    const scale = display.color && mesh?.scale(display.color);
    if (!mesh || !scale) throw new Error('there are no values yet');
    return volumeCells(mesh, scale, keptCells(mesh, display));
  }
}
