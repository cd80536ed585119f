#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "codec/log/target_choice.h"
#include "proto/field_key.h"
#include "proto/level_error_json.h"
#include "proto/series.h"
#include "simplify/commands/command_measure.h"
#include "simplify/commands/extract_times.h"
#include "simplify/commands/instant_collection.h"
#include "simplify/log/kept_input.h"
#include "simplify/log/opened_list.h"
#include "simplify/log/write_mesh.h"
#include "simplify/read/options/time_steps.h"
#include "simplify/split/split_cells.h"

namespace qtet {
namespace {

Target targetOf(const ParsedWords& parsed, const Manifest& manifest) {
  const auto cells = [](double most) { return TetrahedraTarget{static_cast<std::uint64_t>(most)}; };
  if (parsed.has("error")) {
    auto [field, error] = parseNamedError("error", parsed.get<std::string>("error"));
    return FieldErrorTarget{error, std::move(field)};
  }
  if (parsed.has("boundary-error"))
    return BoundaryErrorTarget{parsed.number("boundary-error", 0, 1)};
  if (parsed.has("tets")) return cells(parsed.number("tets", 0, 1e18));
  return cells(parsed.number("ratio", 0, 1) * manifest.levels.back().tetrahedra);
}

/// `--level` is not a target: a level that does not exist is an error.
Result<std::uint32_t> chosenLevel(const ParsedWords& parsed, const Manifest& manifest,
                                  const LogIndex& index) {
  if (parsed.has("level"))
    return static_cast<std::uint32_t>(parsed.integer("level", 0, std::numeric_limits<int>::max()));
  return levelFor(targetOf(parsed, manifest), manifest, index);
}

/// The fields of a segment that NAME of `--error` means at these times: those of points if there
/// are some, and also those without time. Throws UsageError where NAME has a time.
std::vector<std::uint32_t> fieldsAt(const Manifest& manifest, const std::string& name,
                                    const std::vector<double>& times) {
  if (instantName(name))
    throw UsageError("--error " + name +
                     " has a time; for a list give the field's name alone, and --time T");
  const std::vector<double> instants = instantTimes(manifest);
  std::vector<std::uint32_t> out = fieldsOfKey(manifest.fields, name);
  std::erase_if(out, [&](std::uint32_t f) {
    const auto instant = instantName(manifest.fields[f].name);
    return instant && std::ranges::none_of(times, [&](double time) {
             const auto place = placeOfTime(instants, time);
             return place && instants[*place] == instant->time;
           });
  });
  const auto isOfPoints = [&](std::uint32_t f) {
    return manifest.fields[f].association == "point";
  };
  if (std::ranges::any_of(out, isOfPoints)) std::erase_if(out, std::not_fn(isOfPoints));
  return out;
}

/// A level of a list's log for some of its times. Errors of fields hold at each of these.
Result<std::uint32_t> levelOfSegment(const ParsedWords& parsed, const OpenedLog& log,
                                     const std::vector<double>& times) {
  if (!parsed.has("error")) return chosenLevel(parsed, log.manifest, log.file.index());
  const auto [name, error] = parseNamedError("error", parsed.get<std::string>("error"));
  const std::vector<std::uint32_t> fields = fieldsAt(log.manifest, name, times);
  if (fields.empty()) return std::unexpected(noSuchField(log.manifest, name));
  return levelOfFieldErrors(error, fields, log.manifest);
}

// ---- a mesh of either kind with some of its fields

struct LatticeField {
  FieldInfo info;
  std::vector<std::int32_t> values;
};

std::vector<LatticeField> takeFields(LatticeMesh& mesh) {
  std::vector<LatticeField> out;
  for (std::size_t f = 0; f < mesh.fields.size(); ++f)
    out.push_back({std::move(mesh.fields[f]), std::move(mesh.values[f])});
  mesh.fields.clear(), mesh.values.clear();
  return out;
}

std::vector<MeshField> takeFields(TetMesh& mesh) { return std::exchange(mesh.fields, {}); }

void addField(LatticeMesh& mesh, LatticeField&& field, const std::string& name) {
  field.info.name = name;
  mesh.fields.push_back(std::move(field.info));
  mesh.values.push_back(std::move(field.values));
}

void addField(TetMesh& mesh, MeshField&& field, const std::string& name) {
  field.name = name;
  mesh.fields.push_back(std::move(field));
}

Result<Bytes> bytesOf(const LatticeMesh& mesh, const std::string& ending,
                      const MeshFileOptions& options) {
  return meshFileBytes(mesh, ending, options);
}

Result<Bytes> bytesOf(const TetMesh& mesh, const std::string& ending, const MeshFileOptions&) {
  return meshFileBytes(fileMesh(mesh), ending);
}

/// The fields of the log's levels. The last level also has those that its closing blocks hold.
std::vector<ManifestField> fieldsOf(const OpenedLog& log, bool restores) {
  std::vector<ManifestField> out = log.manifest.fields;
  if (!restores || !log.file.hasClosing(ClosingKind::kOriginalCells)) return out;
  out.emplace_back().name = kOriginalCellField;
  out.back().association = "cell";
  return out;
}

/// The numbers of the fields that are meant, ascending (field_key.h).
Result<std::vector<std::uint32_t>> wantedFields(const ParsedWords& parsed,
                                                const std::vector<ManifestField>& fields) {
  std::vector<std::uint32_t> wanted(fields.size());
  std::iota(wanted.begin(), wanted.end(), 0u);
  const auto names = parseFieldNames(parsed.get<std::string>("fields"));
  if (!names) return wanted;
  wanted.clear();
  for (const std::string& name : *names) {
    const std::vector<std::uint32_t> meant = fieldsOfKey(fields, name);
    if (meant.empty())
      return fail(ErrorCode::kNotFound,
                  "the log has no field '" + name +
                      "' at this level; qtet info shows which it has, and what is kept for the "
                      "last level alone");
    wanted.insert(wanted.end(), meant.begin(), meant.end());
  }
  std::ranges::sort(wanted);
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  return wanted;
}

constexpr const char* kCollection = ".pvd";

bool isCollection(const MeshOutput& output) { return output.ending == kCollection; }

std::string endingOfFiles(const MeshOutput& output) {
  return isCollection(output) ? ".vtu" : output.ending;
}

/// Takes each file as it is made.
using FileTaker = std::function<Status(const InstantFile& file, Bytes&& bytes)>;

/// Makes the mesh with each file's fields; `numbers` are those of its own fields, ascending.
template <class Mesh>
Status makeFiles(Mesh& mesh, const std::vector<std::uint32_t>& numbers,
                 const std::vector<InstantFile>& files, const MeshOutput& output,
                 const FileTaker& take) {
  auto all = takeFields(mesh);
  for (const InstantFile& file : files) {
    const bool isLast = &file == &files.back();
    takeFields(mesh);
    for (const FieldInFile& field : file.fields) {
      const auto at = std::ranges::lower_bound(numbers, field.number) - numbers.begin();
      auto& own = all[static_cast<std::size_t>(at)];
      addField(mesh, field.isInstant || isLast ? std::move(own) : auto(own), field.name);
    }
    Result<Bytes> bytes = bytesOf(mesh, endingOfFiles(output), output.options);
    if (!bytes) return std::unexpected(bytes.error());
    if (Status s = take(file, std::move(*bytes)); !s) return s;
  }
  return {};
}

/// At the last level the files are the input itself, as far as the log kept it.
Status makeInput(const OpenedLog& log, const LatticeMesh& finest,
                 const std::vector<InstantFile>& files, const MeshOutput& output,
                 const FileTaker& take) {
  Result<RestoredInput> input = restoreInput(log.file, finest);
  if (!input) return std::unexpected(input.error());
  const bool exact = input->exactPositions ||
                     std::ranges::find(input->exactFields, true) != input->exactFields.end();
  const bool asRead = exact && !needsLattice(output.ending);
  std::vector<std::uint32_t> numbers(asRead ? input->mesh.fields.size()
                                            : input->lattice.fields.size());
  std::iota(numbers.begin(), numbers.end(), 0u);
  return asRead ? makeFiles(input->mesh, numbers, files, output, take)
                : makeFiles(input->lattice, numbers, files, output, take);
}

/// Throws UsageError where one file would hold several instants.
void checkCount(std::size_t instants, const std::string& asked, const MeshOutput& output) {
  if (instants > 1 && !isCollection(output))
    throw UsageError("--time " + asked + " means " + std::to_string(instants) +
                     " instants; -o NAME.pvd writes a file of each");
}

/// The files that `--time` and the output's kind ask for.
Result<std::vector<InstantFile>> filesOf(const ParsedWords& parsed, const MeshOutput& output,
                                         const std::vector<ManifestField>& known,
                                         const std::vector<std::uint32_t>& wanted,
                                         std::vector<std::string>& notes) {
  if (!parsed.has("time") && !isCollection(output)) {
    InstantFile all;
    for (const std::uint32_t f : wanted) all.fields.push_back({f, known[f].name, false});
    return std::vector<InstantFile>{std::move(all)};
  }
  const std::string asked = parsed.has("time") ? parsed.get<std::string>("time") : "all";
  auto files = instantFiles(known, wanted, asked, parsed.get<std::string>("LOG"), notes);
  if (files) checkCount(files->size(), asked, output);
  return files;
}

/// `known`: the fields that the numbers of `wanted` mean, those of the manifest first. Those of an
/// instant are called as in its file.
MeshOutputReport reportOf(const Manifest& manifest, std::uint32_t level,
                          const std::vector<ManifestField>& known,
                          const std::vector<FieldInFile>& wanted, const std::string& ending) {
  const ManifestLevel& told = manifest.levels[level];
  const std::size_t last = manifest.levels.size() - 1;
  MeshOutputReport out{"level " + std::to_string(level) + " of " + std::to_string(last) + ", " +
                           counted(told.tetrahedra, "tetrahedron", "tetrahedra") + ", " +
                           counted(told.vertices, "point", "points"),
                       {{"level", level},
                        {"levels", last},
                        {"tetrahedra", told.tetrahedra},
                        {"vertices", told.vertices},
                        {"boundaryTriangles", told.boundaryTriangles}}};
  std::vector<ManifestField> fields;
  LevelError error = told.error.value_or(LevelError());
  error.fields.clear();
  std::vector<bool> isLabel;
  for (const auto& [f, name, isInstant] : wanted) {
    if (!holdsFields(ending, known[f].association)) continue;
    fields.push_back(known[f]);
    fields.back().name = name;
    if (!told.error || f >= told.error->fields.size()) continue;
    error.fields.push_back(told.error->fields[f]);
    isLabel.push_back(labelNamesOf(manifest, f) != nullptr);
  }
  out.json["fields"] = writtenFieldsJson(fields, ending);
  if (told.error) out.json["error"] = toJson(error, isLabel);
  return out;
}

/// The files that are made of the fields `wanted` among those that are known.
using FileChooser = std::function<Result<std::vector<InstantFile>>(
    const std::vector<ManifestField>& known, const std::vector<std::uint32_t>& wanted)>;

/// Makes the files of one log's level.
Result<MeshOutputReport> extractLog(const ParsedWords& parsed, const OpenedLog& log,
                                    const Result<std::uint32_t>& level, const MeshOutput& output,
                                    const FileChooser& choose, const FileTaker& take) {
  if (!level) return std::unexpected(level.error());
  const bool restores =
      *level + 1 == log.manifest.levels.size() && !log.file.closingBlocks().empty();
  const std::vector<ManifestField> known = fieldsOf(log, restores);
  const Result<std::vector<std::uint32_t>> wanted = wantedFields(parsed, known);
  if (!wanted) return std::unexpected(wanted.error());
  const auto files = choose(known, *wanted);
  if (!files) return std::unexpected(files.error());
  std::vector<std::uint32_t> decoded;
  for (const InstantFile& file : *files)
    for (const FieldInFile& field : file.fields) decoded.push_back(field.number);
  std::ranges::sort(decoded);
  decoded.erase(std::unique(decoded.begin(), decoded.end()), decoded.end());
  Result<LatticeMesh> mesh =
      meshAtLevel(log.file, *level, restores ? std::nullopt : std::optional(decoded));
  if (!mesh) return std::unexpected(mesh.error());
  if (Status s = restores ? makeInput(log, *mesh, *files, output, take)
                          : makeFiles(*mesh, decoded, *files, output, take);
      !s)
    return std::unexpected(s.error());
  return reportOf(log.manifest, *level, known, files->front().fields, endingOfFiles(output));
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
      return Result<std::vector<InstantFile>>(segmentFiles(known, wanted, times));
    };
    Result<MeshOutputReport> report =
        extractLog(parsed, *log, levelOfSegment(parsed, *log, times), output, choose, take);
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
  const auto choose = [&](const auto& known, const auto& wanted) {
    return filesOf(parsed, output, known, wanted, notes);
  };
  return extractLog(parsed, *log, chosenLevel(parsed, log->manifest, log->file.index()), output,
                    choose, take);
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

}  // namespace

int runExtract(const Words& words, Console& console) {
  namespace po = boost::program_options;
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
  const ParsedWords parsed(
      words,
      {"extract",
       "extract LOG.qtet|LIST.json (--level K | --tets N | --ratio R | --error NAME=E | "
       "--boundary-error E) "
       "[--time T] -o OUT",
       "Writes one level of a log as an ordinary mesh: with its cells as .vtu, .vtk, .msh (Gmsh "
       "2.2) or .usda (OpenUSD), its boundary as\n"
       ".obj, .glb (glTF with Draco) or .drc. .obj holds no fields, .glb and .drc hold those of "
       "points. NAME.pvd (ParaView) names a .vtu for each instant of the log's series, in a new "
       "folder "
       "NAME. Where no level is small enough it is level 0.\n"
       "A list of logs, NAME.json, gives the mesh of the log that has the time T. Each log chooses "
       "a level of its own. A list needs --time unless the output is a .pvd. Its --error takes the "
       "name without a time, and holds at each of the chosen times.\n"
       "The last level is the input's mesh, with its own numbering and numbers where the log was "
       "made with --keep-order and --lossless.\n"
       "Errors are those that the log tells, measured when it was made (qtet info shows them).\n"
       "--json: output, kind, bytes, level, levels, tetrahedra, vertices and boundaryTriangles of "
       "the level, fields [{name, association,\ncomponents, type}] that the file holds, error as "
       "in qtet info with the same fields, input; of a .pvd also files [{time, file}]; of "
       "a list also log and times, or for a .pvd of several logs segments, an array of these.",
       "  qtet extract fin.qtet --ratio 0.1 -o coarse.vtu\n  qtet extract fin.qtet --error "
       "Density=0.01 -o near.vtu\n"
       "  qtet extract fin.qtet --tets 20000 --fields Density -o skin.glb\n"
       "  qtet extract wake.qtet --tets 50000 --time 0:1 -o wake.pvd\n"
       "  qtet extract remeshed.json --ratio 0.1 --time 0.3 -o later.vtu\n"
       "  curl -sL http://HOST/v1/meshes/fin/log | qtet extract - --ratio 0.1 --to vtu -o - "
       ">c.vtu\n"},
      options, {"LOG"});
  if (parsed.helped(console)) return kExitOk;
  const auto given = static_cast<int>(parsed.has("level")) + parsed.has("tets") +
                     parsed.has("ratio") + parsed.has("error") + parsed.has("boundary-error");
  if (given != 1)
    throw UsageError("give exactly one of --level, --tets, --ratio, --error and --boundary-error");

  const Status done = extract(parsed, console);
  return done ? kExitOk : reportFailure(done.error(), parsed.has("json"), console);
}

}  // namespace qtet
