// Textures that are filled from arrays.

import {Made, type Graphics} from './graphics';
import type {Texels} from './program';

/** Channels and their type. Only bytes are mixed between texels. */
export type TexelKind = 'rgba8' | 'r32f' | 'rgba32f' | 'rg32ui' | 'rgba32ui';

export class Texture implements Texels {
  private readonly made: Made<WebGLTexture>;

  /** `values` may be changed before `update`. */
  constructor(
    private readonly graphics: Graphics,
    private readonly values: Uint8Array | Float32Array | Uint32Array,
    private readonly width: number,
    private readonly height: number,
    private readonly kind: TexelKind,
  ) {
    const {gl} = graphics;
    this.made = new Made(
      graphics,
      () => {
        const texture = plainTexture(gl, kind === 'rgba8' ? gl.LINEAR : gl.NEAREST);
        this.fill();
        return texture;
      },
      (texture) => gl.deleteTexture(texture),
    );
  }

  update(): void {
    this.bind(0);
    this.fill();
  }

  bind(unit: number): void {
    const {gl} = this.graphics;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, this.made.get());
  }

  dispose(): void {
    this.made.dispose();
  }

  private fill(): void {
    const {gl} = this.graphics;
    const [internal, format, type] = {
      rgba8: [gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE],
      r32f: [gl.R32F, gl.RED, gl.FLOAT],
      rgba32f: [gl.RGBA32F, gl.RGBA, gl.FLOAT],
      rg32ui: [gl.RG32UI, gl.RG_INTEGER, gl.UNSIGNED_INT],
      rgba32ui: [gl.RGBA32UI, gl.RGBA_INTEGER, gl.UNSIGNED_INT],
    }[this.kind] as [number, number, number];
    gl.texImage2D(
      gl.TEXTURE_2D,
      0,
      internal,
      this.width,
      this.height,
      0,
      format,
      type,
      this.values,
    );
  }
}

/** An empty texture, bound. It repeats nothing. */
export function plainTexture(gl: WebGL2RenderingContext, filter: number): WebGLTexture {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  for (const [name, value] of [
    [gl.TEXTURE_MIN_FILTER, filter],
    [gl.TEXTURE_MAG_FILTER, filter],
    [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE],
    [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE],
  ] as const)
    gl.texParameteri(gl.TEXTURE_2D, name, value);
  return texture;
}
