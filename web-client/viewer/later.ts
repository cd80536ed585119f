// The parts of a viewer that the first picture does not need. They are loaded behind it.

import type {Client} from '../core/session/client';
import type {Direction} from '../webgl/directions';
import type {View} from '../webgl/view';
import type {Settings, ShownRange} from './settings/settings';
import {find} from './page/find';
import type {Page} from './page/page';
import type {ShownMesh} from './page/shown_mesh';
import {Undo} from './page/undo';
import {HistogramPanel} from './panels/histogram_panel';
import {Hover} from './panels/hover';
import {OrientationCube} from './panels/orientation_cube';
import type {Pictures} from './picture/pictures';

export interface LaterHost {
  readonly client: Client;
  readonly view: View | null;
  readonly mesh: ShownMesh;
  readonly settings: Settings;
  readonly range: ShownRange | null;
  look(direction: Direction | null): void;
  readonly stream: {choose(mesh: string): void};
  readonly notices: {end(code: string): void};
  failed(code: string, message: string): void;
}

export class Later {
  private readonly cube: OrientationCube;
  private readonly hover: Hover;
  private readonly ends = new AbortController();
  private seen = '';
  private pictures: Promise<Pictures> | null = null;

  constructor(
    private readonly page: Page,
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
    this.takeDrops();
    this.follow();
  }

  dispose(): void {
    this.ends.abort();
  }

  /** Opens the dialog that makes a picture. */
  async picture(): Promise<void> {
    (await this.loadPictures())?.picture();
  }

  /** The next call tries again if the server is away. */
  private async loadPictures(): Promise<Pictures | null> {
    this.pictures ??= import('./picture/pictures').then(
      ({Pictures}) => new Pictures(this.page, this.host),
    );
    try {
      return await this.pictures;
    } catch {
      this.pictures = null;
      this.host.failed('no-picture', 'What makes pictures cannot be loaded. Try again later.');
      return null;
    }
  }

  /** A picture that is dropped opens its view. */
  private takeDrops(): void {
    const {element} = this.page;
    const {signal} = this.ends;
    element.addEventListener(
      'dragover',
      (event) => {
        if (event.dataTransfer?.types.includes('Files')) event.preventDefault();
      },
      {signal},
    );
    element.addEventListener(
      'drop',
      (event) => {
        const [file] = event.dataTransfer?.files ?? [];
        if (!file) return;
        event.preventDefault();
        void this.loadPictures().then((pictures) => pictures?.open(file));
      },
      {signal},
    );
  }

  /** Must be called after every frame. */
  follow(): void {
    const {pose} = this.host.view ?? {};
    const seen = pose?.toCanvas.join() ?? '';
    if (!pose || seen === this.seen) return;
    this.seen = seen;
    this.cube.turn(pose.axes);
    this.hover.hide();
  }
}
