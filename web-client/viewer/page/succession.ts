// The mesh that a viewer shows, and the one that follows it.

import {latticeChange, type LatticeChange} from '../../core/protocol/geometry';
import type {Snapshot} from '../../core/session/worker_messages';
import {ShownMesh, type SegmentPlace} from './shown_mesh';

export class Succession {
  shown = new ShownMesh();
  /** Another segment of the list, until it has a picture; null: none is opened. */
  next: ShownMesh | null = null;
  /** A picture of `coming` that waits for a view. */
  waiting: Snapshot | null = null;

  /** The mesh to which the worker's messages belong. */
  get coming(): ShownMesh {
    return this.next ?? this.shown;
  }

  /** Another mesh is opened. `follows`: the shown one stays until that has a picture. */
  open(place: SegmentPlace | null, follows: boolean): void {
    this.next = follows ? this.shown.successor(place) : null;
    this.waiting = null;
    if (!follows) this.shown = new ShownMesh(place);
  }

  /** The next one takes the place of the shown one. Null if there is none. */
  takeNext(): LatticeChange | null {
    const {shown: before, next} = this;
    if (!next) return null;
    this.shown = next;
    this.next = null;
    return latticeChange(before.manifest!.lattice, next.manifest!.lattice);
  }
}
