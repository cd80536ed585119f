#include "simplify/cost/fusion_cost.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "codec/mesh/boundary.h"
#include "codec/mesh/face_groups.h"
#include "simplify/cost/label_fields.h"
#include "simplify/mesh/large_pages.h"
#include "simplify/mesh/workers.h"

namespace qtet {
namespace {

// Most cells, of some, have all of their vertices in one run of so many ids.
bool areNear(std::span<const Tetrahedron> cells, std::size_t run) {
  constexpr std::size_t kAsked = 1024;
  const std::size_t step = cells.size() / kAsked + 1;
  std::size_t asked = 0, near = 0;
  for (std::size_t i = 0; i < cells.size(); i += step, ++asked) {
    const auto [least, most] = std::ranges::minmax(cells[i]);
    near += least / std::max<std::size_t>(run, 1) == most / std::max<std::size_t>(run, 1);
  }
  return 2 * near > asked;
}

/// The faces of one cell that are no boundary: another block has the cell beyond.
class SeamFaces {
 public:
  SeamFaces(const LatticeMesh& block, std::span<const Triangle> boundary)
      : areNone_(boundary.size() == block.boundary.size()) {
    if (areNone_) return;
    for (const Triangle& t : boundary) boundary_.push_back(sorted(t));
    std::ranges::sort(boundary_);
  }
  [[nodiscard]] bool hold(const Triangle& face) const {
    return !areNone_ && !std::ranges::binary_search(boundary_, sorted(face));
  }

 private:
  static Triangle sorted(Triangle t) {
    std::ranges::sort(t);
    return t;
  }

  bool areNone_;
  std::vector<Triangle> boundary_;
};

}  // namespace

FusionCost::FusionCost(const FusionMesh& mesh, const LatticeMesh& lattice,
                       const CostOptions& options, Workers* workers)
    : mesh_(mesh),
      frame_(lattice, options),
      components_(frame_.basis.components()),
      stride_(kHead + kPerComponent * components_) {
  addAll(lattice, lattice.boundary, workers);
}

FusionCost::FusionCost(const FusionMesh& mesh, const LatticeMesh& block, const CostFrame& frame,
                       std::span<const Triangle> boundary)
    : mesh_(mesh),
      frame_(frame),
      components_(frame_.basis.components()),
      stride_(kHead + kPerComponent * components_) {
  addAll(block, boundary, nullptr);
}

FusionCost::FusionCost(const FusionMesh& mesh, const CostFrame& frame,
                       std::span<const double> quadrics)
    : mesh_(mesh),
      frame_(frame),
      components_(frame_.basis.components()),
      stride_(kHead + kPerComponent * components_),
      quadrics_(quadrics.begin(), quadrics.end()) {
  assert(quadrics.size() == mesh.vertexSlots() * stride_);
  slot_.resize(mesh.vertexSlots());
  std::iota(slot_.begin(), slot_.end(), 0u);
}

void FusionCost::addAll(const LatticeMesh& lattice, std::span<const Triangle> boundary,
                        Workers* workers) {
  assert(mesh_.vertexSlots() == lattice.points.size());
  slot_.resize(lattice.points.size());
  std::iota(slot_.begin(), slot_.end(), 0u);
  quadrics_.reserve(lattice.points.size() * stride_);
  useLargePages(quadrics_);
  quadrics_.resize(lattice.points.size() * stride_, 0);
  takeValues(lattice);
  if (components_ == 0) {
    addPlanes(lattice, boundary);
  } else {
    addSlopes(lattice, boundary, workers);
  }
}

// Each worker adds to vertices of its own, in the order of the cells, so that every sum is that of
// one worker. Ids that lie near one another mostly lie near one another in the mesh, too, so few
// cells are visited by two workers. Where that is not so, one worker alone is quicker.
void FusionCost::addSlopes(const LatticeMesh& lattice, std::span<const Triangle> boundary,
                           Workers* workers) {
  const std::size_t vertices = lattice.points.size();
  const std::size_t runs =
      workers && areNear(lattice.tetrahedra, vertices / workers->count()) ? workers->count() : 1;
  const auto forRuns = [&](const auto& add) {
    forEach(workers, runs, 1, [&](std::size_t, std::size_t i) {
      add(Vertices{static_cast<VertexId>(i * vertices / runs),
                   static_cast<VertexId>((i + 1) * vertices / runs)});
    });
  };
  const auto addSurface = [&](std::span<const Triangle> surface, double weight) {
    forRuns([&](const Vertices& own) { addTriangles(surface, weight / frame_.diagonal, own); });
  };
  forRuns([&](const Vertices& own) { addFields(lattice, own); });
  addSurface(boundary, frame_.boundaryWeight);
  for (const LabelCost& label : frame_.labels)
    if (label.weight > 0) addSurface(interfacesOf(lattice, label.field), label.weight);
}

void FusionCost::takeValues(const LatticeMesh& lattice) {
  std::size_t first = 0;
  for (const CostPart& part : frame_.parts) {
    const std::size_t n = lattice.fields[part.field].components;
    for (VertexId v = 0; v < lattice.points.size(); ++v)
      for (std::size_t c = 0; c < n; ++c)
        frame_.basis.add(first + c, part.scale * lattice.values[part.field][v * n + c],
                         std::span(quadrics_).subspan(at(v) + placeOf(kValue, 0), components_));
    first += n;
  }
}

// Adds weight (s - s_v - g.(x - x_v))^2 and x^T a x for each corner v. It adds no b, c or h, since
// the plane passes through the corner.
void FusionCost::addSlope(std::span<const VertexId> corners, std::span<const Vector3> slopes,
                          double weight, Symmetric3 a, const Vertices& own) {
  for (const Vector3& g : slopes) a.addOuter(g, weight);
  const std::array<double, 6> matrix{a.xx, a.xy, a.xz, a.yy, a.yz, a.zz};
  // W and the slopes lie side by side.
  std::array<double, 1 + 3 * kMaxCostComponents> weighted;
  weighted[0] = weight;
  for (std::size_t f = 0; f < slopes.size(); ++f)
    for (std::size_t i = 0; i < 3; ++i) weighted[1 + i * slopes.size() + f] = weight * slopes[f][i];
  const std::size_t count = 1 + 3 * slopes.size();
  for (const VertexId v : corners) {
    if (!own.holds(v)) continue;
    double* const q = &quadrics_[at(v)];
    for (std::size_t i = 0; i < matrix.size(); i += 2)
      putPair(q + i, pairAt(q + i) + pairAt(&matrix[i]));
    std::size_t i = 0;
    for (; i + 1 < count; i += 2)
      putPair(q + kWeight + i, pairAt(q + kWeight + i) + pairAt(&weighted[i]));
    if (i < count) q[kWeight + i] += weighted[i];
  }
}

// Over each cell: its volume, the fields' gradients in it.
void FusionCost::addFields(const LatticeMesh& lattice, const Vertices& own) {
  std::vector<Vector3> gradients(components_);
  for (const Tetrahedron& t : lattice.tetrahedra) {
    if (!own.holdOne(t)) continue;
    const Vector3 p = mesh_.position(t[0]);
    const Vector3 e1 = mesh_.position(t[1]) - p, e2 = mesh_.position(t[2]) - p,
                  e3 = mesh_.position(t[3]) - p;
    const Vector3 c23 = cross(e2, e3), c31 = cross(e3, e1), c12 = cross(e1, e2);
    const double volume6 = dot(e1, c23);
    if (!(volume6 > 0)) continue;
    for (std::size_t f = 0; f < components_; ++f) {
      const double s = value(t[0], f);
      gradients[f] = (1 / volume6) * ((value(t[1], f) - s) * c23 + (value(t[2], f) - s) * c31 +
                                      (value(t[3], f) - s) * c12);
    }
    addSlope(t, gradients, volume6 / 6, {}, own);
  }
}

// Over each triangle of the boundary: the boundary's distance, and the fields' gradients in the
// triangle with the weight of a thin layer.
void FusionCost::addTriangles(std::span<const Triangle> triangles, double boundaryFactor,
                              const Vertices& own) {
  std::vector<Vector3> gradients(components_);
  for (const Triangle& t : triangles) {
    if (!own.holdOne(t)) continue;
    const Vector3 p = mesh_.position(t[0]);
    const Vector3 e1 = mesh_.position(t[1]) - p, e2 = mesh_.position(t[2]) - p;
    const Vector3 n = cross(e1, e2);
    const double squared = dot(n, n);
    if (!(squared > 0)) continue;
    for (std::size_t f = 0; f < components_; ++f) {
      const double s = value(t[0], f);
      gradients[f] = (1 / squared) *
                     ((value(t[1], f) - s) * cross(e2, n) + (value(t[2], f) - s) * cross(n, e1));
    }
    const double area = 0.5 * std::sqrt(squared);
    Symmetric3 a;
    a.addOuter(n, boundaryFactor * area / squared);
    addSlope(t, gradients, kWallLayer * frame_.diagonal * area, a, own);
  }
}

// Eq. 1-3: weight a_p^2, so n / 2 as it is.
void FusionCost::addPlanes(const LatticeMesh& lattice, std::span<const Triangle> boundary) {
  const SeamFaces seams(lattice, boundary);
  const double surface = frame_.boundaryFactor * frame_.boundaryFactor;
  const auto weightOf = [&](std::span<const FaceSide> sides, const Triangle& face) {
    if (sides.size() == 1)
      return seams.hold(face) ? 0.5 : surface;  // the block beside adds as much
    const bool isInterface = std::ranges::any_of(frame_.labels, [&](const LabelCost& label) {
      const std::vector<std::int32_t>& labels = lattice.values[label.field];
      return label.weight > 0 && labels[cellOf(sides[0])] != labels[cellOf(sides[1])];
    });
    return isInterface ? surface : 1;
  };
  FaceGroups(lattice.tetrahedra).forEach([&](std::span<const FaceSide> sides) {
    const Tetrahedron& cell = lattice.tetrahedra[cellOf(sides[0])];
    const Triangle face = cellFace(cell, oppositeCornerOf(sides[0]));
    const Vector3 p = mesh_.position(face[0]);
    const Vector3 n = cross(mesh_.position(face[1]) - p, mesh_.position(face[2]) - p);
    Symmetric3 a;
    a.addOuter(n, frame_.planeScale * weightOf(sides, face));
    addSlope(face, {}, 0, a, Vertices{});
  });
}

// The boundary's weight for a squared distance. Without fields a triangle's own weight is that for
// its area, so that of a mean triangle counts.
double FusionCost::volumeWeight(double area, std::size_t triangles) const {
  assert(triangles > 0);
  const double length = std::sqrt(area) / frame_.diagonal;
  if (components_ > 0) return kVolumeFactor * length * frame_.boundaryWeight / frame_.diagonal;
  return kVolumeFactor * length * 4 * frame_.planeScale * frame_.boundaryFactor *
         frame_.boundaryFactor * area / static_cast<double>(triangles);
}

// Adds v's quadric, moved from its own place and values to the sum's (Eq. 4).
template <class Value>
void FusionCost::accumulate(VertexId v, const Vector3& origin, const Value& valueOf,
                            Sum& sum) const {
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
    const Vector3 slope = this->slope(q, f);
    const double e = valueOf(f) - q[placeOf(kValue, f)];
    const double along = dot(slope, d) + q[placeOf(kOffset, f)];
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
  assert(v < slot_.size());
  const double* q = &quadrics_[at(v)];
  sum.q = {{q[0], q[1], q[2], q[3], q[4], q[5]}, {q[6], q[7], q[8]}, q[9]};
  sum.weight = q[10];
  for (std::size_t f = 0; f < components_; ++f) {
    sum.slope[f] = slope(q, f);
    sum.offset[f] = q[placeOf(kOffset, f)];
  }
}

void FusionCost::sumOf(const Prey& prey, Sum& sum) const {
  const VertexId first = prey.vertex[0];
  const Vector3 origin = mesh_.position(first);
  start(first, sum);
  for (const VertexId v : prey.vertices().subspan(1))
    accumulate(v, origin, [&](std::size_t f) { return value(first, f); }, sum);
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
  assert(prey.k >= 2 && prey.k <= 4);
  if (prey.k == 2) return ofEdge(prey.vertex[0], prey.vertex[1]);
  Sum sum;
  sumOf(prey, sum);
  const Quadric quadric = sum.reduced(components_);
  return {quadric, pullOf(quadric.a.trace(), sum.weight)};
}

// sumOf and reduced in one.
PreyQuadric FusionCost::ofEdge(VertexId v, VertexId w) const {
  assert(v != w && v < slot_.size() && w < slot_.size());
  const double* const other = &quadrics_[at(w)];
  const auto [a, b, c, weight] = edgeQuadric<double>(
      &quadrics_[at(v)], [&](std::size_t i) { return other[i]; },
      mesh_.position(v) - mesh_.position(w), components_);
  return {{{a[0], a[1], a[2], a[3], a[4], a[5]}, b, c}, pullOf(a[0] + a[3] + a[5], weight)};
}

double FusionCost::valuesAt(const Prey& prey, const LatticePoint& p,
                            std::span<double> values) const {
  Sum sum;
  sumOf(prey, sum);
  const Vector3 d = toVector(p) - mesh_.position(prey.vertex[0]);
  double cost = sum.reduced(components_).at(d);
  for (std::size_t f = 0; f < components_; ++f) {
    const double best = value(prey.vertex[0], f) +
                        (sum.weight > 0 ? (dot(sum.slope[f], d) + sum.offset[f]) / sum.weight : 0);
    values[f] = frame_.basis.isDirect() ? std::clamp(best, 0.0, frame_.limits[f]) : best;
    cost += sum.weight * (values[f] - best) * (values[f] - best);
  }
  return cost;
}

std::array<double, 4> FusionCost::sharesOf(const Prey& prey, const LatticePoint& p) const {
  std::array<double, 4> shares{};
  const auto vertices = prey.vertices();
  if (prey.k == 2) {
    const Vector3 along = mesh_.position(vertices[1]) - mesh_.position(vertices[0]);
    const double t = dot(toVector(p) - mesh_.position(vertices[0]), along) / dot(along, along);
    shares[1] = t > 0 ? std::min(t, 1.0) : 0;
    shares[0] = 1 - shares[1];
    return shares;
  }
  double whole = 0;
  for (const VertexId v : vertices) whole += quadrics_[at(v) + kWeight];
  for (std::size_t i = 0; i < vertices.size(); ++i)
    shares[i] = whole > 0 ? quadrics_[at(vertices[i]) + kWeight] / whole
                          : 1.0 / static_cast<double>(vertices.size());
  return shares;
}

void FusionCost::fuse(const Prey& prey, VertexId fused, const LatticePoint& p,
                      std::span<const double> values) {
  Sum sum;
  std::fill_n(sum.slope.begin(), components_, Vector3{});
  std::fill_n(sum.offset.begin(), components_, 0.0);
  const Vector3 place = toVector(p);
  for (const VertexId v : prey.vertices())
    accumulate(v, place, [&](std::size_t f) { return values[f]; }, sum);
  assert(fused < slot_.size());
  slot_[fused] = slot_[prey.vertex[0]];
  double* q = &quadrics_[at(fused)];
  const Symmetric3& a = sum.q.a;
  const std::array<double, kHead> head{a.xx,       a.xy,       a.xz,       a.yy,    a.yz,      a.zz,
                                       sum.q.b[0], sum.q.b[1], sum.q.b[2], sum.q.c, sum.weight};
  std::ranges::copy(head, q);
  for (std::size_t f = 0; f < components_; ++f) {
    for (std::size_t i = 0; i < 3; ++i) q[placeOf(kSlope + i, f)] = sum.slope[f][i];
    q[placeOf(kOffset, f)] = sum.offset[f];
    q[placeOf(kValue, f)] = values[f];
  }
}

}  // namespace qtet
