// A viewer's state of the mesh that it shows. Another mesh gets another object.

import type {LevelBytes} from '../../core/decode/plan';
import {kNoStatistics, type Statistics} from '../../core/decode/statistics';
import {axisNormal, clip} from '../../core/layers/clip';
import {kLayers} from '../../core/layers/layers';
import {firstOpacities, type Amounts} from '../../core/layers/volume';
import type {BaseFigures} from '../../core/picture/base_figures';
import type {Scalar} from '../../core/picture/field_scale';
import {labelsOf} from '../../core/picture/labels';
import type {FieldInfo} from '../../core/protocol/fields';
import type {Manifest} from '../../core/protocol/manifest';
import {showTime} from '../../core/protocol/series';
import type {Snapshot} from '../../core/session/worker_messages';
import {placeOn} from '../../core/picture/log_scale';
import {
  labelRange,
  readSettings,
  shownRange,
  shownScalar,
  type Settings,
  type ShownRange,
  type ViewAttribute,
} from '../settings/settings';

/** Fields that are asked for ahead at once. A server takes 1,024 names in a request. */
export const kMaxAhead = 512;

export class ShownMesh {
  /** Null before the head of the log is here. */
  manifest: Manifest | null = null;
  /** SHA-256 of the log, or another tag of it; empty before its head is here. */
  digest = '';
  /** The base mesh's, in lattice coordinates; empty before it is decoded. */
  bounds: number[] = [];
  /** The mean length of lines through the mesh, as a share of its diagonal. */
  chord = 0;
  /** The levels ahead. */
  plan: LevelBytes[] = [];
  /** The newest figures. */
  statistics: Statistics = kNoStatistics;
  /** Bytes of the log that have come. */
  received = 0;
  /** The fields that are here for all of the mesh. */
  here: readonly number[] = [];
  /** Fields that the playing series shows soon. */
  playing: readonly number[] = [];
  /** Fields that are plotted over time. */
  plotted: readonly number[] = [];
  /**
   * The instant that a movie shows instead of the attribute's, and the fields that it shows soon;
   * null: no movie is made.
   */
  filmed: {time: number; ahead: readonly number[]} | null = null;
  /** An error keeps the fields ahead from coming. */
  aheadEnded = false;
  /** The newest picture. */
  snapshot: Snapshot | null = null;
  /** A picture that waits for a view. */
  waiting: Snapshot | null = null;
  /** Some values in the picture are missing. */
  hasMissing = false;
  /** The figures of the picture on the screen; null if there is none. */
  drawn: Statistics | null = null;

  /** The field that is shown if no attribute names one. */
  get firstField(): number {
    return this.manifest?.opening?.field ?? 0;
  }

  /** Fields that are wanted behind the shown ones. */
  get ahead(): number[] {
    const all = [...new Set([...(this.filmed?.ahead ?? []), ...this.playing, ...this.plotted])];
    if (all.length <= kMaxAhead) return all;
    const here = new Set(this.here);
    return all.filter((field) => !here.has(field)).slice(0, kMaxAhead);
  }

  takeBase({bounds, chord}: BaseFigures): void {
    Object.assign(this, {bounds, chord});
  }

  take(snapshot: Snapshot): void {
    // Other figures are newer than a picture that waited for a view.
    if (this.statistics === kNoStatistics) this.statistics = snapshot.statistics;
    this.snapshot = snapshot;
    if (!snapshot.surface) return; // a new cut of the same mesh
    this.hasMissing = [snapshot.surface, ...snapshot.cuts].some(({values}) =>
      values.some(Number.isNaN),
    );
  }

  /** The whole mesh is on the screen. The decoder may have finished long before. */
  get isDrawn(): boolean {
    return this.drawn !== null && this.drawn.bytes >= this.statistics.bytesNeeded;
  }
}

/** The settings of the attributes, with what the mesh decides where they say nothing. */
export function settingsFor(
  {manifest, firstField, chord, snapshot, filmed}: ShownMesh,
  read: (name: ViewAttribute) => string | null,
): Settings {
  const settings = readSettings(read);
  if (filmed) settings.time = filmed.time;
  const fields = manifest?.fields ?? [];
  showTime(fields, settings.time);
  const shown = shownScalar(read('field'), fields, firstField);
  if (read('colormap') === null && shown && labelsOf(fields[shown.field]!)) settings.map = 'labels';
  if (settings.hasFirstOpacities)
    settings.volume = firstOpacities(chord, amountsIn(snapshot, manifest, settings));
  const firstCut = manifest?.opening?.cut ?? null;
  const saysWhat = kLayers.some(({name}) => name !== clip.name && read(name) !== null);
  settings.hasFirstCut = firstCut !== null && !saysWhat && read('surface') === null;
  if (settings.hasFirstCut && read('clip') === null)
    settings.planes = [{normal: axisNormal(firstCut!, false), share: 0.5}];
  return settings;
}

/** How much of the volume has which values; null if that is not known. */
function amountsIn(
  snapshot: Snapshot | null,
  manifest: Manifest | null,
  settings: Settings,
): Amounts | null {
  const range = snapshot && manifest && rangeOf(snapshot, manifest, settings);
  if (!range || !snapshot.amounts) return null;
  const [from, to] = snapshot.scaleRange;
  const placeOf = (share: number): number => {
    const value = from + share * (to - from);
    const isBelow = range.logarithmic && range.low > 0 && value <= 0;
    return isBelow ? 0 : placeOn(range, value);
  };
  return {shares: snapshot.amounts, placeOf};
}

/** The range of the colours; null if nothing is coloured. */
export function rangeOf(
  {color, scaleRange, extent, middle}: Snapshot,
  {fields}: Manifest,
  settings: Settings,
): Omit<ShownRange, 'hasMissing'> | null {
  if (!color) return null;
  const labels = settings.map === 'labels' && labelsOf(fields[color.field]!);
  if (labels) return labelRange(labels);
  const own = settings.range === 'instant' ? ownRange(fields[color.field]!, color) : null;
  if (own) return shownRange(settings, own);
  const [low, high] = scaleRange;
  const valueAt = (share: number): number => low + share * (high - low);
  const valuesAt = ([from, to]: [number, number]): [number, number] => [valueAt(from), valueAt(to)];
  const range = settings.range === 'instant' ? 'auto' : settings.range;
  return shownRange({...settings, range}, valuesAt(extent), valuesAt(middle));
}

/** The range of an instant alone; null for other fields, and if its values are all equal. */
function ownRange({instant}: FieldInfo, {component}: Scalar): [number, number] | null {
  if (!instant) return null;
  const {range, ranges} = instant.own;
  const [low, high] = ranges.length > 1 ? (ranges[component] ?? range) : range;
  return low < high ? [low, high] : null;
}
