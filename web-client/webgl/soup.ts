// A triangle soup in buffers that stay and grow. Only the parts of a new soup that differ are
// uploaded.

import type {TriangleSoup} from '../core/picture/triangle_soup';
import type {Plane} from '../core/protocol/geometry';
import {copyChanged} from './changed_ranges';
import {clipValues} from './clip_values';
import type {Lined} from './edge_fade';
import {Made, type Graphics} from './gl/graphics';
import type {Uniform} from './gl/program';

/** A buffer gets this many times the room that it needs, for later levels. */
const kGrowth = 1.5;
/** The attributes of a corner, in the order of a program: their names, and their numbers. */
export const kSoupAttributes = ['position', 'value', 'creases'] as const;
const kNumbers = {position: 3, value: 1, creases: 1};

interface Buffers {
  vertices: WebGLVertexArrayObject;
  buffers: WebGLBuffer[];
}

export class Soup {
  /** The uniforms of its own. */
  readonly look: Record<string, Uniform>;
  private readonly made: Made<Buffers>;
  private readonly data = {
    position: new Float32Array(0),
    value: new Float32Array(0),
    creases: new Uint8Array(0),
  };
  private corners = 0;
  /** The sides of its triangles are edges of cells. */
  hasEdges = true;

  /**
   * `lit` shades it as a surface, without `lit` it is flat, as a cut. The inside of a surface is
   * grey unless it is `twoSided`.
   */
  constructor(
    private readonly graphics: Graphics,
    lit: boolean,
    twoSided = false,
  ) {
    this.look = {
      lit,
      twoSided,
      colored: false,
      firstHalf: 0,
      opacity: 1,
      clipPlanes: clipValues([]),
    };
    const {gl} = graphics;
    this.made = new Made(
      graphics,
      () => this.upload(),
      ({vertices, buffers}) => {
        gl.deleteVertexArray(vertices);
        for (const buffer of buffers) gl.deleteBuffer(buffer);
      },
    );
  }

  get visible(): boolean {
    return this.corners > 0;
  }
  /** Empty while it is invisible. */
  get shown(): Lined {
    const {position, creases} = this.data;
    return {
      positions: position.subarray(0, 3 * this.corners),
      creases: creases.subarray(0, this.corners),
    };
  }

  /** Shows the soup, or nothing for null. The soup's arrays are free afterwards. */
  show(soup: TriangleSoup | null): void {
    this.corners = (soup?.positions.length ?? 0) / 3;
    if (!soup || !this.visible) return;
    this.hasEdges = soup.edges ?? true;
    const colored = soup.values.length > 0;
    Object.assign(this.look, {colored, firstHalf: soup.firstHalf});
    if (this.corners > this.data.value.length) this.grow();
    this.update('position', soup.positions);
    if (colored) this.update('value', soup.values);
    this.update('creases', soup.creases ?? new Uint8Array(this.corners));
  }

  setClip(planes: readonly Plane[]): void {
    this.look.clipPlanes = clipValues(planes);
  }

  /** REQUIRES: a program with kSoupAttributes is in use. */
  draw(): void {
    const {gl} = this.graphics;
    gl.bindVertexArray(this.made.get().vertices);
    gl.drawArrays(gl.TRIANGLES, 0, this.corners);
    gl.bindVertexArray(null);
  }

  dispose(): void {
    this.made.dispose();
  }

  private grow(): void {
    const capacity =
      this.data.value.length === 0 ? this.corners : Math.ceil(this.corners * kGrowth);
    this.data.position = new Float32Array(kNumbers.position * capacity);
    this.data.value = new Float32Array(capacity);
    this.data.creases = new Uint8Array(capacity);
    this.made.dispose();
  }

  private update(name: (typeof kSoupAttributes)[number], values: Float32Array | Uint8Array): void {
    const {gl} = this.graphics;
    const data = this.data[name];
    const ranges = copyChanged(data, values);
    if (ranges.length === 0) return;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.made.get().buffers[kSoupAttributes.indexOf(name)]!);
    for (const {start, count} of ranges)
      gl.bufferSubData(gl.ARRAY_BUFFER, data.BYTES_PER_ELEMENT * start, data, start, count);
  }

  private upload(): Buffers {
    const {gl} = this.graphics;
    const vertices = gl.createVertexArray();
    gl.bindVertexArray(vertices);
    const buffers = kSoupAttributes.map((name, at) => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, this.data[name], gl.DYNAMIC_DRAW);
      gl.enableVertexAttribArray(at);
      const type = name === 'creases' ? gl.UNSIGNED_BYTE : gl.FLOAT;
      gl.vertexAttribPointer(at, kNumbers[name], type, false, 0, 0);
      return buffer;
    });
    gl.bindVertexArray(null);
    return {vertices, buffers};
  }
}
