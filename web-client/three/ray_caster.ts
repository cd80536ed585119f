// Draws a volume's cells onto a DeepTarget by casting rays (ray_shaders.ts). Rays that leave the
// mesh through a hole or a concavity may enter it again. So it works in layers: it draws the next
// boundary faces and casts rays from there, until no pixel has such a face.

import {
  BufferAttribute,
  BufferGeometry,
  Camera,
  CustomBlending,
  GLSL3,
  Matrix4,
  Mesh,
  NearestFilter,
  NoBlending,
  OneFactor,
  OneMinusDstAlphaFactor,
  RGIntegerFormat,
  RawShaderMaterial,
  Scene,
  UnsignedIntType,
  Vector3,
  Vector4,
  WebGLRenderTarget,
  type DataTexture,
  type WebGLRenderer,
} from 'three';
import type {Vector} from '../core/protocol/geometry';
import type {TransferTables} from '../core/picture/transfer';
import {kMinNear} from './camera';
import {tableTexture, type CellTextures} from './cell_textures';
import type {DeepTarget} from './deep_target';
import type {Matrix} from './pose';
import {
  kEntryFragmentShader,
  kEntryVertexShader,
  kRayFragmentShader,
  kRayVertexShader,
} from './ray_shaders';
import {raysOf} from './rays';

/** A camera's lines of sight, in lattice coordinates. */
export interface Sight {
  toCanvas: Matrix;
  fromCanvas: Matrix;
  eye: Vector;
  /** The mesh's diagonal. */
  diagonal: number;
}

const kNoPlane = new Vector4(0, 0, 0, 1);
const kNoCell = new Uint32Array(5);

const entryTarget = (): WebGLRenderTarget =>
  new WebGLRenderTarget(1, 1, {
    format: RGIntegerFormat,
    type: UnsignedIntType,
    internalFormat: 'RG32UI',
    minFilter: NearestFilter,
    magFilter: NearestFilter,
  });

export class RayCaster {
  private readonly entry = new Mesh(
    new BufferGeometry(),
    new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: kEntryVertexShader,
      fragmentShader: kEntryFragmentShader,
      blending: NoBlending,
      uniforms: {
        vertices: {value: null},
        entries: {value: null},
        toCanvas: {value: new Matrix4()},
        middle: {value: [1, 1]},
        distances: {value: [0, 1]},
        isFirst: {value: true},
        before: {value: null},
        picture: {value: null},
      },
    }),
  );
  private readonly ray = new Mesh(
    new BufferGeometry(),
    new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: kRayVertexShader,
      fragmentShader: kRayFragmentShader,
      depthTest: false,
      depthWrite: false,
      transparent: true,
      blending: CustomBlending,
      blendSrc: OneMinusDstAlphaFactor,
      blendDst: OneFactor,
      uniforms: {
        vertices: {value: null},
        links: {value: null},
        cellValues: {value: null},
        ofCells: {value: false},
        entries: {value: null},
        layer: {value: null},
        eyeCell: {value: kNoCell},
        near: {value: vectors()},
        far: {value: vectors()},
        farPerNear: {value: 1},
        perPixel: {value: [1, 1]},
        depths: {value: null},
        clipPlanes: {value: Array.from({length: 3}, () => kNoPlane.clone())},
        density: {value: null},
        integral: {value: null},
        range: {value: [0, 1]},
        scaleRange: {value: [0, 1]},
        logarithmic: {value: false},
        perDiagonal: {value: 1},
      },
    }),
  );
  private readonly entryScene = new Scene();
  private readonly rayScene = new Scene();
  private readonly camera = new Camera();
  /** The entries of this layer, and of the one before. */
  private targets = [entryTarget(), entryTarget()] as [WebGLRenderTarget, WebGLRenderTarget];

  constructor() {
    this.ray.geometry.setAttribute(
      'position',
      new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3),
    );
    for (const [scene, mesh] of [
      [this.entryScene, this.entry],
      [this.rayScene, this.ray],
    ] as const) {
      mesh.frustumCulled = false;
      scene.add(mesh);
    }
  }

  setTransfer({density, integral}: TransferTables): void {
    for (const [name, values] of [
      ['density', density],
      ['integral', integral],
    ] as const) {
      (this.uniforms[name]!.value as DataTexture | null)?.dispose();
      this.uniforms[name]!.value = tableTexture(values);
    }
  }

  /** The same as FieldMaterial.setRange. */
  setRange(range: [number, number], scaleRange: [number, number], logarithmic: boolean): void {
    this.uniforms.range!.value = range;
    this.uniforms.scaleRange!.value = scaleRange;
    this.uniforms.logarithmic!.value = logarithmic;
  }
  setClip(planes: readonly {normal: [number, number, number]; offset: number}[]): void {
    (this.uniforms.clipPlanes!.value as Vector4[]).forEach((clip, i) => {
      const plane = planes[i];
      if (plane) clip.set(...plane.normal, plane.offset);
      else clip.copy(kNoPlane);
    });
  }

  /**
   * Begins a picture of these cells on `deep`. Returns true if the eye is inside a cell: rays from
   * there come first, before any layer.
   */
  begin(
    cells: CellTextures,
    {toCanvas, fromCanvas, eye, diagonal}: Sight,
    deep: DeepTarget,
  ): boolean {
    const {uniforms} = this;
    for (const name of ['vertices', 'links', 'cellValues', 'ofCells', 'entries'] as const)
      uniforms[name]!.value = cells[name];
    const {
      near,
      far,
      farPerNear,
      distances: [from, to],
    } = raysOf(fromCanvas);
    (uniforms.near!.value as Vector3[]).forEach((vector, i) => vector.set(...near[i]!));
    (uniforms.far!.value as Vector3[]).forEach((vector, i) => vector.set(...far[i]!));
    uniforms.farPerNear!.value = farPerNear;
    uniforms.perPixel!.value = [2 / deep.width, 2 / deep.height];
    uniforms.depths!.value = deep.depths;
    uniforms.perDiagonal!.value = 1 / diagonal;
    const eyeCell = cells.eyeCell(eye);
    uniforms.eyeCell!.value = eyeCell ?? kNoCell;
    // not read before the first layer, but it must have its type
    uniforms.layer!.value = cells.entries;
    const its = this.entry.material.uniforms;
    this.entry.geometry = cells.entryGeometry;
    its.vertices!.value = cells.vertices;
    its.entries!.value = its.before!.value = cells.entries;
    its.picture!.value = deep.volume.texture;
    its.isFirst!.value = true;
    // starts at the eye if that is close
    its.distances!.value = [Math.max(0, from - kMinNear), to];
    its.middle!.value = [deep.width / 2, deep.height / 2];
    (its.toCanvas!.value as Matrix4).fromArray(toCanvas);
    for (const target of this.targets) target.setSize(deep.width, deep.height);
    return eyeCell !== null;
  }

  /** Goes on to the next layer. */
  enter(renderer: WebGLRenderer): void {
    const [before, now] = this.targets;
    this.targets = [now, before];
    const {isFirst, before: layerBefore} = this.entry.material.uniforms;
    if (!isFirst!.value) layerBefore!.value = before.texture;
    renderer.setRenderTarget(now);
    renderer.render(this.entryScene, this.camera);
    renderer.setRenderTarget(null);
    isFirst!.value = false;
    this.uniforms.eyeCell!.value = kNoCell;
    this.uniforms.layer!.value = now.texture;
  }

  /** Casts the layer's rays in these rows of pixels. */
  cast(renderer: WebGLRenderer, {volume}: DeepTarget, from: number, rows: number): void {
    volume.scissor.set(0, from, volume.width, rows);
    volume.scissorTest = true;
    const {autoClear} = renderer;
    renderer.autoClear = false;
    renderer.setRenderTarget(volume);
    renderer.render(this.rayScene, this.camera);
    renderer.setRenderTarget(null);
    renderer.autoClear = autoClear;
    volume.scissorTest = false;
  }

  dispose(): void {
    for (const name of ['density', 'integral'])
      (this.uniforms[name]!.value as DataTexture | null)?.dispose();
    for (const target of this.targets) target.dispose();
    for (const mesh of [this.entry, this.ray]) mesh.material.dispose();
    this.ray.geometry.dispose();
  }

  private get uniforms(): RawShaderMaterial['uniforms'] {
    return this.ray.material.uniforms;
  }
}

function vectors(): Vector3[] {
  return Array.from({length: 3}, () => new Vector3());
}
