#include "simplify/measure/measure_error.h"

#include <algorithm>
#include <array>
#include <cmath>

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

Result<std::vector<LevelError>> measured(FusionHistory& history, const MeasureOptions& options) {
  const Result<std::vector<FieldBound>> bounds = fieldBounds(history, options.bounds);
  if (!bounds) return std::unexpected(bounds.error());
  HistoryLevels levels(history);
  for (; levels.level() < levels.finest(); levels.refine()) throwIfStopped(options.stop);
  ErrorMeter meter(levels, options, samplesFor(options.effort, history));
  const LevelError least = meter.rounding();
  const auto isWithin = [&](const LevelError& error) {
    const auto keeps = [&](const FieldBound& bound) {
      return error.fields[bound.first].rms <= std::max(bound.second, least.fields[bound.first].rms);
    };
    const double distance = error.boundaryDistance();
    return distance <=
               std::max(options.bounds.boundary.value_or(distance), least.boundaryDistance()) &&
           std::ranges::all_of(*bounds, keeps);
  };
  std::vector<LevelError> out{meter.measure()};
  while (levels.level() > 0) {
    meter.coarsen();
    LevelError error = meter.measure();
    if (!isWithin(error)) {
      levels.refine();
      break;
    }
    out.push_back(std::move(error));
    if (options.progress)
      options.progress(static_cast<double>(out.size()) / (levels.finest() + 1.0));
  }
  levels.forgetCoarser();
  std::ranges::reverse(out);
  return out;
}

}  // namespace

Result<std::vector<LevelError>> measureLevels(FusionHistory& history,
                                              const MeasureOptions& options) {
  return orCancelled([&] { return measured(history, options); });
}

}  // namespace qtet
