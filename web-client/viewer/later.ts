// The parts of a viewer that the first picture does not need. They are loaded behind it.

import {errorText} from '../core/protocol/errors';
import type {View} from '../webgl/view';
import {beginsLog} from '../core/protocol/magic';
import type {Snapshot, StreamState} from '../core/session/worker_messages';
import styles from './controls.css?inline';
import {kCards, kCube, kDialogs} from './controls_template';
import {kControls, kPanelKinds} from './sections';
import type {ShownMesh} from './page/shown_mesh';
import type {Settings} from './settings/settings';
import {unfittingParts, unknownNames, wrongParts} from './settings/wrong_parts';
import {Actions, type ActionsHost} from './page/actions';
import {find} from './page/find';
import {Hurry} from './page/hurry';
import {bindKeys} from './page/keys';
import type {Kept, Page} from './page/page';
import {tellOfSoftwareGraphics} from './page/software_graphics';
import {adopt, insertMarkup, setMarkup} from './page/trusted';
import {Undo} from './page/undo';
import {ErrorCurve} from './panels/error_curve';
import {Hover} from './panels/hover';
import {OrientationCube} from './panels/orientation_cube';
import type {PanelsHost} from './panels/panel';
import {Panels} from './panels/panels';
import type {Shell} from './panels/shell';
import {TimeBar, type TimeHost} from './panels/time_bar';
import type {MeshDrop} from './drop/mesh_drop';
import {leftOut} from './drop/together';
import type {MovieOptions} from './picture/movies';
import type {Pictures} from './picture/pictures';

export interface LaterHost extends ActionsHost, PanelsHost, TimeHost {
  readonly kept: Kept;
  readonly stream: {
    readonly state: StreamState;
    choose(mesh: string): void;
    readonly logAddress: string;
    openFile(file: File, notice?: string): void;
  };
  readonly notices: {end(code: string): void};
}

/** A part that is loaded when it is wanted. The next call tries again if the server is away. */
class Wanted<T> {
  private loading: Promise<T> | null = null;

  constructor(
    private readonly load: () => Promise<T>,
    private readonly failed: () => void,
  ) {}

  async get(): Promise<T | null> {
    try {
      this.loading ??= this.load();
      return await this.loading;
    } catch {
      this.loading = null;
      this.failed();
      return null;
    }
  }
}

export class Later {
  readonly panels: Panels;
  readonly actions: Actions;
  readonly time: TimeBar;
  readonly hurry: Hurry;
  private readonly cube: OrientationCube;
  private readonly hover: Hover;
  private readonly ends = new AbortController();
  private seen = '';
  /** The sentences about attributes that were shown last. */
  private wrong = '';
  private readonly pictures: Wanted<Pictures>;
  private readonly meshDrop: Wanted<MeshDrop>;

  constructor(
    private readonly page: Page,
    private readonly host: LaterHost,
    shell: Shell,
  ) {
    const {root} = page;
    adopt(root, styles, 'before');
    setMarkup(find(root, '.controls'), kControls);
    insertMarkup(find(root, '.panel'), kCards);
    insertMarkup(find(root, '.notice'), kCube);
    insertMarkup(find(root, '.notice'), kDialogs);
    find(root, '.actions').inert = false;
    this.pictures = new Wanted(
      () => import('./picture/pictures').then(({Pictures}) => new Pictures(page, host)),
      () => host.failed('no-picture', 'What makes pictures cannot be loaded. Try again later.'),
    );
    this.meshDrop = new Wanted(
      () =>
        import('./drop/mesh_drop').then(({MeshDrop}) => new MeshDrop(page, host, this.ends.signal)),
      () =>
        host.failed(
          'dropped-mesh',
          'What simplifies meshes cannot be loaded. Make a log by `qtet simplify` and drop that.',
        ),
    );
    this.hurry = new Hurry(page.element);
    this.actions = new Actions(page, host);
    const {actions} = this;
    const {signal} = this.ends;
    const take = (files: File[]): void => void this.take(files);
    this.panels = new Panels({page, host, actions, signal, take}, kPanelKinds, shell.cards);
    shell.progress.attach(new ErrorCurve(find(root, '.curve')));
    this.cube = new OrientationCube(find(page.root, '.orientation-cube'), (direction) =>
      host.look(direction),
    );
    this.hover = new Hover(page.root, {
      get view() {
        return host.view;
      },
      get shown() {
        const {manifest, snapshot} = host.mesh;
        return manifest && snapshot?.color && host.opening === null
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
      signal,
    );
    this.time = new TimeBar(page.root, page, host, signal);
    this.takeDrops();
    this.panels.showState(host.stream.state);
    if (host.view) this.attach(host.view);
  }

  dispose(): void {
    this.ends.abort();
    this.hurry.end();
    this.panels.inspect.dispose();
  }

  /** Must be called with each new view. */
  attach(view: View): void {
    bindKeys(find(this.page.root, '.scene'), this.actions.keys(view));
    tellOfSoftwareGraphics(this.page.root, view.renderer);
    this.follow();
  }

  /** Brings the controls in line with the attributes and the mesh. */
  update(settings: Settings, mesh: ShownMesh): void {
    const {hurry, time} = this;
    const {kept} = this.host;
    this.tellWrongParts();
    this.panels.update(settings, mesh);
    time.update(settings, mesh);
    if (kept.playing && time.isShown) {
      kept.playing = false;
      time.isPlaying = true;
    }
    if (!time.isPlaying) hurry.end();
  }

  /** Says which attributes the picture does not follow, and why. */
  private tellWrongParts(): void {
    const {host, page} = this;
    const {derived, isDeriving, manifest} = host.mesh;
    if (isDeriving) return;
    const read = page.read.bind(page);
    const sentences = [
      ...unknownNames(page.unknown),
      ...wrongParts(read),
      ...(derived?.errors ?? []),
    ];
    if (manifest) sentences.push(...unfittingParts(read, manifest));
    const text = sentences.join('\n');
    if (text === this.wrong) return;
    this.wrong = text;
    if (text === '') host.notices.end('bad-attribute');
    else host.failed('bad-attribute', text);
  }

  forgetWrongParts(): void {
    this.wrong = '';
  }

  /** Opens the dialog that makes a picture. */
  async picture(): Promise<void> {
    (await this.pictures.get())?.picture();
  }

  /** A movie of the shown series. */
  async movie(options: MovieOptions): Promise<Blob> {
    const pictures = await this.pictures.get();
    if (!pictures) throw new Error('What makes movies cannot be loaded. Try again later.');
    return pictures.movie(options);
  }

  /** A log that is dropped is shown, a mesh is simplified before. A picture opens its view. */
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
        const files = [...(event.dataTransfer?.files ?? [])];
        if (files.length === 0) return;
        event.preventDefault();
        void this.take(files);
      },
      {signal},
    );
  }

  private async take(files: File[]): Promise<void> {
    const [file] = files as [File];
    const first = new Uint8Array(await file.slice(0, 8).arrayBuffer());
    if (beginsLog(first)) this.host.stream.openFile(file, leftOut(file, files));
    else if (file.name.endsWith('.qtet'))
      this.host.failed('dropped-mesh', `${file.name} is no log, or it is damaged. Copy it again.`);
    else if (file.name.endsWith('.json')) await this.takeColors(file);
    else if (file.type.startsWith('image/')) await (await this.pictures.get())?.open(file);
    else await (await this.meshDrop.get())?.take(files);
  }

  /** A colour map of ParaView. */
  private async takeColors(file: File): Promise<void> {
    const {host, page} = this;
    try {
      const {readColorMap} = await import('./drop/color_map_file');
      page.write('colormap', await readColorMap(file));
    } catch (thrown) {
      host.failed('dropped-colors', errorText(thrown));
    }
  }

  /** As Panels.showPicture. */
  showPicture(snapshot: Snapshot, frameMs: number): void {
    this.panels.showPicture(snapshot, frameMs);
    this.hover.showPicture();
    this.time.follow();
  }

  /** Must be called after every frame. */
  follow(): void {
    this.panels.follow();
    const {view} = this.host;
    const {pose} = view ?? {};
    const seen = pose?.toCanvas.join() ?? '';
    if (!pose || seen === this.seen) return;
    this.seen = seen;
    this.cube.turn(pose.axes);
    this.cube.avoid(pose.outline.map((point) => view!.project(point)));
    this.hover.hide();
  }
}
