// An off-screen target that holds the scene with its depths, and the volume, which is drawn over
// it. It uses half floats, so that many faint layers add up without steps; bytes without
// EXT_color_buffer_float or EXT_color_buffer_half_float.

import {
  DepthTexture,
  HalfFloatType,
  Mesh,
  NearestFilter,
  NoBlending,
  OrthographicCamera,
  PlaneGeometry,
  Scene,
  ShaderMaterial,
  UnsignedByteType,
  UnsignedIntType,
  WebGLRenderTarget,
  type Camera,
  type WebGLRenderer,
} from 'three';

export class DeepTarget {
  private readonly scene = new WebGLRenderTarget(1, 1, {
    depthTexture: new DepthTexture(1, 1, UnsignedIntType),
  });
  /** Premultiplied alpha. New parts lie behind those that are there. */
  readonly volume = new WebGLRenderTarget(1, 1, {depthBuffer: false});
  private readonly camera = new OrthographicCamera(-1, 1, 1, -1, 0, 1);
  private readonly planes = new Scene();
  private readonly material = new ShaderMaterial({
    vertexShader:
      'out vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }',
    fragmentShader: /* glsl */ `in vec2 at; uniform sampler2D scene; uniform sampler2D volume;
      void main() {
        vec4 front = texture(volume, at);
        gl_FragColor = front + (1.0 - front.a) * texture(scene, at);
      }`,
    uniforms: {scene: {value: this.scene.texture}, volume: {value: this.volume.texture}},
    depthTest: false,
    depthWrite: false,
    blending: NoBlending,
  });
  private readonly plane = new Mesh(new PlaneGeometry(2, 2), this.material);

  constructor() {
    this.scene.depthTexture!.minFilter = this.scene.depthTexture!.magFilter = NearestFilter;
    this.plane.frustumCulled = false;
    this.planes.add(this.plane);
  }

  get width(): number {
    return this.volume.width;
  }
  get height(): number {
    return this.volume.height;
  }
  get depths(): DepthTexture {
    return this.scene.depthTexture!;
  }

  /** Must be called before a picture. It may keep nothing of the picture before. */
  resize({extensions}: WebGLRenderer, width: number, height: number): void {
    const type =
      extensions.has('EXT_color_buffer_float') || extensions.has('EXT_color_buffer_half_float')
        ? HalfFloatType
        : UnsignedByteType;
    for (const target of [this.scene, this.volume]) {
      target.texture.type = type;
      target.setSize(Math.max(1, width), Math.max(1, height));
    }
  }

  /** Begins a picture with the scene and an empty volume. */
  begin(renderer: WebGLRenderer, scene: Scene, camera: Camera): void {
    renderer.setRenderTarget(this.volume);
    renderer.clear();
    renderer.setRenderTarget(this.scene);
    renderer.render(scene, camera);
    renderer.setRenderTarget(null);
  }

  /** Copies the picture onto `target`, or (null) onto the canvas. */
  present(renderer: WebGLRenderer, target: WebGLRenderTarget | null): void {
    renderer.setRenderTarget(target);
    renderer.render(this.planes, this.camera);
    renderer.setRenderTarget(null);
  }

  dispose(): void {
    this.scene.dispose();
    this.volume.dispose();
    this.material.dispose();
    this.plane.geometry.dispose();
  }
}
