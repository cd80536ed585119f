#include <algorithm>
#include <limits>

#include "codec/atomic_file.h"
#include "codec/level_choice.h"
#include "codec/vtu_writer.h"
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

/// At the last level the input itself, as far as the log kept it.
Result<Bytes> fileOf(const OpenedLog& log, std::uint32_t level, const LatticeMesh& mesh) {
  if (level + 1 < log.manifest.levels.size() || log.file.index().closing.empty()) return vtuBytes(mesh);
  const Result<RestoredInput> input = restoreInput(log.file, mesh);
  if (!input) return std::unexpected(input.error());
  const bool exact = input->exactPositions || std::ranges::find(input->exactFields, true) != input->exactFields.end();
  return exact ? vtuBytes(input->mesh) : vtuBytes(input->lattice);
}

Status extract(const ParsedWords& parsed, Console& console) {
  const auto input = parsed.get<std::string>("LOG"), output = parsed.get<std::string>("output");
  if (Status checked = checkOutput(output, ".vtu", input); !checked) return checked;
  const Result<OpenedLog> log = openLog(input);
  if (!log) return std::unexpected(log.error());

  const Result<std::uint32_t> level = chosenLevel(parsed, log->manifest);
  if (!level) return std::unexpected(level.error());
  const Result<LatticeMesh> mesh = meshAtLevel(log->file, *level);
  if (!mesh) return std::unexpected(mesh.error());
  const Result<Bytes> vtu = fileOf(*log, *level, *mesh);
  if (!vtu) return std::unexpected(vtu.error());
  const Bytes& bytes = *vtu;
  if (Status written = writeFileAtomically(output, bytes); !written) return written;
  console.out << output << ": level " << *level << " of " << log->manifest.levels.size() - 1 << ", " << mesh->tetrahedra.size()
              << " tetrahedra, " << mesh->points.size() << " points, " << bytes.size() << " bytes\n";
  return {};
}

}  // namespace

int runExtract(const Words& words, Console& console) {
  namespace po = boost::program_options;
  po::options_description options("options");
  options.add_options()("output,o", po::value<std::string>(), "required: the .vtu file to write")(
      "level", po::value<int>(), "this level; 0 is the base mesh")("tets", po::value<double>(),
                                                                   "the finest level with at most so many tetrahedra")(
      "ratio", po::value<double>(), "the finest level with at most this fraction of all tetrahedra, 0 to 1")(
      "error", po::value<std::string>(),
      "NAME=E: the coarsest level at which this field's rms error is at most E, a fraction of its range")(
      "boundary-error", po::value<double>(),
      "the coarsest level whose boundary is nowhere further than this from the original's, as a fraction of the diagonal");
  const ParsedWords parsed(
      words,
      {"extract", "extract LOG.qtet (--level K | --tets N | --ratio R | --error NAME=E | --boundary-error E) -o OUT.vtu",
       "Writes one level of a log, with all its fields, as an ordinary mesh. Where no level is small enough it is level 0.\n"
       "The last level is the input's mesh, with its own numbering and numbers where the log was made with --keep-order and --lossless.\n"
       "Errors are those that the log tells, measured when it was made (qtet info shows them).",
       "  qtet extract fin.qtet --ratio 0.1 -o coarse.vtu\n  qtet extract fin.qtet --error Density=0.01 -o near.vtu\n"},
      options, {"LOG"});
  if (parsed.helped(console)) return kExitOk;
  const auto given =
      static_cast<int>(parsed.has("level")) + parsed.has("tets") + parsed.has("ratio") + parsed.has("error") + parsed.has("boundary-error");
  if (given != 1) throw UsageError("give exactly one of --level, --tets, --ratio, --error and --boundary-error\nsee 'qtet extract --help'");

  const Status done = extract(parsed, console);
  return done ? kExitOk : reportFailure(done.error(), false, console);
}

}  // namespace qtet
