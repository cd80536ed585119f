// <qtet-viewer>: a progressive tetrahedral mesh in a web page.
//
// Attributes
//   src          address of the server, by default the page's own; or of a .qtet file on any web
//                server
//   transport    auto (default), websocket, range or chunks: how a server's logs come
//   mesh         id of the mesh; without it the viewer offers a menu and starts with the first
//   field        name of the field, "NAME[0]" for a component; by default the first
//   colormap     viridis (default), cividis, cool-warm, turbo or grey; "turbo reversed"
//   range        "auto" (default), "symmetric" or "LOW,HIGH"
//   scale        "log"
//   edges        "off" hides them
//   surface      "off" hides it
//   opacity      of the surface: above 0, at most 1
//   clip         up to three planes: axis x, y or z or a direction "1,0,1", a share of the extent
//                after a colon, "-" before an axis for the other side: "y", "-x:0.3 z:0.5"
//   clip-mode    cut (default), cells, slice
//   iso          "FIELD=VALUE,VALUE..."
//   threshold    "FIELD=LOW,HIGH"
//   volume       opacities at even shares of the colours' range, "0,0.1,0.5": the cells are seen
//                through instead of the surface
//   quality      full (default), "error:0.01" or "1%", "cells:N", "bytes:N": how far to refine
//   projection   "parallel"
//   camera       six numbers, as the property `cameraState` gives them
// Events         load (first picture), progress, refine (a finer picture), complete (the whole mesh
//                is on the screen), error, camera-change, view-change (an attribute of the view);
//                `detail` holds the figures, the error, the camera or the attribute
// Slots          poster (shown until the first picture), progress (instead of the viewer's own)
// Parts          canvas, panel, progress, legend, result, notice
// Methods        digest(), pause(), resume(), resetView(), look(direction), picture()
// Properties     counts, statistics, state, view, cameraState, token

import type {Counts} from '../core/counts';
import {kTransportKinds} from '../core/auto_transport';
import type {Vector} from '../core/cell_ray';
import {Client} from '../core/client';
import {kMaxPlanes, type Display} from '../core/display';
import {errorCode, errorText, QtetError} from '../core/errors';
import {kMagnitude, type Scalar} from '../core/field_scale';
import type {LevelBytes} from '../core/goal';
import {kFull} from '../core/limit';
import type {Manifest} from '../core/manifest';
import {kNoStatistics, type Statistics} from '../core/statistics';
import type {ViewRequest} from '../core/view_request';
import type {FromWorker, Snapshot, StreamState} from '../core/worker_messages';
import type {CameraState} from '../three/camera';
import {kDirections, type Direction} from '../three/directions';
import {openView} from '../three/far_view';
import type {View} from '../three/view';
import {fetchCatalog, isLogFile, logUrl, meshOfLog, streamUrl, type MeshEntry} from './catalog';
import {ClipHandles} from './clip_handles';
import {ClipPanel, planeOf} from './clip_panel';
import {ColorPanel} from './color_panel';
import {formatCount} from './format';
import {Inspect} from './inspect';
import {bindKeys} from './keys';
import {insetsOf} from './layout';
import {Legend} from './legend';
import {LevelPanel} from './level_panel';
import {scalarTitle, type Host, type Scene} from './panel';
import {ProgressPanel} from './progress_panel';
import {fillSelect} from './select';
import {
  kViewAttributes,
  parseFieldValues,
  parseScalar,
  readSettings,
  scalarKey,
  sharesOf,
  shownRange,
  type Settings,
  type ViewAttribute,
} from './settings';
import {embedSnippet, linkTo} from './share';
import styles from './style.css?inline';
import {kTemplate} from './template';
import {Triad} from './triad';
import {ValuePanel} from './value_panel';
import {VolumePanel} from './volume_panel';

/** Narrower than this, the panel is a sheet at the foot (style.css says the same). */
const kSheetPixels = 640;
/** The camera is told of once it rests. */
const kRestMs = 250;
/**
 * Notices that the stream has nothing to do with: opening it anew does not help, and its going on
 * ends none of them.
 */
const kNotOfStream = ['unknown-field', 'no-fullscreen', 'no-picture'];
/** Notices of the graphics: their way out is to begin drawing anew. */
const kOfGraphics = ['no-view', 'slow-view', 'silent-view', 'drawing', 'graphics-lost'];
/**
 * Graphics may take long to start where software draws; after this the user may begin anew, or go
 * on waiting.
 */
const kStartPatienceMs = 30000;

interface Parts {
  progress: ProgressPanel;
  legend: Legend;
  color: ColorPanel;
  clip: ClipPanel;
  iso: ValuePanel;
  volume: VolumePanel;
  threshold: ValuePanel;
  level: LevelPanel;
  handles: ClipHandles;
  inspect: Inspect;
  resizes: ResizeObserver;
}

export class QtetViewer extends HTMLElement implements Host {
  static readonly observedAttributes = ['src', 'transport', ...kViewAttributes];

  client: Client | null = null;
  meshView: View | null = null;
  manifest: Manifest | null = null;
  private readonly root = this.attachShadow({mode: 'open'});
  private parts: Parts | null = null;
  private catalog: MeshEntry[] = [];
  private pending: Snapshot | null = null;
  private snapshot: Snapshot | null = null;
  private settings: Settings = readSettings(() => null);
  private bounds: number[] = [];
  private sentDisplay = '';
  private plan: LevelBytes[] = [];
  /** Of what is shown some has no value. */
  private hasMissing = false;
  /** The server and the mesh that were opened last. */
  private opened = '';
  /** What users have not been freed of: the last one is shown. */
  private notices: {code: string; message: string}[] = [];
  private loaded = false;
  private completionTold = false;
  /** Of the picture on the screen. */
  private drawn: Statistics | null = null;
  private streamState: StreamState = 'connecting';
  private figures: Statistics = kNoStatistics;
  private writing = false;
  private cameraTimer: ReturnType<typeof setTimeout> | undefined;
  private point: Vector | null = null;
  /** As Inspect's host. */
  middle: [number, number] = [0.5, 0.5];
  private toldCamera = '';
  private toldRequest = '';
  private lastCells: {at: number; cells: number} = {at: 0, cells: 0};
  private bearer = '';
  private openings = 0;
  private earlyCamera: CameraState | null = null; // asked for before there was a view
  private pausedEarly = false; // before there was a stream
  /** There is a stream of the mesh that was opened last. */
  private started = false;
  /** Since the first step: before it there is nothing in the shadow root. */
  private begun = false;

  // ---- for the page

  /**
   * What a server whose meshes are guarded asks for (proto/PROTOCOL.md, "Tokens"); a property, so
   * that it stands in no page's text.
   */
  get token(): string {
    return this.bearer;
  }
  set token(token: string) {
    this.bearer = token;
    if (this.begun) void this.open();
  }

  get state(): StreamState {
    return this.streamState;
  }
  get statistics(): Statistics {
    return this.figures;
  }
  get counts(): Counts {
    const {tetrahedra, vertices, boundaryTriangles} = this.figures;
    return {tetrahedra, vertices, boundaryTriangles};
  }
  /** Attributes that show the same picture again, with the camera as it stands. */
  get view(): Map<string, string> {
    const view = new Map<string, string>();
    for (const name of kViewAttributes) {
      const value = this.getAttribute(name);
      if (value !== null && name !== 'camera') view.set(name, value);
    }
    if (!view.has('mesh') && this.catalog.length > 0) view.set('mesh', this.select('mesh').value);
    if (this.meshView && !this.meshView.pose.fitted)
      view.set('camera', this.meshView.cameraState.join(','));
    return view;
  }
  get cameraState(): CameraState | null {
    return this.meshView?.cameraState ?? null;
  }
  set cameraState(state: CameraState | null) {
    if (state && this.meshView) this.meshView.cameraState = state;
    this.earlyCamera = this.meshView ? null : state;
  }

  /** SHA-256 of the decoded mesh (codec/FORMAT.md, "Mesh digest"); empty before there is one. */
  async digest(): Promise<string> {
    return this.client?.digest() ?? '';
  }
  pause(): void {
    if (this.started) this.client?.pause();
    else this.pausedEarly = this.streamState !== 'failed';
  }
  resume(): void {
    this.pausedEarly = false;
    if (this.started) this.client?.resume();
  }
  resetView(): void {
    this.meshView?.look(null);
  }
  look(direction: Direction): void {
    this.meshView?.look(direction);
  }
  /** The scene as a PNG; null before there is one. */
  async picture(): Promise<Blob | null> {
    return this.meshView?.picture(getComputedStyle(this).getPropertyValue('--ground')) ?? null;
  }

  // ---- Host, InspectHost

  write(name: ViewAttribute, value: string | null): void {
    if (value === null) this.removeAttribute(name);
    else this.setAttribute(name, value);
  }
  read(name: ViewAttribute): string | null {
    return this.getAttribute(name);
  }
  get fieldTitle(): string {
    return this.manifest && this.color ? scalarTitle(this.color, this.manifest.fields) : '';
  }
  pointAt(point: Vector | null): void {
    this.point = point;
    this.lookAt();
  }
  announce(text: string): void {
    const live = this.root.querySelector('.live');
    if (live) live.textContent = text;
  }

  // ---- custom element

  /**
   * In steps, each a task of its own: a page stands still for the longest of them, not for their
   * sum.
   */
  connectedCallback(): void {
    const client = (this.client = new Client((message) => this.receive(message)));
    const steps = [
      (): void => {
        this.root.innerHTML = `<style>${styles}</style>${kTemplate}`;
        this.begun = true;
        // a file's stream begins at once, and only so far
        this.settings = readSettings((name) => this.getAttribute(name));
        void this.prepareView(client, this.settings.camera);
        void this.open();
      },
      (): void => this.build(),
    ];
    const step = (): void => {
      if (this.client !== client) return;
      steps.shift()?.();
      if (steps.length > 0) setTimeout(step);
    };
    setTimeout(step);
  }

  private build(): void {
    const clip = new ClipPanel(
      this.root,
      this,
      () =>
        (this.meshView?.pose.direction ?? [0, -1, 0]).map((x) => -x) as [number, number, number],
    );
    this.parts = {
      progress: new ProgressPanel(this.root, (text) => this.announce(text)),
      legend: new Legend(this.root),
      color: new ColorPanel(this.root, this),
      clip,
      iso: new ValuePanel(this.root, this, 'iso'),
      threshold: new ValuePanel(this.root, this, 'threshold'),
      volume: new VolumePanel(this.root, this),
      level: new LevelPanel(
        this.root,
        (quality) => this.write('quality', quality),
        () => ({
          statistics: this.figures,
          manifest: this.manifest,
          fields: this.color ? [this.color.field] : [],
        }),
      ),
      handles: new ClipHandles(this.find('.layer'), kMaxPlanes, (i, share) => clip.move(i, share)),
      inspect: new Inspect(this.root, inspectHost(this)),
      resizes: new ResizeObserver(() => this.arrange()),
    };
    this.bindControls();
    this.fold(this.isNarrow);
    for (const card of ['.panel', '.result']) this.parts.resizes.observe(this.find(card));
    this.parts.resizes.observe(this);
    this.parts.progress.begin(this.manifest);
    this.parts.progress.takePlan(this.plan);
    this.setState(this.streamState);
    if (this.meshView) this.parts.handles.attach(this.meshView);
    this.apply();
  }

  disconnectedCallback(): void {
    clearTimeout(this.cameraTimer);
    this.client?.dispose();
    this.meshView?.dispose();
    this.parts?.resizes.disconnect();
    this.client = this.meshView = this.parts = null;
    this.begun = this.started = false;
    this.notices = [];
    this.streamState = 'connecting';
    this.forget();
  }

  attributeChangedCallback(name: string, before: string | null, after: string | null): void {
    if (!this.begun || before === after) return; // the first step reads them all
    if (name === 'src' || name === 'transport' || (name === 'mesh' && !this.writing))
      void this.open();
    else this.apply();
    if (name === 'camera' && this.settings.camera && this.meshView)
      this.meshView.cameraState = this.settings.camera;
    if (name !== 'src' && name !== 'transport') this.tell('view-change', {name, value: after});
  }

  /** Brings everything in line with the attributes. */
  private apply(): void {
    if (!this.parts) return;
    const before = this.settings;
    this.settings = readSettings((name) => this.getAttribute(name));
    const {parts, settings} = this;
    const scene: Scene | null =
      this.manifest && this.bounds.length > 0
        ? {manifest: this.manifest, bounds: this.bounds}
        : null;
    const known: Scene | null = this.manifest && {manifest: this.manifest, bounds: this.bounds};
    for (const panel of [parts.color, parts.iso, parts.threshold, parts.volume])
      panel.update(settings, known);
    parts.clip.update(settings, scene);
    parts.level.update(settings);
    parts.handles.update(settings.planes, this.bounds);
    this.input('parallel').checked = settings.parallel;
    if (this.meshView) {
      this.meshView.setLook(settings);
      this.meshView.setParallel(settings.parallel);
    }
    if (this.started && JSON.stringify(before.limit) !== JSON.stringify(settings.limit))
      this.client?.setLimit(settings.limit);
    this.showDisplay();
    this.showLegend();
  }

  // ---- start

  private async prepareView(client: Client, start: CameraState | null): Promise<void> {
    const canvas = this.find<HTMLCanvasElement>('.scene');
    const patience = setTimeout(
      () =>
        this.addNotice(
          'slow-view',
          'The graphics have not started yet. They may only be slow; beginning anew helps if ' +
            'they hang.',
        ),
      kStartPatienceMs,
    );
    try {
      const triad = new Triad(this.find<SVGSVGElement>('.triad'));
      const view = await openView(canvas, {
        drawn: ({rotation}) => {
          triad.turn(rotation);
          this.parts?.handles.place();
          this.parts?.inspect.place();
          this.restCamera();
        },
        lost: (lost) => this.graphicsLost(lost),
        failed: (why) =>
          this.notify(
            'drawing',
            `Something went wrong while drawing: ${why}. If the picture is not right, try again.`,
          ),
        silent: (silent) => {
          if (silent)
            this.addNotice(
              'silent-view',
              'The part that draws does not answer: it hangs, or the browser has ended it. Try ' +
                'again to start it anew; the view stays as it is.',
            );
          else this.endNotices((code) => code === 'silent-view');
        },
        coarse: (have) => this.client?.coarse(have) ?? Promise.reject(new Error('closed')),
      });
      if (this.client !== client || !canvas.isConnected) return view.dispose();
      this.meshView = view;
      this.endNotices((code) => code === 'slow-view');
      this.parts?.handles.attach(view);
      const camera = this.earlyCamera ?? start;
      if (camera) view.cameraState = camera;
      this.bindKeys(canvas, view);
      this.apply();
      this.arrange();
      if (this.pending) this.draw(this.pending);
      this.pending = null;
    } catch (thrown) {
      if (canvas.isConnected)
        this.notify(
          'no-view',
          `The 3D view cannot start: ${errorText(thrown)}. It needs a browser with WebGL 2; ` +
            'trying again may help.',
        );
    } finally {
      clearTimeout(patience);
    }
  }

  /**
   * Another worker and another canvas, for a canvas is given away once; the camera stays, and the
   * mesh comes again from the worker that decodes.
   */
  private restartView(): void {
    const {client, meshView} = this;
    if (!client) return;
    this.endNotices((code) => kOfGraphics.includes(code));
    const camera = !meshView
      ? this.settings.camera
      : meshView.pose.fitted
        ? null
        : meshView.cameraState;
    meshView?.dispose();
    this.meshView = null;
    const canvas = this.find('.scene');
    canvas.replaceWith(canvas.cloneNode());
    client.repeat();
    void this.prepareView(client, camera);
  }

  private get base(): URL {
    return new URL(this.getAttribute('src') ?? '.', document.baseURI);
  }

  private async open(): Promise<void> {
    const opening = ++this.openings; // a later one counts, whichever list comes first
    this.started = false;
    try {
      this.setState('connecting');
      const file = isLogFile(this.base);
      const catalog = file
        ? [{id: meshOfLog(this.base), tetrahedra: 0, fields: []}]
        : await fetchCatalog(this.base, this.bearer);
      if (!this.client || opening !== this.openings) return;
      this.catalog = catalog;
      const wanted = file ? null : this.getAttribute('mesh');
      const mesh = wanted ?? this.catalog[0]?.id;
      if (mesh === undefined)
        throw new QtetError(
          'not-found',
          `The server shows no meshes. Put .qtet files into its folder; for guarded ones set ` +
            `the viewer's property "token".`,
        );
      const isThere = this.catalog.some(({id}) => id === mesh);
      const menu = this.catalog.length > (isThere ? 1 : 0);
      fillSelect(
        this.select('mesh'),
        this.catalog.map(({id}) => ({value: id, title: id})),
        mesh,
      );
      this.find('.mesh-menu').hidden = !menu;
      this.find('.mesh-name').classList.toggle('visually-hidden', menu);
      if (!isThere) {
        const names = this.catalog.map(({id}) => id).join(', ');
        throw new QtetError(
          'not-found',
          `There is no mesh "${mesh}" on this server. ` +
            `It has: ${names || 'none that may be seen without a token'}.`,
        );
      }
      this.openMesh(mesh);
    } catch (thrown) {
      if (opening === this.openings) this.fail(thrown);
    }
  }

  private openMesh(mesh: string): void {
    const opened = `${this.base.href} ${mesh}`;
    this.forget(opened === this.opened);
    this.opened = opened;
    this.endNotices((code) => !kOfGraphics.includes(code));
    this.find('.mesh-name').textContent = this.find('.title').title = mesh;
    this.find('.scene').setAttribute(
      'aria-label',
      `3D view of ${mesh}. Arrow keys turn it, plus and minus zoom; the question mark lists ` +
        'all keys.',
    );
    const fields = this.catalog.find(({id}) => id === mesh)?.fields ?? [];
    const named = [
      this.getAttribute('field'),
      ...['iso', 'threshold'].map(
        (name) => this.getAttribute(name)?.replace(/=[^=]*$/, '') ?? null,
      ),
    ]
      .filter((text) => text !== null)
      .map((text) => (fields.includes(text) ? text : scalarKey(text)));
    const file = isLogFile(this.base);
    // Of a file nobody knows the fields before its head is here.
    const first = named.length > 0 ? [...new Set(named)] : file ? null : fields.slice(0, 1);
    const transport =
      kTransportKinds.find((kind) => kind === this.getAttribute('transport')) ?? 'auto';
    this.client?.start({
      url: file ? '' : streamUrl(this.base),
      log: file ? this.base.href : logUrl(this.base, mesh),
      transport,
      mesh,
      fields: first,
      limit: this.settings.limit,
      pictureFirst: true,
      paused: this.pausedEarly,
      ...(this.bearer && {token: this.bearer}),
    });
    this.started = true;
    this.pausedEarly = false;
  }

  /** With `sameMesh` the camera stays where people have moved it. */
  private forget(sameMesh = false): void {
    this.manifest = this.pending = this.snapshot = this.drawn = null;
    this.bounds = this.plan = [];
    this.sentDisplay = this.toldRequest = '';
    this.loaded = false;
    this.figures = kNoStatistics;
    this.lastCells = {at: 0, cells: 0};
    if (this.meshView) {
      const {
        pose: {fitted},
        cameraState,
      } = this.meshView;
      this.meshView.clear();
      if (sameMesh && !fitted) this.meshView.cameraState = cameraState;
    }
    if (!this.parts) return;
    this.parts.progress.begin(null);
    this.parts.inspect.clear();
    this.parts.legend.hide();
    this.parts.handles.update([], []);
  }

  // ---- from the worker

  private receive(message: Exclude<FromWorker, {type: 'answer'}>): void {
    switch (message.type) {
      case 'manifest':
        return this.takeManifest(message.manifest);
      case 'plan':
        this.plan = message.plan;
        return this.parts?.progress.takePlan(this.plan);
      case 'snapshot':
        return this.meshView ? this.draw(message.snapshot) : void (this.pending = message.snapshot);
      case 'progress':
        return this.takeProgress(message.statistics);
      case 'state':
        return this.setState(message.state, message.attempt, message.delayMs);
      case 'error':
        return this.notify(message.code, message.message);
    }
  }

  private takeManifest(manifest: Manifest): void {
    if (this.manifest) this.forget(true); // another log stands under its name now
    this.manifest = manifest;
    this.parts?.progress.begin(manifest);
    this.apply();
  }

  private takeProgress(statistics: Statistics): void {
    this.figures = statistics;
    this.parts?.progress.show(statistics);
    this.tell('progress', statistics);
  }

  private draw(snapshot: Snapshot): void {
    // else they are newer: a picture may have waited for a view
    if (this.figures === kNoStatistics) this.figures = snapshot.statistics;
    this.snapshot = snapshot;
    if (snapshot.surface)
      this.hasMissing = [snapshot.surface, ...snapshot.cuts].some(({values}) =>
        values.some(Number.isNaN),
      );
    const {manifest} = this;
    this.meshView!.show(snapshot, (drawingMs) => {
      if (manifest !== this.manifest) return; // of the mesh before
      this.client?.shown(drawingMs);
      this.tell(this.loaded ? 'refine' : 'load', snapshot.statistics);
      this.loaded = true;
      this.classList.add('loaded');
      this.drawn = snapshot.statistics;
      this.tellComplete();
    });
    if (this.bounds.length === 0) {
      this.bounds = snapshot.bounds;
      this.apply();
    }
    this.showStatistics(snapshot);
    this.showLegend();
  }

  /** The decoder may be done long before the picture is: both have to be. */
  private tellComplete(): void {
    const {drawn} = this;
    if (
      this.streamState !== 'complete' ||
      this.completionTold ||
      !drawn ||
      drawn.bytes < this.figures.bytesNeeded
    )
      return;
    this.completionTold = true;
    this.tell('complete', drawn);
  }

  private setState(state: StreamState, attempt = 0, delayMs = 0): void {
    this.streamState = state;
    this.completionTold &&= state === 'complete';
    this.tellComplete();
    if (!this.parts) return;
    this.parts.progress.showState(state, attempt, delayMs);
    const pause = this.find<HTMLButtonElement>('.pause');
    pause.hidden = state === 'complete' || state === 'failed';
    pause.textContent = state === 'paused' || state === 'held' ? 'Continue' : 'Pause';
    if (state === 'streaming' || state === 'complete')
      this.endNotices((code) => ![...kNotOfStream, ...kOfGraphics].includes(code));
  }

  // ---- to the worker

  /** What colours: the attribute's field, or the first. */
  private get color(): Scalar | null {
    const fields = this.manifest?.fields ?? [];
    return (
      parseScalar(this.getAttribute('field'), fields) ??
      (fields.length > 0 ? {field: 0, component: kMagnitude} : null)
    );
  }

  private showDisplay(): void {
    if (!this.manifest) return;
    const {
      settings,
      manifest: {fields},
    } = this;
    const iso = this.parts!.iso.value();
    const threshold = parseFieldValues(this.getAttribute('threshold'), fields);
    const ends = threshold && sharesOf(threshold, fields);
    const display: Display = {
      color: this.color,
      body: settings.surface && settings.volume === null,
      mode: settings.planes.length > 0 ? settings.mode : 'cut',
      planes:
        this.bounds.length > 0 ? settings.planes.map((plane) => planeOf(plane, this.bounds)) : [],
      isosurfaces: iso && {scalar: iso.scalar, values: sharesOf(iso, fields)},
      volume: settings.volume !== null,
      threshold:
        threshold && ends!.length === 2
          ? {scalar: threshold.scalar, low: ends![0]!, high: ends![1]!}
          : null,
    };
    const text = JSON.stringify(display);
    if (text === this.sentDisplay) return;
    this.sentDisplay = text;
    this.parts!.progress.follow(display.color ? [display.color.field] : [], settings.limit);
    this.client?.show(display);
    this.lookAt();
  }

  /** Tells a log of regions what to refine first. */
  private lookAt(): void {
    const planes =
      this.bounds.length > 0
        ? this.settings.planes.map((plane) => planeOf(plane, this.bounds))
        : [];
    const request: ViewRequest = {
      frustum: this.meshView?.pose.frustum ?? [],
      planes,
      point: this.point,
    };
    const text = JSON.stringify(request);
    if (text !== this.toldRequest) this.client?.look(request);
    this.toldRequest = text;
  }

  // ---- controls

  private bindControls(): void {
    this.select('mesh').addEventListener('change', (event) =>
      this.chooseMesh((event.target as HTMLSelectElement).value),
    );
    this.input('parallel').addEventListener('change', () =>
      this.write('projection', this.input('parallel').checked ? 'parallel' : null),
    );
    this.on('.fold', () => this.fold(!this.find('.panel').classList.contains('folded')));
    this.on('.reset', () => this.resetView());
    this.on('.pause', () => this.togglePause());
    this.on('.dismiss', () =>
      this.endNotices((code) => code === this.find('.notice').dataset.code),
    );
    this.on('.retry', () =>
      kOfGraphics.includes(this.find('.notice').dataset.code ?? '')
        ? this.restartView()
        : void this.open(),
    );
    this.on('.picture', () => void this.savePicture());
    this.on('.fullscreen', () => this.toggleFullscreen());
    this.on('.share', () => this.share());
    this.on('.help', () => this.find<HTMLDialogElement>('.help-dialog').showModal());
    this.on('.copy-link', () => void this.copy('input[name=link]'));
    this.on('.copy-snippet', () => void this.copy('textarea'));
    for (const button of this.root.querySelectorAll<HTMLButtonElement>('.look'))
      button.addEventListener('click', () => this.look(button.value as Direction));
  }

  private bindKeys(canvas: HTMLCanvasElement, view: View): void {
    bindKeys(canvas, {
      turn: (horizontal, vertical) => view.turn(horizontal, vertical),
      zoom: (factor) => view.zoom(factor),
      look: (direction) => view.look(direction === null ? null : kDirections[direction]!),
      toggle: (what) => this.toggle(what),
      moveClip: (step) => {
        if (this.settings.planes[0]) this.parts?.clip.move(0, this.settings.planes[0].share + step);
      },
      inspect: () => this.parts?.inspect.pickMiddle(),
      picture: () => void this.savePicture(),
      help: () => this.find<HTMLDialogElement>('.help-dialog').showModal(),
      escape: () => this.parts?.inspect.use('none'),
    });
  }

  private toggle(what: 'parallel' | 'edges' | 'clip' | 'pause' | 'fullscreen'): void {
    switch (what) {
      case 'parallel':
        return this.write('projection', this.settings.parallel ? null : 'parallel');
      case 'edges':
        return this.write('edges', this.settings.edges ? 'off' : null);
      case 'clip':
        return this.write('clip', this.settings.planes.length > 0 ? null : 'x:0.5');
      case 'pause':
        return this.togglePause();
      case 'fullscreen':
        return this.toggleFullscreen();
    }
  }

  private togglePause(): void {
    if (this.streamState === 'held') this.refineFully();
    else if (this.streamState === 'paused') this.resume();
    else this.pause();
  }

  /** What memory stopped has no `quality` to take away: it is tried once more. */
  private refineFully(): void {
    if (this.hasAttribute('quality')) this.write('quality', null);
    else this.client?.setLimit(kFull);
  }

  /** Another mesh has other fields, places and values; what does not depend on them stays. */
  private chooseMesh(mesh: string): void {
    this.writing = true;
    for (const name of ['field', 'range', 'iso', 'threshold', 'camera', 'quality'] as const)
      this.write(name, null);
    this.write('mesh', mesh);
    this.writing = false;
    this.openMesh(mesh);
  }

  private async savePicture(): Promise<void> {
    const picture = await this.picture().catch((thrown: unknown) =>
      this.notify('no-picture', `The picture cannot be taken: ${errorText(thrown)}.`),
    );
    if (!picture) return;
    const link = Object.assign(document.createElement('a'), {
      href: URL.createObjectURL(picture),
      download: `${this.find('.mesh-name').textContent}.png`,
    });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  private toggleFullscreen(): void {
    if (document.fullscreenElement) void document.exitFullscreen();
    else {
      this.requestFullscreen().catch(() =>
        this.notify(
          'no-fullscreen',
          'The browser does not give the whole screen to this page. Its own menu may.',
        ),
      );
    }
  }

  private share(): void {
    const link = linkTo(location.href, this.view);
    this.find<HTMLInputElement>('input[name=link]').value = link;
    this.find<HTMLTextAreaElement>('textarea').value = embedSnippet(
      link,
      `3D view of ${this.find('.mesh-name').textContent}`,
    );
    this.find<HTMLDialogElement>('.share-dialog').showModal();
  }

  private async copy(selector: string): Promise<void> {
    const box = this.find<HTMLInputElement | HTMLTextAreaElement>(selector);
    box.select();
    // A page that is not https has no clipboard.
    const clipboard = navigator.clipboard as Clipboard | undefined;
    await clipboard?.writeText(box.value).then(
      () => this.announce('Copied'),
      () => undefined,
    );
  }

  private showLegend(): void {
    if (!this.parts) return;
    const {snapshot, manifest, settings} = this;
    if (!snapshot?.color || !manifest) {
      this.parts.legend.hide();
    } else {
      const [low, high] = snapshot.scaleRange;
      const occurring = snapshot.extent.map((share) => low + share * (high - low)) as [
        number,
        number,
      ];
      const range = shownRange(settings, occurring);
      this.meshView?.setRange(range.low, range.high, snapshot.scaleRange, range.logarithmic);
      this.parts.legend.show(
        snapshot.color,
        manifest.fields,
        {...range, hasMissing: this.hasMissing},
        settings,
      );
      this.parts.color.showRange(range.low, range.high);
    }
    this.arrange();
  }

  private showStatistics({costMs, statistics}: Snapshot): void {
    const now = performance.now();
    const {at, cells} = this.lastCells;
    const text = (selector: string, value: string): void =>
      void (this.find(selector).textContent = value);
    if (at > 0 && statistics.tetrahedra > cells)
      text(
        '.cell-rate',
        `${formatCount(Math.round(((statistics.tetrahedra - cells) / (now - at)) * 1000))} cells/s`,
      );
    this.lastCells = {at: now, cells: statistics.tetrahedra};
    text('.frame-ms', `${this.meshView!.pose.frameMs.toFixed(1)} ms`);
    text('.cost-ms', `${costMs.toFixed(1)} ms`);
    text('.level', `${statistics.level} of ${statistics.lastLevel}`);
    text('.vertices', formatCount(statistics.vertices));
    text('.triangles', formatCount(statistics.boundaryTriangles));
  }

  private restCamera(): void {
    clearTimeout(this.cameraTimer);
    this.cameraTimer = setTimeout(() => {
      const state = this.meshView?.cameraState;
      if (!state || this.bounds.length === 0 || state.join() === this.toldCamera) return;
      this.toldCamera = state.join();
      this.lookAt();
      this.tell('camera-change', state);
    }, kRestMs);
  }

  private get isNarrow(): boolean {
    return this.clientWidth <= kSheetPixels;
  }

  private fold(folded: boolean): void {
    this.find('.panel').classList.toggle('folded', folded);
    this.find('.fold').setAttribute('aria-expanded', String(!folded));
  }

  /** Tells the view what the cards cover. */
  private arrange(): void {
    if (!this.parts) return;
    const sheet = this.isNarrow;
    const panel = this.find('.panel');
    const insets = insetsOf(
      this,
      {panel, legend: this.find('.legend'), result: this.find('.result')},
      sheet,
    );
    this.style.setProperty('--sheet', `${sheet ? panel.offsetHeight : 0}px`);
    this.middle = [(1 + insets.left - insets.right) / 2, (1 + insets.top - insets.bottom) / 2];
    this.meshView?.setInsets(insets);
  }

  // ---- errors

  private graphicsLost(lost: boolean): void {
    if (lost)
      this.notify(
        'graphics-lost',
        'The browser took the graphics away, as it does when memory is short. The picture ' +
          'comes back when it returns them; closing other tabs helps.',
      );
    else this.endNotices((code) => code === 'graphics-lost');
  }

  private endNotices(ended: (code: string) => boolean): void {
    const {notices} = this;
    this.notices = notices.filter(({code}) => !ended(code));
    if (notices.length !== this.notices.length) this.showNotice();
  }

  /** The last one that has not ended. */
  private showNotice(): void {
    const notice = this.find('.notice');
    const {code, message} = this.notices.at(-1) ?? {code: '', message: ''};
    notice.hidden = code === '';
    if (notice.hidden) return;
    notice.dataset.code = code;
    notice.querySelector('p')!.textContent = message;
    notice.querySelector<HTMLElement>('.retry')!.hidden = kNotOfStream.includes(code);
  }

  private fail(thrown: unknown): void {
    this.notify(errorCode(thrown), errorText(thrown));
    this.setState('failed');
  }

  private addNotice(code: string, message: string): void {
    this.notices = [...this.notices.filter((notice) => notice.code !== code), {code, message}];
    this.showNotice();
  }

  private notify(code: string, message: string): void {
    if (!this.client) return;
    this.addNotice(code, message);
    this.tell('error', {code, message});
  }

  private tell(type: string, detail: unknown): void {
    this.dispatchEvent(new CustomEvent(type, {detail}));
  }

  private on(selector: string, action: () => void): void {
    this.find(selector).addEventListener('click', action);
  }
  private find<T extends Element = HTMLElement>(selector: string): T {
    return this.root.querySelector<T>(selector)!;
  }
  private select(name: string): HTMLSelectElement {
    return this.find(`select[name=${name}]`);
  }
  private input(name: string): HTMLInputElement {
    return this.find(`input[name=${name}]`);
  }
}

/** The viewer as Inspect sees it. */
function inspectHost(viewer: QtetViewer): ConstructorParameters<typeof Inspect>[1] {
  return {
    get client() {
      return viewer.client;
    },
    get view() {
      return viewer.meshView;
    },
    get manifest() {
      return viewer.manifest;
    },
    get middle() {
      return viewer.middle;
    },
    get fieldTitle() {
      return viewer.fieldTitle;
    },
    announce: (text) => viewer.announce(text),
    pointAt: (point) => viewer.pointAt(point),
  };
}
