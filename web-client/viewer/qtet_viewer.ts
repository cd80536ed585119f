// <qtet-viewer>: a progressive tetrahedral mesh in a web page.
//
// Attributes
//   src          address of the server, by default the page's own. It may be that of a .qtet file,
//                of an index.json by `qtet publish`, or of a list of segments, on any web server.
//   transport    auto (default), websocket, range or chunks: how a server's logs come.
//   mesh         id of the mesh; without it the viewer offers a menu and starts with the first.
//   derived      fields that are computed of others: "Cp = (p - 101325) / 540; dT = T@2 - T@1".
//   field        name of the field, "NAME.x" for a component; by default the log's choice.
//   field-title  its title in the legend, plots and pictures; by default its name and unit.
//   time         of a series: the instant nearest to it is shown; by default the log's choice.
//   time-range   "FROM,TO": the times that playing begins and ends at.
//   time-loop    on (default), or off: playing ends at the last instant.
//   time-group   a name: viewers of the document with the same one show the same time.
//   colormap     viridis (default), cividis, cool-warm, turbo, grey or labels; "turbo reversed".
//                "viridis/8" has eight steps; "custom:0=0000ff,1=ff0000" are own colours.
//   beyond       colours of values below and above the range: "1f3fbf,ff00ff".
//   range        "auto" (default), "full", "symmetric", "LOW,HIGH" or, of a series, "instant".
//   scale        "log".
//   edges        "off" hides them.
//   creases      "off" hides them.
//   surface      "off" hides it.
//   opacity      of the surface: above 0, at most 1.
//   warp         name of a point field of vectors that move the mesh: its deformed shape. "off"
//                leaves it at rest. By default large displacements move it.
//   warp-scale   the factor of the vectors. 1 is the true size; by default they are well visible.
//   rest-edges   "on" draws the edges of the mesh at rest while `warp` moves it.
//   clip         up to three planes. Each is an axis x, y or z or a direction "1,0,1", then a share
//                of the extent after a colon. "-" before an axis means the other side: "y",
//                "-x:0.3 z:0.5". A mesh may open with a plane; "none" opens it whole.
//   clip-mode    cut (default), cells, slice.
//   iso          "FIELD=VALUE,VALUE...".
//   threshold    "FIELD=LOW,HIGH".
//   parts        name of a label of cells, whose values are parts; by default the first.
//   hidden-parts names or numbers of parts, "Steel,3"; "all but Steel".
//   part-opacity, part-colors
//                "Steel=0.3,3=0.5"; "Steel=ff8800".
//   streamlines  name of a point field of vectors, whose lines are drawn.
//   seeds        where they begin: "even 100" (default), "line 0,0,0 1,0,0 20", "plane x:0.5 8",
//                "sphere 0,0,0 0.1 50", several with ";" between them.
//   streamline-kind
//                stream (default), or path: through the instants of the series.
//   streamline-look
//                tubes (default), lines, dashes.
//   streamline-limits
//                "steps=500 length=2 time=0.1".
//   arrows       name of a point field of vectors or symmetric tensors, drawn as arrows.
//   arrow-places shown (default), volume, vertices.
//   arrow-density, arrow-length, arrow-size, arrow-color
//                "30"; magnitude (default), log, equal; "1.5"; plain or field.
//   volume       opacities at even shares of the colours' range, "0,0.1,0.5": the cells are seen
//                through instead of the surface; "auto" suits the mesh.
//   axes         "on" draws a box with numbers round the mesh.
//   length-unit  that of coordinates, "mm"; by default that of displacements, if the log knows it.
//   ground       light, dark, white, or a colour, "3c3c3c"; by default the page's.
//   points       up to eight places of the mesh at rest with their values, "1,2,0.5 3,2,0".
//   quality      full (default), "error:0.01" or "1%", "cells:N", "bytes:N": how far to refine.
//   projection   "parallel".
//   camera       six numbers, as the property `cameraState` gives them.
// Events         load (first picture), progress, refine (a finer picture), complete (the whole mesh
//                is on the screen), error, camera-change, view-change (an attribute of the view),
//                time-change (another instant, or playing begins or ends). `detail` holds the
//                figures, the error, the camera, the attribute or the time.
// Slots          poster (shown until the first picture), progress (instead of the viewer's own).
// Parts          canvas, panel, progress, legend, time, hint, marks, result, notice.
// Methods        digest(), pause(), resume(), resetView(), look(direction), picture(),
//                movie(options).
// Properties     counts, statistics, state, view, cameraState, playing, token.

import {kNoStatistics, type Statistics} from '../core/decode/statistics';
import type {Counts} from '../core/protocol/counts';
import type {Manifest} from '../core/protocol/manifest';
import {Client} from '../core/session/client';
import type {StreamState} from '../core/session/worker_messages';
import type {CameraState} from '../webgl/camera';
import {checkedDirection, type Direction} from '../webgl/directions';
import {checkedCamera} from '../webgl/pose';
import type {View} from '../webgl/view';
import type {QtetViewerEventMap} from './page/events';
import type {Kept, Page} from './page/page';
import {joinTimeGroup, type Membership, type TimeMember} from './page/time_group';
import {adopt, setMarkup} from './page/trusted';
import {chosenMesh} from './panels/mesh_menu';
import type {MovieOptions} from './picture/movies';
import {kViewAttributes, type ViewAttribute} from './settings/settings';
import styles from './style.css?inline';
import {kTemplate} from './template';
import {Viewing} from './viewing';

export class QtetViewer extends HTMLElement {
  static readonly observedAttributes = ['src', 'transport', 'time-group', ...kViewAttributes];

  /** Exists while the element is in a document. */
  client: Client | null = null;
  private readonly root = this.attachShadow({mode: 'open'});
  private readonly page = pageOf(this, this.root);
  private readonly kept: Kept = {start: null, paused: false, playing: false, opened: ''};
  /** Exists from the first step on; before it the shadow root is empty. */
  private viewing: Viewing | null = null;
  private bearer = '';
  private timeGroup: Membership | null = null;
  /** The names in the page's address: the viewer says which mean nothing to it. */
  unknown: readonly string[] = [];

  constructor() {
    super();
    this.addEventListener('time-change', ({detail}) => {
      if (detail.playing) this.timeGroup?.lead();
    });
  }

  // ---- for the page

  /**
   * The token for a server that guards its meshes (proto/PROTOCOL.md, "Tokens"). It is a property,
   * so that no page's text contains it.
   */
  get token(): string {
    return this.bearer;
  }
  set token(token: string) {
    this.bearer = token;
    void this.viewing?.stream.open();
  }

  /** It is not `complete` before a picture is on the screen. */
  get state(): StreamState {
    const {viewing} = this;
    const state = viewing?.stream.state ?? 'connecting';
    const isAhead = !viewing?.mesh.drawn || viewing.opening !== null;
    return state === 'complete' && isAhead ? 'streaming' : state;
  }
  get statistics(): Statistics {
    return this.viewing?.mesh.progress.statistics ?? kNoStatistics;
  }
  get counts(): Counts {
    const {tetrahedra, vertices, boundaryTriangles} = this.statistics;
    return {tetrahedra, vertices, boundaryTriangles};
  }
  /** The log's manifest; null before its head is here. */
  get manifest(): Manifest | null {
    return this.viewing?.mesh.manifest ?? null;
  }
  /** The view that draws; null before there is one. */
  get meshView(): View | null {
    return this.viewing?.view ?? null;
  }

  /** The attributes that show the same picture again, with the current camera. */
  get view(): Map<string, string> {
    const view = new Map<string, string>();
    for (const name of kViewAttributes) {
      const value = this.getAttribute(name);
      if (value !== null && name !== 'camera') view.set(name, value);
    }
    const mesh = chosenMesh(this.root);
    if (!view.has('mesh') && mesh !== '') view.set('mesh', mesh);
    const {meshView} = this;
    if (meshView && !meshView.pose.fitted) view.set('camera', meshView.cameraState.join(','));
    return view;
  }

  get cameraState(): CameraState | null {
    return this.meshView?.cameraState ?? null;
  }
  set cameraState(state: CameraState | null) {
    const {meshView} = this;
    if (state && meshView) meshView.cameraState = state;
    this.kept.start = meshView ? null : state && checkedCamera(state);
  }

  /** A series plays. Set before the series is known, it plays from then on. */
  get playing(): boolean {
    return this.kept.playing || this.viewing?.later?.time.isPlaying === true;
  }
  set playing(playing: boolean) {
    const time = this.viewing?.later?.time;
    if (time?.isShown) time.isPlaying = playing;
    else this.kept.playing = playing;
  }

  /** SHA-256 of the decoded mesh (codec/FORMAT.md, "Mesh digest"); empty before there is one. */
  async digest(): Promise<string> {
    return this.client?.digest() ?? '';
  }
  pause(): void {
    if (this.viewing) this.viewing.stream.pause();
    else this.kept.paused = true;
  }
  resume(): void {
    this.kept.paused = false;
    this.viewing?.stream.resume();
  }
  resetView(): void {
    this.kept.start = null;
    if (this.meshView) this.viewing!.look(null);
  }
  /** Before there is a picture, the first one is seen from there. */
  look(direction: Direction): void {
    if (this.meshView) this.viewing!.look(direction);
    else this.kept.start = checkedDirection(direction);
  }
  /** The scene as a PNG; null before there is one. */
  async picture(): Promise<Blob | null> {
    return this.viewing?.picture() ?? null;
  }
  /**
   * The instants of the shown series: WebM, or a .zip of PNG files where the browser encodes no
   * video. Rejects with a sentence if it cannot be made, or with the signal's reason.
   */
  async movie(options: MovieOptions = {}): Promise<Blob> {
    if (!this.viewing) throw new Error('The viewer is in no document.');
    return this.viewing.movie(options);
  }

  // ---- typed events

  override addEventListener<Type extends keyof QtetViewerEventMap>(
    type: Type,
    listener: (this: QtetViewer, event: QtetViewerEventMap[Type]) => void,
    options?: boolean | AddEventListenerOptions,
  ): void;
  override addEventListener(...words: Parameters<EventTarget['addEventListener']>): void;
  override addEventListener(...words: unknown[]): void {
    super.addEventListener(...(words as Parameters<HTMLElement['addEventListener']>));
  }
  override removeEventListener<Type extends keyof QtetViewerEventMap>(
    type: Type,
    listener: (this: QtetViewer, event: QtetViewerEventMap[Type]) => void,
    options?: boolean | EventListenerOptions,
  ): void;
  override removeEventListener(...words: Parameters<EventTarget['removeEventListener']>): void;
  override removeEventListener(...words: unknown[]): void {
    super.removeEventListener(...(words as Parameters<HTMLElement['removeEventListener']>));
  }

  // ---- custom element

  /**
   * Starts in steps, each a task of its own: a page stands still for the longest of them, not for
   * their sum.
   */
  connectedCallback(): void {
    if (this.client) return; // it has moved within the document
    this.joinTimeGroup();
    const client = new Client((message) => this.viewing?.receive(message));
    this.client = client;
    const steps = [
      (): void => {
        adopt(this.root, styles);
        setMarkup(this.root, kTemplate);
        this.viewing = new Viewing(this.page, client, this.kept);
      },
      (): void => this.viewing?.buildShell(),
    ];
    const step = (): void => {
      if (this.client !== client) return;
      steps.shift()?.();
      if (steps.length > 0) setTimeout(step);
    };
    setTimeout(step);
  }

  /** Who moves an element takes it out and puts it in at once: then everything stays. */
  disconnectedCallback(): void {
    queueMicrotask(() => {
      if (this.isConnected) return;
      const {meshView, client, viewing} = this;
      if (meshView && !meshView.pose.fitted) this.kept.start = meshView.cameraState;
      client?.dispose();
      viewing?.dispose();
      this.client = this.viewing = null;
      this.timeGroup?.leave();
      this.timeGroup = null;
    });
  }

  /** Leaves the one before. */
  private joinTimeGroup(): void {
    this.timeGroup?.leave();
    const name = this.getAttribute('time-group');
    const first = (): string | null => this.viewing?.mesh.firstTime?.text ?? null;
    const member = memberOf(this, first);
    this.timeGroup = name ? joinTimeGroup(this.ownerDocument, name, member) : null;
  }

  attributeChangedCallback(name: string, before: string | null, after: string | null): void {
    const {viewing} = this;
    if (before === after) return;
    if (name === 'time') this.timeGroup?.lead();
    if (name === 'time-group') {
      if (this.client) this.joinTimeGroup();
      return;
    }
    if (!viewing) return; // the first step reads them all
    const isOfStream = name === 'src' || name === 'transport';
    if (isOfStream || (name === 'mesh' && !viewing.stream.isChoosing)) void viewing.stream.open();
    else viewing.apply();
    const {settings, view} = viewing;
    if (name === 'camera' && settings.camera && view) view.cameraState = settings.camera;
    if (name === 'transport') viewing.apply();
    if (!isOfStream) this.page.dispatch('view-change', {name, value: after});
  }
}

/** `first` is the time without an attribute. */
function memberOf(element: QtetViewer, first: () => string | null): TimeMember {
  return {
    get time() {
      return element.getAttribute('time') ?? first();
    },
    take: (text) => {
      if (text === null) element.removeAttribute('time');
      else element.setAttribute('time', text);
    },
    stop: () => void (element.playing = false),
  };
}

function pageOf(element: QtetViewer, root: ShadowRoot): Page {
  return {
    element,
    root,
    get token() {
      return element.token;
    },
    get unknown() {
      return element.unknown;
    },
    get view() {
      return element.view;
    },
    write: (name: ViewAttribute, value: string | null) => {
      if (value === null) element.removeAttribute(name);
      else element.setAttribute(name, value);
    },
    read: (name: string) => element.getAttribute(name),
    dispatch: (type: string, detail: unknown) =>
      void element.dispatchEvent(new CustomEvent(type, {detail})),
    announce: (text: string) => {
      const live = root.querySelector('.live');
      if (live) live.textContent = text;
    },
  };
}
