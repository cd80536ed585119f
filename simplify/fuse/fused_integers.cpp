#include "simplify/fuse/fused_integers.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace qtet {
namespace {

VertexId nearestOf(const FusionMesh& mesh, const Prey& prey, const LatticePoint& point) {
  assert(prey.k >= 2 && prey.k <= 4);
  VertexId nearest = prey.vertex[0];
  double least = std::numeric_limits<double>::infinity();
  for (const VertexId v : prey.vertices()) {
    const Vector3 d = mesh.position(v) - toVector(point);
    if (dot(d, d) < least) least = dot(d, d), nearest = v;
  }
  return nearest;
}

}  // namespace

FusedIntegers::FusedIntegers(const FusionMesh& mesh, const FusionCost& cost, const Prey& prey,
                             const LatticePoint& point, std::span<const double> values)
    : mesh_(mesh),
      basis_(cost.basis()),
      prey_(prey),
      values_(values),
      nearest_(nearestOf(mesh, prey, point)) {
  assert(values.size() == cost.components());
  if (basis_.isDirect()) return;
  many_.emplace(Many{cost.sharesOf(prey, point), {}});
  for (std::size_t j = 0; j < values.size(); ++j) {
    many_->change[j] = values[j];
    for (std::size_t i = 0; i < prey_.k; ++i)
      many_->change[j] -= many_->shares[i] * cost.value(prey_.vertex[i], j);
  }
}

double FusedIntegers::ofMany(const CostPart& part, std::size_t c, std::size_t component) const {
  assert(many_ && c < mesh_.fields()[part.field].components);
  double value =
      basis_.changeOf(component, std::span(many_->change).first(basis_.components())) / part.scale;
  for (std::size_t i = 0; i < prey_.k; ++i)
    value += many_->shares[i] * mesh_.values(part.field, prey_.vertex[i])[c];
  const double most = std::ldexp(1.0, mesh_.fields()[part.field].bits) - 1;
  return std::clamp(value, 0.0, most);
}

std::int32_t FusedIntegers::ofPart(const CostPart& part, std::size_t c,
                                   std::size_t component) const {
  return static_cast<std::int32_t>(
      std::floor((many_ ? ofMany(part, c, component) : values_[component] / part.scale) + 0.5));
}

SomeIntegers::SomeIntegers(const FusionMesh& mesh, const FusionCost& cost,
                           std::span<const std::size_t> fields)
    : mesh_(mesh), cost_(cost) {
  for (const std::size_t f : fields) {
    assert(f < mesh.fields().size() && !isCellField(mesh.fields()[f]));
    Chosen chosen{f, {}, 0};
    std::size_t component = 0;
    for (const CostPart& part : cost.parts()) {
      if (part.field == f) chosen.part = part, chosen.component = component;
      component += mesh.fields()[part.field].components;
    }
    chosen_.push_back(chosen);
  }
}

std::span<const std::int32_t> SomeIntegers::at(const Prey& prey, const LatticePoint& point) {
  std::array<double, kMaxCostComponents> room;
  const auto values = std::span(room).first(cost_.components());
  cost_.valuesAt(prey, point, values);
  const FusedIntegers all(mesh_, cost_, prey, point, values);
  integers_.clear();
  for (const auto& [field, part, component] : chosen_) {
    if (!part) {
      const auto other = all.ofOther(field);
      integers_.insert(integers_.end(), other.begin(), other.end());
      continue;
    }
    for (std::size_t c = 0; c < mesh_.fields()[field].components; ++c)
      integers_.push_back(all.ofPart(*part, c, component + c));
  }
  return integers_;
}

}  // namespace qtet
