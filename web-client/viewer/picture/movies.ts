// Movies of the shown series: the instants of the part that plays, drawn as pictures are.

import {find} from '../page/find';
import {cutOf, fileNameOf, originOf} from '../panels/origin';
import type {Page} from '../page/page';
import {refusalOf, type Figure} from './figure';
import {film, type Filming, type Sink} from './film';
import {openSink} from './movie_sinks';
import {drawPage, pageFrame, type FigureHost} from './page_figure';
import {seriesIn, SeriesStage, type StageHost} from './series_stage';

const kFramesPerSecond = 10;
const kMaxFramesPerSecond = 60;

/**
 * By default the size is the element's, and the ground white. The sides are rounded down to even
 * numbers. A video has no transparency: its ground is white then.
 */
export interface MovieOptions extends Partial<Figure>, Partial<Filming> {
  /** A whole number up to 60; by default 10. */
  framesPerSecond?: number;
  /** Only the instants that are loaded. */
  onlyLoaded?: boolean;
}

export interface MovieHost extends StageHost, FigureHost {
  readonly later: {readonly time: {isPlaying: boolean}} | null;
}

export class Movies {
  private isBusy = false;

  constructor(
    private readonly page: Page,
    private readonly host: MovieHost,
  ) {}

  /** A series is shown. */
  get isOffered(): boolean {
    const {manifest, snapshot} = this.host.mesh;
    return seriesIn(snapshot, manifest?.fields ?? []) !== undefined;
  }

  /** Its instants are those of the shown segment, and the list has others. */
  get isOfSegment(): boolean {
    return this.host.mesh.isOneOfSegments;
  }

  get name(): string {
    return find(this.page.root, '.mesh-name').textContent;
  }

  /** That of a saved movie, which has all times. */
  fileName(ending: string): string {
    const {host, page} = this;
    const origin = originOf(
      page.root,
      host.mesh,
      cutOf((name) => page.read(name), host.mesh),
    );
    return fileNameOf({...origin, time: ''}, ending);
  }

  async make({framesPerSecond = kFramesPerSecond, ...options}: MovieOptions): Promise<Blob> {
    if (this.isBusy) throw new Error('Another movie is being made.');
    const isRate = Number.isInteger(framesPerSecond) && framesPerSecond > 0;
    if (!isRate || framesPerSecond > kMaxFramesPerSecond)
      throw new Error(`framesPerSecond is a whole number from 1 to ${kMaxFramesPerSecond}.`);
    const figure = this.figureOf(options);
    const why = refusalOf(figure);
    if (why !== '') throw new Error(why);
    this.isBusy = true;
    let sink: Sink | null = null;
    try {
      if (this.host.later) this.host.later.time.isPlaying = false;
      const {onlyLoaded = false, signal, progress} = options;
      sink = await openSink({...figure, framesPerSecond}, this.name);
      if (sink.isOpaque && figure.ground === 'transparent') figure.ground = 'white';
      const stage = new SeriesStage(this.host, onlyLoaded, this.drawing(figure));
      return await film(stage, sink, {
        signal: signal ?? new AbortController().signal,
        progress: progress ?? (() => undefined),
      });
    } finally {
      sink?.close();
      this.isBusy = false;
    }
  }

  private figureOf(options: MovieOptions): Figure {
    const {clientWidth, clientHeight} = this.page.element;
    const even = (pixels: number): number => pixels - (pixels % 2);
    return {
      width: even(options.width ?? Math.round(clientWidth * devicePixelRatio)),
      height: even(options.height ?? Math.round(clientHeight * devicePixelRatio)),
      ground: options.ground ?? 'white',
      hasLegend: options.hasLegend ?? true,
      hasAxes: options.hasAxes ?? true,
      title: options.title ?? '',
      unit: options.unit ?? '',
    };
  }

  /** Draws the figure. The mesh stays in its place, even if the legend's height changes. */
  private drawing(figure: Figure): () => Promise<OffscreenCanvas> {
    const {host, page} = this;
    let frame: ReturnType<typeof pageFrame> | undefined;
    return () => {
      frame ??= pageFrame(page, host, figure);
      return drawPage(page, host, figure, frame);
    };
  }
}
