#include "simplify/measure/measure_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "codec/coding/error_figure.h"
#include "codec/coding/level_columns.h"
#include "proto/field_key.h"
#include "simplify/measure/measure_boundary.h"
#include "simplify/measure/measure_fields.h"
#include "simplify/mesh/stopping.h"
#include "simplify/mesh/workers.h"

namespace qtet {
namespace {

struct Samples {
  std::uint32_t volume, vertices, surface, levelSurface;
};

/// Cells that pay for one place in the volume: measured, ALGORITHM.md, "Known error".
constexpr std::size_t kCellsPerSample = 10;
constexpr std::size_t kFewest = 3000, kMax = 50000;
/// Fewest places on a level's boundary, where nothing is kept from level to level and a search
/// takes the longest.
constexpr std::uint32_t kFewestOnLevel = 300;
constexpr Samples kAllSamples{200000, 200000, 200000, 200000};

Samples samplesFor(Effort effort, const FusionHistory& history) {
  if (effort == Effort::kAll) return kAllSamples;
  const auto isTetrahedron = [](const Tetrahedron& cell) { return cell[3] != kGhost; };
  const auto cells = static_cast<std::size_t>(
      std::ranges::partition_point(history.cells, isTetrahedron) - history.cells.begin());
  const auto volume =
      static_cast<std::uint32_t>(std::clamp(cells / kCellsPerSample, kFewest, kMax));
  return {volume, volume / 4, volume / 4, std::max(volume / 24, kFewestOnLevel)};
}

/// Distances over the diagonal below this are what doubles make of none: a lattice step is a
/// thousand times as much on the finest lattice.
constexpr double kNoDistance = 1e-12;

double roundedDistance(double d) { return d < kNoDistance ? 0 : roundedUp(d); }
OneSidedDistance rounded(const OneSidedDistance& d) {
  return {roundedDistance(d.mean), roundedDistance(d.max)};
}
double roundedVolume(double kept) { return std::round(kept * kVolumeFigure) / kVolumeFigure; }
LevelError rounded(const LevelError& error) {
  LevelError out{
      rounded(error.toLevel), rounded(error.toOriginal), roundedVolume(error.volumeKept), {}};
  for (const FieldError& field : error.fields)
    out.fields.push_back({roundedUp(field.rms), roundedUp(field.max)});
  return out;
}

/// The squared rounding error of a surface, in squared lattice steps. On a triangle with corners
/// that are each off on their own half the variance of rounding is left, 1 / 24. The mean distance
/// along its normal is 0.8 of the root of that.
constexpr double kSquaredRounding = 0.64 / 24;

/// Half a step along each axis: as far as the lattice moves a point at most, and so any place of a
/// surface between them.
void addRounding(OneSidedDistance& distance, double diagonal) {
  if (diagonal > 0) distance.max += std::sqrt(3 * 0.25) / diagonal;
}

class ErrorMeter {
 public:
  ErrorMeter(HistoryLevels& levels, const MeasureOptions& options, const Samples& samples)
      : countsRounding_(options.countsRounding),
        workers_(options.threads, options.stop),
        mesh_(levels),
        boundary_(mesh_, {samples.surface, samples.levelSurface,
                          options.countsRounding ? kSquaredRounding : 0, options.seed, &workers_}),
        fields_(mesh_, {samples.volume, samples.vertices, options.countsRounding,
                        options.seed ^ kFieldSeed, &workers_}) {}

  void coarsen() {
    mesh_.coarsen();
    boundary_.follow();
    fields_.follow();
  }

  [[nodiscard]] LevelError measure() {
    LevelError out{boundary_.toLevel(), boundary_.toOriginal(), mesh_.volumeKept(),
                   fields_.errors()};
    if (countsRounding_) addRounding(out);
    return rounded(out);
  }

  /// The error of the finest level, from rounding alone.
  [[nodiscard]] LevelError rounding() const {
    LevelError out;
    out.fields = fields_.roundings();
    if (countsRounding_) addRounding(out);
    return rounded(out);
  }

 private:
  static constexpr std::uint64_t kFieldSeed = 0x5EEDF1E1D5u;  // other numbers than the surface's

  void addRounding(LevelError& error) const {
    qtet::addRounding(error.toLevel, mesh_.diagonal());
    qtet::addRounding(error.toOriginal, mesh_.diagonal());
  }

  bool countsRounding_;
  Workers workers_;
  MeasuredMesh mesh_;
  BoundaryMeter boundary_;
  FieldMeter fields_;
};

using FieldBound = std::pair<std::size_t, double>;

Result<std::vector<FieldBound>> fieldBounds(const FusionHistory& history,
                                            const ErrorBounds& bounds) {
  std::vector<FieldBound> out;
  for (const auto& [name, bound] : bounds.fields) {
    const auto field = fieldOfKey(history.fields, name);
    if (!field)
      return fail(
          ErrorCode::kNotFound,
          "no field '" + name + "' to keep an error bound of; name one that the log carries");
    out.emplace_back(*field, bound);
  }
  return out;
}

/// How many cells and vertices a level has.
struct LevelSize {
  std::size_t tetrahedra = 0, vertices = 0;

  /// REQUIRES: the history at its finest level.
  explicit LevelSize(const FusionHistory& history) {
    std::vector<std::uint8_t> isUsed(history.points.size(), 0);
    for (const Tetrahedron& cell : history.cells) {
      if (cell[3] == kGhost) break;
      ++tetrahedra;
      for (const VertexId v : cell) vertices += std::exchange(isUsed[v], 1) == 0;
    }
  }
  void coarsenBy(const FusionHistory& history, std::span<const Fusion> step) {
    for (const Fusion& fusion : step) {
      vertices -= fusion.k - 1u;
      for (const std::uint32_t cell :
           std::span(history.deletedCells).subspan(fusion.firstDeleted, fusion.deletedCount))
        tetrahedra -= history.cells[cell][3] != kGhost;
    }
  }
};

/// Which errors a level may have. None is below what rounding alone may do.
class LevelBounds {
 public:
  LevelBounds(const FusionHistory& history, const MeasureOptions& options,
              std::vector<FieldBound> fields, LevelError least)
      : options_(options), fields_(std::move(fields)), least_(std::move(least)) {
    for (const FieldInfo& field : history.fields)
      if (!isCellField(field)) components_ += field.components;
  }

  /// Whether a level with this error may be the base mesh, instead of the finer one of this size.
  [[nodiscard]] bool hold(const LevelError& error, const LevelSize& size) const {
    const double distance = error.boundaryDistance();
    return isNear(distance, options_.bounds.boundary.value_or(distance)) &&
           std::ranges::all_of(fields_,
                               [&](const FieldBound& bound) {
                                 return error.fields[bound.first].rms <=
                                        std::max(bound.second, least_.fields[bound.first].rms);
                               }) &&
           (!options_.base || isBase(*options_.base, error, size));
  }

 private:
  [[nodiscard]] bool isNear(double distance, double bound) const {
    return distance <= std::max(bound, least_.boundaryDistance());
  }
  [[nodiscard]] bool isBase(const BaseRule& rule, const LevelError& error,
                            const LevelSize& size) const {
    return size.tetrahedra > rule.maxCells ||
           baseBytesOf(size.vertices, components_) > rule.maxBytes ||
           (isNear(error.boundaryDistance(), rule.error) &&
            std::abs(1 - error.volumeKept) <= 2 * rule.error);
  }

  const MeasureOptions& options_;
  std::vector<FieldBound> fields_;
  LevelError least_;
  std::size_t components_ = 0;
};

Result<std::vector<LevelError>> measured(FusionHistory& history, const MeasureOptions& options) {
  Result<std::vector<FieldBound>> fields = fieldBounds(history, options.bounds);
  if (!fields) return std::unexpected(fields.error());
  HistoryLevels levels(history);
  for (; levels.level() < levels.finest(); levels.refine()) throwIfStopped(options.stop);
  ErrorMeter meter(levels, options, samplesFor(options.effort, history));
  LevelSize size(history);
  const LevelBounds bounds(history, options, std::move(*fields), meter.rounding());
  std::vector<LevelError> out{meter.measure()};
  while (levels.level() > 0) {
    meter.coarsen();
    LevelError error = meter.measure();
    if (!bounds.hold(error, size)) {
      levels.refine();
      break;
    }
    size.coarsenBy(history, levels.fusionsInto(levels.level()));
    out.push_back(std::move(error));
    if (options.progress)
      options.progress(static_cast<double>(out.size()) / (levels.finest() + 1.0));
  }
  levels.forgetCoarser();
  std::ranges::reverse(out);
  return out;
}

}  // namespace

std::size_t baseBytesOf(std::size_t vertices, std::size_t components) {
  constexpr double kBytesAVertex = 8, kBytesAComponent = 1.3;
  return static_cast<std::size_t>(
      static_cast<double>(vertices) *
      (kBytesAVertex + kBytesAComponent * static_cast<double>(components)));
}

Result<std::vector<LevelError>> measureLevels(FusionHistory& history,
                                              const MeasureOptions& options) {
  return orCancelled([&] { return measured(history, options); });
}

}  // namespace qtet
