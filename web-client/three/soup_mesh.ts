// A triangle soup as a three.js object. Its buffers stay and grow. Only the parts of a new soup
// that differ are uploaded.

import {BufferAttribute, BufferGeometry, DynamicDrawUsage, Mesh, Sphere, Vector3} from 'three';
import type {TriangleSoup} from '../core/picture/triangle_soup';
import {copyChanged} from '../webgl/changed_ranges';
import {FieldMaterial} from './field_material';

/** A buffer gets this many times the room that it needs, for later levels. */
const kGrowth = 1.5;

export class SoupMesh extends Mesh<BufferGeometry, FieldMaterial> {
  /** The corners that fit into the buffers. */
  private capacity = 0;

  constructor(lit: boolean, twoSided = false) {
    super(new BufferGeometry(), new FieldMaterial(lit, twoSided));
    // the view knows the bounds, and computing them for every picture costs more than it saves
    this.frustumCulled = false;
    this.visible = false;
  }

  /** Shows the soup, or nothing for null. The soup's arrays are free afterwards. */
  show(soup: TriangleSoup | null): void {
    this.visible = soup !== null && soup.positions.length > 0;
    if (!soup || !this.visible) return;
    const corners = soup.positions.length / 3;
    if (corners > this.capacity) this.grow(corners);
    this.update('position', soup.positions);
    const colored = soup.values.length > 0;
    if (colored) this.update('value', soup.values);
    this.geometry.setDrawRange(0, corners);
    this.material.setColored(colored);
    this.material.setFirstHalf(soup.firstHalf);
  }

  /** 9 lattice coordinates for each triangle that is shown; empty if none is. */
  get shown(): Float32Array {
    const {position} = this.geometry.attributes;
    if (!this.visible || !position) return new Float32Array(0);
    return (position.array as Float32Array).subarray(0, 3 * this.geometry.drawRange.count);
  }

  override dispose(): void {
    this.geometry.dispose();
    this.material.dispose();
  }

  private grow(corners: number): void {
    this.geometry.dispose();
    this.capacity = this.capacity === 0 ? corners : Math.ceil(corners * kGrowth);
    for (const [name, size] of [
      ['position', 3],
      ['value', 1],
    ] as const) {
      this.geometry.setAttribute(
        name,
        new BufferAttribute(new Float32Array(size * this.capacity), size).setUsage(
          DynamicDrawUsage,
        ),
      );
    }
    this.geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
  }

  private update(name: string, values: Float32Array): void {
    const attribute = this.geometry.getAttribute(name) as BufferAttribute;
    const ranges = copyChanged(attribute.array as Float32Array, values);
    if (ranges.length === 0) return;
    for (const {start, count} of ranges) attribute.addUpdateRange(start, count);
    attribute.needsUpdate = true;
  }
}
