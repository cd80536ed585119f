// The instants of the series that are shown: which there are, are here, and are on the screen.

import type {FieldInfo} from '../../core/protocol/fields';
import {instantsOf, isSameTime, nearestTo, shownInstant} from '../../core/protocol/series';
import type {StreamState} from '../../core/session/worker_messages';
import type {ShownMesh} from '../page/shown_mesh';

/** Instants that are fetched ahead of the one that is shown; the list changes at every half. */
const kAhead = 32;

/** The instants that are nearest to two times. */
export function partOf(
  times: TimeLine['times'],
  part: readonly [number, number],
): [number, number] {
  const [from, to] = part.map((time) => nearestTo(times, time));
  return [from!, to!];
}

export interface TimeLineHost {
  readonly mesh: ShownMesh;
  /** The state of another segment that is opened, before it has a picture; null: none is. */
  readonly opening: StreamState | null;
}

export class TimeLine {
  times: readonly {time: number; text: string}[] = [];
  /** The list of segments, or else the manifest, that `times` are of. */
  private known: unknown = null;
  /** For each series that colours or moves the mesh, by time: its field, -1 for none. */
  private tracks: number[][] = [];
  /** The manifest's fields and the keys of the series that `tracks` are of. */
  private tracked: unknown[] = [];

  constructor(private readonly host: TimeLineHost) {}

  /** Returns false if the mesh has the instants of before. */
  take(mesh: ShownMesh): boolean {
    const known = mesh.place?.list ?? mesh.manifest;
    if (this.known === known) return false;
    this.known = known;
    this.times = mesh.times;
    return true;
  }

  /** Follows these fields. A mesh may have thousands of instants: they are looked up once. */
  choose(shown: readonly number[], fields: readonly FieldInfo[]): void {
    const keys = shown.map((field) => fields[field]?.instant?.series);
    const series = [...new Set(keys.filter((key) => key !== undefined))];
    const tracked = [fields, ...series];
    const {length} = this.tracked;
    if (length === tracked.length && tracked.every((its, i) => its === this.tracked[i])) return;
    this.tracked = tracked;
    this.tracks = series.map((key) => {
      const instants = instantsOf(fields, key);
      const byTime = new Map(instants.map((field) => [fields[field]!.instant!.time, field]));
      const near = (time: number): number | undefined =>
        instants.find((field) => isSameTime(fields[field]!.instant!.time, time));
      return this.times.map(({time}) => byTime.get(time) ?? near(time) ?? -1);
    });
  }

  /** The fields to fetch while instant `at` plays, of the instants `from` to `to`. */
  ahead(at: number, [from, to]: readonly [number, number]): number[] {
    const place = at < from || at > to ? 0 : at - from;
    return this.tracks.flatMap((track) => fieldsAhead(track.slice(from, to + 1), place));
  }

  /** False without a series. */
  isHere(at: number): boolean {
    const {mesh, opening} = this.host;
    const fields = this.tracks.map((track) => track[at % this.times.length]!);
    const areHere = fields.every((field) => mesh.progress.here.includes(field));
    return opening === null && fields.length > 0 && areHere;
  }

  isOnScreen(at: number): boolean {
    const {mesh, opening} = this.host;
    if (opening !== null || this.awaitsFrame) return false;
    const {manifest, snapshot} = mesh;
    const colored = snapshot?.inputs ?? [snapshot?.color?.field];
    const seen = [...colored, snapshot?.warp?.field];
    return this.tracks.every((track) => {
      const field = track[at] ?? -1;
      return !manifest || field < 0 || seen.includes(shownInstant(manifest.fields, field));
    });
  }

  get awaitsFrame(): boolean {
    return this.host.opening === null && this.host.mesh.awaitsFrame;
  }

  /** Another segment is under way. */
  get isOpening(): boolean {
    const {opening} = this.host;
    return opening !== null && opening !== 'failed';
  }

  /** Both instants are of one segment. */
  areTogether(a: number, b: number): boolean {
    const {instants} = this.host.mesh.place?.list ?? {};
    const [one, other] = [a, b].map((at) => instants?.[at % this.times.length]?.segment);
    return one === other;
  }
}

/** By time the fields of a series (-1: none): those to fetch while the one at `at` is shown. */
export function fieldsAhead(fields: readonly number[], at: number): number[] {
  const half = kAhead / 2;
  const from = at - (at % half);
  const round = [...fields.slice(from), ...fields.slice(0, from)];
  return round.slice(0, kAhead).filter((field) => field >= 0);
}
