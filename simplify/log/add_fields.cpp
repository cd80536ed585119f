#include "simplify/log/add_fields.h"

#include <algorithm>
#include <cmath>

#include "codec/log/log_manifest.h"
#include "codec/mesh/predicates.h"
#include "codec/refine/log_file.h"
#include "simplify/clean/quantise_field.h"
#include "simplify/clean/verify.h"
#include "simplify/log/match_mesh.h"
#include "simplify/mesh/history_levels.h"
#include "simplify/mesh/missing_values.h"
#include "simplify/mesh/vector3.h"

namespace qtet {
namespace {

/// For each vertex of the last level, a quarter of the volume of its cells. A fused vertex stands
/// for the sum of its prey's volumes.
std::vector<double> volumesOf(const LogHistory& log) {
  const FusionHistory& h = log.history;
  std::vector<Tetrahedron> cells(h.cells.begin(), h.cells.begin() + log.tetrahedra);
  for (auto fusion = h.fusions.rbegin(); fusion != h.fusions.rend(); ++fusion)
    for (std::uint64_t i = fusion->firstAffected; i < fusion->firstAffected + fusion->affectedCount;
         ++i)
      if (h.affectedCells[i] < log.tetrahedra)
        std::ranges::replace(cells[h.affectedCells[i]], fusion->fused,
                             fusion->prey[h.affectedLabels[i]]);
  std::vector<double> out(h.points.size(), 0.0);
  for (const Tetrahedron& t : cells) {
    const double volume = std::fabs(static_cast<double>(
        volume6(h.points[t[0]], h.points[t[1]], h.points[t[2]], h.points[t[3]])));
    for (const VertexId v : t) out[v] += volume;
  }
  for (const Fusion& fusion : h.fusions)
    for (std::size_t i = 0; i < fusion.k; ++i) out[fusion.fused] += out[fusion.prey[i]];
  return out;
}

/// How much each prey vertex counts in the fused vertex's value. Values by the place on the edge
/// fit the prediction along the step. On comb they take 20 % fewer bytes than the mean by volume,
/// for 10 % more rms error of the base mesh. The nearest prey's value is worse in both.
std::array<double, 4> sharesOf(const Fusion& fusion, const FusionHistory& h,
                               const std::vector<double>& volumes) {
  std::array<double, 4> out{};
  if (fusion.k == 2) {
    const Vector3 a = toVector(h.points[fusion.prey[0]]),
                  step = toVector(h.points[fusion.prey[1]]) - a;
    const double length = dot(step, step);
    const double along =
        length > 0 ? std::clamp(dot(toVector(h.points[fusion.fused]) - a, step) / length, 0.0, 1.0)
                   : 0.5;
    return {1 - along, along};
  }
  double sum = 0;
  for (std::size_t i = 0; i < fusion.k; ++i) sum += volumes[fusion.prey[i]];
  for (std::size_t i = 0; i < fusion.k; ++i)
    out[i] = sum > 0 ? volumes[fusion.prey[i]] / sum : 1.0 / fusion.k;
  return out;
}

/// The field of the mesh in the log's order.
template <class T>
std::vector<T> inLogOrder(const std::vector<T>& values, std::uint32_t components,
                          const std::vector<std::uint32_t>& logs) {
  std::vector<T> out(values.size());
  for (std::size_t i = 0; i < logs.size(); ++i)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(i * components), components,
                out.begin() + static_cast<std::ptrdiff_t>(std::size_t{logs[i]} * components));
  return out;
}

}  // namespace

std::vector<std::int32_t> fusedValues(const LogHistory& log, std::vector<std::int32_t> values,
                                      std::uint32_t components) {
  const std::vector<double> volumes = volumesOf(log);
  const std::size_t n = components;
  values.resize(log.history.points.size() * n);
  for (const Fusion& fusion : log.history.fusions) {
    const std::array<double, 4> shares = sharesOf(fusion, log.history, volumes);
    for (std::size_t c = 0; c < n; ++c) {
      double value = 0;
      for (std::size_t i = 0; i < fusion.k; ++i)
        value += shares[i] * values[fusion.prey[i] * n + c];
      values[fusion.fused * n + c] = static_cast<std::int32_t>(std::floor(value + 0.5));
    }
  }
  return values;
}

Result<AddedFields> addFields(const LogFile& log, const TetMesh& mesh,
                              const AddFieldsOptions& options) {
  const Result<Manifest> manifest = manifestOf(log.index());
  if (!manifest) return std::unexpected(manifest.error());
  Result<LogHistory> history = historyOf(log, [&](double fraction) {
    if (options.progress) options.progress(fraction / 2);
  });
  if (!history) return std::unexpected(history.error());
  FusionHistory& h = history->history;
  const Result<OnLattice> placed = putOnLattice(mesh, h.lattice, {});
  if (!placed) return std::unexpected(placed.error());
  HistoryLevels levels(h);
  levels.moveTo(levels.finest());
  const std::vector<Tetrahedron> cells(h.cells.begin(), h.cells.begin() + history->tetrahedra);
  levels.moveTo(0);
  const Result<MeshMatch> match =
      matchMesh(placed->mesh, std::span(h.points).first(history->vertices), cells);
  if (!match) return std::unexpected(match.error());

  AddedFields out;
  for (const MeshField& field : mesh.fields) {
    Result<QuantisedField> quantised = quantiseField(field, options.fieldBits);
    if (!quantised) return std::unexpected(quantised.error());
    const FieldInfo& info = quantised->info;
    if (quantised->nonFinite > 0)
      fillMissing(mesh.tetrahedra, info, quantised->missing, quantised->values);
    const std::vector<std::uint32_t>& logs = isCellField(info) ? match->tetrahedra : match->points;
    std::vector<std::int32_t> values = inLogOrder(quantised->values, info.components, logs);
    if (!isCellField(info)) values = fusedValues(*history, std::move(values), info.components);
    const std::vector<std::int32_t> completed =
        quantised->missing.empty()
            ? values
            : withMissing(h, info, inLogOrder(quantised->missing, info.components, logs), values);
    Result<std::vector<Bytes>> blocks = encodeFieldBlocks(*history, info, completed);
    if (!blocks) return std::unexpected(blocks.error());
    if (quantised->nonFinite > 0)
      out.notes.push_back("field " + info.name + ": " + std::to_string(quantised->nonFinite) +
                          " values are NaN or infinite and come back as NaN");
    out.fields.push_back({{info.name, info.components, info.type, info.association, info.bits,
                           info.step, info.minimum, info.range, info.hasMissing},
                          std::move(*blocks),
                          {}});
    h.fields.push_back(info);
    h.values.push_back(std::move(values));
  }
  MeasureOptions measure;
  for (const ManifestLevel& level : manifest->levels)
    measure.levels.push_back(level.error.has_value());
  if (std::ranges::count(measure.levels, 1) == 0) return out;
  measure.effort = options.effort;
  measure.countsRounding = true;
  measure.threads = options.threads;
  measure.progress = [&](double fraction) {
    if (options.progress) options.progress((1 + fraction) / 2);
  };
  const Result<LevelErrors> errors = measureLevels(h, measure);
  if (!errors) return std::unexpected(errors.error());
  for (std::size_t f = 0; f < out.fields.size(); ++f)
    for (const std::optional<LevelError>& level : *errors)
      out.fields[f].errors.push_back(level ? level->fields[f] : FieldError());
  return out;
}

}  // namespace qtet
