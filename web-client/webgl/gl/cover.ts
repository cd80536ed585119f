// A triangle that covers all pixels of a target.

import {Made, type Graphics} from './graphics';

/** Its vertex shader. `at` is the place in [0, 1]^2. */
export const kCoverShader = /* glsl */ `
  out vec2 at;
  void main() {
    at = vec2(gl_VertexID == 1 ? 2.0 : 0.0, gl_VertexID == 2 ? 2.0 : 0.0);
    gl_Position = vec4(2.0 * at - 1.0, 0.0, 1.0);
  }`;

export class Cover {
  private readonly made: Made<WebGLVertexArrayObject>;

  constructor(private readonly graphics: Graphics) {
    const {gl} = graphics;
    this.made = new Made(
      graphics,
      () => gl.createVertexArray(),
      (vertices) => gl.deleteVertexArray(vertices),
    );
  }

  /** Draws the corners of so many triangles; their shader needs no attributes. */
  draw(corners = 3): void {
    const {gl} = this.graphics;
    gl.bindVertexArray(this.made.get());
    gl.drawArrays(gl.TRIANGLES, 0, corners);
    gl.bindVertexArray(null);
  }

  dispose(): void {
    this.made.dispose();
  }
}
