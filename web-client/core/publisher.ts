// Turns the growing mesh into pictures for the page, no faster than the page shows them and than decoding can spare.

import type {Assembler} from './assembler';
import {FieldScale} from './field_scale';
import {slice, type Plane} from './slice';
import {boundarySoup, soupBounds} from './triangle_soup';
import type {Snapshot} from './worker_messages';

/** Pictures a second at most, so that decoding has the worker and the page its frames. */
const kShortestPauseMs = 100;
/** Time between pictures is at least this many times what the last one cost. */
const kCostFactor = 3;
/** A cut that the user drags comes at once; this only keeps it from starving the decoder. */
const kCutPauseMs = 8;

export class Publisher {
  private surfaceChanged = false;
  private cutChanged = false;
  private plane: Plane | null = null;
  private field = -1;
  private bounds: number[] = [];
  private onScreen = true;
  private nextAt = 0;
  private dueAt = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly assembler: Assembler, private readonly send: (snapshot: Snapshot) => void) {}

  /** The mesh or the shown field's values changed. */
  changed(): void {
    this.surfaceChanged = true;
    this.schedule();
  }

  /** Show field `field` of the manifest from now on (-1: none). */
  show(field: number): void {
    this.field = field;
    this.changed();
  }

  clip(plane: Plane | null): void {
    this.plane = plane;
    this.cutChanged = true;
    this.schedule();
  }

  /** The page has drawn the last picture. */
  shown(): void {
    this.onScreen = true;
    this.schedule();
  }

  /** Starts with an empty mesh. */
  reset(): void {
    this.surfaceChanged = this.cutChanged = false;
    this.bounds = [];
    this.field = -1;
    clearTimeout(this.timer);
    this.timer = undefined;
  }

  private schedule(): void {
    if (!this.onScreen || !(this.surfaceChanged || this.cutChanged)) return;
    const now = performance.now();
    const due = this.cutChanged ? Math.min(this.nextAt, now + kCutPauseMs) : this.nextAt;
    if (this.timer !== undefined && this.dueAt <= due) return;
    clearTimeout(this.timer);
    this.dueAt = due;
    this.timer = setTimeout(() => this.publish(), due - now);
  }

  private publish(): void {
    this.timer = undefined;
    const {codec, manifest} = this.assembler;
    if (!manifest || codec.chunksApplied === 0) return;
    const start = performance.now();
    const info = manifest.fields[this.field];
    const values = info ? codec.field(this.field, info.components) : null;
    const scale = info && values ? new FieldScale(values, info) : null;
    const snapshot: Snapshot = {
      bounds: this.bounds, field: scale ? this.field : -1, statistics: this.assembler.statistics(this.field),
    };
    const points = codec.points();
    if (this.surfaceChanged) {
      snapshot.surface = boundarySoup(points, codec.boundary(), scale);
      snapshot.bounds = this.bounds = soupBounds(snapshot.surface);
    }
    // A finer mesh has another cut: both travel together, so that they always fit.
    if (this.plane) snapshot.cut = {plane: this.plane, cap: slice(points, codec.tetrahedra(), scale, this.plane)};
    else if (this.cutChanged) snapshot.cut = null;
    this.surfaceChanged = this.cutChanged = this.onScreen = false;
    this.nextAt = start + Math.max(kShortestPauseMs, kCostFactor * (performance.now() - start));
    this.send(snapshot);
  }
}
