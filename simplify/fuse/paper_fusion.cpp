#include "simplify/fuse/paper_fusion.h"

#include <algorithm>
#include <array>
#include <boost/heap/fibonacci_heap.hpp>
#include <cassert>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "proto/limits.h"
#include "simplify/cost/fusion_cost.h"
#include "simplify/legality/fusion_check.h"
#include "simplify/mesh/fusion_mesh.h"
#include "simplify/mesh/stopping.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {
namespace {

// How many times its area a boundary plane counts: the paper weights them, but does not say by how
// much. Ten times less loses 0.03 % of the box's volume; ten times more changes little. Chosen by
// the boundary's distance, for the paper claims the box's boundary to be preserved perfectly.
constexpr double kBoundaryFactor = 1000;
// Extractions between two reports of progress.
constexpr std::uint64_t kProgressEvery = 4096;
// Cosine of the largest angle by which a boundary triangle may turn in one fusion; the paper leaves
// open what keeps its boundary from folding.
constexpr double kNormalCosine = 0.3;

struct Entry {
  double key = 0;
  CellId cell = 0;
  // The heap keeps the largest on top; equal keys in order of the cell, so that the outcome is one
  // and the same everywhere.
  bool operator<(const Entry& other) const {
    return key != other.key ? key > other.key : cell > other.cell;
  }
};

using Heap = boost::heap::fibonacci_heap<Entry>;

/// No field in the cost: then it is PQEM.
CostOptions planesOnly(const LatticeMesh& mesh) {
  CostOptions options;
  options.fieldWeights.assign(mesh.fields.size(), 0);
  options.boundaryFactor = kBoundaryFactor;
  return options;
}

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The weights of the prey's vertices at d (relative to the first), none negative, their sum 1:
/// barycentric coordinates, cut off outside.
std::array<double, 4> weightsAt(const std::array<Vector3, 4>& corners, const Vector3& d) {
  const auto volume = [](const Vector3& a, const Vector3& b, const Vector3& c) {
    return dot(cross(a, b), c);
  };
  const auto& [a, b, c, e] = corners;
  std::array<double, 4> weights{volume(b - d, c - d, e - d), volume(a - d, e - d, c - d),
                                volume(a - d, b - d, e - d), volume(a - d, c - d, b - d)};
  double sum = 0;
  for (double& w : weights) sum += w = std::max(w, 0.0);
  if (!(sum > 0)) return {0.25, 0.25, 0.25, 0.25};
  for (double& w : weights) w /= sum;
  return weights;
}

class PaperSimplifier {
 public:
  PaperSimplifier(const LatticeMesh& mesh, const FusionOptions& options)
      : options_(options),
        mesh_(mesh),
        cost_(mesh_, mesh, planesOnly(mesh)),
        test_(mesh_, FusionLimits{0, nullptr, kNormalCosine}),
        cells_(mesh.tetrahedra.size()),
        target_(options.baseCells.value_or(static_cast<std::size_t>(
            std::ceil(options.targetRatio.value_or(kBaseRatio) * static_cast<double>(cells_))))),
        handles_(cells_),
        queued_(cells_, 1),
        nextLevel_(mesh.points.size(), 0) {
    for (CellId c = 0; c < cells_; ++c) {
      throwIfStopped(options.stop);
      handles_[c] = heap_.push({keyOf(c), c});
    }
  }

  Result<PaperFusion> run() {
    const auto start = std::chrono::steady_clock::now();
    figures_.initialiseSeconds = secondsSince(start_);
    while (!heap_.empty() && mesh_.liveTetrahedra() > target_) {
      throwIfStopped(options_.stop);
      const CellId cell = heap_.top().cell;
      heap_.pop();
      assert(queued_[cell] && mesh_.isLive(cell));
      queued_[cell] = 0;
      if (options_.progress && ++extracted_ % kProgressEvery == 0)
        options_.progress(1 - static_cast<double>(heap_.size()) / static_cast<double>(cells_));
      if (const auto point = legalPoint(cell)) {
        if (!fuse(preyOf(cell), *point))
          return fail(
              ErrorCode::kLimitExceeded,
              "4,096 levels do not reach the target; ask for more cells with `targetRatio`");
        updateHeap();
      }
    }
    assert(figures_.fusions == mesh_.fusions() && mesh_.liveTetrahedra() <= cells_);
    figures_.removed = cells_ - mesh_.liveTetrahedra();
    figures_.fuseSeconds = secondsSince(start);
    assert(nextLevel_.size() == mesh_.vertexSlots());
    PaperFusion out{mesh_.takeHistory(levels_), figures_};
    // Independent fusions may change places; the fused vertices give the order of doing.
    std::ranges::sort(out.history.fusions, {},
                      [](const Fusion& f) { return std::pair(f.level, f.fused); });
    return out;
  }

 private:
  [[nodiscard]] Prey preyOf(CellId c) const {
    assert(c < cells_ && mesh_.isLive(c));
    return {4, mesh_.cell(c)};
  }

  /// Where PQEM(T) is least, the barycentre where that is no one point (Eq. 6-7). Relative to the
  /// first prey vertex.
  [[nodiscard]] Vector3 minimumOf(const Prey& prey, const PreyQuadric& of) const {
    Vector3 sum{};
    for (const VertexId v : prey.vertices())
      sum = sum + (mesh_.position(v) - mesh_.position(prey.vertex[0]));
    const Vector3 barycentre = 0.25 * sum;
    return of.quadric.minimum(barycentre, of.pull).value_or(barycentre);
  }

  [[nodiscard]] double keyOf(CellId c) const {
    const Prey prey = preyOf(c);
    const PreyQuadric of = cost_.of(prey);
    return of.quadric.at(minimumOf(prey, of));
  }

  /// The lattice point next to the minimum, where the lattice has one.
  [[nodiscard]] std::optional<LatticePoint> pointOf(const Prey& prey) const {
    const Vector3 p = mesh_.position(prey.vertex[0]) + minimumOf(prey, cost_.of(prey));
    const double end = std::ldexp(1.0, mesh_.latticeBits());
    LatticePoint out{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double nearest = std::floor(p[a] + 0.5);
      if (!(nearest >= 0 && nearest < end)) return std::nullopt;
      out[a] = static_cast<std::int32_t>(nearest);
    }
    return out;
  }

  [[nodiscard]] bool interior(const Prey& prey) const {
    return std::ranges::none_of(prey.vertices(), [&](VertexId v) { return mesh_.onBoundary(v); });
  }

  /// Where the tetrahedron may be fused by the rules of 3.2, or nothing, counted.
  std::optional<LatticePoint> legalPoint(CellId cell) {
    const Prey prey = preyOf(cell);
    PaperFigures::Refused& refused = figures_.refused;
    const auto no = [](std::uint64_t& count) {
      ++count;
      return std::nullopt;
    };
    if (std::ranges::any_of(prey.vertices(), [&](VertexId v) { return mesh_.singular(v); }) ||
        !test_.gather(prey))
      return no(refused.topology);
    const auto point = pointOf(prey);
    if (!point || !test_.insideEnvelope(*point)) return no(refused.envelope);
    if (test_.shapeAt(*point) < 0) return no(refused.flip);
    if (!test_.keepsTopology()) return no(refused.topology);
    if (interior(prey) && test_.star().deleted.size() < kMinOfInterior) return no(refused.few);
    return point;
  }

  /// False when the log has no level left for it.
  bool fuse(const Prey& prey, const LatticePoint& point) {
    std::uint32_t level = 0;
    for (const VertexId v : prey.vertices()) level = std::max(level, nextLevel_[v]);
    if (level == kMaxLevels) return false;
    levels_ = std::max(levels_, level + 1);
    for (const VertexId v : test_.star().link)
      if (v != kGhost) nextLevel_[v] = std::max(nextLevel_[v], level + 1);
    nextLevel_.push_back(level + 1);
    figures_.interiorFusions += interior(prey);
    ++figures_.fusions;
    valuesAt(prey, point);
    const VertexId fused = mesh_.fuse(prey, {point, integers_}, test_.star(), level);
    cost_.makeRoom(mesh_.vertexSlots());
    cost_.fuse(prey, fused, point, {});
    return true;
  }

  /// Deleted cells leave the heap; an affected tetrahedron gets the key of its new PQEM, if it is
  /// still there.
  void updateHeap() {
    for (const CellId c : test_.star().deleted) {
      if (!isQueued(c)) continue;
      heap_.erase(handles_[c]);
      queued_[c] = 0;
    }
    for (const CellId c : test_.star().affected)
      if (isQueued(c)) heap_.update(handles_[c], {keyOf(c), c});
  }
  [[nodiscard]] bool isQueued(CellId c) const { return c < cells_ && queued_[c]; }

  /// The fields at the fusion point: numbers between the prey's, whole numbers (they may be names
  /// of things) the nearest prey vertex's.
  void valuesAt(const Prey& prey, const LatticePoint& point) {
    std::array<Vector3, 4> corners{};
    for (std::size_t i = 0; i < 4; ++i)
      corners[i] = mesh_.position(prey.vertex[i]) - mesh_.position(prey.vertex[0]);
    const Vector3 d = toVector(point) - mesh_.position(prey.vertex[0]);
    const std::array<double, 4> weights = weightsAt(corners, d);
    const auto squared = [&](const Vector3& corner) { return dot(corner - d, corner - d); };
    const VertexId nearest = prey.vertex[static_cast<std::size_t>(
        std::ranges::min_element(corners, {}, squared) - corners.begin())];
    integers_.clear();
    for (std::size_t f = 0; f < mesh_.fields().size(); ++f) {
      const FieldInfo& info = mesh_.fields()[f];
      if (isCellField(info)) continue;
      for (std::size_t c = 0; c < info.components; ++c) {
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i) sum += weights[i] * mesh_.values(f, prey.vertex[i])[c];
        integers_.push_back(isFloatType(info.type)
                                ? static_cast<std::int32_t>(std::floor(sum + 0.5))
                                : mesh_.values(f, nearest)[c]);
      }
    }
  }

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const FusionOptions& options_;
  FusionMesh mesh_;
  FusionCost cost_;
  FusionCheck test_;
  std::size_t cells_, target_;
  Heap heap_;
  std::vector<Heap::handle_type> handles_;  // by tetrahedron
  std::vector<std::uint8_t> queued_;        // whether its handle is valid
  // By vertex: the first level whose fusions may have it as prey, one above all that touched it.
  // Fusions of one level are then independent.
  std::vector<std::uint32_t> nextLevel_;
  std::uint32_t levels_ = 0;
  std::uint64_t extracted_ = 0;
  PaperFigures figures_;
  std::vector<std::int32_t> integers_;
};

}  // namespace

Result<PaperFusion> simplifyAsThePaper(const LatticeMesh& mesh, const FusionOptions& options) {
  if (mesh.tetrahedra.empty()) return fail(ErrorCode::kBadInput, "the mesh has no tetrahedra");
  const double ratio = options.targetRatio.value_or(kBaseRatio);
  if (!(ratio >= 0 && ratio <= 1))
    return fail(ErrorCode::kBadInput, "the target ratio must lie in 0..1");
  return orCancelled([&] { return PaperSimplifier(mesh, options).run(); });
}

}  // namespace qtet
