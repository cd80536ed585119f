// The viewer's look as a material of three.js (webgl/field_shaders.ts).

import {
  DataTexture,
  DoubleSide,
  LinearFilter,
  RGBAFormat,
  ShaderMaterial,
  Vector3,
  Vector4,
  type ColorRepresentation,
  Color,
} from 'three';
import {colorTable, kColorMapEntries, type ColorMapName} from '../core/picture/color_maps';
import {linearPart} from '../core/picture/log_scale';
import {kFieldFragmentShader, kFieldVertexShader} from '../webgl/field_shaders';

/** No point lies above this plane. */
const kNoPlane = new Vector4(0, 0, 0, 1);

export class FieldMaterial extends ShaderMaterial {
  private table = '';

  /**
   * `lit` shades it as a surface, without `lit` it is flat, as a cut. The inside of a surface is
   * grey unless it is `twoSided`.
   */
  constructor(lit: boolean, twoSided = false) {
    super({
      vertexShader: kFieldVertexShader,
      fragmentShader: kFieldFragmentShader,
      side: DoubleSide,
      uniforms: {
        firstHalf: {value: 0},
        colorMap: {value: emptyTexture()},
        range: {value: [0, 1]},
        colored: {value: false},
        plainColor: {value: new Vector3(0.72, 0.74, 0.78)},
        lit: {value: lit},
        twoSided: {value: twoSided},
        clipPlanes: {value: [kNoPlane.clone(), kNoPlane.clone(), kNoPlane.clone()]},
        scaleRange: {value: [0, 1]},
        logarithmic: {value: false},
        linear: {value: 0},
        opacity: {value: 1},
        edgeStrength: {value: 0.6},
        creaseStrength: {value: 0}, // a SoupMesh has none
        edgeFade: {value: 1},
        onDark: {value: false},
        pixelRatio: {value: 1},
      },
    });
  }

  setColorMap(name: ColorMapName, reversed: boolean): void {
    if (`${name} ${reversed}` === this.table) return;
    this.table = `${name} ${reversed}`;
    const texture = this.uniforms.colorMap!.value as DataTexture;
    (texture.image.data as Uint8Array).set(colorTable(name, reversed));
    texture.needsUpdate = true;
  }

  /**
   * The map spans `low` to `high`, values of the field. `scaleRange` holds the values of 0 and 1 in
   * the soups. REQUIRES: low < high if logarithmic, and low is not 0.
   */
  setRange(low: number, high: number, scaleRange: [number, number], logarithmic: boolean): void {
    const span = scaleRange[1] - scaleRange[0] || 1;
    const share = (value: number): number => (value - scaleRange[0]) / span;
    this.uniforms.range!.value = logarithmic ? [low, high] : [share(low), share(high)];
    this.uniforms.scaleRange!.value = scaleRange;
    this.uniforms.logarithmic!.value = logarithmic;
    this.uniforms.linear!.value = linearPart({low, high, logarithmic});
  }
  /** Below 1 the back shows through the front. */
  setOpacity(opacity: number): void {
    this.uniforms.opacity!.value = opacity;
    this.transparent = opacity < 1;
    this.depthWrite = opacity >= 1;
  }
  setColored(colored: boolean): void {
    this.uniforms.colored!.value = colored;
  }
  setFirstHalf(triangle: number): void {
    this.uniforms.firstHalf!.value = triangle;
  }
  /** 0 hides the edges, 1 draws them at full strength. */
  setEdges(strength: number): void {
    this.uniforms.edgeStrength!.value = strength;
  }
  /** A factor of the edges' strength, as edgeFade says. */
  setEdgeFade(fade: number): void {
    this.uniforms.edgeFade!.value = fade;
  }
  setPixelRatio(ratio: number): void {
    this.uniforms.pixelRatio!.value = Math.max(1, ratio);
  }
  setPlainColor(color: ColorRepresentation): void {
    const {r, g, b} = new Color(color).convertLinearToSRGB();
    (this.uniforms.plainColor!.value as Vector3).set(r, g, b);
  }

  /**
   * Hides what lies above any of at most three planes normal . p = offset (lattice coordinates).
   */
  setClip(planes: readonly {normal: [number, number, number]; offset: number}[]): void {
    (this.uniforms.clipPlanes!.value as Vector4[]).forEach((clip, i) => {
      const plane = planes[i];
      if (plane) clip.set(...plane.normal, plane.offset);
      else clip.copy(kNoPlane);
    });
  }

  override dispose(): void {
    (this.uniforms.colorMap!.value as DataTexture).dispose();
    super.dispose();
  }
}

function emptyTexture(): DataTexture {
  const texture = new DataTexture(
    new Uint8Array(4 * kColorMapEntries),
    kColorMapEntries,
    1,
    RGBAFormat,
  );
  texture.minFilter = texture.magFilter = LinearFilter;
  return texture;
}
