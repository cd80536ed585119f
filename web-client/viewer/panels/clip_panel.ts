// Up to three clip planes, across an axis or facing the camera. Sliders here and handles in the
// picture move them.

import {axisNormal, axisOf, type ClipSetting} from '../../core/layers/clip';
import {clipText, movedPlane} from '../../core/layers/clip_text';
import {kMaxPlanes} from '../../core/picture/display';
import type {Vector} from '../../core/protocol/geometry';
import {find} from '../page/find';
import {formatCoordinate} from '../page/format';
import type {Attributes} from '../page/page';
import {setMarkup} from '../page/trusted';
import type {Settings} from '../settings/settings';
import {ClipHandles} from './clip_handles';
import {segments, toggle} from './markup';
import type {Panel, PanelKind, PanelsHost, Scene} from './panel';

const kModeTitles = {cut: 'Flat', cells: 'Cells', slice: 'Slice'};
const kMarkup = `
${toggle('clip', 'Clip')}
<div class="clip" hidden>
  <fieldset class="segments clip-modes">
    <legend class="visually-hidden">What a clip leaves</legend>
    ${segments('clip-mode', kModeTitles)}
  </fieldset>
  <div class="planes"></div>
  <button type="button" class="add-plane">Add a plane</button>
</div>`;

class ClipPanel implements Panel {
  private planes: ClipSetting[] = [];
  private hasFirstCut = false;

  private readonly handles: ClipHandles;

  constructor(
    private readonly root: ParentNode,
    private readonly attributes: Attributes,
    private readonly host: PanelsHost,
  ) {
    const layer = find(root, '.layer');
    this.handles = new ClipHandles(layer, kMaxPlanes, host, (i, share) => this.move(i, share));
    find<HTMLInputElement>(this.root, 'input[name=clip]').addEventListener('change', (event) => {
      this.write(
        (event.target as HTMLInputElement).checked
          ? [{normal: axisNormal(0, false), share: 0.5}]
          : [],
      );
    });
    find(this.root, '.clip-modes').addEventListener('change', (event) => {
      const mode = (event.target as HTMLInputElement).value;
      attributes.write('clip-mode', mode === 'cut' ? null : mode);
    });
    find(this.root, '.add-plane').addEventListener('click', () => this.add());
    const rows = find(this.root, '.planes');
    rows.replaceChildren(...Array.from({length: kMaxPlanes}, (_, i) => this.row(i)));
  }

  update({planes, mode, hasFirstCut}: Settings, scene: Scene | null): void {
    this.planes = planes;
    this.hasFirstCut = hasFirstCut;
    find<HTMLInputElement>(this.root, 'input[name=clip]').checked = planes.length > 0;
    find(this.root, '.clip').hidden = planes.length === 0;
    find<HTMLInputElement>(this.root, `.clip-modes input[value=${mode}]`).checked = true;
    find(this.root, '.add-plane').hidden = planes.length >= kMaxPlanes;
    [...find(this.root, '.planes').children].forEach((row, i) =>
      this.updateRow(row as HTMLElement, planes[i], scene),
    );
    this.handles.update(planes);
  }

  /** The handles follow the picture. */
  follow(): void {
    this.handles.place();
  }

  clear(): void {
    this.handles.update([]);
  }

  private move(i: number, share: number): void {
    this.write(movedPlane(this.planes, i, share));
  }

  private row(i: number): HTMLElement {
    const row = document.createElement('fieldset');
    row.className = 'plane';
    setMarkup(
      row,
      `<legend class="visually-hidden">Clip plane ${i + 1}</legend>
      <div class="row">
        <select name="axis" aria-label="Direction of clip plane ${i + 1}">
          <option value="x">X</option><option value="y">Y</option><option value="z">Z</option>
          <option value="view">As I look</option><option value="free" hidden>Free</option>
        </select>
        <label class="toggle"><input type="checkbox" name="flip"><span>Flip</span></label>
        <button type="button" class="icon remove" aria-label="Remove clip plane ${i + 1}">
          <svg viewBox="0 0 20 20" aria-hidden="true"><path d="M5 5l10 10M15 5 5 15"/></svg>
        </button>
      </div>
      <div class="row">
        <input type="range" name="position" min="0" max="1000"
          aria-label="Position of clip plane ${i + 1}">
        <output class="position"></output>
      </div>`,
    );
    row
      .querySelector('select')!
      .addEventListener('change', (event) =>
        this.turn(i, (event.target as HTMLSelectElement).value),
      );
    row.querySelector('[name=flip]')!.addEventListener('change', () => this.flip(i));
    row
      .querySelector('.remove')!
      .addEventListener('click', () => this.write(this.planes.filter((_, k) => k !== i)));
    row
      .querySelector('[name=position]')!
      .addEventListener('input', (event) =>
        this.move(i, Number((event.target as HTMLInputElement).value) / 1000),
      );
    return row;
  }

  private updateRow(row: HTMLElement, plane: ClipSetting | undefined, scene: Scene | null): void {
    row.hidden = !plane;
    if (!plane) return;
    const {axis, flipped} = axisOf(plane);
    row.querySelector('select')!.value = axis >= 0 ? 'xyz'[axis]! : 'free';
    row.querySelector<HTMLInputElement>('[name=flip]')!.checked = flipped;
    const slider = row.querySelector<HTMLInputElement>('[name=position]')!;
    slider.value = String(Math.round(1000 * plane.share));
    if (!scene || scene.bounds.length === 0) return;
    const text = positionText(plane, scene);
    row.querySelector('.position')!.textContent = text;
    slider.setAttribute('aria-valuetext', text);
  }

  private add(): void {
    const used = this.planes.map((plane) => axisOf(plane).axis);
    const axis = [0, 1, 2].find((candidate) => !used.includes(candidate)) ?? 0;
    this.write([...this.planes, {normal: axisNormal(axis, false), share: 0.5}]);
  }

  private turn(i: number, direction: string): void {
    const axis = 'xyz'.indexOf(direction);
    const toCamera = (this.host.view?.pose.direction ?? [0, -1, 0]).map((x) => -x) as Vector;
    const normal = axis >= 0 ? axisNormal(axis, false) : toCamera;
    this.write(this.planes.map((plane, k) => (k === i ? {normal, share: 0.5} : plane)));
  }

  private flip(i: number): void {
    this.write(
      this.planes.map((plane, k) => {
        if (k !== i) return plane;
        const normal = plane.normal.map((x) => (x === 0 ? 0 : -x)) as ClipSetting['normal'];
        return {normal, share: axisOf(plane).axis >= 0 ? plane.share : 1 - plane.share};
      }),
    );
  }

  private write(planes: ClipSetting[]): void {
    this.attributes.write('clip', clipText(planes, this.hasFirstCut));
  }
}

/** The plane's coordinate on its axis; for a free plane, its share of the extent. */
function positionText(plane: ClipSetting, {bounds, manifest}: Scene): string {
  const {axis} = axisOf(plane);
  if (axis < 0) return `${Math.round(100 * plane.share)}\u202f%`;
  const {origin, step} = manifest.lattice;
  const low = bounds[axis]!,
    high = bounds[axis + 3]!;
  return formatCoordinate(
    origin[axis]! + step * (low + plane.share * (high - low)),
    step * (high - low),
  );
}

export const clipPanel: PanelKind = {
  markup: kMarkup,
  make: ({page, host}) => new ClipPanel(page.root, page, host),
};
