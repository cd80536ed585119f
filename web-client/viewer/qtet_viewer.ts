// <qtet-viewer>: a progressive tetrahedral mesh in a web page.
//
// Attributes  src          address of the server; by default the page's own
//             mesh         id of the mesh; without it the viewer offers a menu and starts with the first
//             field        name of the field; by default the first
//             colormap     viridis (default), cividis or cool-warm
//             edges        "off" hides the cells' edges
//             clip         axis x, y or z, a share of the extent after a colon, "-" before it for the other side: "y", "-x:0.3"
//             pause-after  payload bytes after which to pause until resume()
// Events      load (first picture), progress, refine (a finer picture), complete (the whole mesh is on the screen), error;
//             `detail` holds the figures or the error
// Methods     digest(), pause(), resume(), clip(), resetView(); property `counts`, `statistics`, `state`

import {Client} from '../core/client';
import {isColorMapName, type ColorMapName} from '../core/color_maps';
import {errorCode, errorText, QtetError} from '../core/errors';
import type {Manifest} from '../core/manifest';
import {retry} from '../core/retry';
import {kNoStatistics, type Counts, type Statistics} from '../core/statistics';
import type {FromWorker, Snapshot, StreamState} from '../core/worker_messages';
import type {MeshView} from '../three/mesh_view';
import {fetchCatalog, streamUrl, type MeshEntry} from './catalog';
import {ClipPanel, parseClip} from './clip_panel';
import {fieldTitle, Legend} from './legend';
import {bindKeys} from './keys';
import {insetsOf} from './layout';
import {ProgressPanel} from './progress_panel';
import styles from './style.css?inline';
import {fillSelect} from './select';
import {kTemplate} from './template';
import {Triad} from './triad';

const kPhone = '(max-width: 640px)';

export class QtetViewer extends HTMLElement {
  static readonly observedAttributes = ['src', 'mesh', 'field', 'colormap', 'edges', 'clip'];

  private readonly root = this.attachShadow({mode: 'open'});
  private client: Client | null = null;
  private view: MeshView | null = null;
  private parts: {progress: ProgressPanel; legend: Legend; clip: ClipPanel; resizes: ResizeObserver} | null = null;
  private catalog: MeshEntry[] = [];
  private manifest: Manifest | null = null;
  private pending: Snapshot | null = null;
  private shownField = -1;
  private loaded = false;
  private completionTold = false;
  private streamState: StreamState = 'connecting';
  private figures: Statistics = kNoStatistics;

  // ---- for the page

  get state(): StreamState { return this.streamState; }
  get statistics(): Statistics { return this.figures; }
  get counts(): Counts {
    const {tetrahedra, vertices, boundaryTriangles} = this.figures;
    return {tetrahedra, vertices, boundaryTriangles};
  }
  get colormap(): ColorMapName {
    const name = this.getAttribute('colormap');
    return isColorMapName(name) ? name : 'viridis';
  }

  /** SHA-256 of the decoded mesh (codec/FORMAT.md, "Mesh digest"); empty before there is one. */
  async digest(): Promise<string> { return this.client?.digest() ?? ''; }
  pause(): void { this.client?.pause(); }
  resume(): void { this.client?.resume(); }
  resetView(): void { this.view?.resetCamera(); }
  /** Clips across axis 0 to 2 at `share` (0 to 1) of the extent; null ends clipping. */
  clip(axis: 0 | 1 | 2 | null, share = 0.5, flipped = false): void { this.parts?.clip.set(axis, share, flipped); }

  // ---- custom element

  connectedCallback(): void {
    this.root.innerHTML = `<style>${styles}</style>${kTemplate}`;
    // The worker fetches its WebAssembly while three.js is on its way.
    this.client = new Client((message) => this.receive(message));
    this.parts = {
      progress: new ProgressPanel(this.root), legend: new Legend(this.root),
      clip: new ClipPanel(this.root, (plane) => this.client?.clip(plane)),
      resizes: new ResizeObserver(() => this.arrange()),
    };
    this.bindControls();
    this.fold(matchMedia(kPhone).matches);
    this.parts.resizes.observe(this.find('.panel'));
    this.parts.resizes.observe(this);
    this.applyLook();
    this.applyClip();
    void this.prepareView();
    void this.open();
  }

  disconnectedCallback(): void {
    this.client?.dispose();
    this.view?.dispose();
    this.parts?.resizes.disconnect();
    this.client = this.view = this.parts = null;
    this.forget();
  }

  attributeChangedCallback(name: string, before: string | null, after: string | null): void {
    if (!this.client || before === after) return;
    if (name === 'src' || name === 'mesh') void this.open();
    else if (name === 'field' && after) this.chooseField(after);
    else if (name === 'clip') this.applyClip();
    else this.applyLook();
  }

  private applyClip(): void {
    const clip = parseClip(this.getAttribute('clip'));
    this.clip(clip?.axis ?? null, clip?.share, clip?.flipped);
  }

  // ---- start

  private async prepareView(): Promise<void> {
    try {
      const {MeshView} = await retry(() => import('../three/mesh_view'));
      if (!this.client || this.view) return;
      const triad = new Triad(this.find<SVGSVGElement>('.triad'));
      this.view = new MeshView(this.find<HTMLCanvasElement>('canvas'), (rotation) => triad.turn(rotation));
      bindKeys(this.view);
      this.applyLook();
      this.arrange();
      if (this.pending) this.draw(this.pending);
      this.pending = null;
    } catch (thrown) {
      this.fail(new QtetError('no-view', `The 3D view cannot start: ${errorText(thrown)}. It needs a browser with WebGL 2; reloading the page may help.`));
    }
  }

  private get base(): URL { return new URL(this.getAttribute('src') ?? '.', document.baseURI); }

  private async open(): Promise<void> {
    try {
      this.setState('connecting');
      this.catalog = await fetchCatalog(this.base);
      const wanted = this.getAttribute('mesh');
      const mesh = wanted ?? this.catalog[0]?.id;
      if (mesh === undefined) throw new QtetError('not-found', 'The server has no meshes yet. Put .qtet files into its folder.');
      if (!this.catalog.some(({id}) => id === mesh)) {
        throw new QtetError('not-found', `There is no mesh "${mesh}" on this server. It has: ${this.catalog.map(({id}) => id).join(', ') || 'none'}.`);
      }
      const menu = wanted === null && this.catalog.length > 1;
      fillSelect(this.select('mesh'), this.catalog.map(({id}) => ({value: id, title: id})), mesh);
      this.find('.mesh-menu').hidden = !menu;
      this.find('.mesh-name').hidden = menu;
      this.openMesh(mesh);
    } catch (thrown) {
      this.fail(thrown);
    }
  }

  private openMesh(mesh: string): void {
    this.forget();
    this.find('.mesh-name').textContent = mesh;
    this.find('canvas').setAttribute('aria-label', `3D view of ${mesh}. Arrow keys turn it, plus and minus zoom, Home resets.`);
    const fields = this.catalog.find(({id}) => id === mesh)?.fields ?? [];
    this.client?.start({
      url: streamUrl(this.base), mesh, field: this.getAttribute('field') ?? fields[0] ?? '',
      pauseAfter: Number(this.getAttribute('pause-after') ?? 0),
    });
  }

  private forget(): void {
    this.manifest = this.pending = null;
    this.shownField = -1;
    this.loaded = false;
    this.figures = kNoStatistics;
    this.view?.clear();
    this.parts?.clip.clear();
    this.parts?.legend.show(null, this.colormap);
    if (this.parts) this.find('.notice').hidden = true;
  }

  // ---- from the worker

  private receive(message: FromWorker): void {
    switch (message.type) {
      case 'manifest': return this.takeManifest(message.manifest);
      case 'snapshot': return this.view ? this.draw(message.snapshot) : void (this.pending = message.snapshot);
      case 'progress': return this.takeProgress(message.statistics);
      case 'state': return this.setState(message.state);
      case 'error': return this.notify(message.code, message.message);
    }
  }

  private takeManifest(manifest: Manifest): void {
    this.manifest = manifest;
    const fields = manifest.fields.filter((field) => field.association === 'point');
    const wanted = this.getAttribute('field');
    const shown = fields.some(({name}) => name === wanted) ? wanted : fields[0]?.name;
    const options = fields.map((field) => ({value: field.name, title: fieldTitle(field)}));
    fillSelect(this.select('field'), options.length > 0 ? options : [{value: '', title: 'No fields'}], shown ?? '');
    this.select('field').disabled = fields.length < 2;
  }

  private takeProgress(statistics: Statistics): void {
    this.figures = statistics;
    this.parts?.progress.show(statistics);
    this.tell('progress', statistics);
  }

  private draw(snapshot: Snapshot): void {
    this.figures = snapshot.statistics;
    this.view!.show(snapshot, () => {
      this.client?.shown();
      this.tell(this.loaded ? 'refine' : 'load', snapshot.statistics);
      this.loaded = true;
      if (this.streamState !== 'complete' || this.completionTold) return;
      this.completionTold = true;
      this.tell('complete', snapshot.statistics);
    });
    if (this.manifest && snapshot.bounds.length > 0) this.parts?.clip.place(snapshot.bounds, this.manifest);
    if (snapshot.field === this.shownField) return;
    this.shownField = snapshot.field;
    this.showLegend();
  }

  private setState(state: StreamState): void {
    this.streamState = state;
    this.parts?.progress.showState(state);
    const pause = this.find<HTMLButtonElement>('.pause');
    pause.hidden = state === 'complete' || state === 'failed';
    pause.textContent = state === 'paused' ? 'Continue' : 'Pause';
    if (state === 'streaming' || state === 'complete') this.find('.notice').hidden ||= this.find('.notice').dataset.code !== 'unknown-field';
    this.completionTold &&= state === 'complete';
  }

  // ---- controls

  private bindControls(): void {
    this.select('mesh').addEventListener('change', (event) => this.openMesh((event.target as HTMLSelectElement).value));
    this.select('field').addEventListener('change', (event) => this.setAttribute('field', (event.target as HTMLSelectElement).value));
    this.find('.swatches').addEventListener('change', (event) => this.setAttribute('colormap', (event.target as HTMLInputElement).value));
    this.input('edges').addEventListener('change', (event) => {
      this.setAttribute('edges', (event.target as HTMLInputElement).checked ? 'on' : 'off');
    });
    this.find('.fold').addEventListener('click', () => this.fold(!this.find('.panel').classList.contains('folded')));
    this.find('.reset').addEventListener('click', () => this.resetView());
    this.find('.pause').addEventListener('click', () => (this.streamState === 'paused' ? this.resume() : this.pause()));
    this.find('.dismiss').addEventListener('click', () => void (this.find('.notice').hidden = true));
    this.find('.retry').addEventListener('click', () => void this.open());
  }

  private chooseField(name: string): void {
    if (!this.manifest?.fields.some((field) => field.name === name)) return;
    this.select('field').value = name;
    this.client?.showField(name);
  }

  private applyLook(): void {
    const edges = this.getAttribute('edges') !== 'off';
    this.input('edges').checked = edges;
    this.find<HTMLInputElement>(`input[name=colormap][value=${this.colormap}]`).checked = true;
    this.view?.setColorMap(this.colormap);
    this.view?.setEdges(edges);
    this.showLegend();
  }

  private showLegend(): void {
    this.parts?.legend.show(this.manifest?.fields[this.shownField] ?? null, this.colormap);
    this.arrange();
  }

  private fold(folded: boolean): void {
    this.find('.panel').classList.toggle('folded', folded);
    this.find('.fold').setAttribute('aria-expanded', String(!folded));
  }

  /** Tells the view what the cards cover. */
  private arrange(): void {
    if (!this.parts) return;
    const sheet = matchMedia(kPhone).matches;
    const insets = insetsOf(this, this.find('.panel'), this.find('.legend'), sheet);
    this.style.setProperty('--sheet', `${Math.round(insets.bottom * this.clientHeight)}px`);
    this.view?.setInsets(insets);
  }

  // ---- errors

  private fail(thrown: unknown): void {
    this.notify(errorCode(thrown), errorText(thrown));
    this.setState('failed');
  }

  private notify(code: string, message: string): void {
    const notice = this.find('.notice');
    notice.dataset.code = code;
    notice.querySelector('p')!.textContent = message;
    notice.querySelector<HTMLElement>('.retry')!.hidden = code === 'unknown-field' || code === 'no-view';
    notice.hidden = false;
    this.tell('error', {code, message});
  }

  private tell(type: string, detail: unknown): void {
    this.dispatchEvent(new CustomEvent(type, {detail}));
  }

  private find<T extends Element = HTMLElement>(selector: string): T { return this.root.querySelector<T>(selector)!; }
  private select(name: string): HTMLSelectElement { return this.find(`select[name=${name}]`); }
  private input(name: string): HTMLInputElement { return this.find(`input[name=${name}]`); }
}
