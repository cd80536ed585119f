// A viewer's state of the mesh that it shows. Another mesh gets another object.

import type {LevelBytes} from '../../core/decode/plan';
import {kNoStatistics, type Statistics} from '../../core/decode/statistics';
import {axisNormal, clip} from '../../core/layers/clip';
import {kLayers} from '../../core/layers/layers';
import {firstOpacities, type Amounts} from '../../core/layers/volume';
import type {BaseFigures} from '../../core/picture/base_figures';
import {parseScalar, scalarText} from '../../core/layers/field_values';
import {kMagnitude, type Scalar} from '../../core/picture/field_scale';
import {labelsOf} from '../../core/picture/labels';
import type {SeriesRanges} from '../../core/protocol/fields';
import type {Manifest} from '../../core/protocol/manifest';
import {listedInstant, type SegmentList} from '../../core/protocol/segment_list';
import {openingTime, showTime, timesOf} from '../../core/protocol/series';
import type {LogFigures, Snapshot} from '../../core/session/worker_messages';
import {placeOn} from '../../core/picture/log_scale';
import {FieldsAhead} from './fields_ahead';
import type {OwnFields} from './own_fields';
import {KnownRanges, type SegmentRanges} from './known_ranges';
import {
  labelRange,
  readSettings,
  shownRange,
  shownScalar,
  type Settings,
  type ShownRange,
  type ViewAttribute,
} from '../settings/settings';
import {firstWarp} from '../settings/warp';

/** A log's place in a list of segments. */
export interface SegmentPlace {
  list: SegmentList;
  segment: number;
}

export class ShownMesh {
  /** Null before the head of the log is here. */
  manifest: Manifest | null = null;
  /** SHA-256 of the log, or another tag of it; empty before its head is here. */
  digest = '';
  /** The base mesh's; without bounds before it is decoded. */
  base: BaseFigures = {bounds: [], chord: 0};
  /** The levels ahead. */
  plan: LevelBytes[] = [];
  progress: LogFigures = {statistics: kNoStatistics, received: 0, here: [], aheadEnded: false};
  readonly ahead = new FieldsAhead();
  /** Its derived fields: null without any, true until what reads them is loaded. */
  own: OwnFields | true | null = null;
  /** The label of the part that stands out; null: none does. */
  selectedPart: number | null = null;
  /** The newest picture. */
  snapshot: Snapshot | null = null;
  /** Some values in the picture are missing. */
  hasMissing = false;
  /** The figures of the picture on the screen; null if there is none. */
  drawn: Statistics | null = null;

  /** The opening of the list's segment before; null: there was none. */
  private heritage: {field: string; cut: number | null} | null = null;
  private ranges = new KnownRanges();

  /** `place` is null for a log that stands alone. */
  constructor(readonly place: SegmentPlace | null = null) {}

  get derived(): OwnFields | null {
    return this.own === true ? null : this.own;
  }

  /** It has derived fields that are not known yet. */
  get isDeriving(): boolean {
    return this.own === true || this.own?.isAwaited === true;
  }

  /** The mesh of another segment. It opens as this one did. */
  successor(place: SegmentPlace | null): ShownMesh {
    const next = new ShownMesh(place);
    const {firstCut, firstField, heritage, manifest} = this;
    const isKnown = manifest !== null && manifest.fields.length > 0;
    const shown = {field: firstField, component: kMagnitude};
    next.heritage = isKnown ? {field: scalarText(shown, manifest.fields), cut: firstCut} : heritage;
    next.ranges = this.ranges;
    return next;
  }

  /** Another segment of its list was shown before. */
  get isSuccessor(): boolean {
    return this.heritage !== null;
  }

  /** The field that is shown if no attribute names one. */
  get firstField(): number {
    const {heritage, manifest} = this;
    const kept = manifest && heritage ? parseScalar(heritage.field, manifest.fields) : null;
    return kept?.field ?? manifest?.opening?.field ?? 0;
  }

  /** The same as a key, from the segment before; empty if there was none. */
  get keptField(): string {
    return this.heritage?.field ?? '';
  }

  /** The axis across which the mesh opens cut; null for none. */
  get firstCut(): number | null {
    return this.heritage ? this.heritage.cut : (this.manifest?.opening?.cut ?? null);
  }

  /** The instants of the log, or of all segments of its list, ascending. */
  get times(): readonly {time: number; text: string}[] {
    return this.place?.list.instants ?? timesOf(this.manifest?.fields ?? []);
  }

  /** The time that it opens at; null without a series. */
  get firstTime(): {time: number; text: string} | null {
    const {manifest, place} = this;
    if (place) return listedInstant(place.list, null);
    return openingTime(manifest?.fields ?? [], manifest?.opening?.field ?? 0);
  }

  /** The range of the colours in a picture of this mesh; null if nothing is coloured. */
  rangeOf(snapshot: Snapshot, settings: Settings): Omit<ShownRange, 'hasMissing'> | null {
    const {manifest, place, ranges} = this;
    if (!manifest) return null;
    return rangeOf(snapshot, manifest, settings, (field, its) =>
      place ? ranges.join(field, place.segment, its) : its,
    );
  }

  take(snapshot: Snapshot): void {
    // Other figures are newer than a picture that waited for a view.
    if (this.progress.statistics === kNoStatistics) this.progress.statistics = snapshot.statistics;
    // A new cut leaves lines, and most arrows, as they are.
    const {streamlines, arrows} = this.snapshot ?? {};
    this.snapshot = {...(streamlines && {streamlines}), ...(arrows && {arrows}), ...snapshot};
    this.derived?.fit(snapshot);
    if (!snapshot.surface) return; // a new cut of the same mesh
    this.hasMissing = [snapshot.surface, ...snapshot.cuts].some(({values}) =>
      values.some(Number.isNaN),
    );
  }

  /** Its list has instants of other segments, too. */
  get isOneOfSegments(): boolean {
    return this.place !== null && this.place.list.logs.length > 1;
  }

  /**
   * A segment's first picture is on its way to the screen. Nothing else holds back segments that
   * follow each other: each one begins with a decoder that waits for no picture.
   */
  get awaitsFrame(): boolean {
    return this.place !== null && this.snapshot !== null && this.drawn === null;
  }

  /** The whole mesh is on the screen. The decoder may have finished long before. */
  get isDrawn(): boolean {
    return this.drawn !== null && this.drawn.bytes >= this.progress.statistics.bytesNeeded;
  }
}

/** The settings of the attributes, with what the mesh decides where they say nothing. */
export function settingsFor(
  mesh: ShownMesh,
  read: (name: ViewAttribute) => string | null,
): Settings {
  const {ahead, base, manifest, firstCut, firstField, place} = mesh;
  const settings = readSettings(read);
  if (ahead.filmed) settings.time = ahead.filmed.time;
  else if (place) settings.time = listedInstant(place.list, settings.time).time;
  const fields = manifest?.fields ?? [];
  showTime(fields, settings.time);
  settings.warp ??= firstWarp({manifest, ...base});
  const shown = shownScalar(read('field'), fields, firstField);
  if (read('colormap') === null && shown && labelsOf(fields[shown.field]!)) settings.map = 'labels';
  if (settings.hasFirstOpacities)
    settings.volume = firstOpacities(base.chord, amountsIn(mesh, settings));
  const saysWhat = kLayers.some(({name}) => name !== clip.name && read(name) !== null);
  settings.hasFirstCut = firstCut !== null && !saysWhat && read('surface') === null;
  if (settings.hasFirstCut && read('clip') === null)
    settings.planes = [{normal: axisNormal(firstCut!, false), share: 0.5}];
  return settings;
}

/** How much of the volume has which values; null if that is not known. */
function amountsIn(mesh: ShownMesh, settings: Settings): Amounts | null {
  const {snapshot} = mesh;
  const range = snapshot && mesh.rangeOf(snapshot, settings);
  if (!range || !snapshot.amounts) return null;
  const [from, to] = snapshot.scaleRange;
  const placeOf = (share: number): number => {
    const value = from + share * (to - from);
    const isBelow = range.logarithmic && range.low > 0 && value <= 0;
    return isBelow ? 0 : placeOn(range, value);
  };
  return {shares: snapshot.amounts, placeOf};
}

/**
 * The range of the colours; null if nothing is coloured. `join` adds what is known of the field in
 * other meshes.
 */
export function rangeOf(
  {color, scaleRange, extent, middle}: Snapshot,
  {fields}: Manifest,
  settings: Settings,
  join: (field: string, its: SegmentRanges) => SegmentRanges = (_, its) => its,
): Omit<ShownRange, 'hasMissing'> | null {
  if (!color) return null;
  const labels = settings.map === 'labels' && labelsOf(fields[color.field]!);
  if (labels) return labelRange(labels);
  const {instant} = fields[color.field]!;
  if (settings.range === 'instant' || settings.range === 'auto') {
    const ranges = settings.range === 'instant' ? instant?.own : instant?.alike;
    const its = ranges && rangeAmong(ranges, color);
    if (its) return shownRange(settings, its);
  }
  const [low, high] = scaleRange;
  const valueAt = (share: number): number => low + share * (high - low);
  const valuesAt = ([from, to]: [number, number]): [number, number] => [valueAt(from), valueAt(to)];
  const range = settings.range === 'instant' ? 'auto' : settings.range;
  const alone = {extent: valuesAt(extent), middle: valuesAt(middle)};
  const all = join(scalarText(color, fields), alone);
  return shownRange({...settings, range}, all.extent, all.middle);
}

/** The range of the scalar; null if its values are all equal. */
function rangeAmong({range, ranges}: SeriesRanges, {component}: Scalar): [number, number] | null {
  const [low, high] = ranges.length > 1 ? (ranges[component] ?? range) : range;
  return low < high ? [low, high] : null;
}
