#include "simplify/measure/measure_error.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <span>
#include <utility>

#include "codec/coding/error_figure.h"
#include "codec/coding/level_columns.h"
#include "proto/field_key.h"
#include "proto/series.h"
#include "simplify/measure/label_volumes.h"
#include "simplify/measure/measure_boundary.h"
#include "simplify/measure/measure_fields.h"
#include "simplify/mesh/stopping.h"
#include "simplify/mesh/tet_mesh.h"
#include "simplify/mesh/workers.h"

namespace qtet {
namespace {

/// Cells that pay for one place in the volume: measured, ALGORITHM.md, "Known error".
constexpr std::size_t kCellsPerSample = 10;
constexpr std::size_t kFewest = 3000, kMax = 50000;
/// Fewest places on a level's boundary, where nothing is kept from level to level and a search
/// takes the longest.
constexpr std::uint32_t kFewestOnLevel = 300;
constexpr MeasuredPlaces kAllPlaces{200000, 200000, 200000, 200000};

std::size_t tetrahedraOf(const FusionHistory& history) {
  const auto isTetrahedron = [](const Tetrahedron& cell) { return cell[3] != kGhost; };
  return static_cast<std::size_t>(std::ranges::partition_point(history.cells, isTetrahedron) -
                                  history.cells.begin());
}

/// Distances over the diagonal below this are what doubles make of none: a lattice step is a
/// thousand times as much on the finest lattice.
constexpr double kNoDistance = 1e-12;

double roundedDistance(double d) {
  assert(d >= 0);
  return d < kNoDistance ? 0 : roundedUp(d);
}
OneSidedDistance rounded(const OneSidedDistance& d) {
  return {roundedDistance(d.mean), roundedDistance(d.max)};
}
double roundedVolume(double share) { return std::round(share * kVolumeFigure) / kVolumeFigure; }
LevelError rounded(const LevelError& error) {
  LevelError out{rounded(error.toLevel),
                 rounded(error.toOriginal),
                 roundedVolume(error.volumeLost),
                 roundedVolume(error.volumeGained),
                 {}};
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
  ErrorMeter(HistoryLevels& levels, const MeasureOptions& options, const MeasuredPlaces& samples)
      : countsRounding_(options.countsRounding),
        workers_(options.threads, options.stop),
        mesh_(levels, options.before),
        boundary_(mesh_, {samples.surface, samples.levelSurface,
                          options.countsRounding ? kSquaredRounding : 0, options.seed, &workers_,
                          options.before}),
        fields_(mesh_, {samples.volume, samples.vertices, options.countsRounding, options.labels,
                        options.seed ^ kFieldSeed, &workers_, options.before}) {}

  void coarsen() {
    mesh_.coarsen();
    boundary_.follow();
    fields_.follow();
  }

  [[nodiscard]] LevelError measure(FieldReplay* replay) {
    mesh_.fitTree();
    boundary_.search();
    fields_.measure();
    if (replay != nullptr) fields_.keepIn(*replay);
    LevelError out{boundary_.toLevel(), boundary_.toOriginal(), 0, 0, fields_.errors()};
    findVolumes(out);
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
  /// The difference of gained and lost is exact, one of them an estimate from the places. It counts
  /// as 0 where it is not above what chance alone may make of 0.
  void findVolumes(LevelError& error) const {
    const double net = mesh_.volumeKept() - 1;
    const auto [places, all] = fields_.uncovered();
    assert(places <= all);
    const double n = static_cast<double>(std::max<std::size_t>(all, 1)),
                 lost = static_cast<double>(places) / n;
    const double chance = kDeviations * std::sqrt(lost * (1 - lost) / n);
    const double both = std::min(lost, lost + net);  // as much lost as gained
    error.volumeLost = std::max(-net, 0.0) + (both > chance ? both : 0);
    assert(error.volumeLost >= 0);
    error.volumeGained = error.volumeLost + net;
  }

  /// Standard deviations that are still chance: once in 700 where nothing is lost and gained.
  static constexpr double kDeviations = 3;
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

/// A level's error, and what the rule for the base mesh asks for beside it.
struct MeasuredLevel {
  LevelError error;
  double labelVolumes = 0;  ///< LabelVolumes::worst()
};

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
      assert(vertices >= fusion.k && tetrahedra >= 1);
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
  LevelBounds(const FusionHistory& history, const LevelSize& finest, const MeasureOptions& options,
              std::vector<FieldBound> fields, LevelError least)
      : options_(options), fields_(std::move(fields)), least_(std::move(least)), finest_(finest) {
    const std::vector<bool> isLater =
        laterInstants(seriesOf(history.fields), history.fields.size());
    for (std::size_t f = 0; f < history.fields.size(); ++f) {
      const FieldInfo& field = history.fields[f];
      if (!isCellField(field) && !isLater[f]) components_ += field.components;
      if (isFloatType(field.type)) floats_.push_back(f);
    }
  }

  /// Whether a level with this error may be the base mesh, instead of the finer one of this size.
  /// Bounds count with this share of them.
  [[nodiscard]] bool hold(const MeasuredLevel& level, const LevelSize& size,
                          double share = 1) const {
    assert(share > 0 && share <= 1);
    assert(level.error.fields.size() == least_.fields.size());
    const LevelError& error = level.error;
    return (!options_.bounds.boundary || isNear(error, share * *options_.bounds.boundary)) &&
           std::ranges::all_of(fields_,
                               [&](const FieldBound& bound) {
                                 return error.fields[bound.first].rms <=
                                        std::max(share * bound.second,
                                                 least_.fields[bound.first].rms);
                               }) &&
           (!options_.base || isBase(*options_.base, level, size, share));
  }

 private:
  [[nodiscard]] bool isNear(const LevelError& error, double bound) const {
    return error.boundaryDistance() <= std::max(bound, least_.boundaryDistance());
  }
  [[nodiscard]] bool isBase(const BaseRule& rule, const MeasuredLevel& level, const LevelSize& size,
                            double share) const {
    const LevelError& error = level.error;
    const auto isAbove = [share](std::size_t count, std::size_t most) {
      return share * static_cast<double>(count) > static_cast<double>(most);
    };
    const std::size_t bytes = baseBytesOf(size.vertices, components_);
    return isAbove(size.tetrahedra, rule.maxCells) || isAbove(bytes, rule.maxBytes) ||
           (isNear(error, share * rule.error) &&
            (isAbove(bytes, rule.maxFieldBytes) || isAbove(size.tetrahedra, mostForFields(rule)) ||
             areFieldsNear(error, share * 2 * rule.error)) &&
            std::max(error.volumeLost, error.volumeGained) <= share * 2 * rule.error &&
            level.labelVolumes <= share * rule.labelError &&
            std::ranges::all_of(options_.labels, [&](std::uint32_t label) {
              return error.fields[label].rms <= share * rule.labelError;
            }));
  }

  [[nodiscard]] std::size_t mostForFields(const BaseRule& rule) const {
    return static_cast<std::size_t>(rule.maxFieldShare * static_cast<double>(finest_.tetrahedra));
  }
  [[nodiscard]] bool areFieldsNear(const LevelError& error, double bound) const {
    return std::ranges::all_of(floats_, [&](std::size_t f) {
      return error.fields[f].rms <= std::max(bound, least_.fields[f].rms);
    });
  }

  const MeasureOptions& options_;
  std::vector<FieldBound> fields_;
  LevelError least_;
  LevelSize finest_;
  std::vector<std::size_t> floats_;  // fields
  std::size_t components_ = 0;
};

/// From this share of a bound on every level is measured, so that the base mesh is not finer than
/// it need be.
constexpr double kNearTheEnd = 0.7;

/// Which levels are measured.
class LevelRow {
 public:
  LevelRow(const MeasureOptions& options, std::uint32_t finest)
      : options_(options),
        last_(finest),
        step_(options.effort == Effort::kAll ? 1 : (finest + kRowLevels - 2) / (kRowLevels - 1)) {}

  /// Whether a coarser one is.
  bool isNext(std::uint32_t level) {
    assert(level < last_);
    assert(options_.levels.empty() || level < options_.levels.size());
    const bool isIt =
        options_.levels.empty() ? last_ - level >= step_ : options_.levels[level] != 0;
    if (!isIt && level > 0) return false;
    last_ = level;
    return true;
  }
  void takeAllFromNowOn() { step_ = 1; }

 private:
  const MeasureOptions& options_;
  std::uint32_t last_, step_;
};

Result<LevelErrors> measured(FusionHistory& history, const MeasureOptions& options) {
  Result<std::vector<FieldBound>> fields = fieldBounds(history, options.bounds);
  if (!fields) return std::unexpected(fields.error());
  HistoryLevels levels(history);
  for (; levels.level() < levels.finest(); levels.refine()) throwIfStopped(options.stop);
  ErrorMeter meter(levels, options, placesFor(options.effort, tetrahedraOf(history)));
  LevelSize size(history), base = size;
  LevelErrors out(levels.finest() + std::size_t{1});
  std::uint32_t coarsest = levels.finest();
  out[coarsest] = meter.measure(options.replay);
  const LevelBounds bounds(history, size, options, std::move(*fields),
                           options.before != nullptr ? *out[coarsest] : meter.rounding());
  const LabelVolumes labels(history, options.labels);
  LevelRow row(options, levels.finest());
  while (levels.level() > 0) {
    meter.coarsen();
    size.coarsenBy(history, levels.fusionsInto(levels.level()));
    if (options.progress)
      options.progress(1 - static_cast<double>(levels.level()) / levels.finest());
    if (!row.isNext(levels.level())) continue;
    MeasuredLevel level{meter.measure(options.replay), labels.worst()};
    if (!bounds.hold(level, base)) break;
    if (!bounds.hold(level, size, kNearTheEnd)) row.takeAllFromNowOn();
    out[levels.level()] = std::move(level.error);
    coarsest = levels.level();
    base = size;
  }
  assert(out[coarsest].has_value() && out.back().has_value());
  levels.moveTo(coarsest);
  levels.forgetCoarser();
  assert(levels.level() == 0 && out.size() == coarsest + levels.finest() + std::size_t{1});
  out.erase(out.begin(), out.begin() + coarsest);
  return out;
}

}  // namespace

MeasuredPlaces placesFor(Effort effort, std::size_t cells) {
  if (effort == Effort::kAll) return kAllPlaces;
  const auto volume =
      static_cast<std::uint32_t>(std::clamp(cells / kCellsPerSample, kFewest, kMax));
  return {volume, volume / 4, volume / 4, std::max(volume / 24, kFewestOnLevel)};
}

std::size_t baseBytesOf(std::size_t vertices, std::size_t components) {
  constexpr double kBytesAVertex = 8, kBytesAComponent = 1.3;
  return static_cast<std::size_t>(
      static_cast<double>(vertices) *
      (kBytesAVertex + kBytesAComponent * static_cast<double>(components)));
}

void setFieldErrors(const FieldReplay& replay, std::span<const FieldError> figures,
                    std::size_t field, LevelErrors& errors) {
  for (std::size_t level = 0; level < replay.levels.size(); ++level) {
    assert(level < figures.size());
    const std::uint32_t coarser = replay.levels[level].coarser;
    if (coarser >= errors.size()) break;  // the history has forgotten it
    if (std::optional<LevelError>& error = errors[errors.size() - 1 - coarser])
      error->fields[field] = {roundedUp(figures[level].rms), roundedUp(figures[level].max)};
  }
}

Result<LevelErrors> measureLevels(FusionHistory& history, const MeasureOptions& options) {
  return orCancelled([&] { return measured(history, options); });
}

}  // namespace qtet
