#include "simplify/fusion_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "codec/boundary.h"
#include "codec/face_groups.h"
#include "simplify/tet_mesh.h"

namespace qtet {
namespace {

// The boundary's field counts like that of a layer this thick (of the diagonal): the thin cells at a wall have no volume to speak for them, yet
// there the field is steepest, and it is what a viewer shows.
constexpr double kWallLayer = 3e-5;
// The pull towards the barycentre, relative to the curvature of the quadric and, where it has none, to volume over diagonal squared.
constexpr double kPull = 1e-6;
constexpr double kFlatPull = 1e-7;

double diagonalOf(const LatticeMesh& mesh) {
  LatticePoint low = mesh.points.empty() ? LatticePoint{} : mesh.points[0], high = low;
  for (const LatticePoint& p : mesh.points)
    for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  const Vector3 d = toVector(high) - toVector(low);
  return std::max(1.0, std::sqrt(dot(d, d)));
}

}  // namespace

FusionCost::FusionCost(const FusionMesh& mesh, const LatticeMesh& lattice, const CostOptions& options)
    : mesh_(mesh), diagonal_(diagonalOf(lattice)) {
  chooseParts(lattice, options);
  stride_ = kHead + kPerComponent * components_;
  slot_.resize(lattice.points.size());
  std::iota(slot_.begin(), slot_.end(), 0u);
  quadrics_.assign(lattice.points.size() * stride_, 0);
  takeValues(lattice);
  if (components_ == 0) {
    addPlanes(lattice, options.boundaryFactor);
  } else {
    addFields(lattice);
    addSurface(lattice, options.hullWeight / diagonal_);
  }
}

void FusionCost::chooseParts(const LatticeMesh& lattice, const CostOptions& options) {
  double total = 0;
  std::vector<double> weights;
  for (std::size_t f = 0; f < lattice.fields.size(); ++f) {
    const FieldInfo& info = lattice.fields[f];
    const double weight = options.fieldWeights.empty() ? isFloatType(info.type) : options.fieldWeights[f];
    const auto [low, high] = std::ranges::minmax(lattice.values[f]);
    if (isCellField(info) || weight <= 0 || low == high || components_ + info.components > kMaxCostComponents) continue;
    parts_.push_back({f, 1});
    weights.push_back(weight);
    components_ += info.components;
    total += weight;
  }
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const FieldInfo& info = lattice.fields[parts_[i].field];
    // Of a vector the larger of its lengths' range and its components': directions may turn while their lengths stay.
    const double extent = info.step * (std::ldexp(1.0, info.bits) - 1);
    const double range = info.components == 1 ? info.range[1] - info.range[0] : std::max(info.range[1] - info.range[0], extent);
    const double steps = (range > 0 ? range : extent) / info.step;
    parts_[i].scale = std::sqrt(weights[i] / total) / steps;
    for (std::size_t c = 0; c < info.components; ++c) limits_.push_back(parts_[i].scale * (std::ldexp(1.0, info.bits) - 1));
  }
}

void FusionCost::takeValues(const LatticeMesh& lattice) {
  std::size_t first = 0;
  for (const Part& part : parts_) {
    const std::size_t n = lattice.fields[part.field].components;
    for (VertexId v = 0; v < lattice.points.size(); ++v)
      for (std::size_t c = 0; c < n; ++c)
        quadrics_[at(v) + kHead + kPerComponent * (first + c) + 4] = part.scale * lattice.values[part.field][v * n + c];
    first += n;
  }
}

// Adds weight (s - s_v - g.(x - x_v))^2 and x^T a x for each corner v: no b, c or h, since the plane passes through the corner.
void FusionCost::addSlopes(std::span<const VertexId> corners, std::span<const Vector3> slopes, double weight, Symmetric3 a) {
  for (const Vector3& g : slopes) a.addOuter(g, weight);
  for (const VertexId v : corners) {
    double* q = &quadrics_[at(v)];
    q[0] += a.xx, q[1] += a.xy, q[2] += a.xz, q[3] += a.yy, q[4] += a.yz, q[5] += a.zz;
    q[10] += weight;
    for (std::size_t f = 0; f < slopes.size(); ++f)
      for (std::size_t i = 0; i < 3; ++i) q[kHead + kPerComponent * f + i] += weight * slopes[f][i];
  }
}

// Over each cell: its volume, the fields' gradients in it.
void FusionCost::addFields(const LatticeMesh& lattice) {
  std::vector<Vector3> gradients(components_);
  for (const Tetrahedron& t : lattice.tetrahedra) {
    const Vector3 p = mesh_.position(t[0]);
    const Vector3 e1 = mesh_.position(t[1]) - p, e2 = mesh_.position(t[2]) - p, e3 = mesh_.position(t[3]) - p;
    const Vector3 c23 = cross(e2, e3), c31 = cross(e3, e1), c12 = cross(e1, e2);
    const double volume6 = dot(e1, c23);
    if (!(volume6 > 0)) continue;
    for (std::size_t f = 0; f < components_; ++f) {
      const double s = value(t[0], f);
      gradients[f] = (1 / volume6) * ((value(t[1], f) - s) * c23 + (value(t[2], f) - s) * c31 + (value(t[3], f) - s) * c12);
    }
    addSlopes(t, gradients, volume6 / 6, {});
  }
}

// Over each boundary triangle: the hull's distance, and the fields' gradients in the triangle with the weight of a thin layer. Interfaces between regions
// count like the boundary.
void FusionCost::addSurface(const LatticeMesh& lattice, double hullFactor) {
  addTriangles(lattice.boundary, hullFactor);
  if (!mesh_.hasRegions()) return;
  std::vector<Triangle> interfaces;
  FaceGroups(lattice.tetrahedra).forEach([&](std::span<const FaceSide> sides) {
    if (sides.size() == 2 && mesh_.region(cellOf(sides[0])) != mesh_.region(cellOf(sides[1])))
      interfaces.push_back(cellFace(lattice.tetrahedra[cellOf(sides[0])], oppositeCornerOf(sides[0])));
  });
  addTriangles(interfaces, hullFactor);
}

void FusionCost::addTriangles(std::span<const Triangle> triangles, double hullFactor) {
  std::vector<Vector3> gradients(components_);
  for (const Triangle& t : triangles) {
    const Vector3 p = mesh_.position(t[0]);
    const Vector3 e1 = mesh_.position(t[1]) - p, e2 = mesh_.position(t[2]) - p;
    const Vector3 n = cross(e1, e2);
    const double squared = dot(n, n);
    if (!(squared > 0)) continue;
    for (std::size_t f = 0; f < components_; ++f) {
      const double s = value(t[0], f);
      gradients[f] = (1 / squared) * ((value(t[1], f) - s) * cross(e2, n) + (value(t[2], f) - s) * cross(n, e1));
    }
    const double area = 0.5 * std::sqrt(squared);
    Symmetric3 a;
    a.addOuter(n, hullFactor * area / squared);
    addSlopes(t, gradients, kWallLayer * diagonal_ * area, a);
  }
}

// Eq. 1-3: weight a_p^2, so n / 2 as it is.
void FusionCost::addPlanes(const LatticeMesh& lattice, double boundaryFactor) {
  // A length to the sixth power in lattice steps would pass the largest float on fine lattices; a power of two changes nothing else.
  const double scale = std::ldexp(0.25, -3 * lattice.lattice.bits);
  FaceGroups(lattice.tetrahedra).forEach([&](std::span<const FaceSide> sides) {
    const Tetrahedron& cell = lattice.tetrahedra[cellOf(sides[0])];
    const Triangle face = cellFace(cell, oppositeCornerOf(sides[0]));
    const Vector3 p = mesh_.position(face[0]);
    const Vector3 n = cross(mesh_.position(face[1]) - p, mesh_.position(face[2]) - p);
    Symmetric3 a;
    a.addOuter(n, scale * (sides.size() == 1 ? boundaryFactor * boundaryFactor : 1));
    addSlopes(face, {}, 0, a);
  });
}

// Adds v's quadric, moved from its own place and values to the sum's (Eq. 4).
template <class Value>
void FusionCost::accumulate(VertexId v, const Vector3& origin, const Value& valueOf, Sum& sum) const {
  const double* q = &quadrics_[at(v)];
  const Vector3 d = origin - mesh_.position(v);
  const Symmetric3 a{q[0], q[1], q[2], q[3], q[4], q[5]};
  const Vector3 b{q[6], q[7], q[8]};
  const double w = q[10];
  const Vector3 ad = a * d;
  sum.q.a += a;
  Vector3 newB = ad + b;
  double c = dot(d, ad) + 2 * dot(b, d) + q[9];
  sum.weight += w;
  for (std::size_t f = 0; f < components_; ++f) {
    const double* p = q + kHead + kPerComponent * f;
    const Vector3 slope{p[0], p[1], p[2]};
    const double e = valueOf(f) - p[4];
    const double along = dot(slope, d) + p[3];
    newB = newB - e * slope;
    c += e * (w * e - 2 * along);
    sum.slope[f] = sum.slope[f] + slope;
    sum.offset[f] += along - w * e;
  }
  sum.q.b = sum.q.b + newB;
  sum.q.c += c;
}

// The sum begins as v's own quadric, about its own place and values.
void FusionCost::start(VertexId v, Sum& sum) const {
  const double* q = &quadrics_[at(v)];
  sum.q = {{q[0], q[1], q[2], q[3], q[4], q[5]}, {q[6], q[7], q[8]}, q[9]};
  sum.weight = q[10];
  for (std::size_t f = 0; f < components_; ++f) {
    const double* p = q + kHead + kPerComponent * f;
    sum.slope[f] = {p[0], p[1], p[2]};
    sum.offset[f] = p[3];
  }
}

void FusionCost::sumOf(const Prey& prey, Sum& sum) const {
  const VertexId first = prey.vertex[0];
  const Vector3 origin = mesh_.position(first);
  start(first, sum);
  for (const VertexId v : prey.vertices().subspan(1))
    accumulate(
        v, origin, [&](std::size_t f) { return value(first, f); }, sum);
}

Quadric FusionCost::Sum::reduced(std::size_t components) const {
  Quadric out = q;
  if (!(weight > 0)) return out;
  const double inverse = 1 / weight;
  for (std::size_t f = 0; f < components; ++f) {
    const double share = offset[f] * inverse;
    out.a.addOuter(slope[f], -inverse);
    out.b = out.b - share * slope[f];
    out.c -= share * offset[f];
  }
  return out;
}

PreyQuadric FusionCost::of(const Prey& prey) const {
  Sum sum;
  sumOf(prey, sum);
  PreyQuadric out{sum.reduced(components_), 0};
  out.pull = kPull * out.quadric.a.trace() / 3 + kFlatPull * sum.weight / (diagonal_ * diagonal_) + std::numeric_limits<double>::min();
  return out;
}

double FusionCost::valuesAt(const Prey& prey, const LatticePoint& p, std::span<double> values) const {
  Sum sum;
  sumOf(prey, sum);
  const Vector3 d = toVector(p) - mesh_.position(prey.vertex[0]);
  double cost = sum.reduced(components_).at(d);
  for (std::size_t f = 0; f < components_; ++f) {
    const double best = value(prey.vertex[0], f) + (sum.weight > 0 ? (dot(sum.slope[f], d) + sum.offset[f]) / sum.weight : 0);
    values[f] = std::clamp(best, 0.0, limits_[f]);
    cost += sum.weight * (values[f] - best) * (values[f] - best);
  }
  return cost;
}

void FusionCost::fuse(const Prey& prey, const LatticePoint& p, std::span<const double> values) {
  Sum sum;
  std::fill_n(sum.slope.begin(), components_, Vector3{});
  std::fill_n(sum.offset.begin(), components_, 0.0);
  const Vector3 place = toVector(p);
  for (const VertexId v : prey.vertices())
    accumulate(
        v, place, [&](std::size_t f) { return values[f]; }, sum);
  slot_.push_back(slot_[prey.vertex[0]]);
  double* q = &quadrics_[slot_.back() * stride_];
  const Symmetric3& a = sum.q.a;
  const std::array<double, kHead> head{a.xx, a.xy, a.xz, a.yy, a.yz, a.zz, sum.q.b[0], sum.q.b[1], sum.q.b[2], sum.q.c, sum.weight};
  std::ranges::copy(head, q);
  for (std::size_t f = 0; f < components_; ++f) {
    double* at = q + kHead + kPerComponent * f;
    std::ranges::copy(sum.slope[f], at);
    at[3] = sum.offset[f];
    at[4] = values[f];
  }
}

}  // namespace qtet
