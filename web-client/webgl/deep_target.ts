// An off-screen target that holds the scene with its depths, and the volume, which is drawn over
// it. It uses half floats, so that many faint layers add up without steps; bytes without
// EXT_color_buffer_float or EXT_color_buffer_half_float.

import type {Graphics} from './gl/graphics';
import {kCoverShader, Cover} from './gl/cover';
import {Program, type Texels} from './gl/program';
import {Target} from './gl/target';
import type {Eye} from './lens';
import type {MeshParts} from './mesh_parts';

export class DeepTarget {
  private readonly scene: Target;
  /** Premultiplied alpha. New parts lie behind those that are there. */
  readonly volume: Target;
  private readonly program: Program;
  private readonly cover: Cover;

  constructor(private readonly graphics: Graphics) {
    this.scene = new Target(graphics, {kind: 'rgba8', depths: 'texture'});
    this.volume = new Target(graphics, {kind: 'rgba8', depths: 'none'});
    this.cover = new Cover(graphics);
    this.program = new Program(
      graphics,
      kCoverShader,
      /* glsl */ `precision highp float;
      uniform sampler2D scene;
      uniform sampler2D volume;
      in vec2 at;
      layout(location = 0) out vec4 color;
      void main() {
        vec4 front = texture(volume, at);
        color = front + (1.0 - front.a) * texture(scene, at);
      }`,
    );
  }

  get width(): number {
    return this.volume.width;
  }
  get height(): number {
    return this.volume.height;
  }
  get depths(): Texels {
    return this.scene.depths;
  }

  /** Must be called before a picture. It may keep nothing of the picture before. */
  resize(width: number, height: number): void {
    const {gl} = this.graphics;
    const hasFloats = ['EXT_color_buffer_float', 'EXT_color_buffer_half_float'].some(
      (name) => gl.getExtension(name) !== null,
    );
    for (const target of [this.scene, this.volume])
      target.resize(Math.max(1, width), Math.max(1, height), hasFloats ? 'rgba16f' : 'rgba8');
  }

  /** Begins a picture with the scene and an empty volume. */
  begin(parts: MeshParts, eye: Eye): void {
    for (const target of [this.volume, this.scene]) {
      target.begin();
      target.clear();
    }
    parts.draw(eye);
  }

  /** Copies the picture onto `target`, or (null) onto the canvas. */
  present(target: Target | null): void {
    if (target) target.begin();
    else this.graphics.beginCanvas();
    this.graphics.use({});
    this.program.use({scene: this.scene.color, volume: this.volume.color});
    this.cover.draw();
  }

  dispose(): void {
    this.scene.dispose();
    this.volume.dispose();
    this.program.dispose();
    this.cover.dispose();
  }
}
