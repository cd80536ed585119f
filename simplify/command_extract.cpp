#include <algorithm>
#include <limits>

#include "codec/atomic_file.h"
#include "codec/level_choice.h"
#include "simplify/command_measure.h"
#include "simplify/kept_input.h"
#include "simplify/opened_log.h"
#include "simplify/write_mesh.h"

namespace qtet {
namespace {

Result<std::uint32_t> levelWithin(const Manifest& manifest, const std::pair<std::string, double>& fieldBound) {
  const auto field = std::ranges::find(manifest.fields, fieldBound.first, &ManifestField::name);
  if (field == manifest.fields.end()) {
    std::string names;
    for (const ManifestField& known : manifest.fields) names += (names.empty() ? "" : ", ") + known.name;
    return fail(ErrorCode::kNotFound, "the log has no field '" + fieldBound.first + "'; it has: " + (names.empty() ? "none" : names));
  }
  const auto index = static_cast<std::size_t>(field - manifest.fields.begin());
  return levelOfFieldError(manifest, index, fieldBound.second);
}

Result<std::uint32_t> chosenLevel(const ParsedWords& parsed, const Manifest& manifest) {
  if (parsed.has("error")) return levelWithin(manifest, parseNamedError("error", parsed.get<std::string>("error")));
  if (parsed.has("boundary-error")) return levelOfBoundaryError(manifest, parsed.number("boundary-error", 0, 1));
  if (parsed.has("level")) return static_cast<std::uint32_t>(parsed.integer("level", 0, std::numeric_limits<int>::max()));
  if (parsed.has("tets")) return levelOfTetrahedra(manifest, parsed.number("tets", 0, 1e18));
  return levelOfTetrahedra(manifest, parsed.number("ratio", 0, 1) * manifest.levels.back().tetrahedra);
}

/// A mesh of the two kinds without the fields that nobody asked for; `wanted` has one entry a field.
void keepFields(LatticeMesh& mesh, const std::vector<bool>& wanted) {
  for (std::size_t f = wanted.size(); f-- > 0;) {
    if (wanted[f]) continue;
    mesh.fields.erase(mesh.fields.begin() + static_cast<std::ptrdiff_t>(f));
    mesh.values.erase(mesh.values.begin() + static_cast<std::ptrdiff_t>(f));
  }
}

void keepFields(TetMesh& mesh, const std::vector<bool>& wanted) {
  for (std::size_t f = wanted.size(); f-- > 0;)
    if (!wanted[f]) mesh.fields.erase(mesh.fields.begin() + static_cast<std::ptrdiff_t>(f));
}

/// Which of a log's fields are meant: by name, or kind:name where a point field and a cell field share one.
Result<std::vector<bool>> wantedFields(const ParsedWords& parsed, const Manifest& manifest) {
  std::vector<bool> wanted(manifest.fields.size(), true);
  const auto names = parseFieldNames(parsed.get<std::string>("fields"));
  if (!names) return wanted;
  wanted.assign(wanted.size(), false);
  for (const std::string& name : *names) {
    bool found = false;
    for (std::size_t f = 0; f < wanted.size(); ++f) {
      const ManifestField& field = manifest.fields[f];
      if (name != field.name && name != field.association + ":" + field.name) continue;
      wanted[f] = found = true;
    }
    if (!found) return fail(ErrorCode::kNotFound, "the log has no field '" + name + "'; qtet info shows which it has");
  }
  return wanted;
}

/// At the last level the input itself, as far as the log kept it.
Result<Bytes> fileOf(const OpenedLog& log, std::uint32_t level, LatticeMesh mesh, const ParsedWords& parsed) {
  const auto output = parsed.get<std::string>("output");
  const Result<std::vector<bool>> wanted = wantedFields(parsed, log.manifest);
  if (!wanted) return std::unexpected(wanted.error());
  if (level + 1 < log.manifest.levels.size() || log.file.index().closing.empty()) {
    keepFields(mesh, *wanted);
    return meshFileBytes(mesh, output);
  }
  Result<RestoredInput> input = restoreInput(log.file, mesh);
  if (!input) return std::unexpected(input.error());
  const bool exact = input->exactPositions || std::ranges::find(input->exactFields, true) != input->exactFields.end();
  keepFields(input->mesh, *wanted);
  keepFields(input->lattice, *wanted);
  return exact && !output.ends_with(".glb") && !output.ends_with(".drc") ? meshFileBytes(input->mesh, output) : meshFileBytes(input->lattice, output);
}

Status extract(const ParsedWords& parsed, Console& console) {
  const auto input = parsed.get<std::string>("LOG"), output = parsed.get<std::string>("output");
  if (Status checked = checkOutput(output, kWrittenEndings, input); !checked) return checked;
  const Result<OpenedLog> log = openLog(input);
  if (!log) return std::unexpected(log.error());

  const Result<std::uint32_t> level = chosenLevel(parsed, log->manifest);
  if (!level) return std::unexpected(level.error());
  Result<LatticeMesh> mesh = meshAtLevel(log->file, *level);
  if (!mesh) return std::unexpected(mesh.error());
  const std::size_t tetrahedra = mesh->tetrahedra.size(), points = mesh->points.size();
  const Result<Bytes> bytes = fileOf(*log, *level, std::move(*mesh), parsed);
  if (!bytes) return std::unexpected(bytes.error());
  if (Status written = writeFileAtomically(output, *bytes); !written) return written;
  console.out << output << ": level " << *level << " of " << log->manifest.levels.size() - 1 << ", " << tetrahedra
              << " tetrahedra, " << points << " points, " << bytes->size() << " bytes\n";
  return {};
}

}  // namespace

int runExtract(const Words& words, Console& console) {
  namespace po = boost::program_options;
  po::options_description options("options");
  options.add_options()("output,o", po::value<std::string>(), ("required: the file to write, " + std::string(kWrittenEndings)).c_str())(
      "level", po::value<int>(), "this level; 0 is the base mesh")("tets", po::value<double>(),
                                                                   "the finest level with at most so many tetrahedra")(
      "ratio", po::value<double>(), "the finest level with at most this fraction of all tetrahedra, 0 to 1")(
      "error", po::value<std::string>(),
      "NAME=E: the coarsest level at which this field's rms error is at most E, a fraction of its range")(
      "boundary-error", po::value<double>(),
      "the coarsest level whose boundary is nowhere further than this from the original's, as a fraction of the diagonal")(
      "fields", po::value<std::string>()->default_value("all"), "all, none, or names between commas; point:NAME or cell:NAME is one of two fields with the same name");
  const ParsedWords parsed(
      words,
      {"extract", "extract LOG.qtet (--level K | --tets N | --ratio R | --error NAME=E | --boundary-error E) -o OUT",
       "Writes one level of a log as an ordinary mesh: with its cells as .vtu, .vtk, .msh (Gmsh 2.2), .usda (OpenUSD) or .npz (numpy), its boundary as\n"
       ".stl, .ply, .obj, .glb (glTF with Draco) or .drc. .stl and .obj hold no fields, .ply, .glb and .drc those of points. Where no level is small enough it is level 0.\n"
       "The last level is the input's mesh, with its own numbering and numbers where the log was made with --keep-order and --lossless.\n"
       "Errors are those that the log tells, measured when it was made (qtet info shows them).",
       "  qtet extract fin.qtet --ratio 0.1 -o coarse.vtu\n  qtet extract fin.qtet --error Density=0.01 -o near.vtu\n"
       "  qtet extract fin.qtet --tets 20000 --fields Density -o skin.glb\n"},
      options, {"LOG"});
  if (parsed.helped(console)) return kExitOk;
  const auto given =
      static_cast<int>(parsed.has("level")) + parsed.has("tets") + parsed.has("ratio") + parsed.has("error") + parsed.has("boundary-error");
  if (given != 1) throw UsageError("give exactly one of --level, --tets, --ratio, --error and --boundary-error\nsee 'qtet extract --help'");

  const Status done = extract(parsed, console);
  return done ? kExitOk : reportFailure(done.error(), false, console);
}

}  // namespace qtet
