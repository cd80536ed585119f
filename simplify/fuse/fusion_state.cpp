#include "simplify/fuse/fusion_state.h"

#include <array>
#include <cassert>

#include "simplify/fuse/fused_integers.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {
namespace {

std::size_t valuesOfAPoint(std::span<const FieldInfo> fields) {
  std::size_t count = 0;
  for (const FieldInfo& field : fields)
    if (!isCellField(field)) count += field.components;
  return count;
}

}  // namespace

FusionState::FusionState(const LatticeMesh& lattice, std::size_t regionField,
                         const CostOptions& cost, Workers& workers)
    : mesh_(lattice, regionField, &workers), cost_(mesh_, lattice, cost, &workers) {
  changes_.resize(mesh_.vertexSlots());
  integers_.resize(valuesOfAPoint(mesh_.fields()));
}

FusionState::FusionState(const LatticeMesh& block, std::size_t regionField, const CostFrame& frame,
                         std::span<const Triangle> boundary)
    : mesh_(block, regionField), cost_(mesh_, block, frame, boundary) {
  changes_.resize(mesh_.vertexSlots());
  integers_.resize(valuesOfAPoint(mesh_.fields()));
}

FusionState::FusionState(const LatticeMesh& part, std::size_t regionField, const CostFrame& frame,
                         std::span<const double> quadrics)
    : mesh_(part, regionField), cost_(mesh_, frame, quadrics) {
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
  for (const VertexId v : prey.vertices()) candidates_.forget(v);
  std::array<double, kMaxCostComponents> room;
  const auto values = std::span(room).first(cost_.components());
  cost_.valuesAt(prey, point, values);
  findIntegers(prey, point, values);
  fuse(prey, {point, integers_}, values, star, level);
}

void FusionState::fuse(const Prey& prey, const FusedVertex& what, const Star& star,
                       std::uint32_t level) {
  std::array<double, kMaxCostComponents> room;
  const auto values = std::span(room).first(cost_.components());
  cost_.valuesAt(prey, what.point, values);
  fuse(prey, what, values, star, level);
}

void FusionState::fuse(const Prey& prey, const FusedVertex& what, std::span<const double> values,
                       const Star& star, std::uint32_t level) {
  assert(what.values.size() == integers_.size());
  assert(values.size() == cost_.components());
  const auto fused = static_cast<VertexId>(mesh_.vertexSlots());
  cost_.makeRoom(fused + std::size_t{1});
  changes_.resize(fused + std::size_t{1});
  cost_.fuse(prey, fused, what.point, values);
  [[maybe_unused]] const VertexId made = mesh_.fuse(prey, what, star, level);
  assert(made == fused && !candidates_.best(fused));
}

void FusionState::findIntegers(const Prey& prey, const LatticePoint& point,
                               std::span<const double> values) {
  const FusedIntegers all(mesh_, cost_, prey, point, values);
  std::size_t part = 0, component = 0, at = 0;
  for (std::size_t f = 0; f < mesh_.fields().size(); ++f) {
    if (isCellField(mesh_.fields()[f])) continue;
    if (part < cost_.parts().size() && cost_.parts()[part].field == f) {
      const CostPart& own = cost_.parts()[part++];
      for (std::size_t c = 0; c < mesh_.fields()[f].components; ++c, ++component)
        integers_[at++] = all.ofPart(own, c, component);
    } else {
      for (const std::int32_t value : all.ofOther(f)) integers_[at++] = value;
    }
  }
  assert(at == integers_.size() && part == cost_.parts().size());
}

}  // namespace qtet
