// Streamlines: tubes, lines of even width, or dashes that move with the vectors. They are ribbons
// that face the eye, a quad for each two points of a line.

import {kLineWidth, type LineSoup} from '../core/picture/streamlines';
import {kColorShader} from './field_shaders';
import type {Graphics} from './gl/graphics';
import {Program, type Uniform} from './gl/program';
import {VertexArrays} from './gl/vertex_arrays';
import type {Eye} from './lens';

/** The radius of a tube over the diagonal of the mesh's box. */
const kTubeShare = 0.0022;
/** In pixels of the canvas, across: of lines, and of tubes at least. */
const kWidth = 2.2;
const kLeastTube = 1.5;
/** A dash and its gap, as a share of the time in which the fastest place crosses the diagonal. */
const kPeriodShare = 0.1;
/** Periods a second: slow enough to follow. */
const kPerSecond = 0.7;

const kVertexShader = /* glsl */ `precision highp float;
  uniform mat4 modelViewMatrix;
  uniform mat4 projectionMatrix;
  uniform vec2 size; // of the canvas, in pixels
  uniform float radius; // of a tube, in lattice steps
  uniform float width; // in pixels, at least
  in vec3 from;
  in vec3 fromMore; // value, time, line
  in vec3 to;
  in vec3 toMore;
  out float vAcross;
  out float vValue;
  out float vTime;
  out vec2 vAside;
  void main() {
    vec4 viewA = modelViewMatrix * vec4(from, 1.0);
    vec4 viewB = modelViewMatrix * vec4(to, 1.0);
    vec4 a = projectionMatrix * viewA;
    vec4 b = projectionMatrix * viewB;
    // the part behind the eye has no place on the canvas
    float nearA = a.z + a.w;
    float nearB = b.z + b.w;
    if (nearA < 0.0 && nearB > 0.0) a = mix(a, b, nearA / (nearA - nearB));
    else if (nearB < 0.0 && nearA > 0.0) b = mix(b, a, nearB / (nearB - nearA));
    vec2 way = (b.xy / b.w - a.xy / a.w) * size;
    vec2 along = length(way) > 0.0 ? normalize(way) : vec2(1.0, 0.0);
    bool isEnd = (gl_VertexID & 1) == 1;
    float side = gl_VertexID < 2 ? -1.0 : 1.0;
    vec2 aside = vec2(-along.y, along.x);
    gl_Position = isEnd ? b : a;
    float scale = length(modelViewMatrix[0].xyz) * projectionMatrix[1].y * size.y;
    float pixels = max(width, radius * scale / gl_Position.w);
    // ends stand out a little, so that corners are closed
    vec2 place = aside * side + (isEnd ? along : -along) * 0.3;
    gl_Position.xy += place * pixels / size * gl_Position.w;
    // no quad joins two lines
    if (fromMore.z != toMore.z) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    vec3 more = isEnd ? toMore : fromMore;
    vAcross = side;
    vAside = aside;
    vValue = more.x;
    vTime = more.y;
  }`;

const kFragmentShader = /* glsl */ `precision highp float;
  precision highp sampler2D;
  in float vAcross;
  in float vValue;
  in float vTime;
  in vec2 vAside;
  uniform bool isTube;
  uniform float period; // of the dashes; 0: there are none
  uniform float clock;
  layout(location = 0) out vec4 fragColor;
${kColorShader}
  void main() {
    float behind = 0.0;
    if (period > 0.0) {
      behind = fract(clock - vTime / period);
      // a head, and a tail that becomes thin
      if (behind > 0.62 || abs(vAcross) > 1.0 - behind) discard;
    }
    vec3 color = isnan(vValue) ? plainColor : colorOf(vValue);
    float up = sqrt(max(0.0, 1.0 - vAcross * vAcross));
    if (isTube) {
      // the lamp of surfaces; tubes are so thin that they need more of it
      vec3 normal = vec3(vAside * vAcross, up);
      float facing = max(dot(normal, normalize(vec3(0.25, 0.45, 1.0))), 0.0);
      color = color * (0.4 + 0.66 * facing) + vec3(0.22 * pow(facing, 24.0));
    } else color *= abs(vAcross) > 0.72 ? 0.55 : 1.0; // a rim sets it off
    fragColor = vec4(min(color, 1.0), 1.0);
  }`;

/** In the order of kLineWidth: those of one point follow those of the last. */
const kAttributes = ['from', 'fromMore', 'to', 'toMore'];

export interface FlowLook {
  /** A LinesLook. */
  kind: string;
  /** That of the mesh's box, in lattice steps. */
  diagonal: number;
  /** Pixels of the target in a pixel of the canvas. */
  pixelRatio: number;
}

export class FlowLines {
  private soup: LineSoup | null = null;
  /** The share of a period that has passed. Dashes at rest, and in tiles of a picture, stay. */
  private clock = 0;
  private readonly program: Program;
  private readonly arrays: VertexArrays;

  constructor(private readonly graphics: Graphics) {
    this.program = new Program(graphics, kVertexShader, kFragmentShader, kAttributes);
    this.arrays = new VertexArrays(graphics, () => [
      // the numbers of a point follow those of the last one
      {data: this.soup!.points, sizes: [3, 3, 3, 3], stride: kLineWidth, ofInstances: true},
    ]);
  }

  /** Dashes are where they should be now. */
  tick(): void {
    this.clock = ((performance.now() / 1000) * kPerSecond) % 1;
  }

  get hasLines(): boolean {
    return (this.soup?.lines ?? 0) > 0;
  }

  show(soup: LineSoup | null): void {
    this.soup = soup;
    this.arrays.dispose();
  }

  /** `look` has the uniforms of all that is coloured. */
  draw(
    {toEye, toCube}: Eye,
    look: Readonly<Record<string, Uniform>>,
    {kind, diagonal, pixelRatio}: FlowLook,
  ): void {
    const {soup} = this;
    const segments = (soup?.points.length ?? 0) / kLineWidth - 1;
    if (!soup || segments < 1) return;
    const {gl, size} = this.graphics;
    const isTube = kind !== 'lines' && kind !== 'dashes';
    this.graphics.use({depths: 'written'});
    this.program.use({
      ...look,
      modelViewMatrix: toEye,
      projectionMatrix: toCube,
      size,
      radius: isTube ? kTubeShare * diagonal : 0,
      width: (isTube ? kLeastTube : kind === 'dashes' ? 1.6 * kWidth : kWidth) * pixelRatio,
      isTube,
      period: kind === 'dashes' ? kPeriodShare * soup.crossing : 0,
      clock: this.clock,
    });
    this.arrays.draw(gl.TRIANGLE_STRIP, 4, segments);
  }

  dispose(): void {
    this.arrays.dispose();
    this.program.dispose();
  }
}
