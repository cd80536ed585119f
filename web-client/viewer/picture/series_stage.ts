// The instants of the shown series that play, one after the other, each wholly on the screen. The
// attribute `time` stays as it is, so that neither the address nor the steps of undo change.

import type {FieldInfo} from '../../core/protocol/fields';
import {instantsOf, isSameTime} from '../../core/protocol/series';
import type {Snapshot, StreamState} from '../../core/session/worker_messages';
import type {View} from '../../webgl/view';
import type {ShownMesh} from '../page/shown_mesh';
import type {Settings} from '../settings/settings';
import {fieldsAhead, partOf} from '../panels/time_line';
import type {Stage} from './film';

export interface StageHost {
  readonly view: View | null;
  readonly mesh: ShownMesh;
  readonly settings: Settings;
  readonly stream: {readonly state: StreamState};
  /** Brings the picture in line with the mesh. */
  apply(): void;
}

const kPollMs = 20;
/** An instant is lost if nothing of it comes for so long. */
const kPatienceMs = 60000;
/** The stream asks for nothing more by itself. */
const kRest: readonly StreamState[] = ['complete', 'held', 'paused', 'failed'];

/** The key of the series that colours the mesh, or else moves it. */
export function seriesIn(
  snapshot: Snapshot | null,
  fields: readonly FieldInfo[],
): string | undefined {
  const {color, inputs = [color?.field], warp} = snapshot ?? {};
  const shown = [...inputs, warp?.field].map((field) => fields[field ?? -1]?.instant?.series);
  return shown.find((series) => series !== undefined);
}

export class SeriesStage implements Stage {
  readonly instants: readonly number[];
  private readonly mesh: ShownMesh;
  private readonly series: string;

  /** Throws if no series is shown. */
  constructor(
    private readonly host: StageHost,
    private readonly onlyLoaded: boolean,
    readonly draw: () => Promise<OffscreenCanvas>,
  ) {
    const {manifest, snapshot, progress} = (this.mesh = host.mesh);
    const {here} = progress;
    const fields = manifest?.fields ?? [];
    const series = seriesIn(snapshot, fields);
    if (series === undefined)
      throw new Error('No series is shown. A movie shows the instants of one.');
    this.series = series;
    const all = this.played(instantsOf(fields, series), fields);
    this.instants = onlyLoaded ? all.filter((field) => here.includes(field)) : all;
    if (this.instants.length === 0)
      throw new Error(
        all.length === 0 ? 'The part that plays is in another segment.' : 'No instant is loaded.',
      );
  }

  /** Those of the part that plays. */
  private played(instants: readonly number[], fields: readonly FieldInfo[]): readonly number[] {
    const {mesh, settings} = this.host;
    if (!settings.timePart) return instants;
    const [first, last] = partOf(mesh.times, settings.timePart).map((at) => mesh.times[at]!.time);
    const isPlayed = (time: number): boolean =>
      (time > first! && time < last!) || isSameTime(time, first!) || isSameTime(time, last!);
    return instants.filter((field) => isPlayed(fields[field]!.instant!.time));
  }

  async show(i: number, signal: AbortSignal): Promise<void> {
    const {mesh, instants, onlyLoaded} = this;
    const field = instants[i]!;
    const {time} = mesh.manifest!.fields[field]!.instant!;
    mesh.ahead.filmed = {time, ahead: onlyLoaded ? [] : fieldsAhead(instants, i)};
    this.host.apply();
    let {bytes} = mesh.progress.statistics;
    let since = performance.now();
    for (;;) {
      signal.throwIfAborted();
      this.check(field);
      if (this.isWhole(field)) return;
      await new Promise((resolve) => setTimeout(resolve, kPollMs));
      const now = performance.now();
      // A hidden page draws nothing.
      if (document.hidden || mesh.progress.statistics.bytes !== bytes) since = now;
      ({bytes} = mesh.progress.statistics);
      if (now - since > kPatienceMs) this.lost(field, `nothing came for ${kPatienceMs / 1000} s`);
    }
  }

  restore(): void {
    const {host, mesh} = this;
    mesh.ahead.filmed = null;
    if (host.mesh === mesh) host.apply();
  }

  /** Throws if the instant cannot come any more. */
  private check(field: number): void {
    const {host, mesh} = this;
    const {fields} = mesh.manifest!;
    if (host.mesh !== mesh) throw new Error('Another mesh was opened.');
    if (!host.view) throw new Error('The graphics have stopped.');
    if (seriesIn(mesh.snapshot, fields) !== this.series)
      throw new Error('Another field was chosen.');
    if (mesh.progress.here.includes(field)) return;
    const {state} = host.stream;
    if (state === 'failed') this.lost(field, 'the stream has failed');
    if (state === 'paused') this.lost(field, 'the stream is paused');
  }

  private lost(field: number, why: string): never {
    const {text} = this.mesh.manifest!.fields[field]!.instant!;
    throw new Error(`The instant t = ${text} did not come: ${why}.`);
  }

  /** No other picture of the instant follows by itself. */
  private isWhole(field: number): boolean {
    const {snapshot, drawn, progress} = this.mesh;
    const {here, statistics} = progress;
    if (drawn === null || drawn !== snapshot?.statistics) return false;
    if (!this.isSeen(field, snapshot)) return false;
    if (!here.includes(field) || !kRest.includes(this.host.stream.state)) return false;
    return drawn.bytes >= Math.min(drawn.bytesNeeded, statistics.bytes);
  }

  /** The instant colours or moves the mesh. Another series that moves it shows the same time. */
  private isSeen(field: number, {color, inputs = [color?.field ?? -1], warp}: Snapshot): boolean {
    const {progress, manifest} = this.mesh;
    const {here} = progress;
    if (!warp) return inputs.includes(field);
    const isOfTime = manifest!.fields[warp.field]!.instant?.isShown !== false;
    return (
      (inputs.includes(field) || warp.field === field) && isOfTime && here.includes(warp.field)
    );
  }
}
