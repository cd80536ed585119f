// Decides which mesh of which server comes to a viewer, and whether it comes: opens, pauses,
// refines.

import {scalarKey} from '../core/layers/field_values';
import {fieldLayers} from '../core/layers/layers';
import {errorCode, errorText, QtetError} from '../core/protocol/errors';
import {kFull, type Limit} from '../core/protocol/limit';
import {listedInstant} from '../core/protocol/segment_list';
import {instantKey, instantName} from '../core/protocol/series';
import type {Client} from '../core/session/client';
import type {StreamState} from '../core/session/worker_messages';
import {kTransportKinds} from '../core/transport/auto_transport';
import {
  fetchCatalog,
  isLogFile,
  logUrl,
  meshOfLog,
  segmentUrl,
  streamUrl,
  type MeshEntry,
} from './page/catalog';
import type {Kept, Page} from './page/page';
import type {SegmentPlace, ShownMesh} from './page/shown_mesh';
import {MeshMenu} from './panels/mesh_menu';
import {hint} from './settings/nearest';
import {displacementKey, kNoWarp} from './settings/warp';

/** Attributes that belong to one mesh: another one has other fields, places and values. */
const kOfOneMesh = [
  'derived',
  'field',
  'field-title',
  'range',
  'time-range',
  ...fieldLayers().map(({name}) => name),
  'warp',
  'warp-scale',
  'camera',
  'quality',
] as const;

export interface StreamListeners {
  /** The limit to begin with. */
  limit(): Limit;
  /** The time of series to begin with; null: that which opens. */
  time(): number | null;
  /** The key of the field that a list's segment before opened with; empty if there was none. */
  keptField(): string;
  /**
   * A mesh is opened. `isSame`: it is the previous one again, or another segment of its list.
   * `place` is null for a log that stands alone.
   */
  opens(isSame: boolean, place: SegmentPlace | null): void;
  changed(state: StreamState, attempt: number, delayMs: number): void;
  failed(code: string, message: string): void;
}

export class StreamControl {
  state: StreamState = 'connecting';
  /** Attributes are changing because the user chose another mesh. */
  isChoosing = false;
  private readonly menu: MeshMenu;
  private catalog: MeshEntry[] = [];
  /** Numbers the openings: the last one counts, whichever list arrives first. */
  private openings = 0;
  /** The mesh that was opened last has a stream. */
  private started = false;
  /** The `complete` event has been dispatched. */
  private completeTold = false;
  /** The address of the log that is open, as a file; empty: there is none. */
  logAddress = '';
  /** The log's place in the list of segments that is open; null: it is none's. */
  private place: SegmentPlace | null = null;

  constructor(
    private readonly page: Page,
    private readonly kept: Kept,
    private readonly client: Client,
    private readonly listeners: StreamListeners,
  ) {
    this.menu = new MeshMenu(page.root, (mesh) => this.choose(mesh));
  }

  /** Lists the meshes and opens the one that the attribute names, or the first. */
  async open(): Promise<void> {
    const opening = ++this.openings;
    this.started = false;
    try {
      this.enter('connecting');
      const catalog = await this.list();
      if (opening !== this.openings) return;
      this.catalog = catalog;
      this.openMesh(this.firstMesh());
    } catch (thrown) {
      if (opening !== this.openings) return;
      this.listeners.failed(errorCode(thrown), errorText(thrown));
      this.enter('failed');
    }
  }

  /** Opens the segment that has the listeners' time, unless it is open. */
  follow(): void {
    const {kept, place, started} = this;
    if (!place || !started) return;
    if (listedInstant(place.list, this.listeners.time()).segment === place.segment) return;
    const isPaused = this.state === 'paused';
    kept.paused = isPaused;
    this.openMesh(meshOfLog(this.base));
    if (!isPaused) this.enter('connecting');
  }

  pause(): void {
    if (this.started) this.client.pause();
    else this.kept.paused = this.state !== 'failed';
  }

  resume(): void {
    this.kept.paused = false;
    if (this.started) this.client.resume();
  }

  togglePause(): void {
    if (this.state === 'held') this.refineFully();
    else if (this.state === 'paused') this.resume();
    else this.pause();
  }

  setLimit(limit: Limit): void {
    if (this.started) this.client.setLimit(limit);
  }

  enter(state: StreamState, attempt = 0, delayMs = 0): void {
    this.state = state;
    this.completeTold &&= state === 'complete';
    this.listeners.changed(state, attempt, delayMs);
  }

  /** Both the decoder and the picture must be complete. */
  tellComplete(mesh: ShownMesh): void {
    if (this.state !== 'complete' || this.completeTold || !mesh.isDrawn) return;
    this.completeTold = true;
    this.page.dispatch('complete', mesh.drawn);
  }

  /** Opens another mesh. The attributes of this one end. */
  choose(mesh: string): void {
    this.leave(mesh);
    // A list that lacks it may be old; otherwise opening says what there is.
    if (!this.catalog.some(({id}) => id === mesh)) return void this.open();
    this.menu.fill(this.catalog, mesh);
    this.openMesh(mesh);
  }

  /** Opens a log of this machine. It stays here. `notice` is shown with it, unless it is empty. */
  openFile(file: File, notice = ''): void {
    this.leave(null);
    const {element} = this.page;
    const before = element.getAttribute('src') ?? '';
    const name = file.name.replace(/(\.qtet)?$/, '.qtet');
    element.setAttribute('src', `${URL.createObjectURL(file)}#${encodeURIComponent(name)}`);
    if (before.startsWith('blob:')) URL.revokeObjectURL(before.replace(/#.*/, ''));
    // The opening, a few microtasks from here, ends the notices of the page.
    if (notice !== '') setTimeout(() => this.listeners.failed('dropped-mesh', notice));
  }

  private leave(mesh: string | null): void {
    this.isChoosing = true;
    for (const name of kOfOneMesh) this.page.write(name, null);
    this.page.write('mesh', mesh);
    this.isChoosing = false;
  }

  dispose(): void {
    ++this.openings;
  }

  private get base(): URL {
    return new URL(this.page.element.getAttribute('src') ?? '.', document.baseURI);
  }

  private async list(): Promise<MeshEntry[]> {
    const {base} = this;
    if (isLogFile(base))
      return [{id: meshOfLog(base), tetrahedra: 0, fields: [], series: [], firstField: ''}];
    return fetchCatalog(base, this.page.token);
  }

  /** Fills the menu. Throws `not-found`. */
  private firstMesh(): string {
    const names = this.catalog.map(({id}) => id);
    const isOne =
      isLogFile(this.base) ||
      (this.catalog.length === 1 && this.catalog[0]!.segments !== undefined);
    const named = isOne ? null : this.page.read('mesh');
    const mesh = named ?? names[0];
    if (mesh === undefined) {
      throw new QtetError(
        'not-found',
        'The server shows no meshes. Put .qtet files into its folder; for guarded ones set the ' +
          'viewer\'s property "token".',
      );
    }
    this.menu.fill(this.catalog, mesh);
    if (names.includes(mesh)) return mesh;
    throw new QtetError(
      'not-found',
      `There is no mesh "${mesh}" on this server.${hint(mesh, names)} ` +
        `It has: ${names.join(', ') || 'none that may be seen without a token'}.`,
    );
  }

  private openMesh(mesh: string): void {
    const {base, client, kept, listeners, page} = this;
    const entry = this.catalog.find(({id}) => id === mesh);
    const list = entry?.segments;
    const instant = list && listedInstant(list, listeners.time());
    this.place = list && instant ? {list, segment: instant.segment} : null;
    const opened = `${base.href} ${mesh}`;
    listeners.opens(opened === kept.opened, this.place);
    kept.opened = opened;
    this.menu.name(mesh);
    const file = list && instant ? segmentUrl(base, list, instant.segment) : this.fileOf(entry);
    const transport = page.element.getAttribute('transport');
    const fields = this.firstFields(mesh);
    this.logAddress = file ?? logUrl(base, mesh);
    client.start({
      url: file === undefined ? streamUrl(base) : '',
      log: this.logAddress,
      firstBytes: entry?.firstBytes,
      chunks: entry?.chunks,
      transport: kTransportKinds.find((kind) => kind === transport) ?? 'auto',
      mesh,
      fields,
      hasSeries: fields?.some((key) => entry?.series.includes(key)) === true,
      time: instant?.time ?? listeners.time(),
      isSegment: instant !== undefined,
      limit: listeners.limit(),
      pictureFirst: true,
      paused: kept.paused,
      ...(page.token && {token: page.token}),
    });
    this.started = true;
    kept.paused = false;
  }

  /** The address of a log on any web server; undefined: a server of ours has it. */
  private fileOf(entry: MeshEntry | undefined): string | undefined {
    const {base} = this;
    return isLogFile(base) ? base.href : entry?.log;
  }

  /**
   * The keys of the fields to begin with: the colours', the warp's, and those of layers. Null: the
   * opening's.
   */
  private firstFields(mesh: string): string[] | null {
    const {page} = this;
    const entry = this.catalog.find(({id}) => id === mesh);
    const ofLayers = fieldLayers().map((layer) => {
      const text = page.read(layer.name);
      return text === null ? null : layer.fieldOf(text);
    });
    const keys = entry?.fields ?? [];
    const time = this.listeners.time();
    const listed = entry ? keyToBegin(entry, time) : '';
    const first = listed === '' ? this.listeners.keptField() : listed;
    // a series would have to wait for the head
    const plain = keys.filter((key) => entry?.series.includes(key) !== true);
    const defined = (page.read('derived') ?? '').split(/[;=]/).map((word) => word.trim());
    const warp = page.read('warp') ?? displacementKey(plain);
    const parts = page.read('hidden-parts') && page.read('parts');
    const named = [page.read('field') ?? first, warp === kNoWarp ? null : warp, parts, ...ofLayers]
      .filter((text) => text !== null && text !== '' && !defined.includes(text))
      .map((text) => keyToAsk(text!, keys, time));
    return named.length > 0 ? [...new Set(named)] : null;
  }

  /** If memory was the limit, there is no `quality` to remove: refining is tried again. */
  private refineFully(): void {
    if (this.page.read('quality') !== null) this.page.write('quality', null);
    else this.client.setLimit(kFull);
  }
}

/** The key of the first view at that time: the field's, or that of its series. */
export function keyToBegin(
  {fields, series, firstField}: Pick<MeshEntry, 'fields' | 'series' | 'firstField'>,
  time: number | null,
): string {
  const own = instantName(firstField)?.series;
  if (own === undefined) return firstField;
  if (time === null) return firstField;
  if (series.includes(own)) return own;
  return instantKey(fields, own, time) ?? firstField;
}

/** The key of the field that the text means in a mesh with these keys. It may have a component. */
export function keyToAsk(text: string, keys: readonly string[], time: number | null): string {
  const plain = scalarKey(text);
  return (
    [text, plain].find((key) => keys.includes(key)) ??
    instantKey(keys, text, time) ??
    instantKey(keys, plain, time) ??
    plain
  );
}
