// A triangle soup in buffers that stay and grow. Only the parts of a new soup that differ are
// uploaded.

import {kPlainCode} from '../core/picture/paint';
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
export const kSoupAttributes = ['position', 'value', 'creases', 'paint'] as const;
const kNumbers = {position: 3, value: 1, creases: 1, paint: 4};

interface Buffers {
  vertices: WebGLVertexArrayObject;
  buffers: WebGLBuffer[];
  /** The corners of triangles that are drawn in another order. */
  order: WebGLBuffer;
}

export class Soup {
  /** The uniforms of its own. */
  readonly look: Record<string, Uniform>;
  private readonly made: Made<Buffers>;
  private readonly data = {
    position: new Float32Array(0),
    value: new Float32Array(0),
    creases: new Uint8Array(0),
    /** Empty without paint: all corners have that of the program. */
    paint: new Uint8Array(0),
  };
  private corners = 0;
  /** The sides of its triangles are edges of cells. */
  hasEdges = true;
  /** Some of its triangles may be seen through, others not. */
  hasClear = false;

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
      ({vertices, buffers, order}) => {
        gl.deleteVertexArray(vertices);
        for (const buffer of [...buffers, order]) gl.deleteBuffer(buffer);
      },
    );
  }

  get visible(): boolean {
    return this.corners > 0;
  }
  /** Empty while it is invisible. */
  get shown(): Lined & {paint: Uint8Array} {
    const {position, creases, paint} = this.data;
    return {
      positions: position.subarray(0, 3 * this.corners),
      creases: creases.subarray(0, this.corners),
      paint: paint.subarray(0, 4 * this.corners),
    };
  }

  /** Shows the soup, or nothing for null. The soup's arrays are free afterwards. */
  show(soup: TriangleSoup | null): void {
    this.corners = (soup?.positions.length ?? 0) / 3;
    if (!soup || !this.visible) return;
    this.hasEdges = soup.edges ?? true;
    const colored = soup.values.length > 0;
    Object.assign(this.look, {colored, firstHalf: soup.firstHalf});
    this.hasClear = soup.hasClear ?? false;
    const isPainted = this.data.paint.length > 0;
    if (this.corners > this.data.value.length || (soup.paint && !isPainted)) this.grow(soup);
    this.update('position', soup.positions);
    if (colored) this.update('value', soup.values);
    this.update('creases', soup.creases ?? new Uint8Array(this.corners));
    if (soup.paint) this.update('paint', soup.paint);
    else if (isPainted) this.update('paint', new Uint8Array(4 * this.corners).fill(kPlainCode));
  }

  setClip(planes: readonly Plane[]): void {
    this.look.clipPlanes = clipValues(planes);
  }

  /**
   * `corners` are drawn in this order, or (null) all. REQUIRES: a program with kSoupAttributes is
   * in use.
   */
  draw(corners: Uint32Array | null): void {
    const {gl} = this.graphics;
    const {vertices, order} = this.made.get();
    gl.bindVertexArray(vertices);
    if (corners) {
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, order);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, corners, gl.STREAM_DRAW);
      gl.drawElements(gl.TRIANGLES, corners.length, gl.UNSIGNED_INT, 0);
    } else gl.drawArrays(gl.TRIANGLES, 0, this.corners);
    gl.bindVertexArray(null);
  }

  dispose(): void {
    this.made.dispose();
  }

  private grow({paint}: TriangleSoup): void {
    const capacity =
      this.data.value.length === 0 ? this.corners : Math.ceil(this.corners * kGrowth);
    this.data.position = new Float32Array(kNumbers.position * capacity);
    this.data.value = new Float32Array(capacity);
    this.data.creases = new Uint8Array(capacity);
    this.data.paint = new Uint8Array(paint ? 4 * capacity : 0);
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
      // WebGL's own value of one that is absent is plain
      if (this.data[name].length > 0) gl.enableVertexAttribArray(at);
      const isFloat = name === 'position' || name === 'value';
      const type = isFloat ? gl.FLOAT : gl.UNSIGNED_BYTE;
      gl.vertexAttribPointer(at, kNumbers[name], type, name === 'paint', 0, 0);
      return buffer;
    });
    gl.bindVertexArray(null);
    return {vertices, buffers, order: gl.createBuffer()};
  }
}
