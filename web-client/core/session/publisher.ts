// Turns the growing mesh into pictures for the page, no faster than the page shows them and
// decoding can spare.

import type {Assembler} from '../decode/assembler';
import {fieldsOf, keptCells, layerSoups, refinedCorners} from '../layers/shown';
import {
  cutsOf,
  cuttingPlanes,
  kPlainDisplay,
  surfaceOf,
  type Display,
  type MeshArrays,
} from '../picture/display';
import {scalarRange, type FieldScale, type Scalar} from '../picture/field_scale';
import {meshArrays} from '../picture/mesh_arrays';
import {spreadOf, type Spread} from '../picture/spread';
import {noSoup, pointBounds} from '../picture/triangle_soup';
import {volumeCells, type VolumeCells} from '../picture/volume';
import type {Snapshot} from './worker_messages';

/**
 * The least time between two pictures: decoding needs the worker, and the page needs its frames.
 */
const kShortestPauseMs = 100;
/**
 * The pause between pictures is so many times the cost of the last one, in the worker and on its
 * way to the screen. Graphics without a GPU take the processors from decoding.
 */
const kCostFactor = 4;
/** A hidden page draws nothing, so that the time until it does says nothing about pictures. */
const kLongestPauseMs = 1000;
/**
 * Below this share of new bytes a picture hardly differs from the last one. It waits for more, but
 * at most kSmallGrowthMs.
 */
const kGrowth = 0.1;
/** The same share where a picture takes so long that decoding suffers. */
const kSlowMs = 100;
const kSlowGrowth = 1;
const kSmallGrowthMs = 500;
/**
 * A picture is worth making if it stays at least this many times as long as it takes to reach the
 * screen. Otherwise only the last one is made, and it arrives sooner.
 */
const kWorthMaking = 2;
/** A cut that the user drags comes at once. This pause only keeps it from starving the decoder. */
const kCutPauseMs = 8;

export class Publisher {
  display: Display = kPlainDisplay;
  /** Since the last reset. */
  hasPublished = false;
  /** Called after the first picture of a mesh has been sent. */
  onFirst: () => void = () => undefined;
  /** Called with refinedCorners of each new mesh. */
  onLayers: (positions: Float32Array) => void = () => undefined;
  /** How long until everything wanted is decoded, in ms; Infinity if unknown. */
  untilLast: () => number = () => Infinity;
  private meshChanged = false;
  private cutChanged = false;
  /** Nothing finer will follow by itself. */
  private isLast = false;
  /** The page has said what to draw. */
  private isRequested = false;
  private bounds: number[] = [];
  /** By colour, from the mesh with which it was first drawn. */
  private readonly spreads = new Map<string, Spread>();
  private onScreen = true;
  /** When the last picture was sent, and how many bytes it was made of. */
  private sentAt = 0;
  private bytes = 0;
  private isFirst = true;
  /**
   * How long the last picture took to the screen; for the first one, without the start of the
   * graphics. 0 if unknown.
   */
  private tookMs = 0;
  /** When the mesh began to differ from the last picture's. */
  private changedAt = 0;
  private nextAt = 0;
  private dueAt = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly assembler: Assembler,
    private readonly send: (snapshot: Snapshot) => void,
  ) {}

  /**
   * The mesh or the shown values have changed. With `isLast` the picture need not leave time for
   * decoding.
   */
  changed(isLast = false): void {
    if (!this.meshChanged) this.changedAt = performance.now();
    this.meshChanged = true;
    this.isLast = isLast;
    this.schedule();
  }

  show(display: Display): void {
    const before = this.display;
    this.display = display;
    // Planes alone make another cut of the same surface, unless they hide whole cells.
    const withoutPlanes = (its: Display): string => JSON.stringify({...its, planes: []});
    const whole = display.mode === 'cells' || withoutPlanes(before) !== withoutPlanes(display);
    if (whole || !this.isRequested) this.meshChanged = true;
    this.isRequested = this.cutChanged = true;
    this.schedule();
  }

  /** The page has drawn the last picture in `drawingMs`; 0 if unknown. */
  shown(drawingMs = 0): void {
    const now = performance.now();
    if (!this.onScreen) {
      this.nextAt = Math.max(
        this.nextAt,
        now + Math.min(kLongestPauseMs, kCostFactor * (now - this.sentAt)),
      );
      this.tookMs = Math.min(kLongestPauseMs, this.isFirst ? drawingMs : now - this.sentAt);
    }
    this.onScreen = true;
    this.schedule();
  }

  /** Sends the picture again, without waiting for the last one. */
  repeat(): void {
    this.onScreen = true;
    this.changed(true);
  }

  /** A picture is due or on its way to the screen. */
  get isBusy(): boolean {
    return this.timer !== undefined || !this.onScreen;
  }

  /** Begins with an empty mesh and waits for a display. */
  reset(): void {
    this.meshChanged = this.cutChanged = this.isRequested = this.hasPublished = this.isLast = false;
    this.onScreen = true; // nobody waits for the previous mesh's picture
    this.bounds = [];
    this.spreads.clear();
    this.bytes = this.tookMs = 0;
    this.display = kPlainDisplay;
    clearTimeout(this.timer);
    this.timer = undefined;
  }

  private schedule(): void {
    if (!this.onScreen || !this.isRequested || !(this.meshChanged || this.cutChanged)) return;
    const now = performance.now();
    const due = this.dueFrom(now);
    if (this.timer !== undefined && this.dueAt <= due) return;
    clearTimeout(this.timer);
    this.dueAt = due;
    this.timer = setTimeout(() => this.publishIfDue(), due - now);
  }

  /** A better moment may be known by now. */
  private publishIfDue(): void {
    this.timer = undefined;
    const now = performance.now();
    if (!this.isLast && !this.cutChanged && this.lastAt(now) > now) this.schedule();
    else this.publish();
  }

  private dueFrom(now: number): number {
    if (this.isLast) return now;
    if (this.cutChanged) return Math.min(this.nextAt, now + kCutPauseMs);
    const {bytes} = this.assembler.statistics(fieldsOf(this.display));
    const isSmall =
      bytes >= this.bytes &&
      bytes < (1 + (this.tookMs < kSlowMs ? kGrowth : kSlowGrowth)) * this.bytes;
    return Math.max(this.nextAt, isSmall ? this.changedAt + kSmallGrowthMs : 0, this.lastAt(now));
  }

  /** When the last picture is due, if one before it is not worth making; else 0. */
  private lastAt(now: number): number {
    const left = this.tookMs > 0 ? this.untilLast() : Infinity;
    return left < kWorthMaking * this.tookMs ? now + left : 0;
  }

  private publish(): void {
    const mesh = meshArrays(this.assembler);
    if (!mesh) return;
    const start = performance.now();
    const {display} = this;
    const kept = keptCells(mesh, display);
    // A finer mesh has another cut. Both travel together, so that they always match.
    const snapshot: Snapshot = {
      ...this.frame(mesh),
      cuts: cutsOf(mesh, display, kept),
      planes: cuttingPlanes(display),
    };
    if (this.meshChanged) {
      snapshot.surface =
        display.body && display.mode !== 'slice' ? surfaceOf(mesh, display, kept) : noSoup();
      Object.assign(snapshot, layerSoups(mesh, display, kept));
      this.onLayers(refinedCorners(snapshot));
      snapshot.volume = this.volumeOf(mesh, kept);
    }
    this.meshChanged = this.cutChanged = this.onScreen = this.isLast = false;
    this.bytes = snapshot.statistics.bytes;
    this.sentAt = performance.now();
    snapshot.costMs = this.sentAt - start;
    this.nextAt = start + Math.max(kShortestPauseMs, kCostFactor * snapshot.costMs);
    this.send(snapshot);
    this.isFirst = !this.hasPublished;
    if (!this.isFirst) return;
    this.hasPublished = true;
    this.onFirst();
  }

  private volumeOf(mesh: MeshArrays, kept: Uint8Array | null): VolumeCells | null {
    const {color, volume} = this.display;
    const scale = volume && color && mesh.scale(color);
    return scale ? volumeCells(mesh, scale, kept) : null;
  }

  private spreadOf(color: Scalar, scale: FieldScale, {tetrahedra}: MeshArrays): Spread {
    const key = `${color.field} ${color.component}`;
    const known = this.spreads.get(key);
    if (known) return known;
    const spread = spreadOf(scale, tetrahedra);
    this.spreads.set(key, spread);
    return spread;
  }

  private frame(mesh: MeshArrays): Omit<Snapshot, 'cuts' | 'planes'> {
    const {color} = this.display;
    const scale = color && mesh.scale(color);
    const info = color && this.assembler.manifest!.fields[color.field];
    if (this.meshChanged || this.bounds.length === 0)
      this.bounds = pointBounds(mesh.points, mesh.boundary);
    return {
      bounds: this.bounds,
      color: scale ? color : null,
      statistics: this.assembler.statistics(fieldsOf(this.display)),
      costMs: 0,
      // The range of a component is known from its values only.
      extent:
        scale && info && info.components > 1 && color.component >= 0
          ? scale.extent(mesh.tetrahedra)
          : [0, 1],
      middle: scale ? this.spreadOf(color, scale, mesh).middle : [0, 1],
      scaleRange: scale && info ? scalarRange(info, color.component) : [0, 1],
    };
  }
}
