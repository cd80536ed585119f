// Pictures apart from the canvas.

import {Made, type Graphics} from './graphics';
import type {Texels} from './program';
import {plainTexture} from './texture';

export type TargetKind = 'rgba8' | 'rgba16f' | 'rg32ui';

export interface TargetParts {
  kind: TargetKind;
  /** `texture`: shaders can read the depths. */
  depths: 'none' | 'buffer' | 'texture';
  /** Above 0 shaders cannot read the colours, `read` can. */
  samples?: number;
}

interface Things {
  framebuffer: WebGLFramebuffer;
  color: WebGLTexture | null;
  depths: WebGLTexture | null;
  all: (() => void)[];
}

export class Target {
  width = 1;
  height = 1;
  readonly color: Texels = {bind: (unit) => this.bindTexture(unit, ({color}) => color)};
  readonly depths: Texels = {bind: (unit) => this.bindTexture(unit, ({depths}) => depths)};
  private readonly made: Made<Things>;

  constructor(
    readonly graphics: Graphics,
    private readonly parts: TargetParts,
  ) {
    this.made = new Made(
      graphics,
      () => this.make(),
      ({all}) => all.forEach((end) => end()),
    );
  }

  private get things(): Things {
    return this.made.get();
  }

  /** Another size or kind empties it. */
  resize(width: number, height: number, kind = this.parts.kind): void {
    if (width === this.width && height === this.height && kind === this.parts.kind) return;
    this.dispose();
    Object.assign(this, {width, height});
    this.parts.kind = kind;
  }

  /** The next drawing goes here. */
  begin(): void {
    const {gl} = this.graphics;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.things.framebuffer);
    this.graphics.fill(this);
  }

  /** Everything becomes 0, and infinitely far. REQUIRES: it has begun. */
  clear(): void {
    const {gl} = this.graphics;
    this.graphics.use({depths: 'written'});
    if (this.parts.kind === 'rg32ui') gl.clearBufferuiv(gl.COLOR, 0, [0, 0, 0, 0]);
    else gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
    if (this.parts.depths !== 'none') gl.clearBufferfv(gl.DEPTH, 0, [1]);
  }

  /** The colours as bytes, row by row from below. REQUIRES: rgba8. */
  read(): Uint8ClampedArray<ArrayBuffer> {
    const {gl} = this.graphics;
    const {width, height} = this;
    const pixels = new Uint8ClampedArray(4 * width * height);
    const plain = this.parts.samples
      ? new Target(this.graphics, {kind: 'rgba8', depths: 'none'})
      : null;
    if (plain) {
      plain.resize(width, height);
      gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, plain.things.framebuffer);
      gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.things.framebuffer);
      gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, (plain ?? this).things.framebuffer);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    plain?.dispose();
    return pixels;
  }

  dispose(): void {
    this.made.dispose();
  }

  private bindTexture(unit: number, which: (things: Things) => WebGLTexture | null): void {
    const {gl} = this.graphics;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, which(this.things));
  }

  private make(): Things {
    const {gl} = this.graphics;
    const {kind, depths, samples = 0} = this.parts;
    const framebuffer = gl.createFramebuffer();
    const made: Things = {
      framebuffer,
      color: null,
      depths: null,
      all: [() => gl.deleteFramebuffer(framebuffer)],
    };
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    const internal = {rgba8: gl.RGBA8, rgba16f: gl.RGBA16F, rg32ui: gl.RG32UI}[kind];
    // Integers and depths are not read between texels.
    if (samples > 0) this.attachBuffer(made, gl.COLOR_ATTACHMENT0, internal);
    else
      made.color = this.attachTexture(
        made,
        gl.COLOR_ATTACHMENT0,
        internal,
        kind === 'rg32ui' ? gl.NEAREST : gl.LINEAR,
      );
    if (depths === 'buffer') this.attachBuffer(made, gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24);
    if (depths === 'texture')
      made.depths = this.attachTexture(made, gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24, gl.NEAREST);
    return made;
  }

  private attachTexture(
    made: Things,
    attachment: number,
    internal: number,
    filter: number,
  ): WebGLTexture {
    const {gl} = this.graphics;
    const texture = plainTexture(gl, filter);
    gl.texStorage2D(gl.TEXTURE_2D, 1, internal, this.width, this.height);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, attachment, gl.TEXTURE_2D, texture, 0);
    made.all.push(() => gl.deleteTexture(texture));
    return texture;
  }

  private attachBuffer(made: Things, attachment: number, internal: number): void {
    const {gl} = this.graphics;
    const buffer = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
    gl.renderbufferStorageMultisample(
      gl.RENDERBUFFER,
      this.parts.samples ?? 0,
      internal,
      this.width,
      this.height,
    );
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, buffer);
    made.all.push(() => gl.deleteRenderbuffer(buffer));
  }
}
