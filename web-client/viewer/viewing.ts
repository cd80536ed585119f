// A viewer while it is in a document: connects the stream, the graphics and the panels.

import type {Statistics} from '../core/decode/statistics';
import type {BaseFigures} from '../core/picture/base_figures';
import type {Vector} from '../core/protocol/geometry';
import type {Manifest} from '../core/protocol/manifest';
import type {Client} from '../core/session/client';
import type {FromWorker, Snapshot, StreamState} from '../core/session/worker_messages';
import type {Direction} from '../webgl/directions';
import type {View} from '../webgl/view';
import {Graphics, type ViewStart} from './graphics';
import {Actions, type ActionsHost} from './page/actions';
import {CameraWatch} from './page/camera_watch';
import {find} from './page/find';
import {isOnDark, watchGround} from './page/ground';
import {bindKeys} from './page/keys';
import {Notices} from './page/notices';
import type {Kept, Page} from './page/page';
import {rangeOf, settingsFor, ShownMesh} from './page/shown_mesh';
import {Panels, type PanelsHost} from './panels/panels';
import {displayOf, planesOf, Requests} from './requests';
import {readSettings, type Settings, type ShownRange} from './settings/settings';
import {unfittingParts, unknownNames, wrongParts} from './settings/wrong_parts';
import type {Later} from './later';
import {StreamControl} from './stream_control';

export class Viewing implements ActionsHost, PanelsHost {
  mesh = new ShownMesh();
  settings: Settings;
  /** The values that the colours span; null if nothing is coloured. */
  range: ShownRange | null = null;
  readonly stream: StreamControl;
  readonly notices: Notices;
  private readonly graphics: Graphics;
  private readonly camera: CameraWatch;
  private readonly requests: Requests;
  private readonly endGround: () => void;
  private readonly actions: Actions;
  /** They are built a task later than the rest. */
  private panels: Panels | null = null;
  /** Loaded behind the first picture. */
  later: Later | null = null;
  /** The sentences about attributes that were shown last. */
  private wrong = '';
  /** The `complete` event has been dispatched. */
  private completeTold = false;

  /** REQUIRES: the page's root holds the markup. */
  constructor(
    private readonly page: Page,
    readonly client: Client,
    private readonly kept: Kept,
  ) {
    // The stream of a file begins at once and needs the limit.
    this.settings = readSettings((name) => page.read(name));
    this.requests = new Requests(client);
    this.actions = new Actions(page, this);
    this.notices = new Notices(page.root, (source) =>
      source === 'graphics' ? this.restartGraphics() : void this.stream.open(),
    );
    this.camera = new CameraWatch(
      () => (this.view && this.mesh.snapshot ? this.view.cameraState : null),
      (state) => {
        this.lookAt();
        page.dispatch('camera-change', state);
      },
    );
    this.graphics = new Graphics(page.root, this.notices, {
      opened: (view) => this.begin(view),
      drawn: () => {
        this.panels?.follow();
        this.later?.follow();
        this.camera.frame();
      },
      failed: (code, message) => this.failed(code, message),
      coarse: (have) => client.coarse(have),
    });
    this.stream = new StreamControl(page, kept, client, {
      limit: () => this.settings.limit,
      opens: (isSame) => {
        this.forget(isSame);
        this.notices.endOf('stream', 'page');
        this.wrong = ''; // it is said again once the mesh is known
      },
      changed: (state, attempt, delayMs) => this.showState(state, attempt, delayMs),
      failed: (code, message) => this.failed(code, message),
    });
    this.endGround = watchGround(() => this.apply());
    void this.graphics.open(() => this.takeStart());
    void this.stream.open();
  }

  buildPanels(): void {
    this.panels = new Panels(this.page, this, this.actions);
    this.panels.progress.begin(this.mesh.manifest);
    this.panels.progress.takePlan(this.mesh.plan);
    this.showState(this.stream.state, 0, 0);
    if (this.view) this.panels.attach(this.view);
    this.apply();
  }

  dispose(): void {
    this.endGround();
    this.camera.dispose();
    this.stream.dispose();
    this.graphics.dispose();
    this.panels?.dispose();
    this.later?.dispose();
    this.panels = this.later = null;
  }

  get view(): View | null {
    return this.graphics.view;
  }

  /** Brings everything in line with the attributes. */
  apply(): void {
    const {mesh, page, panels, view} = this;
    if (!panels) return;
    const before = this.settings;
    this.settings = settingsFor(mesh, (name) => page.read(name));
    this.tellWrongParts();
    panels.update(this.settings, mesh);
    view?.setLook({...this.settings, onDark: isOnDark(page.element)});
    view?.setParallel(this.settings.parallel);
    const {limit} = this.settings;
    if (JSON.stringify(before.limit) !== JSON.stringify(limit)) this.stream.setLimit(limit);
    this.showDisplay();
    this.showRange();
  }

  // ---- ActionsHost, PanelsHost

  async picture(): Promise<Blob | null> {
    const ground = getComputedStyle(this.page.element).getPropertyValue('--ground');
    return this.view?.picture(ground) ?? null;
  }

  togglePause(): void {
    this.stream.togglePause();
  }

  moveClip(step: number): void {
    const [plane] = this.settings.planes;
    if (plane) this.panels?.clip.move(0, plane.share + step);
  }

  centre(): void {
    const {point} = this.requests;
    if (point) this.view?.centre(point);
    else this.look(null);
  }

  look(direction: Direction | null): void {
    this.panels?.cards.refit();
    this.view?.look(direction);
  }

  inspect(): void {
    this.panels?.inspect.pickMiddle();
  }

  endTool(): void {
    this.panels?.inspect.use('none');
  }

  pointAt(point: Vector | null): void {
    this.requests.point = point;
    this.lookAt();
  }

  failed(code: string, message: string): void {
    if (!this.page.element.isConnected) return;
    this.notices.add(code, message);
    this.page.dispatch('error', {code, message});
  }

  // ---- from the worker

  receive(message: Exclude<FromWorker, {type: 'answer'}>): void {
    switch (message.type) {
      case 'manifest':
        return this.takeManifest(message.manifest);
      case 'plan':
        this.mesh.plan = message.plan;
        return this.panels?.progress.takePlan(message.plan);
      case 'base':
        return this.takeBase(message.figures);
      case 'snapshot':
        return this.takePicture(message.snapshot);
      case 'progress':
        return this.takeProgress(message.statistics);
      case 'state':
        return this.stream.enter(message.state, message.attempt, message.delayMs);
      case 'error':
        // A wrong name is a wrong attribute, and named as such.
        if (message.code === 'unknown-field') return this.page.dispatch('error', message);
        return this.failed(message.code, message.message);
    }
  }

  private takeManifest(manifest: Manifest): void {
    if (this.mesh.manifest) this.forget(true); // another log has taken its name
    this.mesh.manifest = manifest;
    this.view?.setFocus(manifest.focus ?? null);
    this.panels?.progress.begin(manifest);
    this.apply();
  }

  private takeBase(figures: BaseFigures): void {
    this.mesh.takeBase(figures);
    this.apply();
  }

  private takeProgress(statistics: Statistics): void {
    this.mesh.statistics = statistics;
    this.panels?.progress.show(statistics);
    this.page.dispatch('progress', statistics);
  }

  private takePicture(snapshot: Snapshot): void {
    this.mesh.waiting = this.view ? null : snapshot;
    if (this.view) this.draw(snapshot, this.view);
  }

  // ---- the picture

  /** The view is ready: show what has been waiting for it. */
  private begin(view: View): void {
    this.panels?.attach(view);
    view.setFocus(this.mesh.manifest?.focus ?? null);
    bindKeys(find(this.page.root, '.scene'), this.actions.keys(view));
    this.apply();
    this.panels?.cards.repeat();
    const {waiting} = this.mesh;
    this.mesh.waiting = null;
    if (waiting) this.draw(waiting, view);
  }

  private draw(snapshot: Snapshot, view: View): void {
    const {mesh, page} = this;
    const isFirst = mesh.snapshot === null;
    const amounts = mesh.snapshot?.amounts?.join();
    mesh.take(snapshot);
    // The range and the free area come first: no frame shows the picture without them.
    if (isFirst || amounts !== snapshot.amounts?.join()) this.apply();
    else this.showRange();
    view.show(snapshot, (drawingMs) => {
      if (mesh !== this.mesh) return; // it belongs to the previous mesh
      this.client.shown(drawingMs);
      page.dispatch(mesh.drawn ? 'refine' : 'load', snapshot.statistics);
      mesh.drawn = snapshot.statistics;
      page.element.classList.add('loaded');
      void this.loadLater();
      this.tellComplete();
    });
    this.panels?.showFigures(snapshot, view.pose.frameMs);
  }

  /** The next picture tries again if the server is away. */
  private async loadLater(): Promise<void> {
    if (this.later) return;
    const {Later} = await import('./later').catch(() => ({Later: null}));
    if (Later && this.panels) this.later ??= new Later(this.page, this);
  }

  /** Keeps the camera. The mesh comes again from the worker that decodes. */
  private restartGraphics(): void {
    const {view} = this;
    const moved = view && !view.pose.fitted ? view.cameraState : null;
    this.client.repeat();
    void this.graphics.restart(() => (view ? moved : this.takeStart()));
  }

  /** Requests made before there was a view count once. */
  private takeStart(): ViewStart {
    const {start} = this.kept;
    this.kept.start = null;
    return start ?? readSettings((name) => this.page.read(name)).camera;
  }

  /** With `isSame` the camera stays where the user has moved it. */
  private forget(isSame: boolean): void {
    this.mesh = new ShownMesh();
    this.requests.forget();
    const {view} = this;
    if (view) {
      const {cameraState, pose} = view;
      const {fitted} = pose;
      view.clear();
      if (isSame && !fitted) view.cameraState = cameraState;
    }
    this.panels?.clear();
  }

  /** Says which attributes the picture does not follow, and why. */
  private tellWrongParts(): void {
    const {mesh, notices, page} = this;
    const read = page.read.bind(page);
    const sentences = [...unknownNames(page.unknown), ...wrongParts(read)];
    if (mesh.manifest) sentences.push(...unfittingParts(read, mesh.manifest));
    const text = sentences.join('\n');
    if (text === this.wrong) return;
    this.wrong = text;
    if (text === '') notices.end('bad-attribute');
    else this.failed('bad-attribute', text);
  }

  private showDisplay(): void {
    const {mesh, page, panels, settings} = this;
    // A picture without its planes would show what the address hides.
    if (!mesh.manifest || mesh.bounds.length === 0) return;
    const display = displayOf(settings, mesh, (name) => page.read(name));
    if (!this.requests.show(display)) return;
    panels?.progress.follow(display.color ? [display.color.field] : [], settings.limit);
    this.lookAt();
  }

  /** Tells a log of regions what to refine first. */
  private lookAt(): void {
    this.requests.look(this.view?.pose.frustum ?? [], planesOf(this.settings, this.mesh));
  }

  private showRange(): void {
    const {mesh, panels, settings} = this;
    if (!panels) return;
    const range = mesh.manifest && mesh.snapshot && rangeOf(mesh.snapshot, mesh.manifest, settings);
    if (range && mesh.snapshot) {
      const {low, high, logarithmic} = range;
      this.view?.setRange(low, high, mesh.snapshot.scaleRange, logarithmic);
    }
    this.range = range && {...range, hasMissing: mesh.hasMissing};
    panels.showRange(this.range, mesh, settings);
  }

  // ---- the state

  private showState(state: StreamState, attempt: number, delayMs: number): void {
    this.completeTold &&= state === 'complete';
    this.tellComplete();
    if (!this.panels) return;
    this.panels.showState(state, attempt, delayMs);
    if (state === 'streaming' || state === 'complete') this.notices.endOf('stream');
  }

  /** Both the decoder and the picture must be complete. */
  private tellComplete(): void {
    const {mesh, stream} = this;
    if (stream.state !== 'complete' || this.completeTold || !mesh.isDrawn) return;
    this.completeTold = true;
    this.page.dispatch('complete', mesh.drawn);
  }
}
