#include "simplify/fuse/fusion_state.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>

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

}  // namespace

FusionState::FusionState(const LatticeMesh& lattice, std::size_t regionField,
                         const CostOptions& cost, Workers& workers)
    : workers_(workers),
      mesh_(lattice, regionField, &workers),
      cost_(mesh_, lattice, cost, &workers) {
  touched_.resize(mesh_.vertexSlots());
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
  touched_.resize(slots);
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

// The fused vertex's integers: of a field in the cost what the cost says, of the others the
// nearest prey vertex's.
void FusionState::findIntegers(const PlannedFusion& planned, std::span<const double> values,
                               std::span<std::int32_t> integers) const {
  VertexId nearest = planned.prey.vertex[0];
  double least = std::numeric_limits<double>::infinity();
  for (const VertexId v : planned.prey.vertices()) {
    const Vector3 d = mesh_.position(v) - toVector(planned.point);
    if (dot(d, d) < least) least = dot(d, d), nearest = v;
  }
  std::size_t part = 0, component = 0, at = 0;
  for (std::size_t f = 0; f < mesh_.fields().size(); ++f) {
    if (isCellField(mesh_.fields()[f])) continue;
    if (part < cost_.parts().size() && cost_.parts()[part].field == f) {
      for (std::size_t c = 0; c < mesh_.fields()[f].components; ++c)
        integers[at++] = static_cast<std::int32_t>(
            std::floor(values[component++] / cost_.parts()[part].scale + 0.5));
      ++part;
    } else {
      for (const std::int32_t value : mesh_.values(f, nearest)) integers[at++] = value;
    }
  }
}

}  // namespace qtet
