// A series over time at a point: the values of its instants, from the server or from their blocks.

import {kMagnitude, type Scalar} from '../../core/picture/field_scale';
import {positionOf, type Vector} from '../../core/protocol/geometry';
import type {Manifest} from '../../core/protocol/manifest';
import {instantsOf} from '../../core/protocol/series';
import type {SeriesServer} from '../../core/transport/series_server';
import {formatIn} from '../page/format';
import {timeTitle, type TimeTable} from './line_table';
import type {TimeCurve, TimePlot} from './probe_plot';
import {BlockValues, ServerValues, type BlocksHost, type TimeValues} from './time_values';

export interface OverTimeHost extends BlocksHost {
  /** The server that has the log; null if none is known. */
  readonly seriesServer: SeriesServer | null;
  /** The scalar that colours, of a series at its shown instant; null for none. */
  readonly color: Scalar | null;
  /** Its title. */
  readonly fieldTitle: string;
  /** Brings the stream in line with the mesh's fields ahead. */
  apply(): void;
  /** Shows the instants at this time. */
  showTime(text: string): void;
  /** Tells screen readers. */
  announce(text: string): void;
}

/** Behind the status, where the plot is of one segment of a list. */
const kOfSegment = ' The plot has only the instants of the shown segment.';

/** The place of the plot. */
export interface TimeCard {
  /** Makes the plot, unless it is not wanted any more once uPlot is here. */
  open(choose: (i: number) => void, isWanted: () => boolean): Promise<TimePlot | null>;
  /** Offers the exact values, or not. */
  offerExact(isOffered: boolean): void;
  close(): void;
}

export class OverTime {
  /** On the lattice; null: there is no plot. */
  private place: Vector | null = null;
  /** The key of the plotted series. */
  private series: string | null = null;
  /** That of the instants: the same log's may come again with more of them. */
  private manifest: Manifest | null = null;
  private values: TimeValues | null = null;
  private plot: TimePlot | null = null;

  constructor(
    private readonly host: OverTimeHost,
    private readonly card: TimeCard,
  ) {}

  /** A series is shown. */
  get isOffered(): boolean {
    return this.shownSeries !== null;
  }

  get isOpen(): boolean {
    return this.place !== null;
  }

  async begin(place: Vector): Promise<void> {
    this.place = place;
    this.plot = this.series = null;
    this.update();
    this.host.apply();
    const isWanted = (): boolean => this.place === place;
    const plot = await this.card.open((i) => this.choose(i), isWanted);
    if (!plot || !isWanted()) return;
    this.plot = plot;
    this.draw();
  }

  end(): void {
    if (!this.isOpen) return;
    this.values?.end();
    this.place = this.plot = this.values = null;
    this.card.close();
  }

  /** Brings the plot in line with what is shown. A field that is no series ends it. */
  update(): void {
    if (!this.isOpen) return;
    const series = this.shownSeries;
    if (series === null) return this.end();
    const {manifest} = this.host.mesh;
    const isOther = series !== this.series;
    // the server's answer has all instants from the beginning
    const hasMore = manifest !== this.manifest && this.values instanceof BlockValues;
    this.series = series;
    this.manifest = manifest;
    if (isOther) this.use(() => this.serverValues() ?? this.blockValues());
    else if (hasMore) this.use(() => this.blockValues());
    this.draw();
  }

  /** Must be called when more is here. */
  takeProgress(): void {
    this.values?.takeProgress?.();
  }

  askExact(): void {
    this.values?.askExact?.();
  }

  /** The plotted values. REQUIRES: it is open. */
  table(): TimeTable {
    const {times, values} = this.values!;
    return {field: this.host.color!.field, times, values};
  }

  private get shownSeries(): string | null {
    const {color, mesh} = this.host;
    return (color && mesh.manifest?.fields[color.field]?.instant?.series) ?? null;
  }

  /** The one before ends first: both decide which instants are fetched. */
  private use(make: () => TimeValues): void {
    this.values?.end();
    this.values = make();
  }

  private serverValues(): TimeValues | null {
    const {color, mesh, seriesServer} = this.host;
    if (!seriesServer) return null;
    const {fields, lattice, levels} = mesh.manifest!;
    const question = {
      point: positionOf(lattice, this.place!),
      field: fields[color!.field]!,
      lastLevel: levels[levels.length - 1]!.level,
    };
    return new ServerValues(seriesServer, question, {
      changed: () => this.draw(),
      announce: (text) => this.host.announce(text),
      failed: () => {
        this.use(() => this.blockValues());
        this.draw();
        this.host.apply();
      },
    });
  }

  private blockValues(): TimeValues {
    const {mesh} = this.host;
    const instants = instantsOf(mesh.manifest!.fields, this.series!);
    return new BlockValues(this.host, this.place!, instants, () => this.draw());
  }

  private draw(): void {
    const {host, plot, values} = this;
    if (!host.color || !plot || !values) return;
    plot.show(this.curve(values, host.color));
    this.card.offerExact(values.offersExact === true);
  }

  private curve({times, values, status}: TimeValues, {field, component}: Scalar): TimeCurve {
    const {mesh, fieldTitle} = this.host;
    const info = mesh.manifest!.fields[field]!;
    const valueOf = (its: number[]): number => {
      if (its.length === 0) return NaN;
      if (its.length === 1) return its[0]!;
      return component === kMagnitude ? Math.hypot(...its) : its[component]!;
    };
    return {
      at: times,
      values: values.map(valueOf),
      title: fieldTitle,
      atTitle: timeTitle(mesh.manifest!.units?.get('')),
      format: info.labels && ((value) => formatIn(info, value)),
      time: info.instant!.time,
      status: `${status}${mesh.isOneOfSegments ? kOfSegment : ''}`,
    };
  }

  private choose(i: number): void {
    const {mesh} = this.host;
    const time = this.values?.times[i];
    if (time === undefined || !mesh.manifest) return;
    const its = mesh.manifest.fields.find(
      ({instant}) => instant?.series === this.series && instant.time === time,
    );
    this.host.showTime(its?.instant?.text ?? String(time));
  }
}
