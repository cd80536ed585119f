// Turns the growing mesh into pictures for the page, no faster than the page shows them and than decoding can spare.

import type {Assembler} from './assembler';
import {cutsOf, cuttingPlanes, fieldsOf, isosurfacesOf, keptCells, kPlainDisplay, surfaceOf, type Display, type MeshNow} from './display';
import {scalarRange} from './field_scale';
import {meshNow} from './mesh_now';
import {noSoup, pointBounds} from './triangle_soup';
import {Volume, type VolumeCells} from './volume';
import type {Snapshot} from './worker_messages';

/** Pictures a second at most, so that decoding has the worker and the page its frames. */
const kShortestPauseMs = 100;
/** Time between pictures is at least this many times what the last one cost. */
const kCostFactor = 3;
/** A cut that the user drags comes at once; this only keeps it from starving the decoder. */
const kCutPauseMs = 8;

export class Publisher {
  display: Display = kPlainDisplay;
  readonly volume = new Volume();
  private meshChanged = false;
  private cutChanged = false;
  /** Nothing is drawn before the page has said what. */
  private wanted = false;
  private bounds: number[] = [];
  private onScreen = true;
  private nextAt = 0;
  private dueAt = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly assembler: Assembler, private readonly send: (snapshot: Snapshot) => void) {}

  /** The mesh or the shown field's values changed. */
  changed(): void {
    this.meshChanged = true;
    this.schedule();
  }

  show(display: Display): void {
    const before = this.display;
    this.display = display;
    const whole = display.mode === 'cells' || before.mode !== display.mode || before.body !== display.body || before.volume !== display.volume ||
      JSON.stringify([before.color, before.threshold, before.isosurfaces]) !== JSON.stringify([display.color, display.threshold, display.isosurfaces]);
    if (whole || !this.wanted) this.meshChanged = true;
    this.wanted = this.cutChanged = true;
    this.schedule();
  }

  /** The page has drawn the last picture. */
  shown(): void {
    this.onScreen = true;
    this.schedule();
  }

  /** Starts with an empty mesh, and waits for a display. */
  reset(): void {
    this.meshChanged = this.cutChanged = this.wanted = false;
    this.bounds = [];
    this.volume.forget();
    this.display = kPlainDisplay;
    clearTimeout(this.timer);
    this.timer = undefined;
  }

  private schedule(): void {
    if (!this.onScreen || !this.wanted || !(this.meshChanged || this.cutChanged)) return;
    const now = performance.now();
    const due = this.cutChanged ? Math.min(this.nextAt, now + kCutPauseMs) : this.nextAt;
    if (this.timer !== undefined && this.dueAt <= due) return;
    clearTimeout(this.timer);
    this.dueAt = due;
    this.timer = setTimeout(() => this.publish(), due - now);
  }

  private publish(): void {
    this.timer = undefined;
    const mesh = meshNow(this.assembler);
    if (!mesh) return;
    const start = performance.now();
    const {display} = this;
    const kept = keptCells(mesh, display);
    // A finer mesh has another cut: both travel together, so that they always fit.
    const snapshot: Snapshot = {...this.frame(mesh), cuts: cutsOf(mesh, display, kept), planes: cuttingPlanes(display)};
    if (this.meshChanged) {
      snapshot.surface = display.body && display.mode !== 'slice' ? surfaceOf(mesh, display, kept) : noSoup();
      snapshot.isosurface = isosurfacesOf(mesh, display, kept) ?? noSoup();
      snapshot.volume = this.volumeOf(mesh, kept);
    }
    this.meshChanged = this.cutChanged = this.onScreen = false;
    snapshot.costMs = performance.now() - start;
    this.nextAt = start + Math.max(kShortestPauseMs, kCostFactor * snapshot.costMs);
    this.send(snapshot);
  }

  private volumeOf(mesh: MeshNow, kept: Uint8Array | null): VolumeCells | null {
    const {color, volume} = this.display;
    const scale = volume && color && mesh.scale(color);
    if (scale) return this.volume.take(mesh, scale, kept);
    this.volume.forget();
    return null;
  }

  private frame(mesh: MeshNow): Omit<Snapshot, 'cuts' | 'planes'> {
    const {color} = this.display;
    const scale = color && mesh.scale(color);
    const info = color && this.assembler.manifest!.fields[color.field];
    if (this.meshChanged || this.bounds.length === 0) this.bounds = pointBounds(mesh.points, mesh.boundary);
    return {
      bounds: this.bounds, color: scale ? color : null, statistics: this.assembler.statistics(fieldsOf(this.display)), costMs: 0,
      // Of a component nobody knows the range but the values themselves.
      extent: scale && info && info.components > 1 && color.component >= 0 ? scale.extent() : [0, 1],
      scaleRange: scale && info ? scalarRange(info, color.component) : [0, 1],
    };
  }
}
