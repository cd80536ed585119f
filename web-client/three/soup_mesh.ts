// A triangle soup as a three.js object whose content is replaced as a whole.

import {BufferAttribute, BufferGeometry, Mesh, Sphere, Vector3} from 'three';
import type {TriangleSoup} from '../core/triangle_soup';
import {FieldMaterial} from './field_material';

export class SoupMesh extends Mesh<BufferGeometry, FieldMaterial> {
  constructor(lit: boolean, twoSided = false) {
    super(new BufferGeometry(), new FieldMaterial(lit, twoSided));
    this.frustumCulled = false;  // the view knows the bounds; computing them again for every picture costs more than it saves
    this.visible = false;
  }

  /** Takes the soup's arrays; null shows nothing. */
  show(soup: TriangleSoup | null): void {
    // Frees the GPU's buffers: the next picture has other sizes, so there is nothing to reuse.
    this.geometry.dispose();
    this.visible = soup !== null && soup.positions.length > 0;
    if (!soup) return;
    const colored = soup.values.length > 0;
    const values = colored ? soup.values : new Float32Array(soup.positions.length / 3);
    this.geometry.setAttribute('position', new BufferAttribute(soup.positions, 3));
    this.geometry.setAttribute('value', new BufferAttribute(values, 1));
    this.geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
    this.material.setColored(colored);
    this.material.setFirstHalf(soup.firstHalf);
  }

  override dispose(): void {
    this.geometry.dispose();
    this.material.dispose();
  }
}
