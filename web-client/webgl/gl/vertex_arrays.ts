// Buffers of numbers as the attributes of a program, in its order.

import {Made, type Graphics} from './graphics';

export interface VertexNumbers {
  data: Float32Array;
  /** Numbers of each attribute, one after another. */
  sizes: readonly number[];
  /** The attributes of an instance begin so many numbers after those of the last one. */
  stride: number;
  /** Each instance has its own; else each corner has. */
  ofInstances: boolean;
}

interface Things {
  vertices: WebGLVertexArrayObject;
  buffers: WebGLBuffer[];
}

export class VertexArrays {
  private readonly made: Made<Things>;

  /** `numbers` is asked when they are needed, again after dispose() and after lost graphics. */
  constructor(
    private readonly graphics: Graphics,
    private readonly numbers: () => VertexNumbers[],
  ) {
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

  /** `mode`, as WebGL names it, with so many corners for each instance. */
  draw(mode: number, corners: number, instances: number): void {
    const {gl} = this.graphics;
    gl.bindVertexArray(this.made.get().vertices);
    gl.drawArraysInstanced(mode, 0, corners, instances);
    gl.bindVertexArray(null);
  }

  /** Makes room. The next drawing has the numbers of then. */
  dispose(): void {
    this.made.dispose();
  }

  private upload(): Things {
    const {gl} = this.graphics;
    const vertices = gl.createVertexArray();
    gl.bindVertexArray(vertices);
    let attribute = 0;
    const buffers = this.numbers().map(({data, sizes, stride, ofInstances}) => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, data as Float32Array<ArrayBuffer>, gl.STATIC_DRAW);
      let at = 0;
      for (const size of sizes) {
        gl.enableVertexAttribArray(attribute);
        gl.vertexAttribPointer(attribute, size, gl.FLOAT, false, 4 * stride, 4 * at);
        gl.vertexAttribDivisor(attribute, Number(ofInstances));
        at += size;
        ++attribute;
      }
      return buffer;
    });
    gl.bindVertexArray(null);
    return {vertices, buffers};
  }
}
