// Casts rays through tetrahedra, from face to face. Two directions across the ray span a plane. In
// this plane the ray is the origin, and a face that it passes is a triangle round the origin. The
// signs of three areas decide by which face the ray leaves a cell. Each area belongs to two corners
// of the triangle, or to one and the fourth. Signs are the same from both sides of a face, so that
// no ray is lost between cells.
//
// After R. Marmitt and P. Slusallek, "Fast ray traversal of tetrahedral and hexahedral meshes for
// direct volume rendering", EuroVis 2006.

import {kBendShader} from '../core/picture/log_scale';
import {kTransferSteps} from '../core/picture/transfer';
import {kRow, kRowBits} from './cell_textures';

/** This opacity hides the rest: less than a step of 255 is missing. */
const kOpaque = 0.996;
/** Values whose difference is this share of the range count as equal: two steps of a colour map. */
const kNarrow = 1 / 128;
/**
 * The faces by which rays enter are drawn larger by so many pixels. Some graphics round corners to
 * a sixteenth of a pixel, most to a 256th.
 */
const kMargin = 1 / 16;
/**
 * The margin is at most so many of the face's heights: a face seen edge-on would become endless.
 */
const kMaxMargin = 4;
/**
 * Faces are drawn from this distance before the eye on, in radii of the mesh. That is long before
 * the canvas's near plane: an eye may be close to a face.
 */
const kNearest = 1e-5;
/** A gradient across the line of sight takes this share of the light away. */
const kShading = 0.45;
/** A ray begins at least this share inside of its face. */
const kInside = 1e-4;
/**
 * The most cells that a ray passes between two boundary faces. A straight line through ten million
 * cells passes 600 to 1,000.
 */
const kMaxSteps = 8192;

const kHead = /* glsl */ `
  precision highp float;
  precision highp int;
  precision highp sampler2D;
  precision highp usampler2D;
  uniform sampler2D vertices;
  ivec2 texel(int i) { return ivec2(i & ${kRow - 1}, i >> ${kRowBits}); }`;

// Beside an edge, a ray that leaves through one face must enter again by the face at the edge's
// other side, or by neither. Graphics round corners and so move edges. Therefore faces are drawn
// larger, and the shader cuts them at the edges that single floats give.
const kSide = /* glsl */ `
  float sideOf(vec2 a, vec2 b, vec2 at) {
    return (b.x - a.x) * (at.y - a.y) - (b.y - a.y) * (at.x - a.x);
  }`;

/**
 * Draws the faces by which rays enter: for each pixel the nearest one behind that of the layer
 * before. Depths are linear in the distance, so that they need no near plane.
 */
export const kEntryVertexShader = /* glsl */ `${kHead}${kSide}
  uniform usampler2D entries;
  uniform mat4 toCanvas;
  uniform vec2 middle;       // of the canvas, in pixels
  flat out uint vEntry;
  // Two corners, and the third, in pixels from the middle. They are in the order of their ids: the
  // faces at both sides of an edge take it the same way.
  flat out vec4 vFirst;
  flat out vec2 vThird;
  out float vDistance;       // from the eye; its inverse if vTurn is not 0
  // 1: the corners go round anticlockwise; -1: clockwise; 0: not all of them are before the eye.
  flat out int vTurn;
  vec4 onCanvas(uint vertex) {
    return toCanvas * vec4(texelFetch(vertices, texel(int(vertex)), 0).xyz, 1.0);
  }
  void main() {
    int entry = gl_VertexID / 3;
    int own = gl_VertexID - 3 * entry;
    vEntry = uint(entry);
    vec3 isOwn = vec3(own == 0, own == 1, own == 2);
    uvec3 ids = texelFetch(entries, texel(2 * entry), 0).xyz;
    vec4 p = onCanvas(ids.x), q = onCanvas(ids.y), r = onCanvas(ids.z);
    vec2 a = p.xy / p.w, b = q.xy / q.w, c = r.xy / r.w;
    vec2 u = a * middle, v = b * middle, w = c * middle;
    float whole = sideOf(u, v, w);
    bool isBefore = min(min(p.w, q.w), r.w) > ${kNearest} && whole > 0.0;
    // Move each edge outward in the face's plane.
    vec3 sides = vec3(distance(v, w), distance(w, u), distance(u, v));
    vec3 margins = min(${kMargin} / whole * sides, ${kMaxMargin}.0);
    vec3 shares = (1.0 + margins.x + margins.y + margins.z) * isOwn - margins;
    vec4 its = own == 0 ? p : own == 1 ? q : r;
    // Only what is nearer than kNearest is clipped.
    gl_Position = isBefore ? vec4(shares.x * a + shares.y * b + shares.z * c, 0.0, 1.0)
      : vec4(its.xy, its.w - 2.0 * ${kNearest}, its.w);
    vDistance = isBefore ? dot(shares, vec3(1.0 / p.w, 1.0 / q.w, 1.0 / r.w)) : its.w;
    bool turns = ids.y < ids.z;  // the lowest id comes first
    vTurn = !isBefore ? 0 : turns ? 1 : -1;
    vFirst = vec4(u, turns ? v : w);
    vThird = turns ? w : v;
  }`;

export const kEntryFragmentShader = /* glsl */ `${kHead}${kSide}
  flat in uint vEntry;
  flat in vec4 vFirst;
  flat in vec2 vThird;
  in float vDistance;
  flat in int vTurn;
  uniform vec2 distances;  // at depths 0 and 1
  uniform vec2 middle;
  uniform bool isFirst;
  uniform usampler2D before;
  uniform sampler2D picture;
  layout(location = 0) out uvec4 found;  // 1 + the entry, and its depth
  void main() {
    vec2 at = gl_FragCoord.xy - middle;
    bool turns = vTurn > 0;
    bool first = (sideOf(vFirst.xy, vFirst.zw, at) >= 0.0) == turns;
    bool second = (sideOf(vFirst.zw, vThird, at) >= 0.0) == turns;
    bool third = (sideOf(vFirst.xy, vThird, at) >= 0.0) != turns;
    if (vTurn != 0 && !(first && second && third)) discard;
    float away = vTurn != 0 ? 1.0 / vDistance : vDistance;
    float depth = (away - distances.x) / (distances.y - distances.x);
    if (!isFirst) {
      ivec2 pixel = ivec2(gl_FragCoord.xy);
      uvec2 last = texelFetch(before, pixel, 0).xy;
      if (last.x == 0u || depth <= uintBitsToFloat(last.y)) discard;
      if (texelFetch(picture, pixel, 0).a > ${kOpaque}) discard;
    }
    gl_FragDepth = depth;
    found = uvec4(vEntry + 1u, floatBitsToUint(depth), 0u, 0u);
  }`;

export const kRayFragmentShader = /* glsl */ `${kHead}
  uniform usampler2D links;
  uniform sampler2D cellValues;
  uniform bool ofCells;
  uniform usampler2D entries;
  uniform usampler2D layer;   // the entry of each pixel
  // Corners and tag of the cell where all rays begin. With tag 0 they begin at the entries.
  uniform uint eyeCell[5];
  // The middle of the canvas at the near plane, in lattice coordinates, and the ways from there to
  // its right and upper end.
  uniform vec3 near[3];
  uniform vec3 far[3];
  uniform float farPerNear;   // of the homogeneous coordinate w
  uniform vec2 perPixel;
  uniform sampler2D depths;   // of the scene without the volume
  uniform vec4 clipPlanes[3];
  uniform sampler2D density;
  uniform sampler2D integral;
  uniform vec2 range;
  uniform vec2 scaleRange;
  uniform bool logarithmic;
  uniform float linear;       // linearPart of the range
  uniform float perDiagonal;  // diagonals a lattice unit
  layout(location = 0) out vec4 color;

  vec3 origin, along, across, up;

${kBendShader}

  float shareOf(float value) {
    if (!logarithmic) return (value - range.x) / max(range.y - range.x, 1e-12);
    float v = mix(scaleRange.x, scaleRange.y, value);
    float low = bend(range.x, linear, range.x);
    return (bend(v, linear, range.x) - low) / (bend(range.y, linear, range.x) - low);
  }

  vec4 densityAt(float share) {
    int step = int(clamp(share, 0.0, 1.0) * ${kTransferSteps}.0 + 0.5);
    return texelFetch(density, ivec2(step, 0), 0);
  }

  // Values beyond the ends look like the ends.
  vec4 integralTo(float share) {
    float at = clamp(share, 0.0, 1.0) * ${kTransferSteps}.0;
    int i = min(int(at), ${kTransferSteps - 1});
    vec4 low = texelFetch(integral, ivec2(i, 0), 0);
    vec4 high = texelFetch(integral, ivec2(i + 1, 0), 0);
    vec4 inside = mix(low, high, at - float(i));
    float beyond = share - clamp(share, 0.0, 1.0);
    return beyond == 0.0 ? inside : inside + beyond * densityAt(share);
  }

  // A vertex in the ray's coordinates: beside it (two numbers), along it, and the value.
  vec4 seen(uint vertex) {
    vec4 its = texelFetch(vertices, texel(int(vertex)), 0);
    vec3 at = its.xyz - origin;
    return vec4(dot(at, across), dot(at, up), dot(at, along), its.w);
  }

  float area(vec4 p, vec4 q) { return p.x * q.y - p.y * q.x; }

  // The place along the ray, and the value, where it passes the triangle with these areas. The
  // place is never outside of the triangle.
  vec2 through(vec4 a, vec4 b, vec4 c, vec3 areas) {
    vec3 shares = max(areas, 0.0);
    float sum = shares.x + shares.y + shares.z;
    shares = sum > 0.0 ? shares / sum : vec3(1.0 / 3.0);
    return shares.x * a.zw + shares.y * b.zw + shares.z * c.zw;
  }

  vec3 areasOf(vec4 a, vec4 b, vec4 c) { return vec3(area(b, c), area(c, a), area(a, b)); }

  // Puts the corner last that is opposite to the face by which the ray enters: the first of the
  // faces that it passes.
  void turn(inout uvec4 ids) {
    vec4 p[4] = vec4[4](seen(ids.x), seen(ids.y), seen(ids.z), seen(ids.w));
    int found = 0;
    float nearest = 0.0;
    float maxInside = -1e30;
    for (int i = 0; i < 4; ++i) {
      vec4 a = p[(i + 1) & 3], b = p[(i + 2) & 3], c = p[(i + 3) & 3];
      vec3 shares = areasOf(a, b, c);
      shares /= shares.x + shares.y + shares.z;
      float inside = min(min(shares.x, shares.y), shares.z);
      float depth = through(a, b, c, shares).x;
      if (inside >= 0.0 && maxInside >= 0.0 ? depth < nearest : inside > maxInside) {
        found = i;
        nearest = depth;
        maxInside = inside;
      }
    }
    ids = uvec4(ids[(found + 1) & 3], ids[(found + 2) & 3], ids[(found + 3) & 3], ids[found]);
  }

  // The light of a cell: 1 if its gradient points along the ray. It is also near 1 where the value
  // changes by less than the range over the mesh's diagonal.
  float lightOf(vec4 a, vec4 b, vec4 c, vec4 d) {
    vec3 p = b.xyz - a.xyz, q = c.xyz - a.xyz, r = d.xyz - a.xyz;
    vec3 qr = cross(q, r);
    vec3 gradient = (b.w - a.w) * qr + (c.w - a.w) * cross(r, p) + (d.w - a.w) * cross(p, q);
    float slope = length(gradient);
    if (slope == 0.0) return 1.0;
    float share = 0.25 * (a.w + b.w + c.w + d.w);
    float perValue = 1.0 / max(range.y - range.x, 1e-12);
    if (logarithmic) {
      float value = mix(scaleRange.x, scaleRange.y, share);
      float perBend = linear == 0.0 ? max(value, range.x) : max(abs(value), linear);
      float bends = bend(range.y, linear, range.x) - bend(range.x, linear, range.x);
      perValue = (scaleRange.y - scaleRange.x) / (perBend * bends);
    }
    float steep = slope * perValue / max(abs(dot(p, qr)) * perDiagonal, 1e-30);
    float steepness = steep * steep / (1.0 + steep * steep);
    return 1.0 - ${kShading} * steepness * (1.0 - abs(gradient.z) / slope);
  }

  // Adds a stretch of the ray, from front to back.
  void add(float from, float to, float length, float light) {
    vec4 mean = abs(to - from) < ${kNarrow} ? densityAt(0.5 * (from + to))
      : (integralTo(to) - integralTo(from)) / (to - from);
    if (mean.a <= 0.0) return;
    float opacity = 1.0 - exp(-mean.a * length * perDiagonal);
    color += (1.0 - color.a) * opacity * vec4(light * mean.rgb / mean.a, 1.0);
  }

  void main() {
    color = vec4(0.0);  // returns instead of discarding, after which SwiftShader goes on
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int entry = eyeCell[4] > 0u ? 1 : int(texelFetch(layer, pixel, 0).x);
    if (entry == 0) return;
    vec2 at = gl_FragCoord.xy * perPixel - 1.0;
    origin = near[0] + at.x * near[1] + at.y * near[2];
    along = far[0] + at.x * far[1] + at.y * far[2] - origin;
    float reach = length(along);
    along /= reach;
    vec3 aside = abs(along.x) < 0.6 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    across = normalize(cross(along, aside));
    up = cross(along, across);

    // The visible part of the ray: before the scene, and below the planes.
    float first = 0.0;
    float depth = texelFetch(depths, pixel, 0).r;
    float last = 1e30;
    if (depth < 1.0) last = reach * farPerNear * depth / (1.0 - depth + farPerNear * depth);
    for (int i = 0; i < 3; ++i) {
      float room = clipPlanes[i].w - dot(clipPlanes[i].xyz, origin);
      float change = -dot(clipPlanes[i].xyz, along);
      if (change > 0.0) first = max(first, -room / change);
      else if (change < 0.0) last = min(last, -room / change);
      else if (room < 0.0) return;
    }
    if (last <= first) return;

    uvec4 ids = uvec4(eyeCell[0], eyeCell[1], eyeCell[2], eyeCell[3]);
    uint tag = eyeCell[4];
    if (tag > 0u) {
      turn(ids);
    } else {
      ids = texelFetch(entries, texel(2 * entry - 2), 0);
      tag = texelFetch(entries, texel(2 * entry - 1), 0).x;
    }
    uint ia = ids.x, ib = ids.y, ic = ids.z, id = ids.w;
    vec4 a = seen(ia), b = seen(ib), c = seen(ic);
    vec3 areas = areasOf(a, b, c);
    if (areas.x + areas.y + areas.z < 0.0) {  // a, b, c go round the ray anticlockwise from here on
      uint other = ib;
      ib = ic;
      ic = other;
      vec4 point = b;
      b = c;
      c = point;
      areas = -areas.xzy;
    }
    // Pixel corners are rounded, so that a ray may miss its face by some hundredths of a pixel.
    // Move it into the face.
    vec3 shares = max(areas, ${kInside} * (areas.x + areas.y + areas.z));
    shares /= max(shares.x + shares.y + shares.z, 1e-30);
    vec2 off = shares.x * a.xy + shares.y * b.xy + shares.z * c.xy;
    if (min(min(areas.x, areas.y), areas.z) < ${kInside} * (areas.x + areas.y + areas.z)) {
      origin += off.x * across + off.y * up;
      a = seen(ia);
      b = seen(ib);
      c = seen(ic);
      areas = areasOf(a, b, c);
    }
    vec2 enter = through(a, b, c, areas);
    for (int step = 0; step < ${kMaxSteps}; ++step) {
      // The fourth corner replaces the one that the next face lacks.
      vec4 point = seen(id);
      bool isSeen = !ofCells && tag >> 31 == 0u;
      float light = isSeen ? lightOf(a, b, c, point) : 1.0;
      vec3 sides = vec3(area(a, point), area(b, point), area(c, point));
      bool lacksC = sides.x <= 0.0 && sides.y >= 0.0;
      bool lacksA = !lacksC && sides.y <= 0.0 && sides.z >= 0.0;
      uint lacked = lacksA ? ia : lacksC ? ic : ib;
      // The corners of a cell are in ascending order.
      int corner = int(lacked > ia) + int(lacked > ib) + int(lacked > ic) + int(lacked > id);
      int cell = int(tag & 0x7fffffffu) - 1;
      if (lacksA) {
        ia = id;
        a = point;
        areas.yz = vec2(sides.z, -sides.y);
      } else if (lacksC) {
        ic = id;
        c = point;
        areas.xy = vec2(sides.y, -sides.x);
      } else {
        ib = id;
        b = point;
        areas.xz = vec2(-sides.z, sides.x);
      }
      vec2 leave = through(a, b, c, areas);
      leave.x = max(leave.x, enter.x);
      float from = max(enter.x, first), to = min(leave.x, last);
      if (to > from && tag >> 31 == 0u) {
        if (ofCells) {
          float share = shareOf(texelFetch(cellValues, texel(cell), 0).r);
          add(share, share, to - from, 1.0);
        } else {
          float slope = (leave.y - enter.y) / (leave.x - enter.x);
          float begin = shareOf(enter.y + (from - enter.x) * slope);
          float end = shareOf(enter.y + (to - enter.x) * slope);
          add(begin, end, to - from, light);
        }
      }
      if (leave.x >= last || color.a > ${kOpaque}) break;
      enter = leave;
      uvec2 beyond = texelFetch(links, texel(4 * cell + corner), 0).xy;
      tag = beyond.x;
      id = beyond.y;
      if (tag == 0u) break;
    }
  }`;
