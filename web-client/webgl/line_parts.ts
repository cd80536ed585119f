// Lines of even width, with a rim that sets them off from what lies behind. The ground and the
// colours of a mesh may both be light or dark.

import type {Graphics} from './gl/graphics';
import {Program} from './gl/program';
import {VertexArrays} from './gl/vertex_arrays';
import type {Eye} from './lens';

/** In pixels of the canvas, across. */
const kWidth = 1.4;
const kRimWidth = 3;

const kLight = [0.96, 0.97, 0.99];
const kDark = [0.1, 0.13, 0.18];

/** Lines lie before creases at the same place by this share of the mesh's radius. */
const kNearer = 0.002;

const kVertexShader = /* glsl */ `precision highp float;
  uniform mat4 modelViewMatrix;
  uniform mat4 projectionMatrix;
  uniform vec2 size; // of the canvas, in pixels
  uniform float width;
  in vec3 from;
  in vec3 to;
  vec4 placed(vec3 end) {
    vec4 view = modelViewMatrix * vec4(end, 1.0);
    view.z += ${kNearer};
    return projectionMatrix * view;
  }
  void main() {
    vec4 a = placed(from);
    vec4 b = placed(to);
    // the part behind the eye has no place on the canvas
    float nearA = a.z + a.w;
    float nearB = b.z + b.w;
    if (nearA < 0.0 && nearB > 0.0) a = mix(a, b, nearA / (nearA - nearB));
    else if (nearB < 0.0 && nearA > 0.0) b = mix(b, a, nearB / (nearB - nearA));
    vec2 way = (b.xy / b.w - a.xy / a.w) * size;
    vec2 along = length(way) > 0.0 ? normalize(way) : vec2(1.0, 0.0);
    bool isEnd = (gl_VertexID & 1) == 1;
    vec2 aside = vec2(-along.y, along.x) * (gl_VertexID < 2 ? -1.0 : 1.0);
    gl_Position = isEnd ? b : a;
    // ends stand out by half of the width, so that corners are closed
    gl_Position.xy += (aside + (isEnd ? along : -along)) * width / size * gl_Position.w;
  }`;

const kFragmentShader = /* glsl */ `precision highp float;
  uniform vec4 color;
  layout(location = 0) out vec4 fragColor;
  void main() {
    fragColor = color;
  }`;

export interface LineLook {
  onDark: boolean;
  opacity: number;
  /** Pixels of the target in a pixel of the canvas. */
  pixelRatio: number;
}

export class LineParts {
  /** 6 lattice coordinates a line. */
  lines: Float32Array = new Float32Array(0);
  private readonly program: Program;
  private readonly arrays: VertexArrays;

  constructor(private readonly graphics: Graphics) {
    this.program = new Program(graphics, kVertexShader, kFragmentShader, ['from', 'to']);
    this.arrays = new VertexArrays(graphics, () => [
      {data: this.lines, sizes: [3, 3], stride: 6, ofInstances: true},
    ]);
  }

  /** Null: none. */
  show(lines: Float32Array | null): void {
    this.lines = lines ?? new Float32Array(0);
    this.arrays.dispose();
  }

  /** All rims come first, so that none lies over a line. */
  draw({toEye, toCube}: Eye, {onDark, opacity, pixelRatio}: LineLook): void {
    if (this.lines.length === 0 || opacity === 0) return;
    const {gl, size} = this.graphics;
    const [ink, rim] = onDark ? [kLight, kDark] : [kDark, kLight];
    for (const [color, width, depths] of [
      [[...rim, opacity], kRimWidth, 'tested'],
      [[...ink, opacity], kWidth, 'written'],
    ] as const) {
      this.graphics.use({depths, mix: 'over'});
      this.program.use({
        modelViewMatrix: toEye,
        projectionMatrix: toCube,
        size,
        width: width * pixelRatio,
        color,
      });
      this.arrays.draw(gl.TRIANGLE_STRIP, 4, this.lines.length / 6);
    }
  }

  dispose(): void {
    this.arrays.dispose();
    this.program.dispose();
  }
}
