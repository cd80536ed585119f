// The only material: a colour map over field values, cell edges, and up to three clip planes by
// discarding. Colours are written as they stand in the table (sRGB, no tone mapping), so that a
// flat cut shows exactly the legend's colours.

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

const kVertexShader = /* glsl */ `
  in float value;
  out float vValue;
  // centroid: a place outside the triangle would leave pixels of slivers above a plane
  centroid out vec3 vLattice;
  out vec3 vView;
  out vec3 vCorner;
  void main() {
    int corner = gl_VertexID % 3;
    vCorner = vec3(corner == 0, corner == 1, corner == 2);
    // In triangles from firstHalf on, the side opposite to the first corner is a quad's diagonal.
    if (gl_VertexID / 3 >= firstHalf) vCorner.x = 1.0;
    vValue = value;
    vLattice = position;
    vec4 view = modelViewMatrix * vec4(position, 1.0);
    vView = view.xyz;
    gl_Position = projectionMatrix * view;
  }`;

/** Edges of cells less than 6 pixels high are fainter, as the cells are smaller. */
const kPlainDensity = 1 / 6;

const kFragmentShader = /* glsl */ `
  in float vValue;
  centroid in vec3 vLattice;
  in vec3 vView;
  in vec3 vCorner;
  uniform sampler2D colorMap;
  // the ends of the map, in units of vValue; of the value itself if logarithmic
  uniform vec2 range;
  uniform vec2 scaleRange; // the values that vValue 0 and 1 stand for
  uniform bool logarithmic;
  uniform bool colored;
  uniform vec3 plainColor;
  uniform bool lit;
  uniform bool twoSided;
  uniform vec4 clipPlanes[3];
  uniform float opacity;
  uniform float edgeStrength;
  uniform float edgeFade;
  uniform float pixelRatio;

  vec3 surfaceColor() {
    // a missing value makes its triangle plain
    if (!colored || isnan(vValue)) return plainColor;
    float t = (vValue - range.x) / max(range.y - range.x, 1e-12);
    if (logarithmic) {
      float value = mix(scaleRange.x, scaleRange.y, vValue);
      t = value > 0.0 ? log(value / range.x) / log(range.y / range.x) : 0.0;
    }
    t = clamp(t, 0.0, 1.0);
    // Sample the centres of entries, so that both ends of the range show the table's own ends.
    float at = (t * ${kColorMapEntries - 1}.0 + 0.5) / ${kColorMapEntries}.0;
    return texture(colorMap, vec2(at, 0.5)).rgb;
  }

  // 1 on an edge, 0 inside. All edges have one strength (edge_fade.ts), so that none stand alone.
  // Only those of cells far smaller than the others are fainter: the lines would cover the colours.
  float edge() {
    vec3 perPixel = max(fwidth(vCorner), 1e-6);
    vec3 distance = smoothstep(vec3(0.0), perPixel * 0.85 * pixelRatio, vCorner);
    float coverage = 1.0 - min(min(distance.x, distance.y), distance.z);
    float density = max(max(perPixel.x, perPixel.y), perPixel.z) * pixelRatio;
    return coverage * min(1.0, ${kPlainDensity} / density);
  }

  void main() {
    for (int i = 0; i < 3; ++i) if (dot(clipPlanes[i].xyz, vLattice) > clipPlanes[i].w) discard;
    vec3 color = surfaceColor();
    if (lit) {
      // Flat shading from screen derivatives makes cells look like cells. A lamp is a little above
      // the eye, and light falls from the sky. All channels get one factor: the hue stays.
      vec3 normal = normalize(cross(dFdx(vView), dFdy(vView)));
      vec3 light = normalize(vec3(0.25, 0.45, 1.0));
      normal *= dot(normal, vView) > 0.0 ? -1.0 : 1.0;
      float facing = max(dot(normal, light), 0.0);
      float sky = 0.5 + 0.5 * normal.y;
      color *= 0.68 + 0.18 * facing + 0.14 * sky;
      if (!gl_FrontFacing && !twoSided) color = mix(color, vec3(0.24, 0.26, 0.30), 0.55);
    }
    color = mix(color, color * 0.22, edgeStrength * edgeFade * edge());
    gl_FragColor = vec4(min(color, 1.0), opacity);
  }`;

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
      vertexShader: `uniform int firstHalf;\n${kVertexShader}`,
      fragmentShader: kFragmentShader,
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
        opacity: {value: 1},
        edgeStrength: {value: 0.6},
        edgeFade: {value: 1},
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
   * the soups. REQUIRES: 0 < low < high if logarithmic.
   */
  setRange(low: number, high: number, scaleRange: [number, number], logarithmic: boolean): void {
    const span = scaleRange[1] - scaleRange[0] || 1;
    const share = (value: number): number => (value - scaleRange[0]) / span;
    this.uniforms.range!.value = logarithmic ? [low, high] : [share(low), share(high)];
    this.uniforms.scaleRange!.value = scaleRange;
    this.uniforms.logarithmic!.value = logarithmic;
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
