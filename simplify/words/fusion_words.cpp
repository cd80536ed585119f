#include "simplify/words/fusion_words.h"

#include <limits>

#include "simplify/mesh/workers.h"
#include "simplify/words/measure_words.h"

namespace qtet {
namespace {

constexpr int kMaxThreads = 1024;

// Weights beyond are words gone wrong: what counts a million times as much as the rest decides
// alone.
constexpr double kMaxWeight = 1e6;
constexpr double kMaxBoundaryWeight = 1e9;

PlacementRule placementRuleOf(const std::string& name) {
  if (name == "optimal") return PlacementRule::kOptimal;
  if (name == "vertex") return PlacementRule::kVertex;
  if (name == "auto") return PlacementRule::kAuto;
  throw UsageError("--placement '" + name + "' is not known; give optimal, vertex or auto");
}

std::vector<std::pair<std::string, double>> namedWeights(const ParsedWords& parsed,
                                                         const std::string& option,
                                                         const std::string& example) {
  std::vector<std::pair<std::string, double>> out;
  if (!parsed.has(option)) return out;
  for (const std::string& text : parsed.get<std::vector<std::string>>(option)) {
    out.push_back(
        parseNamedNumber(option, text, "a field's name and its weight such as " + example));
    if (out.back().second > kMaxWeight)
      throw UsageError("--" + option + " '" + text + "' is above 1,000,000");
  }
  return out;
}

}  // namespace

void addFusionOptions(po::options_description& options) {
  options.add_options()("target-ratio", po::value<double>(),
                        "stop when the base mesh has this fraction of the tetrahedra; without, "
                        "--base-error chooses, from 0.01 and 500 tetrahedra upwards")(
      "base-cells", po::value<int>(), "stop when the base mesh has so many tetrahedra")(
      "boundary-weight", po::value<double>(),
      "what the boundary's place counts beside the fields: 0 to 1 for the fields first, 4,000 to "
      "40,000 for the shape first; without, a weight from 0.05 to 200 by how "
      "smooth the fields and the boundary are, which the report tells")(
      "field-weight", po::value<std::vector<std::string>>(),
      "NAME=W: what the field's error over its range counts, 1 for others; 0 leaves it out; may be "
      "given for several fields; without, the smoother a field the more it counts, 8 at most")(
      "label-weight", po::value<std::vector<std::string>>(),
      "NAME=W: what the interfaces of a cell field of integers, such as materials, count beside "
      "the "
      "fields; without, as the boundary by a weight of the mesh's; 0 leaves them out")(
      "shape-weight", po::value<double>()->default_value(FusionOptions().shapeWeight, "0.5"),
      "what badly shaped new cells cost: 0 for the least error, 1 and more for rounder cells")(
      "placement", po::value<std::string>()->default_value("auto"),
      "where fused vertices go: optimal (least error a cell), vertex (only where vertices were: "
      "fewest bits a cell), or auto (least error a byte)")(
      "envelope-tolerance", po::value<double>(),
      "how far the solid may leave the original one, as a fraction of the diagonal; 0.005 without, "
      "which keeps the volume of thin parts; 0: each level is part of the finer one")(
      "preserve-regions", po::value<std::string>(),
      "a cell field of one component whose values are regions such as tissues or materials: they "
      "and their interfaces keep their topology")(
      "threads", po::value<int>()->default_value(1),
      "threads, as many as there are processors at most; the result does not depend on it");
}

void takeFusionOptions(const ParsedWords& parsed, PipelineOptions& out) {
  FusionOptions& fusion = out.fusion;
  if (parsed.has("target-ratio") && parsed.has("base-cells"))
    throw UsageError("give --target-ratio or --base-cells, not both");
  if (parsed.has("target-ratio")) fusion.targetRatio = parsed.number("target-ratio", 0, 1);
  if (parsed.has("base-cells"))
    fusion.baseCells =
        static_cast<std::size_t>(parsed.integer("base-cells", 1, std::numeric_limits<int>::max()));
  if (parsed.has("boundary-weight"))
    fusion.cost.boundaryWeight = parsed.number("boundary-weight", 0, kMaxBoundaryWeight);
  fusion.shapeWeight = parsed.number("shape-weight", 0, kMaxWeight);
  fusion.placement = placementRuleOf(parsed.get<std::string>("placement"));
  if (parsed.has("envelope-tolerance"))
    fusion.envelopeTolerance = parsed.number("envelope-tolerance", 0, 1);
  fusion.threads = threadsAtOnce(parsed.integer("threads", 1, kMaxThreads));
  out.fieldWeights = namedWeights(parsed, "field-weight", "Density=2");
  out.labelWeights = namedWeights(parsed, "label-weight", "Material=1");
  if (parsed.has("preserve-regions")) out.regions = parsed.get<std::string>("preserve-regions");
}

}  // namespace qtet
