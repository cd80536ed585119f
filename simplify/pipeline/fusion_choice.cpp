#include "simplify/pipeline/fusion_choice.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>

#include "proto/field_key.h"
#include "proto/number_text.h"
#include "simplify/clean/quantise_field.h"
#include "simplify/cost/cost_parts.h"
#include "simplify/cost/field_weights.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {
namespace {

/// Cells of a base mesh at least where nothing else is asked for. They take 2 kB, and fewer are no
/// picture of a part.
constexpr std::size_t kMinBaseCells = 500;

/// The fields of one association that a name means.
std::vector<std::uint32_t> meantBy(const std::string& name, bool ofCells,
                                   std::span<const FieldInfo> fields) {
  std::vector<std::uint32_t> meant = fieldsOfKey(fields, name);
  std::erase_if(meant, [&](std::uint32_t f) { return isCellField(fields[f]) != ofCells; });
  return meant;
}

/// The weights given by name, one a field.
Result<std::vector<std::optional<double>>> namedWeights(const PipelineOptions& options,
                                                        std::span<const FieldInfo> fields) {
  std::vector<std::optional<double>> named(fields.size());
  for (const auto& [name, weight] : options.fieldWeights) {
    const std::vector<std::uint32_t> meant = meantBy(name, false, fields);
    if (meant.empty())
      return fail(ErrorCode::kNotFound,
                  "`fieldWeights`: the mesh carries no point field '" + name + "'");
    for (const std::uint32_t f : meant) named[f] = weight;
  }
  return named;
}

/// Why a field does not count, or nothing.
std::string whyNot(const MeshFigures& mesh, std::size_t f, bool isNamed) {
  const FieldInfo& info = mesh.fields()[f];
  if (mesh.isOneValue()[f]) {
    if (info.range[0] == info.range[1]) return "is constant";
    return "varies by less than its step, " + roundedText(info.step) +
           ", and is stored as one value" +
           (info.step > kFinestFieldStep ? " (more `fieldBits` make a finer step)" : "");
  }
  if (!isFloatType(info.type) && !isNamed)
    return "is one of integers, which may be labels (`fieldWeights` " + info.name +
           "=1 makes it count)";
  return {};
}

/// One a field, 1 where nobody says otherwise.
std::vector<double> weightsOf(const MeshFigures& mesh,
                              const std::vector<std::optional<double>>& named,
                              std::vector<std::string>& notes) {
  const std::span<const FieldInfo> fields = mesh.fields();
  std::vector<double> weights(fields.size(), 0);
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (isCellField(fields[f]) || named[f] == 0) continue;
    const std::string why = whyNot(mesh, f, named[f].has_value());
    if (why.empty()) {
      weights[f] = named[f].value_or(1);
    } else {
      notes.push_back("field " + fields[f].name + " " + why +
                      ": it does not count when cells are fused");
    }
  }
  return weights;
}

/// The weights of fields and boundary that nobody has given.
Status balance(const MeshFigures& mesh, bool areFieldsNamed, CostOptions& cost) {
  if (areFieldsNamed && cost.boundaryWeight) return {};
  const std::vector<CostPart> equal =
      costPartsOf(mesh.fields(), mesh.isOneValue(), cost.fieldWeights);
  std::vector<double> errors = mesh.fieldErrors(equal);
  if (!areFieldsNamed) cost.fieldWeights = balancedFieldWeights(mesh.fields(), equal, errors);
  if (cost.boundaryWeight) return {};
  const std::vector<CostPart> parts =
      costPartsOf(mesh.fields(), mesh.isOneValue(), cost.fieldWeights);
  assert(parts.size() == equal.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double scale = parts[i].scale / equal[i].scale;
    errors[i] *= scale * scale;
  }
  const Result<double> weight = mesh.boundaryWeight(parts, errors);
  if (!weight) return std::unexpected(weight.error());
  cost.boundaryWeight = *weight;
  return {};
}

/// The labels' numbers: those found, those named, and the regions.
Result<std::map<std::size_t, std::optional<double>>> namedLabels(
    const PipelineOptions& options, const MeshFigures& mesh,
    const std::optional<std::size_t>& regions) {
  std::map<std::size_t, std::optional<double>> out;
  for (const std::size_t f : mesh.labels().labels()) out.emplace(f, std::nullopt);
  if (regions) out.emplace(*regions, std::nullopt);
  for (const auto& [name, weight] : options.labelWeights) {
    const std::vector<std::uint32_t> meant = meantBy(name, true, mesh.fields());
    if (meant.empty())
      return fail(ErrorCode::kNotFound,
                  "`labelWeights`: the mesh carries no cell field '" + name + "'");
    bool isFirst = true;  // of a series: its others follow
    for (const std::uint32_t f : meant) {
      if (weight == 0) {
        if (f != regions) out.erase(f);
        continue;
      }
      if (!mesh.labels().canBe(f))
        return fail(ErrorCode::kBadInput,
                    "`labelWeights`: '" + name +
                        "' is no label: that takes a cell field of one component of 2 to " +
                        std::to_string(kMaxLabelValues) + " integers");
      out[f] = isFirst ? std::optional(weight) : std::nullopt;
      isFirst = false;
    }
  }
  return out;
}

/// The weight of each label. Equal instants of a series would count the same faces
/// again and again: its first one stands for it.
std::vector<LabelCost> labelCosts(std::span<const FieldInfo> fields, double boundaryWeight,
                                  const std::map<std::size_t, std::optional<double>>& labels) {
  std::vector<LabelCost> out;
  std::set<std::string_view> series;
  for (const auto& [field, named] : labels) {
    const auto name = fields[field].name.instant();
    const bool isLater = name && !series.insert(name->series).second;
    out.push_back({field, named.value_or(isLater ? 0 : labelWeightBeside(boundaryWeight))});
  }
  return out;
}

Result<std::size_t> regionFieldOf(const std::string& name, std::span<const FieldInfo> fields) {
  const std::vector<std::uint32_t> meant = meantBy(name, true, fields);
  if (meant.size() == 1) return meant.front();
  return fail(
      ErrorCode::kNotFound,
      "`regions`: the mesh carries " +
          std::string(meant.empty() ? "no cell field '" : "several steps of the cell field '") +
          name + (meant.empty() ? "'; see that `fields` includes it" : "'; name one, NAME@TIME"));
}

}  // namespace

Result<FusionOptions> fusionOptionsFor(const PipelineOptions& options, const MeshFigures& mesh,
                                       std::vector<std::string>& notes) {
  const auto named = namedWeights(options, mesh.fields());
  if (!named) return std::unexpected(named.error());
  FusionOptions out = options.fusion;
  if (!out.targetRatio && !out.baseCells)
    out.baseCells = std::max(baseCellsOf(out, mesh.tetrahedra()), kMinBaseCells);
  out.cost.fieldWeights = weightsOf(mesh, *named, notes);
  if (Status s = balance(mesh, !options.fieldWeights.empty(), out.cost); !s)
    return std::unexpected(s.error());
  if (options.regions) {
    const Result<std::size_t> field = regionFieldOf(*options.regions, mesh.fields());
    if (!field) return std::unexpected(field.error());
    out.regionField = *field;
  }
  const auto labels = namedLabels(options, mesh, out.regionField);
  if (!labels) return std::unexpected(labels.error());
  out.cost.labels = labelCosts(mesh.fields(), *out.cost.boundaryWeight, *labels);
  if (options.algorithm == Algorithm::kPaper)
    for (LabelCost& label : out.cost.labels) label.weight = 0;
  return out;
}

}  // namespace qtet
