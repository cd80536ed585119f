// Where the values of a plot over time come from: the server's answer, or the blocks of the
// instants. A plot has one of them at a time, so that values of two levels never stand side by
// side unseen.

import {errorCode} from '../../core/protocol/errors';
import type {FieldInfo} from '../../core/protocol/fields';
import type {Vector} from '../../core/protocol/geometry';
import type {Client} from '../../core/session/client';
import {
  kSeriesError,
  type SeriesServer,
  type SeriesValues,
} from '../../core/transport/series_server';
import {formatBytes, formatError} from '../page/format';
import type {ShownMesh} from '../page/shown_mesh';
import type {TimeTable} from './line_table';

export interface TimeValues extends Omit<TimeTable, 'field'> {
  /** A sentence on where the values come from, and how good they are. */
  readonly status: string;
  /** The exact values can be had by `askExact`. */
  readonly offersExact?: boolean;
  askExact?(): void;
  /** Must be called when more is here. */
  takeProgress?(): void;
  end(): void;
}

export interface BlocksHost {
  /** Null while it has another mesh than the one in the picture. */
  readonly client: Pick<Client, 'values'> | null;
  readonly mesh: ShownMesh;
}

/** Fetches the instants behind all else, and reads the values from those that are here. */
export class BlockValues implements TimeValues {
  readonly times: readonly number[];
  values: number[][];
  private readonly receivedBefore: number;
  private isAsking = false;
  /** More may be here than was asked for last. */
  private isStale = false;
  private isOver = false;

  /** `place` is on the lattice, `instants` are fields. `changed` is called with more values. */
  constructor(
    private readonly host: BlocksHost,
    private readonly place: Vector,
    private readonly instants: readonly number[],
    private readonly changed: () => void,
  ) {
    const {mesh} = host;
    this.times = instants.map((field) => mesh.manifest!.fields[field]!.instant!.time);
    this.values = instants.map(() => []);
    this.receivedBefore = mesh.progress.received;
    mesh.ahead.plotted = instants;
    this.takeProgress();
  }

  takeProgress(): void {
    this.isStale = true;
    if (!this.isAsking) void this.ask();
  }

  end(): void {
    this.isOver = true;
    this.host.mesh.ahead.plotted = [];
  }

  get status(): string {
    const {mesh} = this.host;
    const all = this.times.length;
    const here = this.values.filter(({length}) => length > 0).length;
    const end =
      here < all && mesh.progress.aheadEnded ? ' The others come when they are shown.' : '';
    const bytes = formatBytes(mesh.progress.received - this.receivedBefore);
    return `${here} of ${all} instants are here, ${bytes} so far.${end}`;
  }

  /** One question at a time. */
  private async ask(): Promise<void> {
    this.isAsking = true;
    while (this.isStale) {
      this.isStale = false;
      const found = await this.host.client?.values(this.place, this.instants);
      if (!found || this.isOver) return;
      this.values = found.map((values, i) => (values.length > 0 ? values : this.values[i]!));
      this.changed();
    }
    this.isAsking = false;
  }
}

export interface ServerQuestion {
  /** In the coordinates of the input. */
  point: Vector;
  /** An instant of the series. */
  field: FieldInfo;
  /** The number of the last level. */
  lastLevel: number;
}

export interface ServerListener {
  /** There are other values, or another status. */
  changed(): void;
  /** The server's answer, or why there is none, for screen readers. */
  announce(text: string): void;
  /** The server gives no values. */
  failed(): void;
}

/**
 * Asks the server once, and again when the exact values are wanted. Where a coarse level leaves out
 * a point of the surface, it gets the exact values at once.
 */
export class ServerValues implements TimeValues {
  private here: SeriesValues | null = null;
  private exact: 'unasked' | 'asked' | 'failed' = 'unasked';
  private readonly ends = new AbortController();

  constructor(
    private readonly server: SeriesServer,
    private readonly question: ServerQuestion,
    private readonly listener: ServerListener,
  ) {
    void this.ask(null, (code) => {
      if (code === 'not-found') void this.ask(question.lastLevel, () => listener.failed());
      else listener.failed();
    });
  }

  get times(): readonly number[] {
    return this.here?.times ?? [];
  }
  get values(): readonly number[][] {
    return this.here?.values ?? [];
  }

  get offersExact(): boolean {
    return this.here !== null && !this.isExact && this.exact !== 'asked';
  }

  get status(): string {
    const {here, isExact} = this;
    if (!here) return 'The server is asked for the values.';
    const error = `at most ${formatError(kSeriesError)}`;
    const quality = isExact
      ? 'exact'
      : this.question.field.labels
        ? `wrong in ${error} of the volume`
        : `rms error ${error}`;
    const level = `level ${here.level} of ${this.question.lastLevel}`;
    const more = {
      unasked: '',
      asked: ' The exact values are on their way.',
      failed: ' The server does not give the exact values now.',
    }[this.exact];
    return `${formatBytes(here.bytes)} from the server, ${quality}, ${level}.${more}`;
  }

  askExact(): void {
    this.exact = 'asked';
    this.listener.changed();
    void this.ask(this.question.lastLevel, () => {
      this.exact = 'failed';
      this.tell();
    });
  }

  end(): void {
    this.ends.abort();
  }

  private get isExact(): boolean {
    return this.here?.level === this.question.lastLevel;
  }

  /** `failed` is called with the error's code. */
  private async ask(level: number | null, failed: (code: string) => void): Promise<void> {
    const {point, field} = this.question;
    const {signal} = this.ends;
    try {
      const here = await this.server.values({point, field, level}, signal);
      if (signal.aborted) return;
      this.here = here;
    } catch (thrown) {
      if (!signal.aborted) failed(errorCode(thrown));
      return;
    }
    this.exact = 'unasked';
    this.tell();
  }

  private tell(): void {
    this.listener.changed();
    this.listener.announce(this.status);
  }
}
