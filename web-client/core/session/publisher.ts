// Turns the growing mesh into pictures for the page.

import type {Assembler} from '../decode/assembler';
import {fieldsOf, keptCells, layerSoups} from '../layers/shown';
import {
  colorScale,
  cutsOf,
  cuttingPlanes,
  kPlainDisplay,
  surfaceOf,
  type Display,
  type MeshArrays,
} from '../picture/display';
import {scalarRange, type Scalar} from '../picture/field_scale';
import {kLabelScaleRange, shownLabels, type ShownLabels} from '../picture/labels';
import {meshArrays} from '../picture/mesh_arrays';
import {amountsOf, middleOf} from '../picture/spread';
import {noSoup, pointBounds, type CreasesOf} from '../picture/triangle_soup';
import {volumeCells, type VolumeCells} from '../picture/volume';
import type {Warp} from '../picture/warp';
import type {FieldInfo} from '../protocol/fields';
import {KeptCreases} from './kept_creases';
import {PicturePace} from './picture_pace';
import type {Snapshot} from './worker_messages';

export class Publisher {
  display: Display = kPlainDisplay;
  readonly pace = new PicturePace();
  /** Since the last reset. */
  hasPublished = false;
  /** Called after the first picture of a mesh has been sent. */
  onFirst: () => void = () => undefined;
  /** Null: pictures have no creases yet. */
  private creases: KeptCreases | null = null;
  /** The colour of the last picture; null: it had none. */
  private drawnColor: Scalar | null = null;
  /** The warp of the last picture; null: the mesh was at rest. */
  private drawnWarp: Warp | null = null;
  /** The chunks of the last picture's mesh. */
  private drawnChunks = 0;
  /** The display of the last picture or wish, as it could be drawn then. */
  private seen = '';
  private meshChanged = false;
  private cutChanged = false;
  /** Nothing finer will follow by itself. */
  private isLast = false;
  /** The page has said what to draw. */
  private isRequested = false;
  private bounds: number[] = [];
  /** The same without a warp. */
  private restBounds: number[] = [];
  /** Those of the colour; null: it is no label. */
  private labels: ShownLabels | null = null;
  /** middleOf by colour, from the mesh with which it was first drawn. */
  private readonly middles = new Map<string, [number, number]>();
  /** amountsOf by colour, from the mesh whose volume was first drawn. */
  private readonly amounts = new Map<string, number[]>();
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
    // Until an instant has values, only a finer mesh changes the picture of the last one.
    const isSame = this.assembler.codec.chunksApplied === this.drawnChunks;
    if (isSame && this.isWaiting) return;
    this.renew(isLast);
  }

  private renew(isLast: boolean): void {
    if (!this.meshChanged) this.pace.meshChanged();
    this.meshChanged = true;
    this.isLast = isLast;
    this.schedule();
  }

  /** Draws creases from the next picture on. */
  useCreases(creasesOf: CreasesOf): void {
    this.creases = new KeptCreases(this.assembler.codec, creasesOf);
    this.renew(this.isLast);
  }

  show(display: Display): void {
    const before = this.seen;
    this.display = display;
    this.seen = textOf(this.drawn(display));
    if (this.isRequested && this.seen === before) return; // it differs in what is not seen
    // Planes alone make another cut of the same surface, unless they hide whole cells.
    const withoutPlanes = (its: string): string =>
      JSON.stringify({...(JSON.parse(its) as Display), planes: []});
    const isOther = !this.isRequested || withoutPlanes(before) !== withoutPlanes(this.seen);
    if (isOther || display.mode === 'cells') this.meshChanged = true;
    this.isRequested = this.cutChanged = true;
    this.schedule();
  }

  /**
   * The display as it can be drawn now. An instant leaves the last one on the screen until it has
   * values. If both the colour and the warp are series, they change together.
   */
  get now(): Display {
    return this.drawn(this.display);
  }

  private drawn(display: Display): Display {
    if (!this.isWaiting) return display;
    return {
      ...display,
      color: this.held(display.color, this.drawnColor),
      warp: this.held(display.warp, this.drawnWarp),
    };
  }

  /** The instant that was drawn last, instead of another one of its series. */
  private held<T extends {field: number}>(
    wanted: T | null,
    before: Warp | Scalar | null,
  ): T | null {
    const isHeld = wanted && before && this.isOfSeries(wanted, before);
    return isHeld ? {...wanted, field: before.field} : wanted;
  }

  private get isWaiting(): boolean {
    const {color, warp} = this.display;
    const {drawnColor, drawnWarp} = this;
    const waitsForColor =
      color?.component === drawnColor?.component && this.waitsFor(color, drawnColor);
    return waitsForColor || this.waitsFor(warp, drawnWarp);
  }

  /**
   * The last picture shows another instant of the same series, and the wanted one has no values, or
   * more of them are decoded soon.
   */
  private waitsFor(wanted: {field: number} | null, before: {field: number} | null): boolean {
    const {codec} = this.assembler;
    if (!wanted || !before || !this.isOfSeries(wanted, before)) return false;
    if (wanted.field === before.field || codec.fieldChunksApplied(before.field) === 0) return false;
    const applied = codec.fieldChunksApplied(wanted.field);
    const mayGrow = applied < codec.chunksApplied;
    return applied === 0 || (mayGrow && this.assembler.receivedOfField(wanted.field) > applied);
  }

  /** Both are instants of one series. */
  private isOfSeries(a: {field: number}, b: {field: number}): boolean {
    const fields = this.assembler.manifest?.fields;
    const series = fields?.[a.field]?.instant?.series;
    return series !== undefined && series === fields?.[b.field]?.instant?.series;
  }

  /** The page has drawn the last picture in `drawingMs`; 0 if unknown. */
  shown(drawingMs = 0): void {
    this.pace.shown(drawingMs);
    this.schedule();
  }

  /** Sends the picture again, without waiting for the last one. */
  repeat(): void {
    this.pace.release();
    this.renew(true);
  }

  /** A picture is due or on its way to the screen. */
  get isBusy(): boolean {
    return this.timer !== undefined || !this.pace.isOnScreen;
  }

  /** Begins with an empty mesh and waits for a display. */
  reset(): void {
    this.meshChanged = this.cutChanged = this.isRequested = this.hasPublished = this.isLast = false;
    this.pace.reset();
    this.bounds = [];
    this.middles.clear();
    this.amounts.clear();
    this.creases?.forget();
    this.drawnColor = this.drawnWarp = null;
    this.display = kPlainDisplay;
    clearTimeout(this.timer);
    this.timer = undefined;
  }

  private schedule(): void {
    if (!this.isRequested || !(this.meshChanged || this.cutChanged)) return;
    if (!this.pace.isOnScreen) return;
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
    if (!this.isLast && !this.cutChanged && this.pace.lastAt(now) > now) this.schedule();
    else this.publish();
  }

  private dueFrom(now: number): number {
    if (this.isLast) return now;
    if (this.cutChanged) return this.pace.cutAt(now);
    return this.pace.meshAt(now, this.assembler.statistics(fieldsOf(this.display)).bytes);
  }

  private publish(): void {
    const display = this.now;
    const start = performance.now();
    const mesh = meshArrays(this.assembler, display.warp);
    if (!mesh) return;
    const kept = keptCells(mesh, display);
    // A finer mesh has another cut. Both travel together, so that they always match.
    const snapshot: Snapshot = {
      ...this.frame(mesh, display),
      cuts: cutsOf(mesh, display, kept),
      planes: cuttingPlanes(display),
    };
    if (this.meshChanged) {
      snapshot.surface =
        display.body && display.mode !== 'slice'
          ? surfaceOf(mesh, display, kept, this.creases?.of(mesh))
          : noSoup();
      Object.assign(snapshot, layerSoups(mesh, display, kept));
      snapshot.volume = this.volumeOf(mesh, display, kept);
    }
    this.drawnColor = snapshot.color;
    this.drawnWarp = snapshot.warp ?? null;
    this.drawnChunks = this.assembler.codec.chunksApplied;
    this.seen = textOf(display);
    this.meshChanged = this.cutChanged = this.isLast = false;
    const isFirst = !this.hasPublished;
    snapshot.costMs = this.pace.sends(start, snapshot.statistics.bytes, isFirst);
    this.send(snapshot);
    if (!isFirst) return;
    this.hasPublished = true;
    this.onFirst();
  }

  private volumeOf(
    mesh: MeshArrays,
    display: Display,
    kept: Uint8Array | null,
  ): VolumeCells | null {
    const scale = display.volume && colorScale(mesh, display);
    return scale ? volumeCells(mesh, scale, kept) : null;
  }

  /** The warp's field has values, so that it moves the mesh. */
  private isWarped(warp: Warp | null): warp is Warp {
    return warp !== null && this.assembler.codec.fieldChunksApplied(warp.field) > 0;
  }

  private measure({points, boundary, ...mesh}: MeshArrays, {color, warp}: Display): void {
    const info = color && this.assembler.manifest!.fields[color.field];
    const scale = info?.labels && color && mesh.scale(color);
    this.labels = scale ? shownLabels(scale, mesh.tetrahedra, info) : null;
    this.bounds = pointBounds(points, boundary);
    this.restBounds = this.isWarped(warp)
      ? pointBounds(this.assembler.codec.points(), boundary)
      : this.bounds;
  }

  private restEdges(
    mesh: MeshArrays,
    {restEdges, mode, planes}: Display,
  ): {restEdges?: Float32Array} {
    if (!restEdges || !this.creases) return {};
    // Planes cut them like the mesh, so that none lie before a cut. Round slices they stay whole.
    return {restEdges: this.creases.lines(mesh, mode === 'slice' ? [] : planes)};
  }

  private frame(mesh: MeshArrays, display: Display): Omit<Snapshot, 'cuts' | 'planes'> {
    const {color, labelColors, volume, warp} = display;
    const scale = colorScale(mesh, display);
    const info = color && this.assembler.manifest!.fields[color.field];
    const isComponent = info && info.components > 1 && color.component >= 0;
    const ofSeries = isComponent ? seriesExtent(info, color.component) : null;
    if (this.meshChanged || this.bounds.length === 0) this.measure(mesh, display);
    return {
      bounds: this.bounds,
      ...(this.isWarped(warp) && {
        warp: {...warp, restBounds: this.restBounds, ...this.restEdges(mesh, display)},
      }),
      color: scale ? color : null,
      ...(scale && this.labels && {labels: this.labels}),
      statistics: this.assembler.statistics(fieldsOf(this.display)),
      costMs: 0,
      // The range of a component is known from its values only; a series has one for all of it.
      extent: ofSeries ?? (scale && isComponent ? scale.extent(mesh.tetrahedra) : [0, 1]),
      middle:
        ofSeries ??
        (scale && !info?.instant
          ? keptOf(this.middles, display, () => middleOf(scale, mesh))
          : [0, 1]),
      ...(volume && scale
        ? {amounts: keptOf(this.amounts, display, () => amountsOf(scale, mesh))}
        : {}),
      scaleRange: labelColors
        ? kLabelScaleRange
        : color && scale && info
          ? scalarRange(info, color.component)
          : [0, 1],
    };
  }
}

/** The part of scalarRange that a component of a series can have; null for other fields. */
function seriesExtent(info: FieldInfo, component: number): [number, number] | null {
  if (!info.instant) return null;
  const [low, high] = scalarRange(info, component);
  const shareOf = (value: number): number =>
    high > low ? Math.min(1, Math.max(0, (value - low) / (high - low))) : 0;
  const [from, to] = info.instant.ranges[component]!;
  return [shareOf(from), shareOf(to)];
}

/** Fields ahead are not seen. */
function textOf(display: Display): string {
  return JSON.stringify({...display, ahead: []});
}

/** The value of a colour: as it was when it was first asked for. */
function keptOf<T>(values: Map<string, T>, {color, labelColors}: Display, first: () => T): T {
  const key = JSON.stringify([color, labelColors]);
  const value = values.get(key) ?? first();
  values.set(key, value);
  return value;
}
