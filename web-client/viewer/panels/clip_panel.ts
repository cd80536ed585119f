// Up to three clip planes, across an axis or facing the camera. Sliders here and handles in the
// picture move them.

import {axisNormal, axisOf, clipText, type ClipSetting} from '../../core/layers/clip';
import {kMaxPlanes} from '../../core/picture/display';
import {formatCoordinate} from '../page/format';
import type {Attributes} from '../page/page';
import {setMarkup} from '../page/trusted';
import type {Settings} from '../settings/settings';
import type {Panel, Scene} from './panel';

export class ClipPanel implements Panel {
  private planes: ClipSetting[] = [];
  private hasFirstCut = false;

  /** `viewNormal` points from the mesh to the camera, in lattice coordinates. */
  constructor(
    private readonly root: ParentNode,
    private readonly attributes: Attributes,
    private readonly viewNormal: () => [number, number, number],
  ) {
    this.find<HTMLInputElement>('input[name=clip]').addEventListener('change', (event) => {
      this.write(
        (event.target as HTMLInputElement).checked
          ? [{normal: axisNormal(0, false), share: 0.5}]
          : [],
      );
    });
    this.find('.clip-modes').addEventListener('change', (event) => {
      const mode = (event.target as HTMLInputElement).value;
      attributes.write('clip-mode', mode === 'cut' ? null : mode);
    });
    this.find('.add-plane').addEventListener('click', () => this.add());
    const rows = this.find('.planes');
    rows.replaceChildren(...Array.from({length: kMaxPlanes}, (_, i) => this.row(i)));
  }

  update({planes, mode, hasFirstCut}: Settings, scene: Scene | null): void {
    this.planes = planes;
    this.hasFirstCut = hasFirstCut;
    this.find<HTMLInputElement>('input[name=clip]').checked = planes.length > 0;
    this.find('.clip').hidden = planes.length === 0;
    this.find<HTMLInputElement>(`.clip-modes input[value=${mode}]`).checked = true;
    this.find('.add-plane').hidden = planes.length >= kMaxPlanes;
    [...this.find('.planes').children].forEach((row, i) =>
      this.updateRow(row as HTMLElement, planes[i], scene),
    );
  }

  /** Moves plane `i` to a share of the extent. */
  move(i: number, share: number): void {
    this.write(
      this.planes.map((plane, k) =>
        k === i ? {...plane, share: Math.min(1, Math.max(0, share))} : plane,
      ),
    );
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
    const normal = axis >= 0 ? axisNormal(axis, false) : this.viewNormal();
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
  private find<T extends HTMLElement = HTMLElement>(selector: string): T {
    return this.root.querySelector<T>(selector)!;
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
