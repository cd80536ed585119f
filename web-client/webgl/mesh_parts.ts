// The triangles of a picture: surface, cuts and layers, with the look that they share. The lines of
// the mesh at rest lie among them.

import {linearPart} from '../core/picture/log_scale';
import {kMaxPlanes} from '../core/picture/display';
import type {Snapshot} from '../core/session/worker_messages';
import type {ArrowView} from './arrow_view';
import type {backToFront} from './clear_order';
import {ColorTable} from './color_table';
import {fadesOf} from './edge_fade';
import {kFieldFragmentShader, kFieldVertexShader} from './field_shaders';
import type {Graphics} from './gl/graphics';
import {Program, type Uniform} from './gl/program';
import {isOutside, type Eye} from './lens';
import type {FlowLines} from './flow_lines';
import type {LineParts} from './line_parts';
import type {Matrix} from './matrix';
import type {Size} from './pose';
import {kSoupAttributes, Soup} from './soup';
import type {Look} from './view';

/** The darkness of cell edges: enough to follow them, too little to change what a colour says. */
const kEdgeStrength = 0.52;
/** The darkness of creases: they stand off from edges of cells, and need to be seen alone. */
const kCreaseStrength = 0.72;

/** The LinesLook of dashes. */
const kMovingLook = 'dashes';

const kPrecisions = `precision highp float;
  precision highp int;
  precision highp sampler2D;`;
const kVertexHead = `${kPrecisions}
  uniform mat4 modelViewMatrix;
  uniform mat4 projectionMatrix;
  in vec3 position;`;
const kFragmentHead = `${kPrecisions}
  layout(location = 0) out vec4 fragColor;
  #define gl_FragColor fragColor
`;

export class MeshParts {
  private readonly surface: Soup;
  /** By name. */
  private readonly layers = new Map<string, Soup>();
  private readonly cuts: readonly Soup[];
  private readonly program: Program;
  private readonly colors: ColorTable;
  /** The darkness of edges and creases, and the share of it that creases have now. */
  private readonly lines = {edges: 0, creases: 0, creaseFade: 1};
  /** As Frame, of a picture that is drawn apart from the canvas; null: none is drawn. */
  frame: {onDark: boolean; pixelRatio: number} | null = null;
  /** The surface's, in lattice coordinates. */
  private bounds: readonly number[] = [];
  /** No plane cuts the surface. */
  private isClosed = true;
  /** It is loaded with the first soup that needs it. */
  order: ((...its: Parameters<typeof backToFront>) => Uint32Array | null) | null = null;
  /** They are loaded with the first lines. */
  flow: FlowLines | null = null;
  restEdges: LineParts | null = null;
  arrows: ArrowView | null = null;
  private flowLook = '';
  private flowMoves = false;
  /** The uniforms of all. */
  private readonly look: Record<string, Uniform>;

  constructor(private readonly graphics: Graphics) {
    this.surface = new Soup(graphics, true);
    this.cuts = Array.from({length: kMaxPlanes}, () => new Soup(graphics, false));
    this.program = new Program(
      graphics,
      `${kVertexHead}${kFieldVertexShader}`,
      `${kFragmentHead}${kFieldFragmentShader}`,
      kSoupAttributes,
    );
    this.colors = new ColorTable(graphics);
    this.look = {
      colorMap: this.colors.texture,
      plainColor: [0.72, 0.74, 0.78],
      range: [0, 1],
      scaleRange: [0, 1],
      logarithmic: false,
      linear: 0,
      below: [0, 0, 0, 0],
      above: [0, 0, 0, 0],
      edgeFade: 1,
      onDark: false,
      pixelRatio: 1,
    };
  }

  /** `capped`: the cuts are closed by their cells. */
  show(snapshot: Snapshot, capped: boolean): void {
    if (snapshot.surface) this.surface.show(snapshot.surface);
    const {isosurface, layers} = snapshot;
    const changed = {...(isosurface && {isosurface}), ...layers};
    for (const [name, soup] of Object.entries(changed)) this.layer(name).show(soup);
    for (const soup of this.layers.values()) soup.setClip(snapshot.planes);
    this.surface.setClip(snapshot.planes);
    if (snapshot.streamlines !== undefined) this.flow?.show(snapshot.streamlines);
    if (snapshot.arrows !== undefined) this.arrows?.show(snapshot.arrows);
    this.restEdges?.show(snapshot.warp?.restEdges ?? null);
    this.bounds = snapshot.bounds;
    this.isClosed = snapshot.planes.length === 0;
    this.cuts.forEach((soup, i) => {
      soup.show(capped ? (snapshot.cuts[i] ?? null) : null);
      soup.setClip(snapshot.planes.filter((_, k) => k !== i));
    });
  }

  /** Shows a triangle without area. */
  warmUp(): void {
    this.surface.show({
      positions: new Float32Array(9),
      values: new Float32Array(3),
      firstHalf: 1,
    });
  }

  clear(): void {
    for (const soup of this.all) soup.show(null);
    this.flow?.show(null);
    this.arrows?.show(null);
    this.restEdges?.show(null);
  }

  setLook({map, reversed, edges, creases, opacity, beyond, onDark = false, ...its}: Look): void {
    this.flowLook = its.lines ?? '';
    this.flowMoves = its.moves ?? false;
    this.colors.show(map, reversed);
    this.lines.edges = edges ? kEdgeStrength : 0;
    this.lines.creases = creases ? kCreaseStrength : 0;
    this.look.onDark = onDark;
    for (const [i, name] of (['below', 'above'] as const).entries()) {
      const color = beyond?.[i]?.map((channel) => channel / 255);
      this.look[name] = color ? [...color, 1] : [0, 0, 0, 0];
    }
    this.surface.look.opacity = opacity;
  }

  /**
   * The colours span `low` to `high`, values of the field. `scaleRange` holds the values of 0 and 1
   * in the soups. Returns the range as shaders take it. REQUIRES: low < high if logarithmic, and
   * low is not 0.
   */
  setRange(
    low: number,
    high: number,
    scaleRange: [number, number],
    logarithmic: boolean,
  ): [number, number] {
    const span = scaleRange[1] - scaleRange[0] || 1;
    const share = (value: number): number => (value - scaleRange[0]) / span;
    const range: [number, number] = logarithmic ? [low, high] : [share(low), share(high)];
    const linear = linearPart({low, high, logarithmic});
    Object.assign(this.look, {range, scaleRange, logarithmic, linear});
    return range;
  }

  /** Draws lines as strong as there is space between them on a canvas of this size. */
  fadeLines(toCanvas: Matrix, canvas: Size): void {
    const lined = [this.surface, ...this.cuts].map(({shown}) => shown);
    const {edges, creases} = fadesOf(lined, toCanvas, canvas);
    this.look.edgeFade = edges;
    this.lines.creaseFade = creases;
  }

  setPixelRatio(ratio: number): void {
    this.look.pixelRatio = ratio;
  }

  /** Draws all onto an empty target, or canvas. */
  draw({toEye, toCube}: Eye): void {
    // The inside of a closed surface is hidden. Graphics without a GPU would draw it for long.
    const hidesInside = this.isClosed && isOutside(this.bounds, toEye);
    const isClear = ({look}: Soup): boolean => Number(look.opacity) < 1;
    const visible = this.all.filter((soup) => soup.visible);
    const {lines} = this;
    const ground = this.frame ?? this.look;
    const pixelRatio = Math.max(1, Number(ground.pixelRatio));
    const seen = {...this.look, pixelRatio, modelViewMatrix: toEye, projectionMatrix: toCube};
    const drawSoup = (soup: Soup, clear: boolean): void => {
      this.graphics.use({
        depths: clear ? 'tested' : 'written',
        culls: hidesInside && !clear && soup === this.surface,
        mix: clear ? 'over' : null,
      });
      this.program.use({
        ...seen,
        ...soup.look,
        pass: !soup.hasClear || isClear(soup) ? 0 : clear ? 2 : 1,
        edgeStrength: soup.hasEdges ? lines.edges : 0,
        creaseStrength: soup.hasEdges ? lines.creases * lines.creaseFade : 0,
      });
      const {positions, paint} = soup.shown;
      const isOrdered = clear && soup.hasClear && !isClear(soup);
      soup.draw(isOrdered ? (this.order?.(positions, paint, toEye) ?? null) : null);
    };
    for (const soup of visible) if (!isClear(soup)) drawSoup(soup, false);
    const onDark = Boolean(ground.onDark);
    this.restEdges?.draw({toEye, toCube}, {onDark, opacity: lines.creaseFade, pixelRatio});
    const [x0, y0, z0, x1, y1, z1] = this.bounds;
    const diagonal = Math.hypot(x1! - x0!, y1! - y0!, z1! - z0!);
    this.arrows?.draw({toEye, toCube}, this.look);
    this.flow?.draw({toEye, toCube}, this.look, {kind: this.flowLook, diagonal, pixelRatio});
    // Soups that can be seen through come last, and hide nothing.
    for (const soup of visible) if (isClear(soup) || soup.hasClear) drawSoup(soup, true);
  }

  /** The next picture is another one by itself. */
  get moves(): boolean {
    return this.flowMoves && this.flowLook === kMovingLook && (this.flow?.hasLines ?? false);
  }

  private get all(): Soup[] {
    return [this.surface, ...this.layers.values(), ...this.cuts];
  }

  private layer(name: string): Soup {
    const soup = this.layers.get(name) ?? new Soup(this.graphics, true, true);
    this.layers.set(name, soup);
    return soup;
  }

  dispose(): void {
    for (const soup of this.all) soup.dispose();
    this.restEdges?.dispose();
    this.flow?.dispose();
    this.arrows?.dispose();
    this.program.dispose();
    this.colors.texture.dispose();
  }
}
