#include "simplify/fuse/fusion_state.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "simplify/mesh/tet_mesh.h"

namespace qtet {
namespace {

// How many fusions ahead the memory is asked for what they read.
constexpr std::size_t kAhead = 2;

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
  ManyFields(const FusionState& state, const PlannedFusion& planned, std::span<const double> values)
      : mesh_(state.mesh()),
        basis_(state.cost().basis()),
        prey_(planned.prey),
        shares_(state.cost().sharesOf(planned.prey, planned.point)) {
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
    : workers_(workers),
      mesh_(lattice, regionField, &workers),
      cost_(mesh_, lattice, cost, &workers) {
  changes_.resize(mesh_.vertexSlots());
}

const Candidate* FusionState::bestAlive(VertexId owner) {
  while (const Candidate* best = candidates_.best(owner)) {
    if (mesh_.alive(best->partner)) return best;
    candidates_.drop(owner);
  }
  return nullptr;
}

void FusionState::fuse(std::span<const PlannedFusion> planned, std::uint32_t level) {
  const std::size_t slots = mesh_.vertexSlots() + planned.size();
  const std::size_t pointValues = valuesOfAPoint(mesh_.fields());
  integers_.resize(planned.size() * pointValues);
  cost_.makeRoom(slots);
  changes_.resize(slots);
  const auto valuesOf = [&](std::size_t i, VertexId fused) -> std::span<const std::int32_t> {
    if (i + kAhead < planned.size()) prefetch(planned[i + kAhead].prey);
    for (const VertexId v : planned[i].prey.vertices()) candidates_.forget(v);
    const auto integers = std::span(integers_).subspan(i * pointValues, pointValues);
    fuseCosts(planned[i], fused, integers);
    return integers;
  };
  mesh_.fuse(planned, level, std::cref(valuesOf), &workers_);
}

void FusionState::prefetch(const Prey& prey) const {
  for (const VertexId v : prey.vertices()) {
    cost_.prefetch(v), candidates_.prefetch(v);
    for (std::size_t f = 0; f < mesh_.fields().size(); ++f)
      if (!isCellField(mesh_.fields()[f])) qtet::prefetch(mesh_.values(f, v).data());
  }
}

void FusionState::fuseCosts(const PlannedFusion& planned, VertexId fused,
                            std::span<std::int32_t> integers) {
  std::array<double, kMaxCostComponents> room;
  const auto values = std::span(room).first(cost_.components());
  cost_.valuesAt(planned.prey, planned.point, values);
  findIntegers(planned, values, integers);
  cost_.fuse(planned.prey, fused, planned.point, values);
}

VertexId FusionState::nearest(const PlannedFusion& planned) const {
  VertexId nearest = planned.prey.vertex[0];
  double least = std::numeric_limits<double>::infinity();
  for (const VertexId v : planned.prey.vertices()) {
    const Vector3 d = mesh_.position(v) - toVector(planned.point);
    if (dot(d, d) < least) least = dot(d, d), nearest = v;
  }
  return nearest;
}

// The fused vertex's integers: of a field in the cost what the cost says, of the others the
// nearest prey vertex's.
void FusionState::findIntegers(const PlannedFusion& planned, std::span<const double> values,
                               std::span<std::int32_t> integers) const {
  std::optional<ManyFields> many;
  if (!cost_.basis().isDirect()) many.emplace(*this, planned, values);
  const VertexId nearest = this->nearest(planned);
  std::size_t part = 0, component = 0, at = 0;
  for (std::size_t f = 0; f < mesh_.fields().size(); ++f) {
    if (isCellField(mesh_.fields()[f])) continue;
    if (part < cost_.parts().size() && cost_.parts()[part].field == f) {
      const CostPart& own = cost_.parts()[part++];
      for (std::size_t c = 0; c < mesh_.fields()[f].components; ++c, ++component)
        integers[at++] = static_cast<std::int32_t>(
            std::floor((many ? many->at(own, c, component) : values[component] / own.scale) + 0.5));
    } else {
      for (const std::int32_t value : mesh_.values(f, nearest)) integers[at++] = value;
    }
  }
}

}  // namespace qtet
