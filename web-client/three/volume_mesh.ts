// The cells seen through: each is drawn once, from back to front, and every pixel of it computes where its line of sight enters and leaves the cell and
// what lies between. Projected tetrahedra (Shirley and Tuchman 1990) with the exact length and values inside each cell; nothing is resampled.

import {
  BufferAttribute, BufferGeometry, CustomBlending, DataTexture, FloatType, FrontSide, GLSL3, Mesh, NearestFilter, OneFactor, OneMinusSrcAlphaFactor, RGBAFormat,
  RGBAIntegerFormat, RawShaderMaterial, RedFormat, RedIntegerFormat, UnsignedIntType, Vector3, Vector4, type PixelFormat, type TextureDataType,
} from 'three';
import {kTransferSteps, type TransferTables} from '../core/transfer';
import type {VolumeCells} from '../core/volume';

/** Texels in a row of the data textures; a power of two. */
const kRowBits = 11;
const kRow = 1 << kRowBits;

const kVertexShader = /* glsl */ `
  precision highp float;
  precision highp sampler2D;
  precision highp usampler2D;
  uniform mat4 projectionMatrix;
  uniform mat4 modelViewMatrix;
  uniform usampler2D order;
  uniform sampler2D vertices;
  uniform usampler2D cells;
  uniform sampler2D cellValues;
  uniform bool ofCells;
  uniform vec3 eye;
  out vec4 vShares;  // barycentric coordinates here, and how they change with each length of vSight along the line of sight
  out vec4 vAlong;
  out vec3 vAt;
  out vec3 vSight;   // from the eye to here
  out vec2 vValue;   // the value here, and its change along the line

  ivec2 texel(uint i) { return ivec2(i & ${kRow - 1}u, i >> ${kRowBits}u); }

  void main() {
    uint cell = texelFetch(order, texel(uint(gl_VertexID) >> 2), 0).r;
    uvec4 ids = texelFetch(cells, texel(cell), 0);
    vec4 a = texelFetch(vertices, texel(ids.x), 0), b = texelFetch(vertices, texel(ids.y), 0);
    vec4 c = texelFetch(vertices, texel(ids.z), 0), d = texelFetch(vertices, texel(ids.w), 0);
    int corner = gl_VertexID & 3;
    vAt = (corner == 0 ? a : corner == 1 ? b : corner == 2 ? c : d).xyz;
    vShares = vec4(corner == 0, corner == 1, corner == 2, corner == 3);
    vSight = vAt - eye;
    vec3 ab = b.xyz - a.xyz, ac = c.xyz - a.xyz, ad = d.xyz - a.xyz;
    float volume = dot(ab, cross(ac, ad));
    vec3 along = vec3(dot(cross(ac, ad), vSight), dot(cross(ad, ab), vSight), dot(cross(ab, ac), vSight)) / volume;
    vAlong = vec4(-along.x - along.y - along.z, along);
    vec4 values = ofCells ? vec4(texelFetch(cellValues, texel(cell), 0).r) : vec4(a.w, b.w, c.w, d.w);
    vValue = vec2(dot(values, vShares), dot(values, vAlong));
    gl_Position = projectionMatrix * modelViewMatrix * vec4(vAt, 1.0);
  }`;

const kFragmentShader = /* glsl */ `
  precision highp float;
  precision highp sampler2D;
  in vec4 vShares;
  in vec4 vAlong;
  in vec3 vAt;
  in vec3 vSight;
  in vec2 vValue;
  uniform vec4 clipPlanes[3];
  uniform sampler2D density;
  uniform sampler2D integral;
  uniform vec2 range;
  uniform vec2 scaleRange;
  uniform bool logarithmic;
  uniform float perDiagonal;  // diagonals a lattice unit
  out vec4 color;

  float shareOf(float value) {
    if (!logarithmic) return (value - range.x) / max(range.y - range.x, 1e-12);
    float v = mix(scaleRange.x, scaleRange.y, value);
    return v > 0.0 ? log(v / range.x) / log(range.y / range.x) : 0.0;
  }

  vec4 between(sampler2D table, float share) {
    float at = clamp(share, 0.0, 1.0) * ${kTransferSteps}.0;
    int i = min(int(at), ${kTransferSteps - 1});
    return mix(texelFetch(table, ivec2(i, 0), 0), texelFetch(table, ivec2(i + 1, 0), 0), at - float(i));
  }

  // Beyond the ends values look like the ends.
  vec4 integralTo(float share) { return between(integral, share) + (share - clamp(share, 0.0, 1.0)) * between(density, share); }

  void main() {
    float leave = 1e30;
    for (int i = 0; i < 4; ++i) if (vAlong[i] < 0.0) leave = min(leave, -vShares[i] / vAlong[i]);
    float enter = 0.0;
    for (int i = 0; i < 3; ++i) {
      float room = clipPlanes[i].w - dot(clipPlanes[i].xyz, vAt);
      float change = -dot(clipPlanes[i].xyz, vSight);
      if (change > 0.0) enter = max(enter, -room / change);
      else if (change < 0.0) leave = min(leave, -room / change);
      else if (room < 0.0) discard;
    }
    if (leave <= enter || leave > 1e29) discard;
    float from = shareOf(vValue.x + enter * vValue.y);
    float to = shareOf(vValue.x + leave * vValue.y);
    vec4 mean;
    if (abs(to - from) < 2.0 / ${kTransferSteps}.0) mean = between(density, 0.5 * (from + to));
    else mean = (integralTo(to) - integralTo(from)) / (to - from);
    float opacity = 1.0 - exp(-mean.a * (leave - enter) * length(vSight) * perDiagonal);
    color = mean.a > 0.0 ? vec4(mean.rgb / mean.a * opacity, opacity) : vec4(0.0);
  }`;

/** Room beyond what is needed, for the levels to come. */
const kGrowth = 1.5;
const kNoPlane = new Vector4(0, 0, 0, 1);
/** Corners of the faces opposite to corners 0 to 3, outward in a cell of positive volume. */
const kFaceCorners = [1, 2, 3, 0, 3, 2, 0, 1, 3, 0, 2, 1];

export class VolumeMesh extends Mesh<BufferGeometry, RawShaderMaterial> {
  private version = -1;
  /** Cells that the index has room for. */
  private capacity = 0;

  constructor() {
    super(new BufferGeometry(), new RawShaderMaterial({
      glslVersion: GLSL3, vertexShader: kVertexShader, fragmentShader: kFragmentShader, side: FrontSide, transparent: true, depthWrite: false,
      blending: CustomBlending, blendSrc: OneFactor, blendDst: OneMinusSrcAlphaFactor, blendSrcAlpha: OneFactor, blendDstAlpha: OneMinusSrcAlphaFactor,
      uniforms: {
        order: {value: null}, vertices: {value: null}, cells: {value: null}, cellValues: {value: null}, ofCells: {value: false}, eye: {value: new Vector3()},
        clipPlanes: {value: [kNoPlane.clone(), kNoPlane.clone(), kNoPlane.clone()]}, density: {value: null}, integral: {value: null},
        range: {value: [0, 1]}, scaleRange: {value: [0, 1]}, logarithmic: {value: false}, perDiagonal: {value: 1},
      },
    }));
    this.frustumCulled = false;
    this.visible = false;
  }

  /** The cells, in an order of the same version; null: none. */
  show(cells: VolumeCells | null, order: Uint32Array): void {
    this.visible = cells !== null && order.length > 0;
    if (!cells || !this.visible) return;
    if (cells.version !== this.version) this.upload(cells);
    this.version = cells.version;
    if (order.length > this.capacity) this.grow(Math.ceil(order.length * kGrowth));
    this.setTexture('order', rows(order, 1, RedIntegerFormat, UnsignedIntType));
    this.geometry.setDrawRange(0, 12 * order.length);
  }

  setTransfer({density, integral}: TransferTables): void {
    this.setTexture('density', table(density));
    this.setTexture('integral', table(integral));
  }

  /** As FieldMaterial.setRange. */
  setRange(range: [number, number], scaleRange: [number, number], logarithmic: boolean): void {
    Object.assign(this.uniforms.range!, {value: range});
    Object.assign(this.uniforms.scaleRange!, {value: scaleRange});
    this.uniforms.logarithmic!.value = logarithmic;
  }
  setClip(planes: readonly {normal: [number, number, number]; offset: number}[]): void {
    (this.uniforms.clipPlanes!.value as Vector4[]).forEach((clip, i) => {
      const plane = planes[i];
      if (plane) clip.set(...plane.normal, plane.offset);
      else clip.copy(kNoPlane);
    });
  }
  /** Both in lattice units. */
  setEye(eye: Vector3, diagonal: number): void {
    (this.uniforms.eye!.value as Vector3).copy(eye);
    this.uniforms.perDiagonal!.value = 1 / diagonal;
  }

  override dispose(): void {
    for (const name of ['order', 'vertices', 'cells', 'cellValues', 'density', 'integral']) this.setTexture(name, null);
    this.geometry.dispose();
    this.material.dispose();
  }

  private get uniforms(): RawShaderMaterial['uniforms'] { return this.material.uniforms; }

  /** Four vertices and four faces a cell, whichever cell that is: an instance a cell would be the shorter way, and ten times as slow without a GPU. */
  private grow(cells: number): void {
    this.capacity = cells;
    this.geometry.dispose();
    const index = new Uint32Array(12 * cells);
    for (let i = 0; i < index.length; ++i) index[i] = 4 * Math.floor(i / 12) + kFaceCorners[i % 12]!;
    this.geometry.setIndex(new BufferAttribute(index, 1));
  }

  private upload({vertices, cells, cellValues}: VolumeCells): void {
    this.setTexture('vertices', rows(vertices, 4, RGBAFormat, FloatType));
    this.setTexture('cells', rows(cells, 4, RGBAIntegerFormat, UnsignedIntType));
    this.setTexture('cellValues', rows(cellValues ?? new Float32Array(1), 1, RedFormat, FloatType));
    this.uniforms.ofCells!.value = cellValues !== null;
  }

  private setTexture(name: string, texture: DataTexture | null): void {
    (this.uniforms[name]!.value as DataTexture | null)?.dispose();
    this.uniforms[name]!.value = texture;
  }
}

function rows(values: Float32Array | Uint32Array, size: number, format: PixelFormat, type: TextureDataType): DataTexture {
  const height = Math.max(1, Math.ceil(values.length / (size * kRow)));
  const filled = values instanceof Float32Array ? new Float32Array(size * kRow * height) : new Uint32Array(size * kRow * height);
  filled.set(values);
  return dataTexture(filled, kRow, height, format, type);
}

function table(values: Float32Array): DataTexture { return dataTexture(values, values.length / 4, 1, RGBAFormat, FloatType); }

function dataTexture(values: Float32Array | Uint32Array, width: number, height: number, format: PixelFormat, type: TextureDataType): DataTexture {
  const texture = new DataTexture(values, width, height, format, type);
  if (type === UnsignedIntType) texture.internalFormat = format === RedIntegerFormat ? 'R32UI' : 'RGBA32UI';
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}
