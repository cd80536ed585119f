// The clip plane's controls: across one axis, at a share of the mesh's extent, from either side.

import type {Manifest} from '../core/manifest';
import type {Plane} from '../core/slice';
import {formatCoordinate} from './format';

type Axis = 0 | 1 | 2;

/** The side that is cut away first faces the first camera: front, right and top. */
const kFirstSides: [number, number, number] = [1, -1, 1];

/** A clip as an attribute tells it: "y", "y:0.3" (share of the extent), "-y:0.3" (from the other side); null for anything else. */
export function parseClip(text: string | null): {axis: Axis; share: number; flipped: boolean} | null {
  const match = /^(-?)([xyz])(?::(0(?:\.\d+)?|1(?:\.0+)?))?$/.exec(text ?? '');
  if (!match) return null;
  return {axis: 'xyz'.indexOf(match[2]!) as Axis, share: Number(match[3] ?? 0.5), flipped: match[1] === '-'};
}

export class ClipPanel {
  private readonly form: HTMLElement;
  private readonly on: HTMLInputElement;
  private readonly position: HTMLInputElement;
  private readonly flip: HTMLInputElement;
  private bounds: number[] = [];
  private manifest: Manifest | null = null;

  /** `changed` gets the plane in lattice coordinates, or null for none. */
  constructor(root: ParentNode, private readonly changed: (plane: Plane | null) => void) {
    this.form = root.querySelector('.clip')!;
    this.on = root.querySelector('input[name=clip]')!;
    this.position = root.querySelector('input[name=position]')!;
    this.flip = root.querySelector('input[name=flip]')!;
    this.on.addEventListener('change', () => this.update());
    this.form.addEventListener('input', () => this.update());
  }

  /** The mesh's bounds in lattice coordinates and where the lattice lies. */
  place(bounds: number[], manifest: Manifest): void {
    const first = this.bounds.length === 0;
    this.bounds = bounds;
    this.manifest = manifest;
    if (first) this.update();
  }

  clear(): void {
    this.bounds = [];
    this.manifest = null;
  }

  /** Clips at `share` of the extent along axis 0 to 2, from the side that faces the first camera, or from the other. */
  set(axis: Axis | null, share: number, flipped: boolean): void {
    this.on.checked = axis !== null;
    this.flip.checked = flipped;
    this.position.value = String(Math.round(1000 * share));
    if (axis !== null) this.form.querySelectorAll<HTMLInputElement>('input[name=axis]')[axis]!.checked = true;
    this.update();
  }

  private update(): void {
    this.form.hidden = !this.on.checked;
    if (this.bounds.length === 0 || !this.manifest) return;
    if (!this.on.checked) {
      this.changed(null);
      return;
    }
    const axis = this.axis();
    const low = this.bounds[axis]!;
    const high = this.bounds[axis + 3]!;
    // Between two lattice planes: no vertex lies on the cut, and no cell's section is a single point.
    const at = Math.floor(low + (Number(this.position.value) / 1000) * (high - low)) + 0.5;
    const side = kFirstSides[axis]! * (this.flip.checked ? -1 : 1);
    const normal: [number, number, number] = [0, 0, 0];
    normal[axis] = side;
    const {origin, step} = this.manifest.lattice;
    const coordinate = formatCoordinate(origin[axis]! + step * at, step * (high - low));
    this.form.querySelector('.position')!.textContent = coordinate;
    this.position.setAttribute('aria-valuetext', coordinate);
    this.changed({normal, offset: side * at});
  }

  private axis(): Axis {
    const checked = this.form.querySelector<HTMLInputElement>('input[name=axis]:checked')!;
    return 'xyz'.indexOf(checked.value) as Axis;
  }
}
