// A picture in half floats, so that hundreds of faint layers add up without steps, brought onto the canvas at its end.

import {HalfFloatType, Mesh, NoBlending, OrthographicCamera, PlaneGeometry, Scene, ShaderMaterial, Vector2, WebGLRenderTarget, type Camera, type WebGLRenderer} from 'three';

export class DeepTarget {
  private readonly target = new WebGLRenderTarget(1, 1, {type: HalfFloatType, depthBuffer: true});
  private readonly camera = new OrthographicCamera(-1, 1, 1, -1, 0, 1);
  private readonly scene = new Scene();
  private readonly material = new ShaderMaterial({
    vertexShader: 'out vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }',
    fragmentShader: 'in vec2 at; uniform sampler2D picture; void main() { gl_FragColor = texture(picture, at); }',
    uniforms: {picture: {value: this.target.texture}}, depthTest: false, depthWrite: false, blending: NoBlending,
  });
  private readonly plane = new Mesh(new PlaneGeometry(2, 2), this.material);

  constructor() {
    this.plane.frustumCulled = false;
    this.scene.add(this.plane);
  }

  /** Needs EXT_color_buffer_float or EXT_color_buffer_half_float; without them the scene is drawn on the canvas as it is. `share` of the canvas's pixels each way. */
  render(renderer: WebGLRenderer, scene: Scene, camera: Camera, share: number): void {
    if (!renderer.extensions.has('EXT_color_buffer_float') && !renderer.extensions.has('EXT_color_buffer_half_float')) {
      renderer.render(scene, camera);
      return;
    }
    const {width, height} = renderer.getDrawingBufferSize(new Vector2());
    this.target.setSize(Math.max(1, Math.round(width * share)), Math.max(1, Math.round(height * share)));
    renderer.setRenderTarget(this.target);
    renderer.render(scene, camera);
    renderer.setRenderTarget(null);
    renderer.render(this.scene, this.camera);
  }

  dispose(): void {
    this.target.dispose();
    this.material.dispose();
    this.plane.geometry.dispose();
  }
}
