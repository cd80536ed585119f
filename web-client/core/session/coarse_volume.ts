// The mesh with few cells, decoded a second time from the same blocks. Where graphics are slow, a
// volume is drawn with it while something moves.

import type {Assembler} from '../decode/assembler';
import {fieldsOf, hidingKey, keptCells} from '../layers/shown';
import {colorScale, type Display} from '../picture/display';
import {lateMaking} from '../picture/late_making';
import {meshArrays} from '../picture/mesh_arrays';
import {kCoarseCells, type CoarseCells, type VolumeCells} from '../picture/volume';
import type {Frame} from '../protocol/messages';

export class CoarseVolume {
  private version = 0;
  private frames: Frame[] = [];
  /** The part of later instants. */
  private later: Uint8Array | null = null;
  /** The request that the cells were made for; empty if there are none. */
  private key = '';
  private assembler: Promise<Assembler> | null = null;

  /** `makeAssembler` makes an assembler with an empty codec of its own. */
  constructor(private readonly makeAssembler: () => Promise<Assembler>) {}

  /** Notes a part of the log. The bytes are kept elsewhere anyway. */
  note(frame: Frame): void {
    this.frames.push(frame);
  }

  noteLater(part: Uint8Array): void {
    this.later = part;
  }

  forget(): void {
    this.frames = [];
    this.later = null;
    this.key = '';
  }

  /**
   * The cells that `display` shows, left out if the caller has version `have`. Throws if the field
   * has no values yet.
   */
  async cells(have: number, display: Display): Promise<CoarseCells> {
    const assembler = await (this.assembler ??= this.makeAssembler());
    const key = JSON.stringify([display.color, display.warp, display.derived, hidingKey(display)]);
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
    for (const frame of this.frames) {
      assembler.take(frame);
      if (this.later && assembler.laterBytes > 0) assembler.takeLater(this.later);
    }
    const hasRoom = (): boolean => {
      const next = codec.chunksApplied;
      return (
        next === 0 ||
        (next < codec.chunkCount &&
          codec.tetrahedronCount + codec.brings(next).tetrahedra <= kCoarseCells)
      );
    };
    while (assembler.step(fields, hasRoom())) continue;
    const mesh = meshArrays(assembler, display);
    const scale = mesh && colorScale(mesh, display);
    const cells = mesh && scale && lateMaking.volume?.(mesh, scale, keptCells(mesh, display));
    if (!cells) throw new Error('there are no values yet');
    return cells;
  }
}
