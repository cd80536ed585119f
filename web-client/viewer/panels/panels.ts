// The panels of sections.ts, and what one points with; this updates them together.

import type {Scalar} from '../../core/picture/field_scale';
import type {Vector} from '../../core/protocol/geometry';
import {isEqual} from '../../core/protocol/equal';
import type {Pick} from '../../core/session/inspector';
import type {Snapshot, StreamState} from '../../core/session/worker_messages';
import {seriesServer} from '../../core/transport/series_server';
import {bindFolds} from '../page/folds';
import type {ShownMesh} from '../page/shown_mesh';
import {keptText, mayKeep, parseKept, type Kept, type KeptName} from '../settings/points';
import {kViewAttributes, shownScalar, type Settings, type ShownRange} from '../settings/settings';
import {Inspect} from './inspect';
import {scalarTitle, type Panel, type PanelKind, type PanelTools, type Scene} from './panel';

export class Panels {
  readonly inspect: Inspect;
  private readonly panels: readonly Panel[];
  /** The field and the level that a line's plot shows. */
  private plotted: unknown = null;
  /** Everything that panels other than those of the time depend on, as it was last. */
  private shown: unknown = null;

  /** REQUIRES: the markup of `kinds` is in the page. */
  constructor(
    private readonly tools: Omit<PanelTools, 'open'>,
    kinds: readonly PanelKind[],
    cards: {readonly middle: [number, number]},
  ) {
    const {host, page} = tools;
    const {root} = page;
    bindFolds(root);
    const open = (picks: Pick[]): void => this.inspect.open(picks);
    this.panels = kinds.flatMap((kind) => kind.make?.({...tools, open}) ?? []);
    const keptOf = (places: Vector[]): [KeptName, Kept[]] => {
      const name = places.length > 1 ? 'lines' : 'points';
      return [name, parseKept(name, page.read(name) ?? '') ?? []];
    };
    this.inspect = new Inspect(root, {
      get client() {
        return host.opening === null ? host.client : null;
      },
      get view() {
        return host.view;
      },
      get middle() {
        return cards.middle;
      },
      get mesh() {
        return host.mesh;
      },
      get seriesServer() {
        return seriesServer(host.stream.logAddress, host.mesh.digest, page.token);
      },
      get color() {
        const {manifest, firstField} = host.mesh;
        return manifest && shownScalar(page.read('field'), manifest.fields, firstField);
      },
      mayKeep: (places) => mayKeep(...keptOf(places), places),
      keep: (places) => {
        const [name, all] = keptOf(places);
        page.write(name, keptText([...all, {name: '', places}]));
      },
      apply: () => host.apply(),
      showTime: (text) => page.write('time', text),
      get fieldTitle() {
        const color: Scalar | null = this.color;
        return host.settings.title ?? (color ? scalarTitle(color, host.mesh.manifest!.fields) : '');
      },
      announce: (text) => page.announce(text),
    });
  }

  /**
   * Brings all panels in line with the attributes and the mesh. While a series plays, those that do
   * not show the time would be written again for nothing.
   */
  update(settings: Settings, {manifest, base: {bounds}, firstField, snapshot}: ShownMesh): void {
    const {host, page} = this.tools;
    const texts = kViewAttributes.filter((name) => name !== 'time').map((name) => page.read(name));
    const shown = [texts, {...settings, time: null}, bounds, snapshot === null];
    const known: Scene | null = manifest && {manifest, bounds, firstField};
    if (!host.isPlaying || !isEqual(shown, this.shown))
      for (const panel of this.panels) panel.update?.(settings, known);
    this.shown = shown;
    this.inspect.update();
  }

  /** Must be called after every frame. */
  follow(): void {
    for (const panel of this.panels) panel.follow?.();
    this.inspect.place();
  }

  showState(state: StreamState): void {
    for (const panel of this.panels) panel.showState?.(state);
  }

  /** `frameMs` is the time of drawing the picture. */
  showPicture(snapshot: Snapshot, frameMs: number): void {
    for (const panel of this.panels) panel.showPicture?.(snapshot, frameMs);
    const {color, statistics} = snapshot;
    const isWhole = statistics.bytes >= statistics.bytesNeeded;
    const plotted = {color, isWhole};
    if (!isEqual(plotted, this.plotted)) this.inspect.refresh();
    this.plotted = plotted;
    this.inspect.showPicture();
  }

  /** Shows the range of the colours. */
  showRange(range: ShownRange): void {
    for (const panel of this.panels) panel.showRange?.(range);
  }

  /** Must be called before another mesh. */
  clear(): void {
    for (const panel of this.panels) panel.clear?.();
    this.inspect.clear();
  }
}
