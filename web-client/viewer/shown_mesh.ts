// What a viewer knows of the mesh that it shows. Another mesh begins with none of it.

import type {LevelBytes} from '../core/goal';
import type {Manifest} from '../core/manifest';
import {kNoStatistics, type Statistics} from '../core/statistics';
import type {Snapshot} from '../core/worker_messages';

export class ShownMesh {
  /** Null before the head of the log is here. */
  manifest: Manifest | null = null;
  /** In lattice coordinates; empty before the first picture. */
  bounds: number[] = [];
  /** What lies ahead. */
  plan: LevelBytes[] = [];
  /** The newest figures. */
  statistics: Statistics = kNoStatistics;
  /** The newest picture. */
  snapshot: Snapshot | null = null;
  /** A picture that came before there was a view. */
  waiting: Snapshot | null = null;
  /** Some of its values are missing. */
  hasMissing = false;
  /** Figures of the picture on the screen; null: there is none. */
  drawn: Statistics | null = null;

  take(snapshot: Snapshot): void {
    // Other figures are newer: the picture may have waited for a view.
    if (this.statistics === kNoStatistics) this.statistics = snapshot.statistics;
    this.snapshot = snapshot;
    if (!snapshot.surface) return; // a new cut of the same mesh
    this.hasMissing = [snapshot.surface, ...snapshot.cuts].some(({values}) =>
      values.some(Number.isNaN),
    );
  }

  /** All that is here and wanted is on the screen: the decoder may be done long before. */
  get isDrawn(): boolean {
    return this.drawn !== null && this.drawn.bytes >= this.statistics.bytesNeeded;
  }
}
