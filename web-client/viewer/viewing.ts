// A viewer while it is in a document: connects the stream, the graphics and the panels.

import {isEqual} from '../core/protocol/equal';
import type {CoarseCells} from '../core/picture/volume';
import type {Client} from '../core/session/client';
import type {FromWorker, Progress, Snapshot, StreamState} from '../core/session/worker_messages';
import type {Direction} from '../webgl/directions';
import type {View} from '../webgl/view';
import {Graphics, type ViewStart} from './graphics';
import {CameraWatch} from './page/camera_watch';
import {kMaxAhead} from './page/fields_ahead';
import {find} from './page/find';
import {isOnDark, watchGround} from './page/ground';
import {Hurry} from './page/hurry';
import {Notices} from './page/notices';
import type {Kept, Page} from './page/page';
import {settingsFor, type SegmentPlace, type ShownMesh} from './page/shown_mesh';
import {Succession} from './page/succession';
import {Shell} from './panels/shell';
import {displayOf, Requests} from './requests';
import {readSettings, type Settings, type ShownRange} from './settings/settings';
import type {Later, LaterHost} from './later';
import type {MovieOptions} from './picture/movies';
import {StreamControl} from './stream_control';

/**
 * The controls come behind the first picture, or after this time: who has no picture may want to
 * change what is shown.
 */
const kLaterMs = 5000;

type Head = Extract<FromWorker, {type: 'manifest'}>;

export class Viewing implements LaterHost {
  private readonly meshes = new Succession();
  settings: Settings;
  /** The values that the colours span; null if nothing is coloured. */
  range: ShownRange | null = null;
  readonly stream: StreamControl;
  readonly notices: Notices;
  private readonly graphics: Graphics;
  private readonly camera: CameraWatch;
  private readonly requests: Requests;
  private readonly endGround: () => void;
  /** It is built a task later than the rest. */
  private shell: Shell | null = null;
  /** The controls; null before they are loaded. */
  later: Later | null = null;
  private readonly timer: ReturnType<typeof setTimeout>;
  /** The `complete` event has been dispatched. */
  private completeTold = false;
  private readonly hurry: Hurry;

  /** REQUIRES: the page's root holds the markup. */
  constructor(
    private readonly page: Page,
    readonly client: Client,
    private readonly kept: Kept,
  ) {
    // The stream of a file begins at once and needs the limit.
    this.settings = readSettings((name) => page.read(name));
    this.requests = new Requests(client);
    this.hurry = new Hurry(page.element);
    this.notices = new Notices(page.root, (source) =>
      source === 'graphics' ? this.restartGraphics() : void this.stream.open(),
    );
    this.camera = new CameraWatch(
      () => (this.view && this.mesh.snapshot ? this.view.cameraState : null),
      (state) => page.dispatch('camera-change', state),
    );
    this.graphics = new Graphics(page.root, this.notices, {
      opened: (view) => this.begin(view),
      drawn: () => {
        this.later?.follow();
        this.camera.frame();
      },
      failed: (code, message) => this.failed(code, message),
      coarse: (have) => this.coarse(have),
    });
    this.stream = new StreamControl(page, kept, client, {
      limit: () => this.settings.limit,
      time: () => this.settings.time,
      keptField: () => this.meshes.coming.keptField,
      opens: (isSame, place) => this.opens(isSame, place),
      changed: (state, attempt, delayMs) => this.showState(state, attempt, delayMs),
      failed: (code, message) => this.failed(code, message),
    });
    this.timer = setTimeout(() => void this.loadLater(), kLaterMs);
    this.endGround = watchGround(() => this.apply());
    void this.graphics.open(() => this.takeStart());
    void this.stream.open();
  }

  buildShell(): void {
    this.shell = new Shell(this.page, this, () => this.later?.panels.inspect.arrange());
    this.shell.progress.begin(this.mesh.manifest);
    this.shell.progress.takePlan(this.mesh.plan);
    this.showState(this.stream.state, 0, 0);
    this.apply();
  }

  dispose(): void {
    this.hurry.end();
    clearTimeout(this.timer);
    this.endGround();
    this.camera.dispose();
    this.stream.dispose();
    this.graphics.dispose();
    this.shell?.dispose();
    this.later?.dispose();
    this.shell = this.later = null;
  }

  get mesh(): ShownMesh {
    return this.meshes.shown;
  }
  get view(): View | null {
    return this.graphics.view;
  }

  /** As Client.coarse: cells of the mesh that is shown. */
  private async coarse(have: number): Promise<CoarseCells> {
    if (this.opening !== null) throw new Error('the worker has another segment');
    return this.client.coarse(have);
  }

  /** Brings everything in line with the attributes. */
  apply(): void {
    const {page, shell, view} = this;
    if (!shell) return;
    const before = this.settings;
    this.settings = settingsFor(this.mesh, (name) => page.read(name));
    this.stream.follow();
    const {mesh} = this;
    this.later?.tellWrongParts();
    this.later?.panels.update(this.settings, mesh);
    this.later?.time.update(this.settings, mesh);
    this.startPlaying();
    view?.setLook({...this.settings, onDark: isOnDark(find(page.root, '.scene'))});
    view?.setParallel(this.settings.parallel);
    view?.setPlaying(this.playsEveryMs);
    if (!this.isPlaying) this.hurry.end();
    const {limit} = this.settings;
    if (!isEqual(before.limit, limit)) this.stream.setLimit(limit);
    this.showDisplay();
    this.showRange();
  }

  get isPlaying(): boolean {
    return this.later?.time.isPlaying === true;
  }

  /** Between two instants; 0: nothing plays. */
  private get playsEveryMs(): number {
    return this.isPlaying ? this.later!.time.stepMs : 0;
  }

  private startPlaying(): void {
    const {kept, later} = this;
    if (!kept.playing || !later?.time.isShown) return;
    kept.playing = false;
    later.time.isPlaying = true;
  }

  // ---- ActionsHost, PanelsHost

  async picture(): Promise<Blob | null> {
    const ground = getComputedStyle(this.page.element).getPropertyValue('--ground-now');
    return this.view?.picture(ground) ?? null;
  }

  async movie(options: MovieOptions): Promise<Blob> {
    await this.loadLater();
    if (!this.later) throw new Error('What makes movies cannot be loaded. Try again later.');
    return this.later.movie(options);
  }

  togglePause(): void {
    this.stream.togglePause();
  }

  look(direction: Direction | null): void {
    this.shell?.cards.refit();
    this.view?.look(direction);
  }

  // ---- TimeHost

  get isHurried(): boolean {
    return this.hurry.isOn;
  }

  get opening(): StreamState | null {
    return this.meshes.next ? this.stream.state : null;
  }

  timeChanged(time: number, playing: boolean): void {
    this.page.dispatch('time-change', {time, playing});
  }

  failed(code: string, message: string): void {
    if (!this.page.element.isConnected) return;
    this.notices.add(code, message);
    void this.loadLater(); // there may be no picture
    this.page.dispatch('error', {code, message});
  }

  // ---- from the worker

  receive(message: Exclude<FromWorker, {type: 'answer'}>): void {
    switch (message.type) {
      case 'manifest':
        return this.takeManifest(message);
      case 'plan':
        this.meshes.coming.plan = message.plan;
        return this.shell?.progress.takePlan(message.plan);
      case 'base':
        this.meshes.coming.base = message.figures;
        return this.apply();
      case 'snapshot':
        return this.takePicture(message.snapshot);
      case 'progress':
        return this.takeProgress(message);
      case 'state':
        return this.stream.enter(message.state, message.attempt, message.delayMs);
      case 'error':
        // A wrong name is a wrong attribute, and named as such.
        if (message.code === 'unknown-field') return this.page.dispatch('error', message);
        return this.failed(message.code, message.message);
    }
  }

  private takeManifest({manifest, digest, isMore}: Head): void {
    // another log has taken its name
    const {coming} = this.meshes;
    if (coming.manifest && !isMore) this.replace(true, coming.place);
    Object.assign(this.meshes.coming, {manifest, digest});
    if (isMore) {
      this.shell?.progress.takeFields(manifest);
      return this.apply();
    }
    if (!this.meshes.next) this.view?.setFocus(manifest.focus ?? null);
    this.shell?.progress.begin(manifest);
    this.apply();
  }

  private takeProgress(progress: Progress): void {
    const {coming: mesh, next} = this.meshes;
    const isMore = progress.here.length !== mesh.progress.here.length;
    mesh.progress = progress;
    if (isMore && mesh.ahead.plotted.length > kMaxAhead) this.apply(); // asks for the next ones
    this.later?.time.follow();
    if (!next) this.later?.panels.inspect.takeProgress();
    this.shell?.progress.show(progress.statistics);
    this.page.dispatch('progress', progress.statistics);
  }

  private takePicture(snapshot: Snapshot): void {
    this.meshes.waiting = this.view ? null : snapshot;
    if (this.view) this.draw(snapshot, this.view);
  }

  // ---- the picture

  /** The view is ready: show what has been waiting for it. */
  private begin(view: View): void {
    this.later?.attach(view);
    view.setFocus(this.mesh.manifest?.focus ?? null);
    this.apply();
    this.shell?.cards.repeat();
    const {waiting} = this.meshes;
    this.meshes.waiting = null;
    if (waiting) this.draw(waiting, view);
  }

  private draw(snapshot: Snapshot, view: View): void {
    const change = this.meshes.takeNext();
    const {mesh, page} = this;
    if (change) this.later?.panels.clear();
    const isFirst = mesh.snapshot === null;
    const amounts = mesh.snapshot?.amounts?.join();
    mesh.take(snapshot);
    // The range and the free area come first: no frame shows the picture without them.
    if (isFirst || amounts !== snapshot.amounts?.join()) this.apply();
    else this.showRange();
    view.show(
      snapshot,
      (drawingMs) => {
        if (mesh !== this.mesh) return; // it belongs to the previous mesh
        if (!this.meshes.next) this.client.shown(drawingMs);
        page.dispatch(mesh.drawn ? 'refine' : 'load', snapshot.statistics);
        mesh.drawn = snapshot.statistics;
        page.element.classList.add('loaded');
        if (this.isPlaying) this.hurry.note(drawingMs, this.playsEveryMs);
        void this.loadLater();
        this.tellComplete();
      },
      change,
    );
    this.later?.showPicture(snapshot, view.pose.frameMs);
    this.later?.time.follow();
  }

  /** The next picture tries again if the server is away. */
  private async loadLater(): Promise<void> {
    if (this.later) return;
    const {Later} = await import('./later').catch(() => ({Later: null}));
    if (!Later || !this.shell) return;
    this.later ??= new Later(this.page, this, this.shell);
    this.apply();
    const {snapshot} = this.mesh;
    if (snapshot && this.view) this.later.showPicture(snapshot, this.view.pose.frameMs);
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

  private opens(isSame: boolean, place: SegmentPlace | null): void {
    this.notices.endOf('stream');
    if (this.replace(isSame, place)) return;
    this.notices.endOf('page');
    this.later?.forgetWrongParts(); // they are told again once the mesh is known
  }

  /** Returns true if the picture stays, because another segment of its list comes. */
  private replace(isSame: boolean, place: SegmentPlace | null): boolean {
    const stays = isSame && place !== null && this.view !== null && this.mesh.snapshot !== null;
    this.meshes.open(place, stays);
    this.requests.forget();
    if (!stays) this.forget(isSame);
    return stays;
  }

  /** With `isSame` the camera stays where the user has moved it. */
  private forget(isSame: boolean): void {
    const {view} = this;
    if (view) {
      const {cameraState, pose} = view;
      const {fitted} = pose;
      view.clear();
      if (isSame && !fitted) view.cameraState = cameraState;
    }
    this.shell?.clear();
    this.later?.panels.clear();
  }

  private showDisplay(): void {
    const {page, shell} = this;
    const {coming: mesh, next} = this.meshes;
    // A picture without its planes would show what the address hides.
    if (!mesh.manifest || mesh.base.bounds.length === 0) return;
    const read = page.read.bind(page);
    const settings = next ? settingsFor(next, read) : this.settings;
    const display = displayOf(settings, mesh, read);
    if (!this.requests.show(display)) return;
    shell?.progress.follow(display.color ? [display.color.field] : [], settings.limit);
  }

  private showRange(): void {
    const {mesh, shell, settings} = this;
    if (!shell) return;
    const range = mesh.snapshot && mesh.rangeOf(mesh.snapshot, settings);
    if (range && mesh.snapshot) {
      const {low, high, logarithmic} = range;
      this.view?.setRange(low, high, mesh.snapshot.scaleRange, logarithmic);
    }
    this.range = range && {...range, hasMissing: mesh.hasMissing};
    shell.showRange(this.range, mesh, settings);
    if (this.range) this.later?.panels.showRange(this.range);
  }

  // ---- the state

  private showState(state: StreamState, attempt: number, delayMs: number): void {
    this.completeTold &&= state === 'complete';
    if (state === 'paused' || state === 'failed') void this.loadLater(); // no picture is due
    this.tellComplete();
    if (!this.shell) return;
    this.shell.progress.showState(state, attempt, delayMs, this.meshes.coming.isSuccessor);
    this.later?.panels.showState(state);
    if (state === 'streaming' || state === 'complete') this.notices.endOf('stream');
  }

  /** Both the decoder and the picture must be complete. */
  private tellComplete(): void {
    const {mesh, stream} = this;
    if (stream.state !== 'complete' || this.completeTold || this.meshes.next || !mesh.isDrawn)
      return;
    this.completeTold = true;
    this.page.dispatch('complete', mesh.drawn);
  }
}
