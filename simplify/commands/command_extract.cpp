#include <algorithm>
#include <limits>
#include <numeric>

#include "codec/log/log_index.h"
#include "codec/log/target_choice.h"
#include "proto/field_key.h"
#include "proto/level_error_json.h"
#include "simplify/commands/command_measure.h"
#include "simplify/log/kept_input.h"
#include "simplify/log/opened_log.h"
#include "simplify/log/write_mesh.h"
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

/// Leaves a mesh of either kind only the `wanted` fields: their numbers, ascending.
void keepFields(LatticeMesh& mesh, const std::vector<std::uint32_t>& wanted) {
  for (std::size_t f = mesh.fields.size(); f-- > 0;) {
    if (std::ranges::binary_search(wanted, f)) continue;
    mesh.fields.erase(mesh.fields.begin() + static_cast<std::ptrdiff_t>(f));
    mesh.values.erase(mesh.values.begin() + static_cast<std::ptrdiff_t>(f));
  }
}

void keepFields(TetMesh& mesh, const std::vector<std::uint32_t>& wanted) {
  for (std::size_t f = mesh.fields.size(); f-- > 0;)
    if (!std::ranges::binary_search(wanted, f))
      mesh.fields.erase(mesh.fields.begin() + static_cast<std::ptrdiff_t>(f));
}

/// The fields of the log's levels; of the last level also what its closing blocks hold.
std::vector<ManifestField> fieldsOf(const OpenedLog& log, bool restores) {
  std::vector<ManifestField> out = log.manifest.fields;
  if (!restores || log.file.index().closingBlock(ClosingKind::kOriginalCells) == nullptr)
    return out;
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

/// At the last level the input itself, as far as the log kept it.
Result<Bytes> inputFile(const OpenedLog& log, const LatticeMesh& finest,
                        const std::vector<std::uint32_t>& wanted, const MeshOutput& output) {
  Result<RestoredInput> input = restoreInput(log.file, finest);
  if (!input) return std::unexpected(input.error());
  const bool exact = input->exactPositions ||
                     std::ranges::find(input->exactFields, true) != input->exactFields.end();
  keepFields(input->mesh, wanted);
  keepFields(input->lattice, wanted);
  return exact && !needsLattice(output.ending)
             ? meshFileBytes(fileMesh(input->mesh), output.ending)
             : meshFileBytes(input->lattice, output.ending, output.options);
}

/// `known`: the fields that the numbers of `wanted` mean, those of the manifest first.
MeshOutputReport reportOf(const Manifest& manifest, std::uint32_t level,
                          const std::vector<ManifestField>& known,
                          const std::vector<std::uint32_t>& wanted, const std::string& ending) {
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
  for (const std::uint32_t f : wanted) {
    if (!holdsFields(ending, known[f].association)) continue;
    fields.push_back(known[f]);
    if (told.error && f < told.error->fields.size()) error.fields.push_back(told.error->fields[f]);
  }
  out.json["fields"] = writtenFieldsJson(fields, ending);
  if (told.error) out.json["error"] = toJson(error);
  return out;
}

Status extract(const ParsedWords& parsed, Console& console) {
  const auto input = parsed.get<std::string>("LOG");
  const Result<MeshOutput> output = meshOutputOf(parsed, input);
  if (!output) return std::unexpected(output.error());
  const Result<OpenedLog> log = openLog(input);
  if (!log) return std::unexpected(log.error());

  const Result<std::uint32_t> level = chosenLevel(parsed, log->manifest, log->file.index());
  if (!level) return std::unexpected(level.error());
  const bool restores =
      *level + 1 == log->manifest.levels.size() && !log->file.index().closing.empty();
  const std::vector<ManifestField> known = fieldsOf(*log, restores);
  const Result<std::vector<std::uint32_t>> wanted = wantedFields(parsed, known);
  if (!wanted) return std::unexpected(wanted.error());
  const Result<LatticeMesh> mesh =
      meshAtLevel(log->file, *level, restores ? std::nullopt : std::optional(*wanted));
  if (!mesh) return std::unexpected(mesh.error());
  const Result<Bytes> bytes = restores ? inputFile(*log, *mesh, *wanted, *output)
                                       : meshFileBytes(*mesh, output->ending, output->options);
  if (!bytes) return std::unexpected(bytes.error());
  MeshOutputReport report = reportOf(log->manifest, *level, known, *wanted, output->ending);
  report.json["input"] = input;
  return writeMeshOutput(*output, *bytes, report, console);
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
      "range; cell:NAME where a point field has the same name")(
      "boundary-error", po::value<double>(),
      "the coarsest level whose boundary is nowhere further than this from the original's, as a "
      "fraction of the diagonal")("fields", po::value<std::string>()->default_value("all"),
                                  kFieldsHelp);
  const ParsedWords parsed(
      words,
      {"extract",
       "extract LOG.qtet (--level K | --tets N | --ratio R | --error NAME=E | --boundary-error E) "
       "-o OUT",
       "Writes one level of a log as an ordinary mesh: with its cells as .vtu, .vtk, .msh (Gmsh "
       "2.2) or .usda (OpenUSD), its boundary as\n"
       ".obj, .glb (glTF with Draco) or .drc. .obj holds no fields, .glb and .drc hold those of "
       "points. Where no level is small enough it is level 0.\n"
       "The last level is the input's mesh, with its own numbering and numbers where the log was "
       "made with --keep-order and --lossless.\n"
       "Errors are those that the log tells, measured when it was made (qtet info shows them).\n"
       "--json: output, kind, bytes, level, levels, tetrahedra, vertices and boundaryTriangles of "
       "the level, fields [{name, association,\ncomponents, type}] that the file holds, error as "
       "in qtet info with the same fields, input.",
       "  qtet extract fin.qtet --ratio 0.1 -o coarse.vtu\n  qtet extract fin.qtet --error "
       "Density=0.01 -o near.vtu\n"
       "  qtet extract fin.qtet --tets 20000 --fields Density -o skin.glb\n"
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
