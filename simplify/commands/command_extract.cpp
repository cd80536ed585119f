#include <algorithm>
#include <iterator>
#include <utility>

#include "simplify/commands/commands.h"
#include "simplify/commands/extract_choice.h"
#include "simplify/log/opened_list.h"
#include "simplify/produce/extract_times.h"
#include "simplify/produce/extracted_level.h"
#include "simplify/produce/instant_collection.h"
#include "simplify/read/options/time_steps.h"
#include "simplify/words/field_names.h"
#include "simplify/words/json_report.h"
#include "simplify/words/parsed_words.h"

namespace qtet {
namespace {

/// The keys of --fields. Throws UsageError.
auto wantedFields(const ParsedWords& parsed) {
  return parseFieldNames(parsed.get<std::string>("fields"));
}

/// Throws UsageError where one file would hold several instants.
void checkCount(std::size_t instants, const std::string& asked, const MeshOutput& output) {
  if (instants > 1 && !isCollection(output))
    throw UsageError("--time " + asked + " means " + std::to_string(instants) +
                     " instants; -o NAME.pvd writes a file of each");
}

std::vector<InstantFile> oneFile(const std::vector<ManifestField>& known,
                                 const std::vector<std::uint32_t>& wanted) {
  InstantFile all;
  for (const std::uint32_t f : wanted) all.fields.push_back({f, known[f].name, false});
  return {std::move(all)};
}

/// The files that `--time` and the output's kind ask for.
Result<std::vector<InstantFile>> filesOf(const ParsedWords& parsed, const MeshOutput& output,
                                         const Instants& instants,
                                         std::vector<std::string>& notes) {
  const std::string asked = parsed.has("time") ? parsed.get<std::string>("time") : "all";
  auto files = instantFiles(instants, asked, parsed.get<std::string>("LOG"), notes);
  if (files) checkCount(files->size(), asked, output);
  return files;
}

/// The one file of an output, or those of a collection.
class Written {
 public:
  explicit Written(const MeshOutput& output) : output_(output), collection_(output.file) {}

  [[nodiscard]] FileTaker taker() {
    return [this](const InstantFile& file, Bytes&& bytes) -> Status {
      if (isCollection(output_)) return collection_.add(file.time, bytes);
      one_ = std::move(bytes);
      return {};
    };
  }
  [[nodiscard]] Status finish(MeshOutputReport& report, Console& console) {
    if (!isCollection(output_)) return writeMeshOutput(output_, one_, report, console);
    if (Status s = collection_.finish(); !s) return s;
    report.json["files"] = collection_.filesJson();
    report.sentence += ", " + collection_.sentence();
    reportMeshOutput(output_, collection_.bytes(), report, console);
    return {};
  }

 private:
  const MeshOutput& output_;
  InstantCollection collection_;
  Bytes one_;
};

/// The report on files of several logs of a list.
MeshOutputReport joined(const std::vector<MeshOutputReport>& reports, const std::string& list) {
  if (reports.size() == 1) {
    MeshOutputReport out = reports.front();
    out.sentence += " of " + out.json["log"].get<std::string>();
    return out;
  }
  MeshOutputReport out{counted(reports.size(), "log", "logs") + " of " + list,
                       {{"segments", OrderedJson::array()}}};
  for (const MeshOutputReport& report : reports) out.json["segments"].push_back(report.json);
  return out;
}

/// The times of a segment among those that are asked for, which ascend.
std::vector<double> timesIn(const Segment& segment, const std::vector<double>& asked) {
  std::vector<double> out;
  std::ranges::set_intersection(segment.times, asked, std::back_inserter(out));
  return out;
}

/// The times of the list that `--time` means.
Result<std::vector<double>> askedTimes(const ParsedWords& parsed, const SegmentList& list,
                                       const std::string& input, const MeshOutput& output,
                                       std::vector<std::string>& notes) {
  if (!parsed.has("time") && !isCollection(output))
    throw UsageError(
        "a list has a mesh for each of its logs; give --time T, or all of them with -o NAME.pvd");
  const std::string asked = parsed.has("time") ? parsed.get<std::string>("time") : "all";
  const std::vector<double> times = list.times();
  const auto steps = chosenSteps(times, asked, input, notes);
  if (!steps) return std::unexpected(steps.error());
  checkCount(steps->size(), asked, output);
  std::vector<double> out;
  for (const std::size_t step : *steps) out.push_back(times[step]);
  return out;
}

Result<MeshOutputReport> extractList(const ParsedWords& parsed, const std::string& input,
                                     const MeshOutput& output, const FileTaker& take,
                                     std::vector<std::string>& notes) {
  const Result<SegmentList> list = openList(input);
  if (!list) return std::unexpected(list.error());
  const auto asked = askedTimes(parsed, *list, input, output, notes);
  if (!asked) return std::unexpected(asked.error());
  std::vector<MeshOutputReport> reports;
  for (const Segment& segment : list->segments) {
    const std::vector<double> times = timesIn(segment, *asked);
    if (times.empty()) continue;
    const Result<OpenedLog> log = openSegment(input, segment);
    if (!log) return std::unexpected(log.error());
    const auto choose = [&](const auto& known, const auto& wanted) {
      return Result<std::vector<InstantFile>>(
          segmentFiles(Instants(known, wanted, seriesOf(known, 1)), times));
    };
    Result<MeshOutputReport> report = extractLevel(*log, levelOfSegment(parsed, *log, times),
                                                   {output, wantedFields(parsed), choose, take});
    if (!report) return report;
    report->json["log"] = segment.log;
    report->json["times"] = times;
    reports.push_back(std::move(*report));
  }
  return joined(reports, input);
}

Result<MeshOutputReport> extractOne(const ParsedWords& parsed, const std::string& input,
                                    const MeshOutput& output, const FileTaker& take,
                                    std::vector<std::string>& notes) {
  const Result<OpenedLog> log = openLog(input);
  if (!log) return std::unexpected(log.error());
  const auto choose = [&](const auto& known,
                          const auto& wanted) -> Result<std::vector<InstantFile>> {
    if (!parsed.has("time") && !isCollection(output)) return oneFile(known, wanted);
    return filesOf(parsed, output, Instants(known, wanted, log->manifest.series), notes);
  };
  return extractLevel(*log, chosenLevel(parsed, *log),
                      {output, wantedFields(parsed), choose, take});
}

Status extract(const ParsedWords& parsed, Console& console) {
  const auto input = parsed.get<std::string>("LOG");
  const Result<MeshOutput> output =
      meshOutputOf(parsed, input, std::string(kWrittenEndings) + " " + kCollection);
  if (!output) return std::unexpected(output.error());
  if (output->isStandardOutput && isCollection(*output))
    throw UsageError(
        "a .pvd names other files, which the standard output cannot hold; give -o NAME.pvd");
  Written written(*output);
  std::vector<std::string> notes;
  Result<MeshOutputReport> report =
      isSegmentList(input) ? extractList(parsed, input, *output, written.taker(), notes)
                           : extractOne(parsed, input, *output, written.taker(), notes);
  if (!report) return std::unexpected(report.error());
  // that the last was taken is known where it was asked for
  if (!parsed.has("time") || timeWord(parsed.get<std::string>("time")) != "last")
    for (const std::string& note : notes) console.note(note);
  report->json["input"] = input;
  return written.finish(*report, console);
}

CommandHelp extractHelp() {
  return {"extract",
          R"(extract LOG.qtet|LIST.json (--level K | --tets N | --ratio R | --error NAME=E
| --boundary-error E) [--time T] -o OUT)",
          R"(Writes one level of a log as an ordinary mesh: with its cells as .vtu, .vtk, .msh (Gmsh
2.2) or .usda (OpenUSD), its boundary as .obj, .glb (glTF with Draco) or .drc.
.obj holds no fields, .glb and .drc hold those of points.
NAME.pvd (ParaView) names a .vtu for each instant of the log's series, in a new folder NAME.
Where no level is small enough it is level 0.
A list of logs, NAME.json, gives the mesh of the log that has the time T.
Each log chooses a level of its own. A list needs --time unless the output is a .pvd.
Its --error takes the name without a time, and holds at each of the chosen times.
The last level is the input's mesh, with its own numbering and numbers where the log was made
with --keep-order and --lossless.
Errors are those that the log tells, measured when it was made (qtet info shows them).
--json: output, kind, bytes, level, levels, tetrahedra, vertices and boundaryTriangles of the level,
fields [{name, association, components, type}] that the file holds, error as in qtet info with the
same fields, input; of a .pvd also files [{time, file}]; of a list also log and times, or for a .pvd
of several logs segments, an array of these.)",
          R"(  qtet extract fin.qtet --ratio 0.1 -o coarse.vtu
  qtet extract fin.qtet --error Density=0.01 -o near.vtu
  qtet extract fin.qtet --tets 20000 --fields Density -o skin.glb
  qtet extract wake.qtet --tets 50000 --time 0:1 -o wake.pvd
  qtet extract remeshed.json --ratio 0.1 --time 0.3 -o later.vtu
  curl -sL http://HOST/v1/meshes/fin/log | qtet extract - --ratio 0.1 --to vtu -o - >c.vtu
)"};
}

}  // namespace

int runExtract(const Words& words, Console& console) {
  po::options_description options("options");
  addMeshOutputOptions(options);
  options.add_options()("level", po::value<int>(), "this level; 0 is the base mesh")(
      "tets", po::value<double>(), "the finest level with at most so many tetrahedra")(
      "ratio", po::value<double>(),
      "the finest level with at most this fraction of all tetrahedra, 0 to 1")(
      "error", po::value<std::string>(),
      "NAME=E: the coarsest level at which this field's rms error is at most E, a fraction of its "
      "range, or of a label's volume; cell:NAME where a point field has the same name")(
      "boundary-error", po::value<double>(),
      "the coarsest level whose boundary is nowhere further than this from the original's, as a "
      "fraction of the diagonal")("fields", po::value<std::string>()->default_value("all"),
                                  kFieldsHelp)(
      "time", po::value<std::string>(),
      "of series, whose instants are fields NAME@TIME: those of one time, first or last, called "
      "NAME; all, or FROM:TO:EVERY, every so many between two times, with -o NAME.pvd; without it "
      "all instants are fields of one file");
  const ParsedWords parsed(words, extractHelp(), options, {"LOG"});
  if (parsed.helped(console)) return kExitOk;
  const auto given = static_cast<int>(parsed.has("level")) + parsed.has("tets") +
                     parsed.has("ratio") + parsed.has("error") + parsed.has("boundary-error");
  if (given != 1)
    throw UsageError("give exactly one of --level, --tets, --ratio, --error and --boundary-error");

  const Status done = extract(parsed, console);
  return done ? kExitOk : reportFailure(done.error(), parsed.has("json"), console);
}

}  // namespace qtet
