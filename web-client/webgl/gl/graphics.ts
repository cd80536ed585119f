// A WebGL 2 context. The browser may take it away and give it back; then all that was made in it
// is gone. So whatever draws keeps its data, and makes its things again when it needs them.

export interface Drawing {
  depths?: 'none' | 'tested' | 'written';
  /** Triangles that face away are left out. */
  culls?: boolean;
  /** How colours mix with those that are there; null: they replace them. */
  mix?: 'over' | 'behind' | null;
  /** Only these rows of pixels are drawn. */
  rows?: {from: number; count: number; width: number} | null;
}

export class Graphics {
  readonly gl: WebGL2RenderingContext;
  /** Infinity if the graphics are lost already. */
  readonly maxTextureSize: number;
  /** Width and height of what is drawn onto, in pixels. */
  size: readonly [number, number] = [1, 1];
  /** Counts how often the browser has given the graphics back. */
  generation = 0;

  /** Throws when the browser has no WebGL 2. */
  constructor(readonly surface: HTMLCanvasElement | OffscreenCanvas) {
    const gl = surface.getContext('webgl2', {
      antialias: true,
      alpha: true,
      powerPreference: 'high-performance',
    }) as WebGL2RenderingContext | null;
    if (!gl) throw new Error('the browser gives no WebGL 2');
    this.gl = gl;
    // Lost graphics answer nothing.
    this.maxTextureSize = Number(gl.getParameter(gl.MAX_TEXTURE_SIZE) ?? Infinity);
  }

  /** The name of the graphics; empty if the browser does not say it. */
  get renderer(): string {
    const {gl} = this;
    const name = String(gl.getParameter(gl.RENDERER) ?? '');
    if (name !== 'WebKit WebGL') return name; // Firefox says it, and warns of the extension
    const names = gl.getExtension('WEBGL_debug_renderer_info');
    return String((names && gl.getParameter(names.UNMASKED_RENDERER_WEBGL)) ?? '');
  }

  /** Must be called when the browser has given the graphics back. */
  restored(): void {
    ++this.generation;
  }

  /** Sets how the next drawings test and mix. */
  use({depths = 'none', culls = false, mix = null, rows = null}: Drawing): void {
    const {gl} = this;
    const set = (what: number, on: boolean): void => (on ? gl.enable(what) : gl.disable(what));
    set(gl.DEPTH_TEST, depths !== 'none');
    gl.depthFunc(gl.LEQUAL);
    gl.depthMask(depths === 'written');
    set(gl.CULL_FACE, culls);
    set(gl.BLEND, mix !== null);
    // Behind: premultiplied colours lie behind those that are there.
    if (mix === 'behind') gl.blendFunc(gl.ONE_MINUS_DST_ALPHA, gl.ONE);
    else gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    set(gl.SCISSOR_TEST, rows !== null);
    if (rows) gl.scissor(0, rows.from, rows.width, rows.count);
  }

  /** The next drawing goes to the canvas. */
  beginCanvas(): void {
    const {gl, surface} = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    this.fill(surface);
  }

  /** The next drawing fills all of a target of this size. */
  fill({width, height}: {width: number; height: number}): void {
    this.size = [width, height];
    this.gl.viewport(0, 0, width, height);
  }
}

/** Something that is made when it is needed, and again after the graphics were lost. */
export class Made<Thing> {
  private thing: Thing | null = null;
  private generation = -1;

  constructor(
    private readonly graphics: Graphics,
    private readonly make: () => Thing,
    private readonly remove: (thing: Thing) => void,
  ) {}

  get(): Thing {
    if (this.thing === null || this.generation !== this.graphics.generation)
      this.thing = this.make();
    this.generation = this.graphics.generation;
    return this.thing;
  }

  /** Makes room. It may be made again. */
  dispose(): void {
    if (this.thing !== null && this.generation === this.graphics.generation)
      this.remove(this.thing);
    this.thing = null;
  }
}
