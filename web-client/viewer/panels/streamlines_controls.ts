// The controls of streamlines: the field, where lines begin, and how they look. A line at the
// pointer shows more of the flow; a click keeps it.

import {
  isLook,
  kFirstSeeds,
  kLooks,
  kMostAlongPlane,
  kMostLines,
  vectorField,
  parseSeeds,
  seedsText,
  type SeedsText,
} from '../../core/layers/streamlines_text';
import {parseNumbers} from '../../core/layers/field_values';
import {kLineWidth, type LineSoup} from '../../core/picture/streamlines';
import {errorsOfLevel} from '../../core/protocol/limit';
import {positionOf, type Vector} from '../../core/protocol/geometry';
import {find, onClick, setText} from '../page/find';
import {formatCount, formatError} from '../page/format';
import {readLate} from '../page/late_readers';
import {lateRequests} from '../page/late_requests';
import {onScene, onSceneClick} from '../page/scene_events';
import {fillSelect} from '../page/select';
import {adopt, setMarkup} from '../page/trusted';
import type {Settings} from '../settings/settings';
import type {LateContent} from './late_panel';
import {shape} from './marks';
import {segments, toggle} from './markup';
import type {PanelTools, Scene} from './panel';
import styles from './streamlines.css?inline';
import {chooseVectors, fillVectors} from './vector_menu';

/** Digits of places that are written. A georeferenced mesh has millions of metres. */
const kDigits = 10;
/** The first radius of a sphere, over the diagonal. */
const kSphereShare = 0.12;
/** The surface's opacity through which lines are seen well. */
const kSeeThrough = '0.2';
/** A press that moves no farther is a click, in CSS pixels. */
const kClickPixels = 4;
/** A place on the surface goes this share of the way into its cell. */
const kInwards = 0.02;

const kKinds = {
  even: 'Evenly spaced',
  line: 'On a line',
  plane: 'On a plane',
  sphere: 'In a sphere',
} as const;
type Kind = keyof typeof kKinds;
const kLookTitles = {tubes: 'Tubes', lines: 'Lines', dashes: 'Dashes'};

const text = (name: string, title: string, kind: string): string =>
  `<label class="row of-kind" data-kind="${kind}"><span class="name">${title}</span>` +
  `<input type="text" name="seeds-${name}" autocomplete="off" spellcheck="false"></label>`;

const kMarkup = `
${toggle('streamlines', 'Streamlines')}
<div class="sub streamlines-body" hidden>
  <select name="streamlines-field" aria-label="Vectors that lines follow"></select>
  ${toggle('streamline-kind', 'Through all instants')}
  <label class="field"><span class="name">Begin</span><select name="seeds"></select></label>
  ${text('from', 'From', 'line')}${text('to', 'To', 'line')}
  <fieldset class="segments of-kind" data-kind="plane">
    <legend class="visually-hidden">Axis across the plane</legend>
    ${segments('seeds-axis', {x: 'x', y: 'y', z: 'z'})}
  </fieldset>
  <input type="range" class="of-kind" data-kind="plane" name="seeds-share" min="0" max="1"
    step="0.01" aria-label="Place of the plane">
  ${text('centre', 'Centre', 'sphere')}${text('radius', 'Radius', 'sphere')}
  <label class="row"><span class="name">Lines</span>
    <input type="text" inputmode="numeric" name="seeds-count" autocomplete="off"></label>
  <fieldset class="segments">
    <legend class="visually-hidden">Look of the lines</legend>
    ${segments('streamline-look', kLookTitles)}
  </fieldset>
  ${toggle('pointer-line', 'Line at the pointer')}
  <p class="hint flow-hidden" hidden>The surface hides them.
    <button type="button" class="see-flow">See through it</button></p>
  <p class="hint flow-state"></p>
</div>`;

export class StreamlinesControls implements LateContent {
  private readonly on: HTMLInputElement;
  private readonly marks: SVGSVGElement;
  private field = -1;
  private seeds: SeedsText[] = [];
  /** The line at the pointer, on the lattice. */
  private line: Vector[] = [];
  private isAsking = false;
  /** Where the pointer is, on the canvas; null: nowhere. */
  private pointer: [number, number] | null = null;

  constructor(
    private readonly tools: PanelTools,
    private readonly place: HTMLElement,
  ) {
    const {page, signal} = tools;
    lateRequests.read = readLate;
    adopt(page.root, styles);
    setMarkup(place, kMarkup);
    this.marks = find<SVGSVGElement>(page.root, '.marks').cloneNode() as SVGSVGElement;
    this.marks.setAttribute('part', 'marks');
    find(page.root, '.layer').append(this.marks);
    this.on = this.input('streamlines');
    this.on.addEventListener('change', () =>
      page.write('streamlines', this.on.checked ? chooseVectors(tools) : null),
    );
    this.select('streamlines-field').addEventListener('change', (event) =>
      page.write('streamlines', (event.target as HTMLSelectElement).value),
    );
    this.select('seeds').addEventListener('change', (event) =>
      this.begin((event.target as HTMLSelectElement).value as Kind),
    );
    for (const name of ['from', 'to', 'centre', 'radius', 'count', 'share'])
      this.input(`seeds-${name}`).addEventListener('change', () => this.type(name));
    place.addEventListener('change', ({target}) => {
      const {name, value} = target as HTMLInputElement;
      if (name === 'streamline-look') page.write(name, value === kLooks[0] ? null : value);
      if (name === 'streamline-kind')
        page.write(name, (target as HTMLInputElement).checked ? 'path' : null);
      if (name === 'seeds-axis') this.type('axis');
      if (name === 'pointer-line') this.point(null);
    });
    onClick(place, '.see-flow', () => page.write('opacity', kSeeThrough));
    this.watchPointer(signal);
  }

  see(isSeen: boolean): void {
    if (!isSeen) this.point(null);
  }

  update(settings: Settings, scene: Scene | null): void {
    const fields = scene?.manifest.fields ?? [];
    const {page} = this.tools;
    this.field = vectorField(page.read('streamlines'), fields);
    const isOn = this.field >= 0;
    this.on.checked = isOn;
    find(this.place, '.streamlines-body').hidden = !isOn;
    if (!isOn) return this.point(null);
    fillVectors(this.select('streamlines-field'), this.field, fields);
    const kind = this.input('streamline-kind');
    kind.checked = page.read('streamline-kind') === 'path';
    kind.closest('label')!.hidden = fields[this.field]!.instant === undefined;
    this.seeds = parseSeeds(page.read('seeds') ?? kFirstSeeds) ?? parseSeeds(kFirstSeeds)!;
    this.showSeeds();
    const look = page.read('streamline-look') ?? kLooks[0];
    this.radio('streamline-look', isLook(look) ? look : kLooks[0]);
    const {surface, opacity, volume, planes, mode} = settings;
    const isHidden = surface && opacity === 1 && volume === null && planes.length === 0;
    find(this.place, '.flow-hidden').hidden = !isHidden || mode === 'slice';
    this.say();
  }

  showPicture(): void {
    this.say();
    void this.ask();
  }

  /** The line follows the picture. */
  follow(): void {
    const {view} = this.tools.host;
    const points = view ? this.line.map((point) => view.project(point)) : [];
    const d = points.map(({x, y}) => `${x.toFixed(1)} ${y.toFixed(1)}`).join('L');
    this.marks.replaceChildren(...(d ? [shape('path', {class: 'flow', d: `M${d}`})] : []));
  }

  clear(): void {
    this.point(null);
  }

  // ---- the seeds

  private showSeeds(): void {
    const [first] = this.seeds as [SeedsText];
    const isOne = this.seeds.length === 1;
    const kind = isOne ? first.kind : 'several';
    const kinds = Object.entries(kKinds).map(([value, title]) => ({value, title}));
    const more = isOne ? [] : [{value: 'several', title: `${this.seeds.length} places`}];
    fillSelect(this.select('seeds'), [...kinds, ...more], kind);
    for (const row of this.place.querySelectorAll<HTMLElement>('.of-kind'))
      row.hidden = row.dataset.kind !== kind;
    this.put('count', isOne ? String(first.count) : '');
    this.input('seeds-count').disabled = !isOne;
    if (first.kind === 'line') {
      this.put('from', first.from.join(', '));
      this.put('to', first.to.join(', '));
    }
    if (first.kind === 'sphere') {
      this.put('centre', first.centre.join(', '));
      this.put('radius', String(first.radius));
    }
    if (first.kind !== 'plane') return;
    const [axis = '', share = '0.5'] = first.plane.split(':');
    for (const radio of this.place.querySelectorAll<HTMLInputElement>('[name=seeds-axis]'))
      radio.checked = radio.value === axis.replace('-', '');
    this.put('share', share);
  }

  /** Another kind of seeds, in the middle of the mesh. */
  private begin(kind: Kind | 'several'): void {
    const {manifest, snapshot} = this.tools.host.mesh;
    const {bounds} = snapshot ?? {};
    if (!manifest || !bounds || kind === 'several') return;
    const [low, high] = [bounds.slice(0, 3), bounds.slice(3)].map((corner) =>
      positionOf(manifest.lattice, corner as Vector),
    ) as [Vector, Vector];
    const centre = rounded(low.map((x, axis) => (x + high[axis]!) / 2) as Vector);
    const sizes = low.map((x, axis) => high[axis]! - x);
    // across the longest side, where flow mostly goes
    const across = [0, 1, 2].sort((a, b) => sizes[a]! - sizes[b]!)[1]!;
    const longest = sizes.indexOf(Math.max(...sizes));
    const end = (corner: Vector): Vector =>
      rounded(centre.map((x, axis) => (axis === across ? corner[axis]! : x)) as Vector);
    const firsts: Record<Kind, SeedsText> = {
      even: parseSeeds(kFirstSeeds)![0]!,
      line: {kind: 'line', from: end(low), to: end(high), count: 25},
      plane: {kind: 'plane', plane: `${'xyz'[longest]}:0.5`, count: 10},
      sphere: {
        kind: 'sphere',
        centre,
        radius: Number((kSphereShare * Math.hypot(...sizes)).toPrecision(3)),
        count: 50,
      },
    };
    this.write([firsts[kind]]);
  }

  /** A control of the seeds has another value. */
  private type(name: string): void {
    const input = this.input(`seeds-${name}`);
    const changed = this.withChange(name);
    const isRight = changed !== null && parseSeeds(seedsText([changed])) !== null;
    input.setCustomValidity(isRight ? '' : this.expected(name));
    if (isRight) this.write([changed]);
    else input.reportValidity();
  }

  private withChange(name: string): SeedsText | null {
    const [first] = this.seeds as [SeedsText];
    const numbers = parseNumbers(this.input(`seeds-${name}`).value);
    if (name === 'count') return {...first, count: numbers[0] ?? 0};
    if (name === 'axis' || name === 'share') {
      if (first.kind !== 'plane') return null;
      const axis = this.place.querySelector<HTMLInputElement>('[name=seeds-axis]:checked')?.value;
      const [direction = ''] = first.plane.split(':');
      const share = this.input('seeds-share').value;
      return {...first, plane: `${name === 'axis' ? axis : direction}:${share}`};
    }
    if (name === 'radius') return {...first, radius: numbers[0] ?? 0} as SeedsText;
    return numbers.length === 3 ? {...first, [name]: numbers} : null;
  }

  private expected(name: string): string {
    if (name === 'radius') return 'A number above 0';
    if (name !== 'count') return 'Three numbers: 1, 2, 0.5';
    const isPlane = this.seeds[0]!.kind === 'plane';
    return `1 to ${isPlane ? kMostAlongPlane : kMostLines}`;
  }

  private write(seeds: readonly SeedsText[]): void {
    const its = seedsText(seeds);
    this.tools.page.write('seeds', its === kFirstSeeds ? null : its);
  }

  // ---- the line at the pointer

  private watchPointer(signal: AbortSignal): void {
    const its = {root: this.tools.page.root, signal};
    onScene(its, 'pointermove', (event) => {
      if (this.followsPointer && event.buttons === 0 && event.pointerType !== 'touch')
        this.point([event.offsetX, event.offsetY]);
    });
    onScene(its, 'pointerout', () => this.point(null));
    onSceneClick(its, kClickPixels, (event) => {
      if (!this.followsPointer || event.button !== 0 || !event.isPrimary) return;
      this.pointer = [event.offsetX, event.offsetY];
      void this.ask(true);
    });
  }

  private get followsPointer(): boolean {
    return this.field >= 0 && this.input('pointer-line').checked;
  }

  private point(at: [number, number] | null): void {
    this.pointer = at;
    if (at) return void this.ask();
    if (this.line.length === 0) return;
    this.line = [];
    this.follow();
  }

  /** One question at a time; the last place of the pointer follows it. */
  private async ask(keeps = false): Promise<void> {
    const {client, mesh, opening, view} = this.tools.host;
    const at = this.pointer;
    if (!at || !view || !mesh.snapshot || opening !== null || (this.isAsking && !keeps)) return;
    this.isAsking = true;
    try {
      const pick = await client.pick(view.rayAt(...at));
      const place = pick && inside(pick.lattice, pick.places);
      if (place && keeps) return this.keep(place);
      const soup = place && (await client.trace(pick.cell, place));
      this.line = soup ? pointsOf(soup) : [];
      this.follow();
    } finally {
      this.isAsking = false;
    }
    if (this.pointer && this.pointer !== at) void this.ask();
  }

  /** A line begins there for good. */
  private keep(place: Vector): void {
    const {manifest} = this.tools.host.mesh;
    if (!manifest) return;
    const from = rounded(positionOf(manifest.lattice, place));
    const all: SeedsText[] = [...this.seeds, {kind: 'line', from, to: from, count: 1}];
    if (parseSeeds(seedsText(all))) this.write(all);
    else this.tools.page.announce('No more lines can be kept');
  }

  // ---- what is said

  /** How many lines there are, and on which error they stand. */
  private say(): void {
    const {manifest, snapshot} = this.tools.host.mesh;
    const info = manifest?.fields[this.field];
    const soup = snapshot?.streamlines;
    const line = find(this.place, '.flow-state');
    if (!manifest || !soup || !info) return setText(line, '');
    if (soup.lines === 0) return setText(line, 'No line begins in the mesh.');
    const name = info.instant?.name ?? info.name;
    const {level} = snapshot.statistics;
    const error = errorsOfLevel(manifest.levels, level)?.fields[this.field]?.mean;
    const known = error === undefined ? '' : `, along ${name} within ${formatError(error)} (rms)`;
    const cut = soup.isCut ? '; more or longer ones would take too long' : '';
    setText(line, `${formatCount(soup.lines)} line${soup.lines === 1 ? '' : 's'}${known}${cut}.`);
  }

  private input(name: string): HTMLInputElement {
    return find(this.place, `input[name=${name}]`);
  }
  private select(name: string): HTMLSelectElement {
    return find(this.place, `select[name=${name}]`);
  }
  private put(name: string, value: string): void {
    const input = this.input(`seeds-${name}`);
    input.setCustomValidity('');
    if (this.tools.page.root.activeElement !== input) input.value = value;
  }
  private radio(name: string, value: string): void {
    const found = this.place.querySelector<HTMLInputElement>(`[name=${name}][value="${value}"]`);
    if (found) found.checked = true;
  }
}

const rounded = (place: Vector): Vector =>
  place.map((x) => Number(x.toPrecision(kDigits))) as Vector;

/** A place on a cell's face, a little inside. */
function inside(place: Vector, corners: readonly Vector[]): Vector {
  return place.map((x, axis) => {
    const middle = corners.reduce((sum, corner) => sum + corner[axis]!, 0) / corners.length;
    return x + kInwards * (middle - x);
  }) as Vector;
}

function pointsOf({points}: LineSoup): Vector[] {
  const all: Vector[] = [];
  for (let at = 0; at < points.length; at += kLineWidth)
    all.push([points[at]!, points[at + 1]!, points[at + 2]!]);
  return all;
}
