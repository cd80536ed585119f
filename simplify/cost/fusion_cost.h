// The cost of a fusion (ALGORITHM.md, "Cost"): one quadric in the fusion point and its values. It
// sums the residual of the fields over the volume and the distance of the boundary. Without fields
// it is the paper's planar quadric error (Eq. 1-7).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "codec/coding/prefetch.h"
#include "codec/mesh/mesh.h"
#include "simplify/cost/cost_frame.h"
#include "simplify/cost/edge_quadric.h"
#include "simplify/cost/line_allocator.h"
#include "simplify/cost/quadric.h"
#include "simplify/mesh/fusion_mesh.h"
#include "simplify/mesh/two_vectors.h"

namespace qtet {

struct PreyQuadric {
  Quadric quadric;
  /// The weight of a pull towards the barycentre that decides where the quadric does not.
  double pull = 0;
};

/// The boundary's field counts like that of a layer this thick (of the diagonal). The thin cells at
/// a wall have no volume to give them weight, yet the field is steepest there, and a viewer shows
/// it.
inline constexpr double kWallLayer = 3e-5;

/// The factor on the volume that a fusion adds or takes, beside the boundary's distance. Smaller
/// stars weigh less, by the root of their area over the diagonal's square.
inline constexpr double kVolumeFactor = 600;

class FusionCost {
 public:
  /// `workers` share the work and change nothing of its outcome. REQUIRES: `mesh` outlives this and
  /// was made of `lattice`.
  FusionCost(const FusionMesh& mesh, const LatticeMesh& lattice, const CostOptions& options,
             Workers* workers = nullptr);
  /// A block of a mesh, in the frame of the whole: what its own cells and `boundary` give. The
  /// quadric of a vertex of several blocks is the sum of theirs. REQUIRES: as the first.
  FusionCost(const FusionMesh& mesh, const LatticeMesh& block, const CostFrame& frame,
             std::span<const Triangle> boundary);
  /// A part of a mesh. `quadrics`: quadric(v) of its vertices in the whole, back to back. REQUIRES:
  /// `mesh` outlives this.
  FusionCost(const FusionMesh& mesh, const CostFrame& frame, std::span<const double> quadrics);

  [[nodiscard]] const CostFrame& frame() const { return frame_; }
  /// The weight of the squared volume that a fusion adds or takes, over the area of the star's
  /// boundary (ALGORITHM.md, "Volume"). REQUIRES: a triangle at least.
  [[nodiscard]] double volumeWeight(double area, std::size_t triangles) const;
  /// All that v stands for, as the other constructor takes it.
  [[nodiscard]] std::span<const double> quadric(VertexId v) const {
    return std::span(quadrics_).subspan(at(v), stride_);
  }
  /// How many of the numbers of a quadric of a frame of so many components are sums over cells and
  /// triangles. The values of the vertex stand behind them.
  [[nodiscard]] static std::size_t sumsOf(std::size_t components) {
    return kHead + (kPerComponent - 1) * components;
  }

  /// The prey's quadric as a function of the fusion point relative to prey.vertex[0], at the best
  /// values for each point.
  [[nodiscard]] PreyQuadric of(const Prey& prey) const;
  /// The same of two edges v-w at once, relative to v.
  struct TwoEdges {
    EdgeQuadric<Pair> quadric;
    Pair pull;
    TwoVectors along;  // from v
  };
  [[nodiscard]] TwoEdges ofEdges(VertexId v, std::array<VertexId, 2> w) const;
  /// The error that v has already: its quadric at its own place and values.
  [[nodiscard]] double of(VertexId v) const { return quadrics_[at(v) + kConstant]; }
  /// Asks the memory for where v's quadric is.
  void prefetchSlot(VertexId v) const { qtet::prefetch(&slot_[v]); }
  /// Asks the memory for v's quadric.
  void prefetch(VertexId v) const {
    for (std::size_t i = 0; i < stride_; i += kLineDoubles) qtet::prefetch(&quadrics_[at(v) + i]);
  }

  /// The fields in the cost.
  [[nodiscard]] std::span<const CostPart> parts() const { return frame_.parts; }
  /// The meaning of the values, in the order of parts().
  [[nodiscard]] const CostBasis& basis() const { return frame_.basis; }
  [[nodiscard]] std::size_t components() const { return components_; }

  /// The best values at p in the cost's unit (components() numbers), within the fields' limits if
  /// basis().isDirect(), and E there.
  double valuesAt(const Prey& prey, const LatticePoint& p, std::span<double> values) const;
  /// The share of each prey vertex in the values of the fused vertex at p. It follows from the
  /// place on an edge, else from the volume that the vertex stands for. The shares sum to 1.
  [[nodiscard]] std::array<double, 4> sharesOf(const Prey& prey, const LatticePoint& p) const;
  /// A vertex's value number f.
  [[nodiscard]] double value(VertexId v, std::size_t f) const {
    return quadrics_[at(v) + placeOf(kValue, f)];
  }
  /// The prey's quadrics become the fused vertex's. Threads may do so at once, each for prey of its
  /// own. REQUIRES: room for it; called before or after FusionMesh::fuse, once each fusion.
  void fuse(const Prey& prey, VertexId fused, const LatticePoint& p,
            std::span<const double> values);
  /// Room for so many vertices in all.
  void makeRoom(std::size_t vertices) { slot_.resize(vertices); }

 private:
  // The quadric of one vertex, relative to its place and values. It consists of A (6), b (3), c, W,
  // then the G of each component, x, y and z apart. Then come each one's h and each one's value.
  // E(d, e) = d^T A d + 2 b.d + c + sum_f (W e_f^2 - 2 e_f (G_f.d + h_f)).
  static constexpr std::size_t kConstant = 9;
  static constexpr std::size_t kWeight = 10;
  static constexpr std::size_t kHead = kWeight + 1;
  static constexpr std::size_t kPerComponent = 5;
  static constexpr std::size_t kLineDoubles = 8;  // of a cache line
  // The pull towards the barycentre, relative to the curvature of the quadric and, where it has
  // none, to volume over diagonal squared.
  static constexpr double kPull = 1e-6;
  static constexpr double kFlatPull = 1e-7;

  struct Sum {
    Quadric q;
    double weight = 0;
    std::array<Vector3, kMaxCostComponents> slope;
    std::array<double, kMaxCostComponents> offset;

    [[nodiscard]] Quadric reduced(std::size_t components) const;
  };

  /// The vertices whose quadrics are added to; by default all.
  struct Vertices {
    VertexId begin = 0, end = kGhost;
    [[nodiscard]] bool holds(VertexId v) const { return v - begin < end - begin; }
    [[nodiscard]] bool holdOne(std::span<const VertexId> corners) const {
      return std::ranges::any_of(corners, [this](VertexId v) { return holds(v); });
    }
  };

  void takeValues(const LatticeMesh& lattice);
  void addAll(const LatticeMesh& lattice, std::span<const Triangle> boundary, Workers* workers);
  void addSlopes(const LatticeMesh& lattice, std::span<const Triangle> boundary, Workers* workers);
  void addFields(const LatticeMesh& lattice, const Vertices& own);
  void addTriangles(std::span<const Triangle> triangles, double boundaryFactor,
                    const Vertices& own);
  void addSlope(std::span<const VertexId> corners, std::span<const Vector3> slopes, double weight,
                Symmetric3 a, const Vertices& own);
  void addPlanes(const LatticeMesh& lattice, std::span<const Triangle> boundary);
  [[nodiscard]] std::size_t at(VertexId v) const { return slot_[v] * stride_; }
  enum Part : std::size_t { kSlope = 0, kOffset = 3, kValue = 4 };
  [[nodiscard]] std::size_t placeOf(std::size_t part, std::size_t f) const {
    return kHead + part * components_ + f;
  }
  [[nodiscard]] Vector3 slope(const double* q, std::size_t f) const {
    return {q[placeOf(0, f)], q[placeOf(1, f)], q[placeOf(2, f)]};
  }
  [[nodiscard]] PreyQuadric ofEdge(VertexId v, VertexId w) const;
  template <class T>
  [[nodiscard]] T pullOf(const T& trace, const T& weight) const;
  void start(VertexId v, Sum& sum) const;
  template <class Value>
  void accumulate(VertexId v, const Vector3& origin, const Value& valueOf, Sum& sum) const;
  void sumOf(const Prey& prey, Sum& sum) const;

  const FusionMesh& mesh_;
  CostFrame frame_;
  std::size_t components_ = 0, stride_ = kHead;
  std::vector<double, LineAllocator<double>> quadrics_;  // stride_ a slot
  std::vector<std::uint32_t> slot_;  // by vertex: a fused vertex takes its first prey vertex's
};

template <class T>
inline T FusionCost::pullOf(const T& trace, const T& weight) const {
  return kPull * trace / 3 + kFlatPull * weight / (frame_.diagonal * frame_.diagonal) +
         std::numeric_limits<double>::min();
}

// a call would pass all of it through memory
[[gnu::always_inline]] inline FusionCost::TwoEdges FusionCost::ofEdges(
    VertexId v, std::array<VertexId, 2> w) const {
  const double *const first = &quadrics_[at(w[0])], *const second = &quadrics_[at(w[1])];
  const Vector3 from = mesh_.position(v);
  const TwoVectors along = both(mesh_.position(w[0]) - from, mesh_.position(w[1]) - from);
  TwoEdges out{edgeQuadric<Pair>(
                   &quadrics_[at(v)], [&](std::size_t i) { return Pair{first[i], second[i]}; },
                   {-along[0], -along[1], -along[2]}, components_),
               {},
               along};
  const auto& a = out.quadric.a;
  out.pull = pullOf(a[0] + a[3] + a[5], out.quadric.weight);
  return out;
}

}  // namespace qtet
