// A pair of shaders, and the values of their uniforms.

import {Made, type Graphics} from './graphics';

/** A sampler reads it. */
export interface Texels {
  /** Makes it the texture of this unit. */
  bind(unit: number): void;
}

export type Uniform = number | boolean | readonly number[] | Uint32Array | Texels;

interface Slot {
  name: string;
  type: number;
  location: WebGLUniformLocation | null;
}

export class Program {
  private readonly made: Made<{program: WebGLProgram; slots: Slot[]}>;

  /** The shaders are GLSL ES 3.00 without their first line. */
  constructor(
    private readonly graphics: Graphics,
    vertexShader: string,
    fragmentShader: string,
    /** Names of the vertices' attributes 0, 1, ... */
    attributes: readonly string[] = [],
  ) {
    const {gl} = graphics;
    this.made = new Made(
      graphics,
      () => linked(gl, vertexShader, fragmentShader, attributes),
      ({program}) => gl.deleteProgram(program),
    );
  }

  /** The next drawing uses it with these values. REQUIRES: a value for each uniform it reads. */
  use(values: Readonly<Record<string, Uniform>>): void {
    const {gl} = this.graphics;
    const {program, slots} = this.made.get();
    gl.useProgram(program);
    let unit = 0;
    for (const {name, type, location} of slots) {
      const value = values[name]!;
      if (typeof value === 'object' && 'bind' in value) {
        value.bind(unit);
        gl.uniform1i(location, unit++);
      } else set(gl, type, location, value);
    }
  }

  dispose(): void {
    this.made.dispose();
  }
}

function set(
  gl: WebGL2RenderingContext,
  type: number,
  location: WebGLUniformLocation | null,
  value: number | boolean | readonly number[] | Uint32Array,
): void {
  const one = typeof value === 'object' ? 0 : Number(value);
  const many = typeof value === 'object' ? value : [];
  switch (type) {
    case gl.FLOAT:
      return gl.uniform1f(location, one);
    case gl.INT:
    case gl.BOOL:
      return gl.uniform1i(location, one);
    case gl.UNSIGNED_INT:
      return gl.uniform1uiv(location, many);
    case gl.FLOAT_VEC2:
      return gl.uniform2fv(location, many);
    case gl.FLOAT_VEC3:
      return gl.uniform3fv(location, many);
    case gl.FLOAT_VEC4:
      return gl.uniform4fv(location, many);
    case gl.FLOAT_MAT4:
      return gl.uniformMatrix4fv(location, false, many);
    default:
      throw new Error(`a uniform of type ${type} has no setter`);
  }
}

function linked(
  gl: WebGL2RenderingContext,
  vertexShader: string,
  fragmentShader: string,
  attributes: readonly string[],
): {program: WebGLProgram; slots: Slot[]} {
  const program = gl.createProgram();
  if (gl.isContextLost()) return {program, slots: []}; // all is made anew
  const shaders = [
    [gl.VERTEX_SHADER, vertexShader],
    [gl.FRAGMENT_SHADER, fragmentShader],
  ] as const;
  for (const [type, text] of shaders) {
    const shader = gl.createShader(type)!;
    gl.shaderSource(shader, `#version 300 es\n${text}`);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    gl.deleteShader(shader); // it lives as long as the program
  }
  attributes.forEach((name, at) => gl.bindAttribLocation(program, at, name));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
    const logs = (gl.getAttachedShaders(program) ?? []).map((one) => gl.getShaderInfoLog(one));
    throw new Error([gl.getProgramInfoLog(program), ...logs].filter(Boolean).join('\n'));
  }
  const count = Number(gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) ?? 0);
  const slots = Array.from({length: count}, (_, i): Slot[] => {
    const info = gl.getActiveUniform(program, i);
    if (!info) return []; // lost meanwhile
    const location = gl.getUniformLocation(program, info.name);
    return [{name: info.name.replace(/\[0\]$/, ''), type: info.type, location}];
  });
  return {program, slots: slots.flat()};
}
