#include "simplify/fuse/fusion_state.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "simplify/mesh/tet_mesh.h"

namespace qtet {
namespace {

std::size_t valuesOfAPoint(std::span<const FieldInfo> fields) {
  std::size_t count = 0;
  for (const FieldInfo& field : fields)
    if (!isCellField(field)) count += field.components;
  return count;
}

// The fields of a fused vertex where the cost's values stand for many components. They are the mean
// of what the prey vertices have, changed as the values change.
class ManyFields {
 public:
  ManyFields(const FusionState& state, const Prey& prey, const LatticePoint& point,
             std::span<const double> values)
      : mesh_(state.mesh()),
        basis_(state.cost().basis()),
        prey_(prey),
        shares_(state.cost().sharesOf(prey, point)) {
    for (std::size_t j = 0; j < values.size(); ++j) {
      change_[j] = values[j];
      for (std::size_t i = 0; i < prey_.k; ++i)
        change_[j] -= shares_[i] * state.cost().value(prey_.vertex[i], j);
    }
  }

  /// Component c of a field, number `component` of all in the cost.
  [[nodiscard]] double at(const CostPart& part, std::size_t c, std::size_t component) const {
    double value =
        basis_.changeOf(component, std::span(change_).first(basis_.components())) / part.scale;
    for (std::size_t i = 0; i < prey_.k; ++i)
      value += shares_[i] * mesh_.values(part.field, prey_.vertex[i])[c];
    const double most = std::ldexp(1.0, mesh_.fields()[part.field].bits) - 1;
    return std::clamp(value, 0.0, most);
  }

 private:
  const FusionMesh& mesh_;
  const CostBasis& basis_;
  Prey prey_;
  std::array<double, 4> shares_;
  CostValues change_{};
};

}  // namespace

FusionState::FusionState(const LatticeMesh& lattice, std::size_t regionField,
                         const CostOptions& cost, Workers& workers)
    : mesh_(lattice, regionField, &workers), cost_(mesh_, lattice, cost, &workers) {
  changes_.resize(mesh_.vertexSlots());
  integers_.resize(valuesOfAPoint(mesh_.fields()));
}

const Candidate* FusionState::bestAlive(VertexId owner) {
  while (const Candidate* best = candidates_.best(owner)) {
    if (mesh_.alive(best->partner)) return best;
    candidates_.drop(owner);
  }
  return nullptr;
}

void FusionState::fuse(const Prey& prey, const LatticePoint& point, const Star& star,
                       std::uint32_t level) {
  for (const VertexId v : star.link)
    if (v != kGhost) mesh_.prefetchVertex(v);
  const auto fused = static_cast<VertexId>(mesh_.vertexSlots());
  cost_.makeRoom(fused + std::size_t{1});
  changes_.resize(fused + std::size_t{1});
  for (const VertexId v : prey.vertices()) candidates_.forget(v);
  std::array<double, kMaxCostComponents> room;
  const auto values = std::span(room).first(cost_.components());
  cost_.valuesAt(prey, point, values);
  findIntegers(prey, point, values);
  cost_.fuse(prey, fused, point, values);
  mesh_.fuse(prey, {point, integers_}, star, level);
}

VertexId FusionState::nearest(const Prey& prey, const LatticePoint& point) const {
  VertexId nearest = prey.vertex[0];
  double least = std::numeric_limits<double>::infinity();
  for (const VertexId v : prey.vertices()) {
    const Vector3 d = mesh_.position(v) - toVector(point);
    if (dot(d, d) < least) least = dot(d, d), nearest = v;
  }
  return nearest;
}

// The fused vertex's integers: of a field in the cost what the cost says, of the others the
// nearest prey vertex's.
void FusionState::findIntegers(const Prey& prey, const LatticePoint& point,
                               std::span<const double> values) {
  std::optional<ManyFields> many;
  if (!cost_.basis().isDirect()) many.emplace(*this, prey, point, values);
  const VertexId nearest = this->nearest(prey, point);
  std::size_t part = 0, component = 0, at = 0;
  for (std::size_t f = 0; f < mesh_.fields().size(); ++f) {
    if (isCellField(mesh_.fields()[f])) continue;
    if (part < cost_.parts().size() && cost_.parts()[part].field == f) {
      const CostPart& own = cost_.parts()[part++];
      for (std::size_t c = 0; c < mesh_.fields()[f].components; ++c, ++component)
        integers_[at++] = static_cast<std::int32_t>(
            std::floor((many ? many->at(own, c, component) : values[component] / own.scale) + 0.5));
    } else {
      for (const std::int32_t value : mesh_.values(f, nearest)) integers_[at++] = value;
    }
  }
}

}  // namespace qtet
