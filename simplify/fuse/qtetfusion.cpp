#include "simplify/fuse/qtetfusion.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "proto/limits.h"
#include "simplify/fuse/fusion_loop.h"
#include "simplify/fuse/fusion_state.h"
#include "simplify/mesh/stopping.h"
#include "simplify/mesh/tet_mesh.h"
#include "simplify/mesh/workers.h"

namespace qtet {
namespace {

/// Calls `release` once the mesh is not needed any more.
template <class Release>
Result<FusionHistory> simplifyAll(const LatticeMesh& mesh, const FusionOptions& options,
                                  const FirstFusions& first, const EarlierFusions* earlier,
                                  const Release& release) {
  const std::size_t target = baseCellsOf(options, mesh.tetrahedra.size());
  Workers workers(options.threads, options.stop);
  const std::size_t regions = options.regionField.value_or(FusionMesh::kNoRegions);
  std::optional<FusionState> made;
  if (earlier != nullptr) {
    made.emplace(mesh, regions, earlier->cost, std::span(earlier->quadrics));
  } else {
    made.emplace(mesh, regions, options.cost, workers);
  }
  FusionState& state = *made;
  const FusionFrame frame(mesh, state, options);
  state.keep(options.kept);
  release();
  const std::uint32_t done = first ? first(state, frame) : 0;
  const Result<std::uint32_t> levels = FusionLoop(state, frame, options, workers, done).run(target);
  if (!levels) return std::unexpected(levels.error());
  assert(*levels >= done && *levels <= kMaxLevels);
  return state.takeHistory(*levels);
}

Status checkWeights(const LatticeMesh& mesh, const FusionOptions& options) {
  const std::vector<double>& weights = options.cost.fieldWeights;
  if (!weights.empty() && weights.size() != mesh.fields.size())
    return fail(ErrorCode::kBadInput, "there must be one field weight a field");
  const auto bad = [](double w) { return !(w >= 0) || std::isinf(w); };
  const auto badLabel = [&](const LabelCost& label) { return bad(label.weight); };
  if (std::ranges::any_of(weights, bad) || bad(options.cost.boundaryWeight.value_or(0)) ||
      std::ranges::any_of(options.cost.labels, badLabel) || bad(options.shapeWeight))
    return fail(ErrorCode::kBadInput, "weights must be finite and not negative");
  return {};
}

/// A field of regions or labels.
Status checkRegions(const LatticeMesh& mesh, std::size_t number) {
  if (number >= mesh.fields.size())
    return fail(ErrorCode::kBadInput, "there is no such field of regions");
  const FieldInfo& field = mesh.fields[number];
  if (!isCellField(field) || field.components != 1)
    return fail(ErrorCode::kBadInput,
                "field '" + field.name +
                    "' cannot tell regions apart: that takes a cell field of one component");
  if (isFloatType(field.type) || field.step != 1)
    return fail(ErrorCode::kBadInput,
                "field '" + field.name +
                    "' cannot tell regions apart: only integers that are stored exactly can");
  return {};
}

Status check(const LatticeMesh& mesh, const FusionOptions& options) {
  if (mesh.tetrahedra.empty()) return fail(ErrorCode::kBadInput, "the mesh has no tetrahedra");
  const double ratio = options.targetRatio.value_or(kBaseRatio);
  if (options.targetRatio && options.baseCells)
    return fail(ErrorCode::kBadInput,
                "give a ratio or a number of cells for the base mesh, not both");
  if (!(ratio >= 0 && ratio <= 1))
    return fail(ErrorCode::kBadInput, "the target ratio must lie in 0..1");
  if (!(options.envelopeTolerance.value_or(0) >= 0))
    return fail(ErrorCode::kBadInput, "the envelope tolerance must not be negative");
  const auto isNone = [&](VertexId v) { return v >= mesh.points.size(); };
  if (std::ranges::any_of(options.kept, isNone))
    return fail(ErrorCode::kBadInput, "a vertex that is to be kept is none of the mesh");
  if (Status weights = checkWeights(mesh, options); !weights) return weights;
  for (const LabelCost& label : options.cost.labels)
    if (Status regions = checkRegions(mesh, label.field); !regions) return regions;
  return options.regionField ? checkRegions(mesh, *options.regionField) : Status{};
}

}  // namespace

std::size_t baseCellsOf(const FusionOptions& options, std::size_t cells) {
  if (options.baseCells) return *options.baseCells;
  const double of = static_cast<double>(cells);
  if (options.targetRatio) return static_cast<std::size_t>(*options.targetRatio * of);
  return std::min(static_cast<std::size_t>(kBaseRatio * of), kMaxBaseCells);
}

Result<FusionHistory> simplify(const LatticeMesh& mesh, const FusionOptions& options) {
  if (Status checked = check(mesh, options); !checked) return std::unexpected(checked.error());
  return orCancelled([&] { return simplifyAll(mesh, options, {}, nullptr, [] {}); });
}

Result<FusionHistory> simplify(LatticeMesh&& mesh, const FusionOptions& options,
                               const FirstFusions& first, const EarlierFusions* earlier) {
  if (Status checked = check(mesh, options); !checked) return std::unexpected(checked.error());
  return orCancelled(
      [&] { return simplifyAll(mesh, options, first, earlier, [&] { mesh = {}; }); });
}

}  // namespace qtet
