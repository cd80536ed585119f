// A viewer's picture: the graphics that draw it, and the worker's orders for it.

import type {Client} from '../core/session/client';
import type {Snapshot} from '../core/session/worker_messages';
import type {View} from '../webgl/view';
import type {Controls} from './controls';
import {Graphics, type ViewStart} from './graphics';
import {CameraWatch} from './page/camera_watch';
import {find} from './page/find';
import {isOnDark} from './page/ground';
import type {Notices} from './page/notices';
import type {Kept, Page} from './page/page';
import {awaitsRequests} from './page/late_requests';
import {settingsFor} from './page/shown_mesh';
import type {Succession} from './page/succession';
import {displayOf, Requests} from './requests';
import {readSettings, type Settings, type ShownRange} from './settings/settings';
import type {StreamControl} from './stream_control';

export interface PictureHost {
  readonly client: Client;
  readonly controls: Controls;
  readonly meshes: Succession;
  readonly notices: Notices;
  readonly settings: Settings;
  readonly stream: StreamControl;
  /** Brings everything in line with the attributes and the mesh. */
  apply(): void;
  failed(code: string, message: string): void;
}

export class ShownPicture {
  /** The values that the colours span; null if nothing is coloured. */
  range: ShownRange | null = null;
  private readonly requests: Requests;
  private readonly graphics: Graphics;
  private readonly camera: CameraWatch;

  constructor(
    private readonly page: Page,
    private readonly kept: Kept,
    private readonly host: PictureHost,
  ) {
    this.requests = new Requests(host.client);
    this.camera = new CameraWatch(
      () => (this.view && host.meshes.shown.snapshot ? this.view.cameraState : null),
      (state) => page.dispatch('camera-change', state),
    );
    this.graphics = new Graphics(page.root, host.notices, {
      opened: (view) => this.begin(view),
      drawn: () => {
        host.controls.later?.follow();
        this.camera.frame();
      },
      failed: (code, message) => host.failed(code, message),
      coarse: async (have) => {
        if (host.meshes.next) throw new Error('the worker has another segment');
        return host.client.coarse(have);
      },
    });
    void this.graphics.open(() => this.takeStart());
  }

  /** Null before the graphics have started. */
  get view(): View | null {
    return this.graphics.view;
  }

  /** Brings the picture in line with the settings. */
  apply(): void {
    const {page, view} = this;
    const {settings} = this.host;
    const moves = !matchMedia('(prefers-reduced-motion: reduce)').matches;
    view?.setLook({...settings, moves, onDark: isOnDark(find(page.root, '.scene'))});
    view?.setParallel(settings.parallel);
    view?.setPlaying(this.playsEveryMs);
    this.showDisplay();
    this.showRange();
  }

  take(snapshot: Snapshot): void {
    this.host.meshes.waiting = this.view ? null : snapshot;
    if (this.view) this.draw(snapshot, this.view);
  }

  /** Another mesh is opened. With `isSame` the camera stays where the user has moved it. */
  clear(isSame: boolean): void {
    const {view} = this;
    if (!view) return;
    const {cameraState, pose} = view;
    const {fitted} = pose;
    view.clear();
    if (isSame && !fitted) view.cameraState = cameraState;
  }

  /** Keeps the camera. The mesh comes again from the worker that decodes. */
  restart(): void {
    const {view} = this;
    const moved = view && !view.pose.fitted ? view.cameraState : null;
    this.host.client.repeat();
    void this.graphics.restart(() => (view ? moved : this.takeStart()));
  }

  dispose(): void {
    this.camera.dispose();
    this.graphics.dispose();
  }

  /** Between two instants; 0: nothing plays. */
  private get playsEveryMs(): number {
    const time = this.host.controls.later?.time;
    return time?.isPlaying ? time.stepMs : 0;
  }

  /** The view is ready: show what has been waiting for it. */
  private begin(view: View): void {
    const {controls, meshes} = this.host;
    controls.later?.attach(view);
    view.setFocus(meshes.shown.manifest?.focus ?? null);
    this.host.apply();
    controls.shell?.cards.repeat();
    const {waiting} = meshes;
    meshes.waiting = null;
    if (waiting) this.draw(waiting, view);
  }

  private draw(snapshot: Snapshot, view: View): void {
    const {client, controls, meshes, stream} = this.host;
    const {later} = controls;
    const change = meshes.takeNext();
    const mesh = meshes.shown;
    if (change) later?.panels.clear();
    const isFirst = mesh.snapshot === null;
    const amounts = mesh.snapshot?.amounts?.join();
    mesh.take(snapshot);
    // The range and the free area come first: no frame shows the picture without them.
    if (isFirst || amounts !== snapshot.amounts?.join()) this.host.apply();
    else this.showRange();
    view.show(
      snapshot,
      (drawingMs) => {
        if (mesh !== meshes.shown) return; // it belongs to the previous mesh
        if (!meshes.next) client.shown(drawingMs);
        this.page.dispatch(mesh.drawn ? 'refine' : 'load', snapshot.statistics);
        mesh.drawn = snapshot.statistics;
        this.page.element.classList.add('loaded');
        const {playsEveryMs} = this;
        if (playsEveryMs > 0) controls.later!.hurry.note(drawingMs, playsEveryMs);
        void controls.load();
        stream.tellComplete(meshes.coming);
      },
      change,
    );
    later?.showPicture(snapshot, view.pose.frameMs);
  }

  /** Requests made before there was a view count once. */
  private takeStart(): ViewStart {
    const {start} = this.kept;
    this.kept.start = null;
    return start ?? readSettings((name) => this.page.read(name)).camera;
  }

  private showDisplay(): void {
    const {controls, meshes, settings: shown} = this.host;
    const {coming: mesh, next} = meshes;
    // A picture without its planes would show what the address hides.
    if (!mesh.manifest || mesh.base.bounds.length === 0 || mesh.isDeriving) return;
    const read = this.page.read.bind(this.page);
    if (awaitsRequests(read, () => this.showDisplay())) return;
    const settings = next ? settingsFor(next, read) : shown;
    const display = displayOf(settings, mesh, read);
    if (!this.requests.show(display, mesh)) return;
    const fields = display.color ? [display.color.field] : [];
    controls.shell?.progress.follow(fields, settings.limit);
  }

  private showRange(): void {
    const {controls, meshes, settings} = this.host;
    const {shell} = controls;
    if (!shell) return;
    const mesh = meshes.shown;
    const range = mesh.snapshot && mesh.rangeOf(mesh.snapshot, settings);
    if (range && mesh.snapshot) {
      const {low, high, logarithmic} = range;
      this.view?.setRange(low, high, mesh.snapshot.scaleRange, logarithmic);
    }
    this.range = range && {...range, hasMissing: mesh.hasMissing};
    shell.showRange(this.range, mesh, settings);
    if (this.range) controls.later?.panels.showRange(this.range);
  }
}
