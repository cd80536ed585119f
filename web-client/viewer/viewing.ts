// A viewer while it is in a document: connects the stream, the graphics and the panels.

import {isEqual} from '../core/protocol/equal';
import type {FieldInfo} from '../core/protocol/fields';
import type {Client} from '../core/session/client';
import type {FromWorker, LogFigures, StreamState} from '../core/session/worker_messages';
import type {Direction} from '../webgl/directions';
import type {View} from '../webgl/view';
import {Controls} from './controls';
import {kMaxAhead} from './page/fields_ahead';
import {watchGround} from './page/ground';
import {Notices} from './page/notices';
import type {Kept, Page} from './page/page';
import {settingsFor, type SegmentPlace, type ShownMesh} from './page/shown_mesh';
import {Succession} from './page/succession';
import {readSettings, type Settings, type ShownRange} from './settings/settings';
import type {Later, LaterHost} from './later';
import type {MovieOptions} from './picture/movies';
import {ShownPicture, type PictureHost} from './shown_picture';
import {StreamControl} from './stream_control';

type Head = Extract<FromWorker, {type: 'manifest'}>;

export class Viewing implements LaterHost, PictureHost {
  readonly meshes = new Succession();
  settings: Settings;
  readonly stream: StreamControl;
  readonly notices: Notices;
  readonly controls: Controls;
  private readonly shown: ShownPicture;
  private readonly endGround: () => void;

  /** REQUIRES: the page's root holds the markup. */
  constructor(
    private readonly page: Page,
    readonly client: Client,
    readonly kept: Kept,
  ) {
    // The stream of a file begins at once and needs the limit.
    this.settings = readSettings((name) => page.read(name));
    this.notices = new Notices(page.root, (source) =>
      source === 'graphics' ? this.shown.restart() : void this.stream.open(),
    );
    this.stream = new StreamControl(page, kept, client, {
      limit: () => this.settings.limit,
      time: () => this.settings.time,
      keptField: () => this.meshes.coming.keptField,
      opens: (isSame, place) => this.opens(isSame, place),
      changed: (state, attempt, delayMs) => this.showState(state, attempt, delayMs),
      failed: (code, message) => this.failed(code, message),
    });
    this.controls = new Controls(page, this);
    this.shown = new ShownPicture(page, kept, this);
    this.endGround = watchGround(() => this.apply());
    void this.stream.open();
  }

  buildShell(): void {
    const {progress} = this.controls.buildShell();
    progress.begin(this.mesh.manifest);
    progress.takePlan(this.mesh.plan);
    this.showState(this.stream.state, 0, 0);
    this.apply();
  }

  dispose(): void {
    this.endGround();
    this.shown.dispose();
    this.stream.dispose();
    this.controls.dispose();
  }

  get mesh(): ShownMesh {
    return this.meshes.shown;
  }
  get view(): View | null {
    return this.shown.view;
  }
  get later(): Later | null {
    return this.controls.later;
  }
  get range(): ShownRange | null {
    return this.shown.range;
  }

  /** Brings everything in line with the attributes. */
  apply(): void {
    const {controls, later, page} = this;
    if (!controls.shell) return;
    this.derive();
    const before = this.settings;
    this.settings = settingsFor(this.mesh, (name) => page.read(name));
    this.stream.follow();
    later?.update(this.settings, this.mesh);
    const {limit} = this.settings;
    if (!isEqual(before.limit, limit)) this.stream.setLimit(limit);
    this.shown.apply();
  }

  /** Reads the definitions of derived fields, by a part that is loaded on use. */
  private derive(): void {
    const mesh = this.meshes.coming;
    const {derived, manifest, own} = mesh;
    const text = this.page.read('derived') ?? '';
    if (manifest && derived) return derived.read(text, mesh, this.client, () => this.apply());
    if (own || (text === '' && !manifest?.fields.some((its) => this.hasQuantities(its)))) return;
    mesh.own = true;
    import('./page/own_fields').then(
      ({OwnFields}) => {
        mesh.own = new OwnFields();
        this.apply();
      },
      () => (mesh.own = null), // the next change tries again
    );
  }

  /** Those of vectors wait for the first picture, unless an attribute names one. */
  private hasQuantities({components, association}: FieldInfo): boolean {
    const isNamed = /\.(div|vorticity|Q)\b/.test([...this.page.view.values()].join());
    const isTime = this.later !== null || isNamed;
    return components === 6 || (components === 3 && association === 'point' && isTime);
  }

  get isPlaying(): boolean {
    return this.later?.time.isPlaying === true;
  }

  // ---- ActionsHost, PanelsHost

  async picture(): Promise<Blob | null> {
    const ground = getComputedStyle(this.page.element).getPropertyValue('--ground-now');
    return this.view?.picture(ground) ?? null;
  }

  async movie(options: MovieOptions): Promise<Blob> {
    await this.controls.load();
    if (!this.later) throw new Error('What makes movies cannot be loaded. Try again later.');
    return this.later.movie(options);
  }

  togglePause(): void {
    this.stream.togglePause();
  }

  look(direction: Direction | null): void {
    this.controls.shell?.cards.refit();
    this.view?.look(direction);
  }

  // ---- TimeHost

  get isHurried(): boolean {
    return this.later?.hurry.isOn === true;
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
    void this.controls.load(); // there may be no picture
    this.page.dispatch('error', {code, message});
  }

  // ---- from the worker

  receive(message: Exclude<FromWorker, {type: 'answer'}>): void {
    switch (message.type) {
      case 'manifest':
        return this.takeManifest(message);
      case 'plan':
        this.meshes.coming.plan = message.plan;
        return this.controls.shell?.progress.takePlan(message.plan);
      case 'base':
        this.meshes.coming.base = message.figures;
        return this.apply();
      case 'snapshot':
        return this.shown.take(message.snapshot);
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
      this.controls.shell?.progress.takeFields(manifest);
      return this.apply();
    }
    if (!this.meshes.next) this.view?.setFocus(manifest.focus ?? null);
    this.controls.shell?.progress.begin(manifest);
    this.apply();
  }

  private takeProgress(progress: LogFigures): void {
    const {coming: mesh, next} = this.meshes;
    const isMore = progress.here.length !== mesh.progress.here.length;
    mesh.progress = progress;
    if (isMore && mesh.ahead.plotted.length > kMaxAhead) this.apply(); // asks for the next ones
    this.later?.time.follow();
    if (!next) this.later?.panels.inspect.takeProgress();
    this.controls.shell?.progress.show(progress.statistics);
    this.page.dispatch('progress', progress.statistics);
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
    if (stays) return true;
    this.shown.clear(isSame);
    this.controls.shell?.clear();
    this.later?.panels.clear();
    return false;
  }

  // ---- the state

  private showState(state: StreamState, attempt: number, delayMs: number): void {
    if (state === 'paused' || state === 'failed') void this.controls.load(); // no picture is due
    this.stream.tellComplete(this.meshes.coming);
    const {shell} = this.controls;
    if (!shell) return;
    shell.progress.showState(state, attempt, delayMs, this.meshes.coming.isSuccessor);
    this.later?.panels.showState(state);
    if (state === 'streaming' || state === 'complete') this.notices.endOf('stream');
  }
}
