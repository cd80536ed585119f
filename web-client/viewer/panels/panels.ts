// The controls, and what one points with. Each panel is a component of its own; this updates them
// together.

import {fieldLayers} from '../../core/layers/layers';
import type {Scalar} from '../../core/picture/field_scale';
import {kMaxPlanes} from '../../core/picture/display';
import type {Vector} from '../../core/protocol/geometry';
import type {Client} from '../../core/session/client';
import type {StreamState} from '../../core/session/worker_messages';
import {seriesServer} from '../../core/transport/series_server';
import type {View} from '../../webgl/view';
import type {Actions} from '../page/actions';
import type {CardLayout} from '../page/card_layout';
import {find} from '../page/find';
import {bindFolds} from '../page/folds';
import type {Page} from '../page/page';
import type {ShownMesh} from '../page/shown_mesh';
import {shownScalar, type Settings, type ShownRange} from '../settings/settings';
import {ClipHandles} from './clip_handles';
import {ClipPanel} from './clip_panel';
import {ColorPanel} from './color_panel';
import {Inspect} from './inspect';
import {LevelPanel} from './level_panel';
import {scalarTitle, type Panel, type Scene} from './panel';
import {StatisticsPanel} from './statistics_panel';
import {ValuePanel} from './value_panel';
import {ViewPanel} from './view_panel';
import {VolumePanel} from './volume_panel';
import {WarpPanel} from './warp_panel';

export interface PanelsHost {
  readonly client: Client;
  readonly view: View | null;
  readonly mesh: ShownMesh;
  /** As TimeHost.opening. */
  readonly opening: StreamState | null;
  readonly stream: {
    /** The address of the log that is open, as a file; empty: there is none. */
    readonly logAddress: string;
  };
  /** Brings everything in line with the attributes and the mesh. */
  apply(): void;
  /** The place that is pointed at, in lattice coordinates; null for none. */
  pointAt(point: Vector | null): void;
}

export class Panels {
  readonly clip: ClipPanel;
  readonly inspect: Inspect;
  private readonly color: ColorPanel;
  /** Panels that need only the attributes and the mesh. */
  private readonly simple: readonly Panel[];
  private readonly handles: ClipHandles;
  private readonly statistics: StatisticsPanel;
  private readonly view: ViewPanel;
  /** The field and the level that a line's plot shows. */
  private plotted = '';

  constructor(page: Page, host: PanelsHost, actions: Actions, cards: CardLayout) {
    const {root} = page;
    const announce = (text: string): void => page.announce(text);
    bindFolds(root);
    this.statistics = new StatisticsPanel(root);
    this.view = new ViewPanel(page, actions);
    this.color = new ColorPanel(root, page);
    this.clip = new ClipPanel(
      root,
      page,
      () => (host.view?.pose.direction ?? [0, -1, 0]).map((x) => -x) as Vector,
    );
    this.handles = new ClipHandles(find(root, '.layer'), kMaxPlanes, (i, share) =>
      this.clip.move(i, share),
    );
    const level = new LevelPanel(
      root,
      (quality) => page.write('quality', quality),
      () => standing(page, host.mesh),
    );
    this.simple = [
      this.color,
      this.clip,
      ...fieldLayers().map((layer) => new ValuePanel(root, page, layer)),
      new VolumePanel(root, page),
      new WarpPanel(root, page),
      level,
      this.view,
    ];
    this.inspect = new Inspect(root, {
      get client() {
        return host.opening === null ? host.client : null;
      },
      get view() {
        return host.view;
      },
      get manifest() {
        return host.mesh.manifest;
      },
      get bounds() {
        return host.mesh.bounds;
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
        return colorOf(page, host.mesh);
      },
      apply: () => host.apply(),
      showTime: (text) => page.write('time', text),
      get fieldTitle() {
        return fieldTitle(page, host.mesh);
      },
      announce,
      pointAt: (point) => host.pointAt(point),
    });
  }

  attach(view: View): void {
    this.handles.attach(view);
  }

  /** Brings all panels in line with the attributes and the mesh. */
  update(settings: Settings, mesh: ShownMesh): void {
    const {manifest, bounds, firstField, snapshot} = mesh;
    const known: Scene | null = manifest && {manifest, bounds, firstField};
    for (const panel of this.simple) panel.update(settings, known);
    this.inspect.update();
    this.handles.update(settings.planes, snapshot ? bounds : []);
  }

  /** Must be called after every frame: handles and marks follow the picture. */
  follow(): void {
    this.handles.place();
    this.inspect.place();
  }

  showState(state: StreamState): void {
    this.view.showState(state);
  }

  /** Shows the picture's figures. `frameMs` is the time of drawing. */
  showFigures(
    {color, statistics, costMs}: NonNullable<ShownMesh['snapshot']>,
    frameMs: number,
  ): void {
    this.statistics.show(statistics, costMs, frameMs);
    const isWhole = statistics.bytes >= statistics.bytesNeeded;
    const plotted = JSON.stringify([color, isWhole]);
    if (plotted !== this.plotted) this.inspect.refresh();
    this.plotted = plotted;
  }

  /** Shows the range of the colours. */
  showRange({low, high}: ShownRange): void {
    this.color.showRange(low, high);
  }

  /** Must be called before another mesh. */
  clear(): void {
    this.statistics.clear();
    this.inspect.clear();
    this.handles.update([], []);
  }
}

function fieldTitle(page: Pick<Page, 'read'>, mesh: ShownMesh): string {
  const color = colorOf(page, mesh);
  return color ? scalarTitle(color, mesh.manifest!.fields) : '';
}

function colorOf({read}: Pick<Page, 'read'>, {manifest, firstField}: ShownMesh): Scalar | null {
  return manifest && shownScalar(read('field'), manifest.fields, firstField);
}

/** The mesh as it is now: coarser and finer start from it. */
function standing(
  {read}: Pick<Page, 'read'>,
  {statistics, manifest, firstField}: ShownMesh,
): ReturnType<ConstructorParameters<typeof LevelPanel>[2]> {
  const color = shownScalar(read('field'), manifest?.fields ?? [], firstField);
  return {statistics, manifest, fields: color ? [color.field] : []};
}
