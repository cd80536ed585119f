// The known error: each level of a history measured against the original, as it goes into the log's
// manifest (ALGORITHM.md, "Known error").
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "codec/record/fusion_history.h"
#include "proto/error.h"
#include "proto/level_error.h"
#include "simplify/measure/field_replay.h"
#include "simplify/measure/original_samples.h"

namespace qtet {

/// How many levels are measured, and by how many places.
enum class Effort : std::uint8_t {
  kLevels,  ///< some kRowLevels; places in proportion to the cells, from 3,000 to 50,000
  kAll,     ///< all levels; 200,000 places in the volume and on each boundary, whatever that costs
};

/// Places in the original's volume, vertices of it, places on its boundary and on a level's.
struct MeasuredPlaces {
  std::uint32_t volume = 0, vertices = 0, surface = 0, levelSurface = 0;
};
/// For an original of so many tetrahedra.
[[nodiscard]] MeasuredPlaces placesFor(Effort effort, std::size_t cells);

/// Levels that Effort::kLevels measures at most, where no bound or rule wants more. Their numbers
/// are evenly spaced, so their sizes are about a geometric row.
inline constexpr std::uint32_t kRowLevels = 12;

/// The largest errors that a level may have. A mesh beyond them is no level.
struct ErrorBounds {
  std::optional<double> boundary;                      ///< LevelError::boundaryDistance()
  std::vector<std::pair<std::string, double>> fields;  ///< name and rms

  [[nodiscard]] bool any() const { return boundary.has_value() || !fields.empty(); }
};

/// BaseRule's distance where nothing else is asked for: seven pixels of a picture of 800.
inline constexpr double kBaseError = 0.01;
/// The same for the share of the volume that has another label, and for the volume of each label.
/// Grains and layers can still be told apart.
inline constexpr double kMaxBaseLabelError = 0.1;
/// Bytes of a base mesh at most, which a line of 1 Mbit/s brings in half a second.
inline constexpr std::size_t kMaxBaseBytes = 64'000;
/// Bytes of a base mesh at most that is larger for its fields alone. Noise is never near.
inline constexpr std::size_t kMaxBaseFieldBytes = 24'000;
/// The same as a share of the cells: more would leave little to refine.
inline constexpr double kMaxBaseFieldShare = 0.25;

/// Where the base mesh is when its size is not given: the coarsest level of which it and all finer
/// ones are near the original.
struct BaseRule {
  /// The largest LevelError::boundaryDistance(). Twice that is the bound of the volume lost, and of
  /// the volume gained. It is that of the rms of each field of floats too, at any instant.
  double error = kBaseError;
  /// A larger level is no base mesh, however far from the original the coarser ones are.
  std::size_t maxCells = std::numeric_limits<std::size_t>::max();
  std::size_t maxBytes = std::numeric_limits<std::size_t>::max();  ///< as baseBytesOf tells
  /// The largest share of the volume that has another label (FieldError), and the largest
  /// LabelVolumes::worst().
  double labelError = kMaxBaseLabelError;
  /// A level above these is no base mesh for fields alone. The share is of the finest one's cells.
  std::size_t maxFieldBytes = kMaxBaseFieldBytes;
  double maxFieldShare = kMaxBaseFieldShare;
};

/// The bytes that a base mesh takes in a log, to some 20 % (measured on nine meshes with fields of
/// 12 bits). `components` are those of point fields that a viewer fetches first. A series counts
/// with one instant.
[[nodiscard]] std::size_t baseBytesOf(std::size_t vertices, std::size_t components);

struct MeasureOptions {
  Effort effort = Effort::kLevels;
  /// By level, 1 for those that are measured besides the first and the last. Empty: `effort` says.
  std::vector<std::uint8_t> levels;
  ErrorBounds bounds;
  std::optional<BaseRule> base{};  ///< where no level's size was asked for
  /// The fields that are labels (label_fields.h). REQUIRES: fields of the history of one component.
  std::vector<std::uint32_t> labels{};
  /// Whether what the lattice and the fields' steps have moved counts too: the original is then the
  /// input, not the input on the lattice. A bound below what they may move is taken as that.
  bool countsRounding = false;
  FieldReplay* replay = nullptr;  ///< takes where the places lay
  /// The history's finest level was reduced from it before, and is not the original. Outlives the
  /// call.
  const OriginalSamples* before = nullptr;
  int threads = 1;  ///< the result does not depend on it
  std::uint64_t seed = 1;
  std::function<void(double fraction)> progress;  ///< 0..1, called once a level
  std::stop_token stop{};                         ///< asked many times a second
};

/// The errors, coarse-first; the first and the last level have one. The last one (the original
/// itself) has all zero, or the error of rounding alone. Figures are those that a log can state
/// (errors rounded up to three significant digits, volumes to 10^-6) and depend on the history and
/// the options only. With bounds or a rule, `history` forgets the coarse levels behind the last
/// one, counted from the finest, that keeps them. Level 0 is then the coarsest measured one such
/// that it and all finer measured ones keep them. Errors: not-found (a bound names no field of the
/// history), cancelled (the history is unspecified then). REQUIRES: as HistoryLevels; it stands at
/// level 0 before and after.
[[nodiscard]] Result<LevelErrors> measureLevels(FusionHistory& history,
                                                const MeasureOptions& options);

/// Puts a field's errors by level, as FieldReplay::errors gives them, in place of the known ones,
/// rounded as those are. `field`: its place in `errors`.
void setFieldErrors(const FieldReplay& replay, std::span<const FieldError> figures,
                    std::size_t field, LevelErrors& errors);

}  // namespace qtet
