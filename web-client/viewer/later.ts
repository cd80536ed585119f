// The parts of a viewer that the first picture does not need. They are loaded behind it.

import type {Client} from '../core/session/client';
import type {Direction} from '../three/directions';
import type {View} from '../three/view';
import type {Settings, ShownRange} from './settings/settings';
import {find} from './page/find';
import type {Page} from './page/page';
import type {ShownMesh} from './page/shown_mesh';
import {Undo} from './page/undo';
import {HistogramPanel} from './panels/histogram_panel';
import {Hover} from './panels/hover';
import {OrientationCube} from './panels/orientation_cube';

export interface LaterHost {
  readonly client: Client;
  readonly view: View | null;
  readonly mesh: ShownMesh;
  readonly settings: Settings;
  readonly range: ShownRange | null;
  look(direction: Direction | null): void;
}

export class Later {
  private readonly cube: OrientationCube;
  private readonly hover: Hover;
  private readonly ends = new AbortController();
  private seen = '';

  constructor(
    page: Page,
    private readonly host: LaterHost,
  ) {
    this.cube = new OrientationCube(find(page.root, '.orientation-cube'), (direction) =>
      host.look(direction),
    );
    this.hover = new Hover(page.root, {
      get view() {
        return host.view;
      },
      get shown() {
        const {manifest, snapshot} = host.mesh;
        return manifest && snapshot?.color
          ? {scalar: snapshot.color, fields: manifest.fields}
          : null;
      },
      pick: (x, y) => host.client.pick(host.view!.rayAt(x, y)),
    });
    new Undo(
      page,
      (camera) => {
        if (camera && host.view) host.view.cameraState = camera;
        else host.look(null);
      },
      this.ends.signal,
    );
    new HistogramPanel(page, host, this.ends.signal);
    this.follow();
  }

  dispose(): void {
    this.ends.abort();
  }

  /** Must be called after every frame. */
  follow(): void {
    const {pose} = this.host.view ?? {};
    const seen = pose?.toCanvas.join() ?? '';
    if (!pose || seen === this.seen) return;
    this.seen = seen;
    this.cube.turn(pose.rotation);
    this.hover.hide();
  }
}
