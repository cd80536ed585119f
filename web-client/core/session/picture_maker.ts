// Makes pictures of the mesh as it is now: what is drawn, and the figures that go with it.

import type {Assembler} from '../decode/assembler';
import {partCells} from '../layers/parts';
import {isJagged, keptCells, layerSoups, type LayerSoups} from '../layers/shown';
import {derivation} from '../picture/derivation';
import {derivedIn, infoIn} from '../picture/derived_field';
import {
  colorScale,
  cutsOf,
  cuttingPlanes,
  surfaceOf,
  type Display,
  type MeshArrays,
} from '../picture/display';
import {scalarRange} from '../picture/field_scale';
import {kLabelScaleRange, shownLabels, type ShownLabels} from '../picture/labels';
import {meshArrays} from '../picture/mesh_arrays';
import {amountsOf, middleOf} from '../picture/spread';
import {lateMaking} from '../picture/late_making';
import {noSoup, pointBounds, type CreasesOf} from '../picture/triangle_soup';
import type {Warp} from '../picture/warp';
import type {FieldInfo} from '../protocol/fields';
import {KeptCreases} from './kept_creases';
import type {Snapshot} from './worker_messages';

export type Picture = Omit<Snapshot, 'statistics' | 'costMs'>;
type Body = Pick<Snapshot, 'surface' | 'volume' | 'streamlines' | keyof LayerSoups>;

/** Measuring these takes time. They change with the surface only. */
interface Measures {
  bounds: number[];
  /** The same without a warp. */
  restBounds: number[];
  /** Those of the colour; null: it is no label. */
  labels: ShownLabels | null;
}

export class PictureMaker {
  /** Null: pictures have no creases yet. */
  private creases: KeptCreases | null = null;
  private measures: Measures | null = null;
  /** middleOf by colour, from the mesh with which it was first drawn. */
  private readonly middles = new Map<string, [number, number]>();
  /** amountsOf by colour, from the mesh whose volume was first drawn. */
  private readonly amounts = new Map<string, number[]>();

  constructor(private readonly assembler: Assembler) {}

  get hasCreases(): boolean {
    return this.creases !== null;
  }

  useCreases(creasesOf: CreasesOf): void {
    this.creases = new KeptCreases(this.assembler.codec, creasesOf);
  }

  /** Must be called before another mesh. */
  forget(): void {
    this.measures = null;
    this.middles.clear();
    this.amounts.clear();
    this.creases?.forget();
  }

  /** `isOnlyCut`: the surface is the last picture's. Null while there is no mesh. */
  make(display: Display, isOnlyCut: boolean): Picture | null {
    const mesh = meshArrays(this.assembler, display);
    if (!mesh) return null;
    mesh.paint = (display.parts && partCells.paint?.(mesh, display.parts)) ?? null;
    const kept = keptCells(mesh, display);
    const measures = isOnlyCut && this.measures ? this.measures : this.measure(mesh, display);
    this.measures = measures;
    // A finer mesh has another cut. Both travel together, so that they always match.
    return {
      ...this.figures(mesh, display, measures),
      cuts: cutsOf(mesh, display, kept),
      planes: cuttingPlanes(display),
      // Only those on what is drawn depend on planes.
      ...((!isOnlyCut || display.arrows?.places === 'shown') && {
        arrows: lateMaking.arrows?.(this.assembler, {...mesh, kept}, display) ?? null,
      }),
      ...(!isOnlyCut && this.body(mesh, display, kept)),
    };
  }

  private body(mesh: MeshArrays, display: Display, kept: Uint8Array | null): Body {
    const hasSurface = display.body && display.mode !== 'slice';
    const scale = display.volume && colorScale(mesh, display);
    const creasesOf = isJagged(mesh, display) ? null : this.creases?.of(mesh);
    return {
      surface: hasSurface ? surfaceOf(mesh, display, kept, creasesOf) : noSoup(),
      ...layerSoups(mesh, display, kept),
      volume: (scale ? lateMaking.volume?.(mesh, scale, kept) : null) ?? null,
      streamlines: lateMaking.lines?.(this.assembler, {...mesh, kept}, display) ?? null,
    };
  }

  /** The warp's field has values, so that it moves the mesh. */
  private isWarped(warp: Warp | null): warp is Warp {
    return warp !== null && this.assembler.codec.fieldChunksApplied(warp.field) > 0;
  }

  private infoOf(display: Display): FieldInfo | null {
    const {color} = display;
    return color && infoIn(display, this.assembler.manifest!, color.field);
  }

  private measure({points, boundary, ...mesh}: MeshArrays, display: Display): Measures {
    const {color, warp} = display;
    const info = this.infoOf(display);
    const scale = info?.labels && color && mesh.scale(color);
    const bounds = pointBounds(points, boundary);
    const rest = this.isWarped(warp) && this.assembler.codec.points();
    return {
      bounds,
      restBounds: rest ? pointBounds(rest, boundary) : bounds,
      labels: scale ? shownLabels(scale, mesh.tetrahedra, info) : null,
    };
  }

  private restEdges(
    mesh: MeshArrays,
    {restEdges, mode, planes}: Display,
  ): {restEdges?: Float32Array} {
    if (!restEdges || !this.creases) return {};
    // Planes cut them like the mesh, so that none lie before a cut. Round slices they stay whole.
    return {restEdges: this.creases.lines(mesh, mode === 'slice' ? [] : planes)};
  }

  private figures(
    mesh: MeshArrays,
    display: Display,
    {bounds, restBounds, labels}: Measures,
  ): Omit<Picture, 'cuts' | 'planes'> {
    const {color, labelColors, volume, warp} = display;
    const scale = colorScale(mesh, display);
    const info = this.infoOf(display);
    const isComponent = color && info && info.components > 1 && color.component >= 0;
    const ofSeries = isComponent ? seriesExtent(info, color.component) : null;
    const derived = scale && derivation.color?.(mesh, display, scale, this.assembler.manifest!);
    const ofAll = ofSeries ?? derived?.ofSeries;
    const isMoved = this.isWarped(warp);
    return {
      bounds,
      ...(isMoved && {warp: {...warp, restBounds, ...this.restEdges(mesh, display)}}),
      color: scale ? color : null,
      ...(scale && labels && {labels}),
      // The range of a component is known from its values only; a series has one for all of it.
      extent:
        ofSeries ??
        derived?.extent ??
        (scale && isComponent ? scale.extent(mesh.tetrahedra) : [0, 1]),
      middle:
        ofAll ??
        (scale && !info?.instant
          ? keptOf(this.middles, display, () => middleOf(scale, mesh, derived?.extent))
          : [0, 1]),
      ...derived?.made,
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

/** The value of a colour: as it was when it was first asked for. */
function keptOf<T>(values: Map<string, T>, display: Display, first: () => T): T {
  const {color, labelColors} = display;
  const key = [
    color?.field,
    color && derivedIn(display, color.field)?.id,
    color?.component,
    labelColors === true,
  ].join();
  const value = values.get(key) ?? first();
  values.set(key, value);
  return value;
}
