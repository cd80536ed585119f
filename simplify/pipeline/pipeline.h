// Makes the bytes of a log from a mesh in arrays, in one call: clean, put on the lattice, simplify,
// measure, encode (ALGORITHM.md). Shared by `qtet simplify`, the C API and Python.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "codec/log/log_index.h"
#include "codec/log/log_writer.h"
#include "proto/manifest.h"
#include "simplify/clean/clean_mesh.h"
#include "simplify/clean/quantise.h"
#include "simplify/fuse/paper_fusion.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/log/kept_input.h"
#include "simplify/measure/measure_error.h"
#include "simplify/parts/parts_simplify.h"
#include "simplify/pieces/input_pieces.h"
#include "simplify/pipeline/made_log.h"

namespace qtet {

enum class Algorithm : std::uint8_t {
  kQtet,
  kPaper,  ///< the paper's own loop, tetrahedra only
};

/// In the order of doing, but for kReduce, which is before kSimplify. It, kMeasure and kKeep are
/// left out where nothing is reduced, measured or kept.
enum class Stage : std::uint8_t { kClean, kQuantise, kSimplify, kMeasure, kEncode, kKeep, kReduce };

struct PipelineOptions {
  std::string source{};  ///< the input's file name, for the manifest; may be empty
  Algorithm algorithm = Algorithm::kQtet;
  QuantiseOptions quantise{};
  /// Fields by index, progress and stop are the pipeline's own affair. Measuring takes its threads.
  FusionOptions fusion{};
  /// Point fields by name (proto/field_key.h) and what they count; others 1. Empty: as
  /// fusion_choice.h says.
  std::vector<std::pair<std::string, double>> fieldWeights{};
  /// Cell fields of integers by name, and what their interfaces count. A field named here is a
  /// label (label_fields.h) unless it counts 0; without, labelWeightBeside.
  std::vector<std::pair<std::string, double>> labelWeights{};
  /// The name of the cell field whose values are regions that keep their topology.
  std::optional<std::string> regions{};
  /// Only its effort, bounds and rule for the base mesh count. Without it nothing is measured, and
  /// no rule chooses the base mesh.
  std::optional<MeasureOptions> measure{std::in_place};
  /// The mesh is reduced to so many cells before, in blocks (BLOCKS.md). They are the log's last
  /// level. A mesh of no more cells stays.
  std::optional<std::size_t> finest{};
  /// Bytes that reducing may take. It limits the blocks in hand and so the threads, never the
  /// result.
  std::optional<std::uint64_t> memory{};
  /// A large mesh is simplified in parts, on all cores. Without: in one piece.
  std::optional<PartsOptions> parts{};
  CodecId valueCodec = CodecId::kLifted;
  /// Coarse levels keep the values that are best for them, whatever bits these take (liftFields).
  bool exactCoarse = false;
  KeepOptions keep{};
  Units units{};
  /// Each series gives four more fields, its statistics over all instants (time_statistics.h).
  bool timeStatistics = false;
  /// Series open at their first instants, whatever these show.
  bool opensAtFirst = false;
  /// Makes the place where the log's blocks wait for its head; in memory without it.
  std::function<Result<std::unique_ptr<ByteSpool>>()> spool{};

  /// Called in the caller's thread, with 0 when a stage begins; the fraction is in 0..1.
  std::function<void(Stage stage, double fraction)> progress{};
  /// Asked several times a second in every stage; then the error is `cancelled`.
  std::stop_token stop{};
};

struct PipelineReport {
  std::uint64_t tetrahedraIn = 0;  ///< before cleaning
  CleanReport clean;
  QuantiseReport quantise;
  /// The weight that the fusions were ordered by, where there were fields to weigh it against.
  std::optional<double> boundaryWeight;
  /// The names of labels and the weights of their interfaces, where these count.
  std::vector<std::pair<std::string, double>> labelWeights;
  std::optional<PaperFigures> paper;  ///< with Algorithm::kPaper
  LogStatistics statistics;
  /// Read from the head of the log, not from what was meant to be written.
  LogIndex index;
  Manifest manifest;
  /// Changes made and unusual findings, one sentence each, in the order of doing.
  std::vector<std::string> notes;
  /// Large losses of the base mesh (loss_warnings.h), and instants that lead far away from the
  /// others (field_scales.h); one sentence each.
  std::vector<std::string> warnings;
  std::vector<std::pair<Stage, double>> seconds;  ///< wall time, in the order of doing
};

struct PipelineOutput {
  MadeLog log;
  PipelineReport report;
};

/// Reads index and manifest of the report from the log itself. Errors: LogIndex::parse's,
/// manifestOf's.
[[nodiscard]] Status readBack(const MadeLog& log, PipelineReport& report);

/// "90 of 100 fields are instants that are coded as differences in time"
[[nodiscard]] std::string differencesNote(const LogIndex& index);

/// Whether the options go together and lie in their ranges. Errors: bad-value.
[[nodiscard]] Status checkOptions(const PipelineOptions& options);

/// Whether what cleanMesh and quantise require holds, and whether a log can hold the fields. It is
/// for a mesh that comes from outside and was not read by readMesh. Errors: bad-input (the first
/// point, tetrahedron or field at fault, by its number), limit-exceeded.
[[nodiscard]] Status checkArrays(const TetMesh& mesh);

/// Simplifying takes 275 to 340 bytes a cell, fields included; this is what it never does without.
constexpr std::uint64_t kLeastBytesACell = 250;
/// It takes at most so much, with a dozen of values a point.
constexpr std::uint64_t kMostBytesACell = 340;
/// A block of a reduction takes so much while it is fused.
constexpr std::uint64_t kBlockBytes = 400'000'000;
/// Error: limit-exceeded (so many cells cannot be simplified where a program has `most` bytes, such
/// as the 4 GiB of WebAssembly).
[[nodiscard]] Status checkRoom(std::uint64_t cells, std::uint64_t most);

/// Makes the log of a mesh; the mesh is given back before the first fusion. The same mesh and
/// options give the same bytes, whatever the number of threads. Errors: checkOptions's,
/// addTimeStatistics's, cleanMesh's, quantise's, simplify's, measureLevels's, the spool's and
/// encodeLog's; not-found (a weight, a unit, an error or regions name no field); bad-input (a label
/// that cannot be one); cancelled. REQUIRES: a mesh
/// that checkArrays or readMesh has passed.
[[nodiscard]] Result<PipelineOutput> simplifyToLog(TetMesh&& mesh, const PipelineOptions& options);
/// The same of a mesh that comes in pieces, which is never held as a whole. The log has
/// `options.finest` cells at most. Errors: the same, CleanedPieces's. REQUIRES: `finest`; no time
/// statistics.
[[nodiscard]] Result<PipelineOutput> simplifyToLog(InputPieces& pieces,
                                                   const PipelineOptions& options);

}  // namespace qtet
