#include <algorithm>
#include <set>

#include "proto/field_name.h"
#include "simplify/commands/commands.h"
#include "simplify/log/write_mesh.h"
#include "simplify/mesh/moved_place.h"
#include "simplify/produce/instant_collection.h"
#include "simplify/produce/piece_summary.h"
#include "simplify/samples/samples.h"
#include "simplify/words/json_report.h"
#include "simplify/words/output.h"
#include "simplify/words/parsed_words.h"

namespace qtet {
namespace {

std::string listOfSamples() {
  std::size_t widest = 0;
  for (const Sample& sample : samples()) widest = std::max(widest, sample.name.size());
  std::string out = "Writes a mesh that is computed, not read. NAME is one of:";
  for (const Sample& sample : samples()) {
    std::string name(sample.name);
    name.resize(widest, ' ');
    out += "\n  " + name + "  " + std::string(sample.description);
  }
  return out;
}

/// One step as a solver writes it: the fields without @TIME, and points that have moved.
TetMesh stepOf(const TetMesh& mesh, double time) {
  TetMesh out{mesh.points, mesh.tetrahedra, {}, mesh.pointType};
  for (const MeshField& field : mesh.fields) {
    const auto name = field.name.instant();
    if (!name || name->time != time) continue;
    if (name->series == kDisplacement) {
      for (std::size_t i = 0; i < out.points.size(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
          out.points[i][axis] += field.values[3 * i + axis];
      continue;
    }
    out.fields.push_back(field);
    out.fields.back().name = name->series;
  }
  return out;
}

/// A file for each instant. Returns the bytes of all.
Result<std::uint64_t> writeSteps(const TetMesh& mesh, const std::filesystem::path& file) {
  InstantCollection steps(file);
  std::set<double> times;
  for (const MeshField& field : mesh.fields) times.insert(field.name.instant()->time);
  for (const double time : times)
    if (Status s = steps.add(time, vtuBytes(stepOf(mesh, time))); !s)
      return std::unexpected(s.error());
  if (Status s = steps.finish(); !s) return std::unexpected(s.error());
  return steps.bytes();
}

struct WrittenPieces {
  std::uint64_t cells = 0, bytes = 0;
};

/// The fin in pieces, of which one at a time is made.
Result<WrittenPieces> writePieces(std::uint64_t cells, std::uint32_t pieces,
                                  const std::filesystem::path& file) {
  WrittenPieces out;
  InstantCollection files(file);
  TetMesh mesh;
  for (std::uint32_t i = 0; i < pieces; ++i) {
    mesh = finPiece(cells, i, pieces);
    out.cells += mesh.tetrahedra.size();
    if (Status s = files.add(std::nullopt, vtuBytes(mesh)); !s) return std::unexpected(s.error());
  }
  if (Status s = files.finish(pieceSummary(mesh, files.names())); !s)
    return std::unexpected(s.error());
  out.bytes = files.bytes();
  return out;
}

int runPieces(const ParsedWords& parsed, const Output& output, Console& console) {
  const auto cells = static_cast<std::uint64_t>(
      parsed.has("cells") ? parsed.number("cells", 1, static_cast<double>(kMaxCellsInPieces))
                          : static_cast<double>(kFinCells));
  if (parsed.get<std::string>("NAME") != "fin" || parsed.has("steps"))
    throw UsageError("only the steady fin comes in pieces; leave out --pieces");
  const std::uint32_t layers = finLayers(cells);
  const auto pieces =
      static_cast<std::uint32_t>(parsed.integer("pieces", 1, static_cast<int>(layers)));
  const Result<WrittenPieces> written = writePieces(cells, pieces, output.file);
  if (!written) return reportFailure(written.error(), false, console);
  reportOutput(output,
               output.name() + ": " + counted(written->cells, "tetrahedron", "tetrahedra") +
                   " in " + counted(pieces, "piece", "pieces") + ", " + grouped(written->bytes) +
                   " bytes\n",
               console);
  return kExitOk;
}

/// Returns the bytes that were written.
Result<std::uint64_t> writeSample(const TetMesh& mesh, const Output& output) {
  if (output.file.extension() == ".pvd") return writeSteps(mesh, output.file);
  const Bytes bytes = vtuBytes(mesh);
  if (Status s = writeOutput(output, bytes); !s) return std::unexpected(s.error());
  return bytes.size();
}

}  // namespace

int runSample(const Words& words, Console& console) {
  po::options_description options("options");
  options.add_options()("output,o", po::value<std::string>(),
                        "required: the .vtu file to write; with --steps also NAME.pvd, a series "
                        "with a file a step, whose points move; or - for the standard output")(
      "cells", po::value<double>(),
      "at least so many tetrahedra, for samples that come in sizes (fin: 2,400 to 100,000,000)")(
      "steps", po::value<int>(),
      ("so many time steps of each field, 2 to " + std::to_string(kMaxSampleInstants) +
       " (fin, beam)")
          .c_str())("pieces", po::value<int>(),
                    "so many files, which NAME.pvtu lists (fin): a mesh of up to 1,000,000,000 "
                    "tetrahedra, of which one piece at a time is in memory");
  addNoClobber(options);
  const ParsedWords parsed(
      words,
      {"sample", "sample NAME -o FILE.vtu|FILE.pvd|FILE.pvtu [--cells N] [--steps N] [--pieces N]",
       listOfSamples(),
       "  qtet sample box -o box.vtu\n  qtet sample fin --cells 1000000 -o fin.vtu\n"
       "  qtet sample fin --steps 40 -o run.vtu\n  qtet sample fin --cells 5000 --steps 8 -o "
       "run.pvd\n"
       "  qtet sample beam --steps 40 -o swing.vtu\n"},
      options, {"NAME"});
  if (parsed.helped(console)) return kExitOk;

  const Output output = outputOf(parsed, console);
  if (Status checked = checkOutput(output, ".vtu .pvd .pvtu"); !checked)
    return reportFailure(checked.error(), false, console);
  const bool isList = output.file.extension() == ".pvtu";
  if (parsed.has("pieces") != isList)
    throw UsageError("--pieces N and a file NAME.pvtu go together; give both, or neither");
  if (isList) return runPieces(parsed, output, console);
  std::optional<std::uint64_t> cells;
  if (parsed.has("cells")) cells = static_cast<std::uint64_t>(parsed.number("cells", 1, 1e12));
  const auto steps =
      parsed.has("steps")
          ? static_cast<std::uint32_t>(parsed.integer("steps", 2, kMaxSampleInstants))
          : 0;
  if (steps == 0 && output.file.extension() == ".pvd")
    throw UsageError("a series needs --steps N; or write a .vtu file");
  const Result<TetMesh> mesh = makeSample(parsed.get<std::string>("NAME"), cells, steps);
  if (!mesh) throw UsageError(mesh.error().message);
  const Result<std::uint64_t> bytes = writeSample(*mesh, output);
  if (!bytes) return reportFailure(bytes.error(), false, console);
  reportOutput(
      output,
      output.name() + ": " + counted(mesh->tetrahedra.size(), "tetrahedron", "tetrahedra") + ", " +
          counted(mesh->points.size(), "point", "points") + ", " +
          counted(mesh->fields.size(), "field", "fields") + ", " + grouped(*bytes) + " bytes\n",
      console);
  return kExitOk;
}

}  // namespace qtet
