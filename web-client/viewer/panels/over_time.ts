// A series over time at a point: fetches its instants and plots those that are here.

import {kMagnitude, type Scalar} from '../../core/picture/field_scale';
import type {Vector} from '../../core/protocol/geometry';
import type {Manifest} from '../../core/protocol/manifest';
import {instantsOf} from '../../core/protocol/series';
import type {Client} from '../../core/session/client';
import type {ShownMesh} from '../page/shown_mesh';
import type {TimeCurve, TimePlot} from './probe_plot';

export interface OverTimeHost {
  readonly client: Pick<Client, 'values'> | null;
  readonly mesh: ShownMesh;
  /** The scalar that colours, of a series at its shown instant; null for none. */
  readonly color: Scalar | null;
  /** Its title. */
  readonly fieldTitle: string;
  /** Brings the stream in line with the mesh's fields ahead. */
  apply(): void;
  /** Shows the instants at this time. */
  showTime(text: string): void;
}

/** The place of the plot. */
export interface TimeCard {
  /** Makes the plot, unless it is not wanted any more once uPlot is here. */
  open(choose: (i: number) => void, isWanted: () => boolean): Promise<TimePlot | null>;
  close(): void;
}

export class OverTime {
  /** On the lattice; null: there is no plot. */
  private place: Vector | null = null;
  /** The key of the plotted series. */
  private series: string | null = null;
  /** That of the instants: the same log's may come again with more of them. */
  private manifest: Manifest | null = null;
  /** Fields, by time. */
  private instants: readonly number[] = [];
  /** By instant: one value a component, none before it is here. A new mesh replaces them. */
  private values: number[][] = [];
  private plot: TimePlot | null = null;
  private isAsking = false;
  /** More may be here than was asked for last. */
  private isStale = false;

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
    this.place = this.plot = null;
    this.host.mesh.plotted = [];
    this.card.close();
  }

  /** Brings the plot in line with what is shown. A field that is no series ends it. */
  update(): void {
    if (!this.isOpen) return;
    const {mesh} = this.host;
    const series = this.shownSeries;
    if (series === null) return this.end();
    const {manifest} = mesh;
    if (series !== this.series || manifest !== this.manifest) {
      this.series = series;
      this.manifest = manifest;
      this.instants = instantsOf(manifest!.fields, series);
      this.values = this.instants.map(() => []);
      mesh.plotted = this.instants;
      void this.ask();
    }
    this.draw();
  }

  /** Must be called when more is here. */
  takeProgress(): void {
    if (this.isOpen) void this.ask();
  }

  table(): {instants: readonly number[]; values: readonly number[][]} {
    return {instants: this.instants, values: this.values};
  }

  private get shownSeries(): string | null {
    const {color, mesh} = this.host;
    return (color && mesh.manifest?.fields[color.field]?.instant?.series) ?? null;
  }

  /** One question at a time. */
  private async ask(): Promise<void> {
    this.isStale = true;
    if (this.isAsking) return;
    this.isAsking = true;
    while (this.isStale && this.place) {
      this.isStale = false;
      const {place, instants} = this;
      const found = await this.host.client!.values(place, instants);
      if (place !== this.place || instants !== this.instants) this.isStale = true;
      else this.take(found);
    }
    this.isAsking = false;
  }

  private take(found: number[][]): void {
    this.values = found.map((values, i) => (values.length > 0 ? values : this.values[i]!));
    this.draw();
  }

  private draw(): void {
    if (this.host.color) this.plot?.show(this.curve(this.host.color));
  }

  private curve({field, component}: Scalar): TimeCurve {
    const {mesh, fieldTitle} = this.host;
    const timeOf = (instant: number): number => mesh.manifest!.fields[instant]!.instant!.time;
    const valueOf = (values: number[]): number => {
      if (values.length === 0) return NaN;
      if (values.length === 1) return values[0]!;
      return component === kMagnitude ? Math.hypot(...values) : values[component]!;
    };
    return {
      at: this.instants.map(timeOf),
      values: this.values.map(valueOf),
      title: fieldTitle,
      time: timeOf(field),
      status: this.status,
    };
  }

  private get status(): string {
    const {fieldTitle, mesh} = this.host;
    const all = this.instants.length;
    const here = this.values.filter(({length}) => length > 0).length;
    if (here === all) return fieldTitle;
    const end = mesh.aheadEnded ? ' The others come when they are shown.' : '';
    return `${here} of ${all} instants are here.${end}`;
  }

  private choose(i: number): void {
    const instant = this.instants[i];
    const fields = this.host.mesh.manifest?.fields;
    if (instant !== undefined && fields) this.host.showTime(fields[instant]!.instant!.text);
  }
}
