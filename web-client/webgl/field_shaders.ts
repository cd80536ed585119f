// The shaders of every surface and cut: a colour map over field values, cell edges, and up to three
// clip planes by discarding. Colours are written as they stand in the table (sRGB, no tone
// mapping), so that a flat cut shows exactly the legend's colours.
//
// three.js puts a head before them, and MeshParts puts a like one: position, both matrices,
// gl_FragColor.

import {kColorMapEntries} from '../core/picture/color_maps';
import {kOpacitySteps, kPlainCode} from '../core/picture/paint';
import {kBendShader} from '../core/picture/log_scale';

/** The colour of a value: the map over the range. Its uniforms are shared by all that has one. */
export const kColorShader = /* glsl */ `
  uniform sampler2D colorMap;
  // the ends of the map, in units of the value; of the field's value itself if logarithmic
  uniform vec2 range;
  uniform vec2 scaleRange; // the field's values that 0 and 1 stand for
  uniform bool logarithmic;
  uniform float linear; // linearPart of the range
  uniform vec4 below; // the colours beyond the range; those of its ends if transparent
  uniform vec4 above;
  uniform vec3 plainColor;

${kBendShader}

  vec3 colorOf(float its) {
    float t = (its - range.x) / max(range.y - range.x, 1e-12);
    if (logarithmic) {
      float value = mix(scaleRange.x, scaleRange.y, its);
      float low = bend(range.x, linear, range.x);
      t = (bend(value, linear, range.x) - low) / (bend(range.y, linear, range.x) - low);
    }
    if (t < 0.0 && below.a > 0.0) return below.rgb;
    if (t > 1.0 && above.a > 0.0) return above.rgb;
    t = clamp(t, 0.0, 1.0);
    // Sample the centres of entries, so that both ends of the range show the table's own ends.
    float at = (t * ${kColorMapEntries - 1}.0 + 0.5) / ${kColorMapEntries}.0;
    return texture(colorMap, vec2(at, 0.5)).rgb;
  }`;

export const kFieldVertexShader = /* glsl */ `
  uniform int firstHalf;
  in float value;
  in float creases; // creasesOf the triangle
  in vec4 paint; // paintOf the triangle
  out float vValue;
  flat out vec3 vCreases;
  flat out vec4 vPaint;
  // centroid: a place outside the triangle would leave pixels of slivers above a plane
  centroid out vec3 vLattice;
  centroid out float vReach; // half of the canvas's height there, in lattice units
  out vec2 vAcross; // divided, -1 to 1 over the canvas's height
  out vec3 vView;
  out vec3 vCorner;
  void main() {
    int corner = gl_VertexID % 3;
    vCorner = vec3(corner == 0, corner == 1, corner == 2);
    // In triangles from firstHalf on, the side opposite to the first corner is a quad's diagonal.
    if (gl_VertexID / 3 >= firstHalf) vCorner.x = 1.0;
    vValue = value;
    vPaint = paint;
    vCreases = vec3(ivec3(int(creases)) >> ivec3(0, 1, 2) & 1);
    vLattice = position;
    vec4 view = modelViewMatrix * vec4(position, 1.0);
    vView = view.xyz;
    gl_Position = projectionMatrix * view;
    vAcross = gl_Position.yw;
    vReach = gl_Position.w / (projectionMatrix[1].y * length(modelViewMatrix[1].xyz));
  }`;

/** Edges of cells less than 6 pixels high are fainter, as the cells are smaller. */
const kPlainDensity = 1 / 6;

export const kFieldFragmentShader = /* glsl */ `
  in float vValue;
  centroid in vec3 vLattice;
  centroid in float vReach;
  in vec2 vAcross;
  in vec3 vView;
  in vec3 vCorner;
  flat in vec3 vCreases;
  flat in vec4 vPaint;
  uniform bool colored;
  uniform bool lit;
  uniform bool twoSided;
  uniform vec4 clipPlanes[3];
  uniform float opacity;
  uniform int pass; // 0: all is drawn, 1: what is solid, 2: what is seen through
  uniform float edgeStrength;
  uniform float creaseStrength;
  uniform float edgeFade;
  uniform bool onDark; // creases are lighter than their surface
  uniform float pixelRatio;

${kColorShader}

  vec3 surfaceColor(int code) {
    if (code > 127) return vPaint.rgb;
    // a missing value makes its triangle plain
    return !colored || isnan(vValue) ? plainColor : colorOf(vValue);
  }

  // How strong lines are at a place: edges, creases. All edges have one strength (edge_fade.ts), so
  // that none stand alone. Only those of cells far smaller than the others are fainter: the lines
  // would cover the colours. Half of a crease lies in each triangle. Where a plane cuts, half of
  // the line stands out of the cut.
  vec2 lines(vec3 onPlanes) {
    vec3 perPixel = max(fwidth(vCorner), 1e-6);
    vec3 onSide = 1.0 - smoothstep(vec3(0.0), perPixel * 0.85 * pixelRatio, vCorner);
    float density = max(max(perPixel.x, perPixel.y), perPixel.z) * pixelRatio;
    float fade = min(1.0, ${kPlainDensity} / density);
    vec3 onCrease = max(onSide * vCreases, onPlanes);
    return vec2(
      edgeStrength * edgeFade * fade * max(max(onSide.x, onSide.y), onSide.z),
      creaseStrength * max(max(onCrease.x, onCrease.y), onCrease.z)
    );
  }

  void main() {
    vec3 heights;
    for (int i = 0; i < 3; ++i) heights[i] = dot(clipPlanes[i].xyz, vLattice) - clipPlanes[i].w;
    float halfLine = creaseStrength > 0.0 ? 0.85 * pixelRatio : 0.0;
    vec3 width = fwidth(heights) * halfLine;
    // A triangle seen edge-on is high within a pixel. It stands out by the size of two pixels.
    float pixels = 2.0 * vReach * abs(dFdy(vAcross.x / vAcross.y));
    if (any(greaterThan(heights, min(width, pixels * halfLine)))) discard;
    int code = int(vPaint.a * 255.0 + 0.5);
    if (code == ${kPlainCode}) code = ${kOpacitySteps};
    float own = min(float(code & 63) / ${kOpacitySteps}.0, 1.0);
    if (pass > 0 && (pass == 1) != (own == 1.0)) discard;
    vec3 color = surfaceColor(code);
    if ((code & 64) > 0) color = mix(color, vec3(1.0), 0.45); // it is selected
    if (lit) {
      // Flat shading from screen derivatives makes cells look like cells. A lamp is a little above
      // the eye, and light falls from the sky. All channels get one factor: the hue stays.
      vec3 normal = normalize(cross(dFdx(vView), dFdy(vView)));
      vec3 light = normalize(vec3(0.25, 0.45, 1.0));
      normal *= dot(normal, vView) > 0.0 ? -1.0 : 1.0;
      float facing = max(dot(normal, light), 0.0);
      float sky = 0.5 + 0.5 * normal.y;
      color *= 0.68 + 0.18 * facing + 0.14 * sky;
      bool isInside = !gl_FrontFacing && !twoSided && own == 1.0;
      if (isInside) color = mix(color, vec3(0.24, 0.26, 0.30), 0.55);
    }
    vec2 line = lines(1.0 - smoothstep(vec3(0.0), max(width, 1e-6), abs(heights)));
    vec3 crease = onDark ? mix(color, vec3(1.0), 0.7) : color * 0.22;
    color = mix(mix(color, color * 0.22, line.x), crease, line.y);
    gl_FragColor = vec4(min(color, 1.0), opacity * own);
  }`;
