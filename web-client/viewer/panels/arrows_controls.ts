// The controls of arrows: the field, where they stand, and how long they are.

import {
  firstColor,
  kArrowComponents,
  kDensities,
  kFirstSize,
  kSizes,
  readArrows,
} from '../../core/layers/arrows_text';
import type {ArrowsRequest} from '../../core/picture/arrows';
import {find, setText} from '../page/find';
import {formatCount, formatFactor} from '../page/format';
import {readLate} from '../page/late_readers';
import {lateRequests} from '../page/late_requests';
import {setMarkup} from '../page/trusted';
import type {Settings} from '../settings/settings';
import type {LateContent} from './late_panel';
import {segments, toggle} from './markup';
import type {PanelTools, Scene} from './panel';
import {chooseVectors, fillVectors} from './vector_menu';

const kPlaces: Record<ArrowsRequest['places'], string> = {
  shown: 'Surface',
  volume: 'Inside',
  vertices: 'Vertices',
};
const kLengths: Record<ArrowsRequest['length'], string> = {
  magnitude: 'Linear',
  log: 'Log',
  equal: 'Equal',
};
const kMarkup = `
${toggle('arrows', 'Arrows')}
<div class="sub arrows-body" hidden>
  <select name="arrows-field" aria-label="Field that arrows show"></select>
  <fieldset class="segments">
    <legend class="visually-hidden">Places of the arrows</legend>
    ${segments('arrow-places', kPlaces)}
  </fieldset>
  <fieldset class="segments">
    <legend class="visually-hidden">Length of the arrows</legend>
    ${segments('arrow-length', kLengths)}
  </fieldset>
  <label class="row"><span class="name">Density</span><input type="range"
    name="arrow-density" min="${kDensities[0]}" max="${kDensities[1]}"
    aria-label="Arrows along the longest side"></label>
  <label class="row"><span class="name">Size</span><input type="range" name="arrow-size"
    min="${Math.log2(kSizes[0])}" max="${Math.log2(kSizes[1])}" step="0.1"
    aria-label="Size of the arrows"></label>
  ${toggle('arrow-color', 'Colours of the field')}
  <p class="hint arrows-state"></p>
</div>`;

export class ArrowsControls implements LateContent {
  private readonly on: HTMLInputElement;
  private request: ArrowsRequest | null = null;

  constructor(
    private readonly tools: PanelTools,
    private readonly place: HTMLElement,
  ) {
    const {page} = tools;
    lateRequests.read = readLate;
    setMarkup(place, kMarkup);
    this.on = find(place, 'input[name=arrows]');
    this.on.addEventListener('change', () =>
      page.write('arrows', this.on.checked ? chooseVectors(tools, kArrowComponents) : null),
    );
    place.addEventListener('change', ({target}) => {
      const {name, value} = target as HTMLInputElement;
      if (name === 'arrows-field') page.write('arrows', value);
      if (name === 'arrow-places') page.write(name, value === 'shown' ? null : value);
      if (name === 'arrow-color') this.colour((target as HTMLInputElement).checked);
      if (name === 'arrow-length') page.write(name, value === 'magnitude' ? null : value);
    });
    place.addEventListener('input', ({target}) => {
      const {name, value} = target as HTMLInputElement;
      if (name === 'arrow-density') page.write(name, value);
      if (name === 'arrow-size') page.write(name, String(sizeAt(Number(value))));
    });
  }

  see(): void {
    this.say();
  }

  update(_: Settings, scene: Scene | null): void {
    const {page} = this.tools;
    const fields = scene?.manifest.fields ?? [];
    const request = (this.request = readArrows((name) => page.read(name), fields));
    this.on.checked = request !== null;
    find(this.place, '.arrows-body').hidden = !request;
    if (!request) return;
    fillVectors(find(this.place, 'select'), request.field, fields, kArrowComponents);
    for (const [name, value] of [
      ['arrow-places', request.places],
      ['arrow-length', request.length],
    ])
      find<HTMLInputElement>(this.place, `[name=${name}][value=${value}]`).checked = true;
    find<HTMLInputElement>(this.place, '[name=arrow-color]').checked = request.isColored;
    this.slide('density', request.density, String(request.density));
    this.slide('size', Math.log2(request.size), formatFactor(request.size));
    this.say();
  }

  showPicture(): void {
    this.say();
  }

  private colour(isColored: boolean): void {
    const color = isColored ? 'field' : 'plain';
    const isFirst = this.request && color === firstColor(this.request.places);
    this.tools.page.write('arrow-color', isFirst ? null : color);
  }

  private say(): void {
    const soup = this.request && this.tools.host.mesh.snapshot?.arrows;
    const line = find(this.place, '.arrows-state');
    if (!soup) return setText(line, '');
    const few = soup.isCut ? '; more would be too many' : '';
    setText(line, `${formatCount(soup.count)} arrows${few}.`);
  }

  private slide(name: string, value: number, text: string): void {
    const slider = find<HTMLInputElement>(this.place, `input[name=arrow-${name}]`);
    slider.value = String(value);
    slider.setAttribute('aria-valuetext', text);
  }
}

const sizeAt = (power: number): number =>
  Math.abs(2 ** power - kFirstSize) < 0.02 ? kFirstSize : Number((2 ** power).toPrecision(2));
