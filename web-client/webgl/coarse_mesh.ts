// A few cells in the place of many, for slow graphics while something moves. The page makes them on
// request.

import type {CoarseCells} from '../core/picture/volume';
import {CellMesh} from './cell_mesh';
import type {Graphics} from './gl/graphics';

export class CoarseMesh extends CellMesh {
  private version = -1;
  private state: 'stale' | 'asked' | 'here' | 'none' = 'stale';

  /** `ask` is that of ViewListeners; without it there are never any cells. */
  constructor(
    graphics: Graphics,
    private readonly ask?: (have: number) => Promise<CoarseCells>,
  ) {
    super(graphics);
  }

  get isHere(): boolean {
    return this.state === 'here';
  }
  /** The page has none. */
  get isMissing(): boolean {
    return this.state === 'none';
  }

  /** The fine mesh has changed. The cells may belong to another field now. */
  expire(): void {
    this.state = 'stale';
  }

  forget(): void {
    this.requested = null;
    this.version = -1;
  }

  /** Asks for the cells of the fine mesh, unless they are here or under way. */
  refresh(answered: () => void): void {
    if (this.state !== 'stale') return;
    this.state = 'asked';
    const end = (state: 'here' | 'none'): void => {
      if (this.state === 'asked') this.state = state;
      answered();
    };
    if (!this.ask) return end('none');
    this.ask(this.version).then(
      ({version, cells}) => {
        if (cells) this.requested = cells;
        this.version = version;
        end(this.requested ? 'here' : 'none');
      },
      () => end('none'),
    );
  }
}
