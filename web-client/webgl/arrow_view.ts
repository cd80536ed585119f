// Arrows: one shape, drawn at many places in one call.

import {kArrowWidth, type ArrowSoup} from '../core/picture/arrows';
import {kColorShader} from './field_shaders';
import type {Graphics} from './gl/graphics';
import {Program, type Uniform} from './gl/program';
import {VertexArrays} from './gl/vertex_arrays';
import type {Eye} from './lens';

/** Shares of the length of the shape. */
const kShaftRadius = 0.032;
const kHeadRadius = 0.1;
const kHeadLength = 0.32;
/** It is seen on most colours of maps. */
const kPlain = [0.97, 0.97, 0.98];
/** Round enough at the size of an arrow; many arrows are small. */
const kSides = [9, 4] as const;
const kManyArrows = 5000;

const kVertexShader = /* glsl */ `precision highp float;
  uniform mat4 modelViewMatrix;
  uniform mat4 projectionMatrix;
  in vec3 place; // of the shape: across, across, and along it
  in vec3 normal;
  in vec3 tail;
  in vec3 way;
  in float value;
  out float vValue;
  out vec3 vNormal;
  void main() {
    float size = length(way);
    vec3 along = way / size;
    vec3 aside = normalize(cross(along, abs(along.z) < 0.9 ? vec3(0, 0, 1) : vec3(1, 0, 0)));
    mat3 turn = mat3(aside, cross(along, aside), along);
    gl_Position = projectionMatrix * modelViewMatrix * vec4(tail + size * (turn * place), 1.0);
    vNormal = mat3(modelViewMatrix) * (turn * normal);
    vValue = value;
  }`;

const kFragmentShader = /* glsl */ `precision highp float;
  precision highp sampler2D;
  in float vValue;
  in vec3 vNormal;
  layout(location = 0) out vec4 fragColor;
${kColorShader}
  void main() {
    vec3 color = isnan(vValue) ? plainColor : colorOf(vValue);
    // the lamp of surfaces; shapes this small need more of it
    float facing = max(dot(normalize(vNormal), normalize(vec3(0.25, 0.45, 1.0))), 0.0);
    fragColor = vec4(min(color * (0.45 + 0.6 * facing), 1.0), 1.0);
  }`;

/** Place and normal of each corner, 6 numbers. */
function shape(sides: number): Float32Array {
  const corners: number[] = [];
  const at = (i: number): [number, number] => {
    const turn = (2 * Math.PI * i) / sides;
    return [Math.cos(turn), Math.sin(turn)];
  };
  const foot = 1 - kHeadLength;
  const slope = Math.hypot(kHeadRadius, kHeadLength);
  const [out, up] = [kHeadLength / slope, kHeadRadius / slope];
  for (let i = 0; i < sides; ++i) {
    const [[a, b], [c, d]] = [at(i), at(i + 1)];
    const [x, y] = at(i + 0.5);
    const corner = (
      p: number,
      q: number,
      radius: number,
      z: number,
      normal: number[],
    ): number[] => [p * radius, q * radius, z, ...normal];
    const [first, second] = [
      [a, b, 0],
      [c, d, 0],
    ];
    const low = [corner(a, b, kShaftRadius, 0, first), corner(c, d, kShaftRadius, 0, second)];
    const high = [
      corner(a, b, kShaftRadius, foot, first),
      corner(c, d, kShaftRadius, foot, second),
    ];
    corners.push(...low[0]!, ...low[1]!, ...high[0]!, ...high[0]!, ...low[1]!, ...high[1]!);
    const back = [0, 0, -1];
    corners.push(
      ...corner(0, 0, 0, foot, back),
      ...corner(c, d, kHeadRadius, foot, back),
      ...corner(a, b, kHeadRadius, foot, back),
      ...corner(a, b, kHeadRadius, foot, [a * out, b * out, up]),
      ...corner(c, d, kHeadRadius, foot, [c * out, d * out, up]),
      ...corner(0, 0, 0, 1, [x * out, y * out, up]),
    );
  }
  return Float32Array.from(corners);
}

/** Those of a corner of the shape, and of an arrow. */
const kAttributes = ['place', 'normal', 'tail', 'way', 'value'];
const kShapeWidth = 6;

export class ArrowView {
  private soup: ArrowSoup | null = null;
  private readonly program: Program;
  private readonly arrays: VertexArrays;
  private shape: Float32Array = new Float32Array(0);

  constructor(private readonly graphics: Graphics) {
    this.program = new Program(graphics, kVertexShader, kFragmentShader, kAttributes);
    this.arrays = new VertexArrays(graphics, () => [
      {data: this.shape, sizes: [3, 3], stride: kShapeWidth, ofInstances: false},
      {data: this.soup!.arrows, sizes: [3, 3, 1], stride: kArrowWidth, ofInstances: true},
    ]);
  }

  show(soup: ArrowSoup | null): void {
    this.soup = soup;
    this.shape = shape(kSides[Number((soup?.count ?? 0) > kManyArrows)]!);
    this.arrays.dispose();
  }

  /** `look` has the uniforms of all that is coloured. */
  draw({toEye, toCube}: Eye, look: Readonly<Record<string, Uniform>>): void {
    const count = (this.soup?.arrows.length ?? 0) / kArrowWidth;
    if (count === 0) return;
    const {gl} = this.graphics;
    this.graphics.use({depths: 'written'});
    this.program.use({
      ...look,
      plainColor: kPlain,
      modelViewMatrix: toEye,
      projectionMatrix: toCube,
    });
    this.arrays.draw(gl.TRIANGLES, this.shape.length / kShapeWidth, count);
  }

  dispose(): void {
    this.arrays.dispose();
    this.program.dispose();
  }
}
