#include <limits>
#include <sstream>

#include "proto/limits.h"
#include "proto/utf8.h"
#include "simplify/commands/commands.h"
#include "simplify/log/opened_list.h"
#include "simplify/parts/metis_partition.h"
#include "simplify/produce/made_log_report.h"
#include "simplify/produce/simplified_list.h"
#include "simplify/produce/simplified_log.h"
#include "simplify/read/listed_files.h"
#include "simplify/words/byte_count.h"
#include "simplify/words/error_words.h"
#include "simplify/words/field_names.h"
#include "simplify/words/fusion_words.h"
#include "simplify/words/json_report.h"
#include "simplify/words/measure_words.h"
#include "simplify/words/parsed_words.h"
#include "simplify/words/progress.h"
#include "simplify/words/read_words.h"

namespace qtet {
namespace {

CodecId valueCodecOf(const std::string& name) {
  if (name == "lifted") return CodecId::kLifted;
  if (name == "draco") return CodecId::kDraco;
  if (name == "adaptive") return CodecId::kAdaptive;
  throw UsageError("--value-codec '" + name + "' is not known; give lifted, draco or adaptive");
}

Algorithm algorithmOf(const std::string& name) {
  if (name == "qtet") return Algorithm::kQtet;
  if (name == "paper") return Algorithm::kPaper;
  throw UsageError("--algorithm '" + name + "' is not known; give qtet or paper");
}

/// NAME=UNIT of each --unit, and --time-unit under the empty name. Throws UsageError.
Units unitsOf(const ParsedWords& parsed) {
  Units out;
  const auto add = [&](const std::string& option, std::string name, std::string unit) {
    if (unit.empty() || unit.size() > kMaxUnitBytes || !isUtf8(unit))
      throw UsageError(option + ": a unit is a text of 1 to " + std::to_string(kMaxUnitBytes) +
                       " bytes of UTF-8, such as K or m/s");
    if (!out.emplace(std::move(name), std::move(unit)).second)
      throw UsageError(option + ": this field has a unit already");
  };
  if (parsed.has("unit"))
    for (const std::string& text : parsed.get<std::vector<std::string>>("unit")) {
      const std::size_t equals = text.rfind('=');
      if (equals == std::string::npos || equals == 0)
        throw UsageError("--unit '" + text + "' is no field's name and its unit such as T=K");
      add("--unit '" + text + "'", text.substr(0, equals), text.substr(equals + 1));
    }
  if (parsed.has("time-unit")) add("--time-unit", "", parsed.get<std::string>("time-unit"));
  return out;
}

/// The input's name without its folder; a folder's own name, also that of ".".
std::string sourceOf(const std::filesystem::path& input) {
  std::error_code code;
  const std::filesystem::path path = std::filesystem::is_directory(input, code)
                                         ? std::filesystem::weakly_canonical(input, code)
                                         : input.lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

SimplifyRequest requestOf(const ParsedWords& parsed, const Output& output) {
  SimplifyRequest request;
  request.read = readOptionsOf(parsed);
  request.input = inputOf(parsed, request.read);
  request.output = output.name();
  PipelineOptions& options = request.pipeline;
  options.source = sourceOf(request.input);
  options.algorithm = algorithmOf(parsed.get<std::string>("algorithm"));
  request.read.fields = parseFieldNames(parsed.get<std::string>("fields"));
  options.quantise.positionBits =
      parsed.integer("position-bits", kMinPositionBits, kMaxPositionBits);
  options.quantise.fieldBits = parsed.integer("field-bits", kMinFieldBits, kMaxFieldBits);
  options.quantise.errors = valueBoundsOf(parsed);
  takeFusionOptions(parsed, options);
  if (Status checked = checkOptions(options); !checked)
    throw UsageError(withOptionNames(checked.error().message));
  options.measure = measureOptionsOf(parsed);
  options.units = unitsOf(parsed);
  options.valueCodec = valueCodecOf(parsed.get<std::string>("value-codec"));
  options.exactCoarse = parsed.has("exact-coarse");
  if (parsed.has("finest"))
    options.finest =
        static_cast<std::size_t>(parsed.integer("finest", 1, std::numeric_limits<int>::max()));
  if (parsed.has("memory")) {
    const std::string text = parsed.get<std::string>("memory");
    options.memory = parseByteCount(text);
    if (!options.memory || *options.memory < kLeastMemory)
      throw UsageError("--memory '" + text + "' is no size of at least 1G, such as 4G or 1500M");
    if (!options.finest) options.finest = finestWithin(*options.memory);
  }
  if (parsed.has("parts")) {
    options.parts = PartsOptions{.partition = metisPartitioner()};
    if (!options.parts->partition)
      throw UsageError(
          "--parts needs METIS, which this program was built without; leave it out, or "
          "take the program of the Debian package qtet");
  }
  request.read.originalIds = parsed.has("original-ids");
  options.timeStatistics = parsed.has("time-statistics");
  if (options.timeStatistics && isSegmentList(request.output))
    throw UsageError(
        "--time-statistics needs values of all steps at the same points, which a list of logs does "
        "not have; give -o NAME.qtet, or leave it out");
  request.read.keepsNumbers = parsed.has("lossless");
  options.keep = {parsed.has("keep-order"), parsed.has("lossless"), request.read.originalIds};
  return request;
}

CommandHelp simplifyHelp() {
  return {"simplify",
          "simplify IN... -o OUT.qtet|OUT.json [options]",
          R"(Reads a volume mesh with its fields (.vtu, .vtk, .msh, Exodus, EnSight, CGNS, ...:
simplify/INPUT.md has them all), splits its cells into tetrahedra, cleans them, simplifies them
level by level and writes the log, from which every level and the whole mesh come back.
Numbered files (several names, a pattern in quotes, a folder) are the steps of one series.
A series whose cells change becomes a list of logs (experimental), NAME.json with NAME.0.DIGEST.qtet
and so on.)",
          R"(  qtet simplify fin.vtu -o fin.qtet
  qtet simplify fin.vtu -o fin.qtet --fields Density,Velocity --error all=0.1% --json
  qtet simplify ogrid.xyz --plot3d ogrid.q --weld 0 -o ogrid.qtet
  qtet simplify run.pvd --time all -o run.qtet
  qtet simplify step_*.vtu --time all -o run.qtet
  qtet simplify remeshed.pvd --time all -o remeshed.json
)",
          {{"input", {"format", "times", "curved", "weld", "threshold", "plot3d", "read-seconds"}},
           {"fields",
            {"error", "field-bits", "field-weight", "label-weight", "time-statistics", "unit",
             "time-unit"}},
           {"quality and base mesh",
            {"target-ratio", "base-cells", "base-error", "max-boundary-error", "envelope-tolerance",
             "placement", "shape-weight", "preserve-regions", "position-bits"}},
           {"output", {"value-codec", "keep-order", "original-ids", "measure"}},
           {"rare", {"algorithm", "exact-coarse", "finest", "memory", "parts"}}}};
}

}  // namespace

int runSimplify(const Words& words, Console& console) {
  po::options_description options("options");
  options.add_options()(
      "output,o", po::value<std::string>(),
      "required: NAME.qtet, the log; NAME.json, the list of logs of a series; or - for the log "
      "on the standard output")(
      "algorithm", po::value<std::string>()->default_value("qtet"),
      "qtet, or paper: the paper's own loop, tetrahedra only, which ends near half of the cells")(
      "fields", po::value<std::string>()->default_value("all"), kFieldsHelp)(
      "position-bits", po::value<int>()->default_value(16),
      "bits of the lattice an axis, 4 to 28; raised where a cell would be flattened or inverted")(
      "field-bits", po::value<int>()->default_value(12),
      "bits of a float field's values, 1 to 28; integer fields are stored exactly")(
      "time-statistics",
      "experimental, of each series: its average, least, largest and standard deviation over all "
      "instants, as "
      "the fields NAME_average, NAME_minimum, NAME_maximum and NAME_stddev")(
      "unit", po::value<std::vector<std::string>>(),
      "NAME=UNIT: the unit of a field or of a series, for the legend, plots and tables; may be "
      "given several times. Names such as \"T [K]\" have theirs")(
      "time-unit", po::value<std::string>(), "the unit of times")(
      "value-codec", po::value<std::string>()->default_value("lifted"),
      "how values are coded: lifted is smallest (positions by Draco), draco is quickest to decode, "
      "adaptive is a coder of our own for positions too")(
      "finest", po::value<int>(),
      "experimental: the last level has at most so many tetrahedra, to which the mesh is reduced "
      "before; the errors of all levels are against the input")(
      "memory", po::value<std::string>(),
      "experimental: the bytes that may be used, such as 4G. A .vtu or .pvtu file is read in "
      "pieces "
      "then, and the log ends at as many tetrahedra as fit, unless --finest says how many")(
      "parts",
      "experimental: simplify a mesh of over a million cells in parts, each of which a thread "
      "takes; the log does not depend on the number of threads")(
      "exact-coarse",
      "coarse levels keep the best values of their fields, which takes up to a third more for "
      "errors some 2 % smaller")("keep-order",
                                 "keep the input's numbering of points, cells and their vertices: "
                                 "extract gives it back at the last level")(
      "lossless",
      "keep the input's own coordinates and field values: extract gives them back bit for bit at "
      "the last level")("original-ids",
                        "keep which cell of the input each tetrahedron was split from: extract "
                        "gives it back at the last level as the cell field OriginalCellId; implies "
                        "--keep-order")("json", "print one JSON object");
  addNoClobber(options);
  addReadOptions(options);
  addTimesOption(options);
  addErrorOption(options);
  addFusionOptions(options);
  addMeasureOptions(options);
  const ParsedWords parsed(words, simplifyHelp(), options, {"IN..."});
  if (parsed.helped(console)) return kExitOk;
  const Output output = outputOf(parsed, console);
  SimplifyRequest request = requestOf(parsed, output);
  const bool asJson = parsed.has("json");
  if (Status checked = checkOutput(output, ".qtet .json", request.input); !checked)
    return reportFailure(checked.error(), asJson, console);
  // once, since a long series is read in many parts
  Result<ReadOptions> listed = withListedFiles(request.input, request.read);
  if (!listed) return reportFailure(listed.error(), asJson, console);
  request.read = std::move(*listed);

  Progress progress(console);
  const Result<OrderedJson> report = isSegmentList(request.output)
                                         ? makeList(request, progress)
                                         : makeLog(request, output, progress);
  progress.clear();
  if (!report) return reportFailure(report.error(), asJson, console);
  for (const OrderedJson& note : (*report)["notes"]) console.note(note.get<std::string>());
  std::ostringstream lines;
  isSegmentList(request.output) ? printMadeList(*report, lines) : printMadeLog(*report, lines);
  asJson ? printJson(*report, console) : reportOutput(output, lines.str(), console);
  for (const OrderedJson& warning : (*report)["warnings"]) console.warn(warning.get<std::string>());
  return kExitOk;
}

}  // namespace qtet
