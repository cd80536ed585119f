#include "simplify/measure/measure_fields.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "simplify/measure/measure_boundary.h"
#include "simplify/mesh/tet_mesh.h"
#include "simplify/mesh/workers.h"

namespace qtet {
namespace {

/// A place on a face may miss the cells on both its sides by rounding: it is covered while no
/// barycentric coordinate is below this.
constexpr double kRounding = 1e-9;

/// Barycentric coordinates of p; false where the cell is flat or where one coordinate is not above
/// `least`.
bool weightsIn(const std::array<Vector3, 4>& corners, const Vector3& p, double least,
               std::array<double, 4>& weights) {
  const Vector3 ab = corners[1] - corners[0], ac = corners[2] - corners[0],
                ad = corners[3] - corners[0], ap = p - corners[0];
  const Vector3 acad = cross(ac, ad);
  const double volume = dot(ab, acad);
  if (volume == 0) return false;
  const double scale = 1 / volume;
  weights[1] = dot(ap, acad) * scale;
  if (!(weights[1] > least)) return false;
  const Vector3 abap = cross(ab, ap);
  weights[2] = dot(abap, ad) * scale;
  weights[3] = dot(abap, ac) * -scale;
  weights[0] = 1 - weights[1] - weights[2] - weights[3];
  return weights[2] > least && weights[3] > least && weights[0] > least;
}

}  // namespace

FieldMeter::FieldMeter(const MeasuredMesh& mesh, const FieldOptions& options)
    : mesh_(mesh), options_(options) {
  assert(mesh.level() == mesh.history().levels && options.workers != nullptr);
  if (options.before != nullptr) {
    takePlaces(*options.before);
  } else {
    drawPlaces();
  }
  assert(truth_.empty() || truth_.size() == mesh.history().fields.size());
  assert(ranges_.size() == truth_.size());
  squaredErrors_.assign(truth_.size(), std::vector<double>(places_.size(), 0));
}

void FieldMeter::drawPlaces() {
  const FusionHistory& history = mesh_.history();
  const auto isTetrahedron = [](const Tetrahedron& cell) { return cell[3] != kGhost; };
  const CellSpan cells(history.cells.begin(),
                       std::ranges::partition_point(history.cells, isTetrahedron));
  const SampledPlaces drawn =
      placesOf(history.points, cells,
               {options_.samples, history.fields.empty() ? 0 : std::max(options_.vertices, 1u)},
               options_.seed);
  for (const ErrorSample& sample : drawn.places) places_.push_back({sample, {}, sample.cell});
  uniform_ = drawn.uniform;
  ranges_ = rangesOf(history.fields, history.values, cells, history.points.size());
  keepTruth();
}

void FieldMeter::takePlaces(const OriginalSamples& before) {
  const FusionHistory& history = mesh_.history();
  truth_ = before.truth;
  ranges_ = before.ranges;
  uniform_ = before.uniform;
  places_.reserve(before.places.size());
  for (const FollowedPlace& place : before.places) {
    assert(place.tetrahedron < history.cells.size() && !mesh_.isGhost(place.tetrahedron));
    Place& own = places_.emplace_back(
        Place{{place.at, place.tetrahedron, {}}, {}, place.tetrahedron, false});
    own.wasOriginal = place.isOriginal;
    if (place.isCovered) {
      std::array<Vector3, 4> corners;
      for (std::size_t i = 0; i < 4; ++i)
        corners[i] = toVector(history.points[history.cells[place.tetrahedron][i]]);
      // a flat cell holds no place; then one corner stands for it
      if (!weightsIn(corners, place.at, -std::numeric_limits<double>::infinity(),
                     own.sample.weights))
        own.sample.weights = {1, 0, 0, 0};
    } else {
      mesh_.boundaryTree().nearest(place.at, own.nearest);
      own.sample.cell = own.nearest.triangle;
    }
  }
}

FollowedPlace FieldMeter::placeAt(std::size_t i) const {
  const Place& place = places_[i];
  assert(place.isMeasured);
  const bool isCovered = !mesh_.isGhost(place.sample.cell);
  return {place.sample.at, isCovered ? place.tetrahedron : place.sample.cell, isCovered,
          place.wasOriginal && mesh_.isOriginal(place.sample.cell)};
}

void FieldMeter::keepTruth() {
  const FusionHistory& history = mesh_.history();
  for (std::size_t f = 0; f < history.fields.size(); ++f) {
    const std::size_t components = history.fields[f].components;
    std::vector<double>& truth = truth_.emplace_back();
    truth.reserve(places_.size() * components);
    for (const Place& place : places_)
      for (std::size_t c = 0; c < components; ++c) truth.push_back(valueAt(place, f, c));
  }
}

double FieldMeter::valueAt(const Place& place, std::size_t field, std::size_t component) const {
  const FusionHistory& history = mesh_.history();
  assert(field < history.fields.size() && component < history.fields[field].components);
  const std::size_t components = history.fields[field].components;
  if (isCellField(history.fields[field]))
    return history.values[field][place.tetrahedron * components + component];
  return valueIn(history.cells[place.sample.cell], place.sample.weights, history.values[field],
                 components, component);
}

void FieldMeter::follow() {
  options_.workers->forRuns(places_.size(), kPlacesPerRun, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) follow(places_[i]);
  });
}

void FieldMeter::measure() {
  options_.workers->forRuns(places_.size(), kPlacesPerRun, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (std::exchange(places_[i].isMeasured, true)) continue;
      if (mesh_.isGhost(places_[i].sample.cell)) findOnBoundary(places_[i]);
      measure(i);
    }
  });
}

void FieldMeter::follow(Place& place) const {
  const Fusion* fusion = mesh_.fusionOf(place.sample.cell);
  if (fusion == nullptr) return;
  place.isMeasured = place.isKept = false;
  if (findIn(*fusion, place)) {
    assert(!mesh_.isGhost(place.sample.cell) && mesh_.history().live[place.sample.cell]);
    place.tetrahedron = place.sample.cell;
  } else {
    followFusion(mesh_, *fusion, place.sample.at, place.nearest);
    place.sample.cell = place.nearest.triangle;
    assert(mesh_.isGhost(place.sample.cell));
  }
}

bool FieldMeter::findIn(const Fusion& fusion, Place& place) const {
  const FusionHistory& history = mesh_.history();
  double best = -std::numeric_limits<double>::infinity();
  bool mayLeave = false;
  std::array<double, 4> weights;
  const auto isIn = [&](std::uint32_t id, double least) {
    std::array<Vector3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = toVector(history.points[history.cells[id][i]]);
    if (!weightsIn(corners, place.sample.at, std::max(least, best), weights)) return false;
    best = *std::ranges::min_element(weights);
    place.sample.cell = id;
    place.sample.weights = weights;
    return best >= 0;
  };
  const auto tryCells = [&](double least) {
    for (const std::uint32_t id : mesh_.affected(fusion)) {
      if (mesh_.isGhost(id)) {
        mayLeave = true;
      } else if (isIn(id, least)) {
        return true;
      }
    }
    return best > least;
  };
  const CellId own = place.sample.cell;
  if (history.live[own] && !mesh_.isGhost(own) && isIn(own, -kRounding)) return true;
  // Nearly always a cell holds the place. Rounding at a face, or an inverted cell of the input, may
  // leave it just beside all of them.
  if (tryCells(-kRounding)) return true;
  return !mayLeave && tryCells(-std::numeric_limits<double>::infinity());
}

void FieldMeter::findOnBoundary(Place& place) const {
  assert(mesh_.isGhost(place.sample.cell));
  mesh_.boundaryTree().nearest(place.sample.at, place.nearest);
  place.sample.cell = place.nearest.triangle;
  const auto& weights = place.nearest.point.weights;
  place.sample.weights = {weights[0], weights[1], weights[2], 0};
}

void FieldMeter::measure(std::size_t place) {
  for (std::size_t f = 0; f < truth_.size(); ++f) {
    if (!(ranges_[f] > 0)) continue;
    assert(truth_[f].size() == places_.size() * mesh_.history().fields[f].components);
    const std::size_t components = mesh_.history().fields[f].components;
    double squared = 0;
    for (std::size_t c = 0; c < components; ++c) {
      const double apart = valueAt(places_[place], f, c) - truth_[f][place * components + c];
      squared += apart * apart;
    }
    squaredErrors_[f][place] =
        isLabel(f) ? (squared > 0 ? 1 : 0) : squared / (ranges_[f] * ranges_[f]);
  }
}

FieldMeter::Uncovered FieldMeter::uncovered() const {
  const auto isUncovered = [&](const Place& place) { return mesh_.isGhost(place.sample.cell); };
  assert(uniform_ <= places_.size());
  const auto uniform = std::span(places_).first(uniform_);
  return {static_cast<std::size_t>(std::ranges::count_if(uniform, isUncovered)), uniform_};
}

void FieldMeter::keepIn(FieldReplay& replay) {
  const FusionHistory& history = mesh_.history();
  if (replay.levels.empty()) {
    assert(mesh_.level() == history.levels);
    replay.uniform = uniform_;
    replay.ranges = ranges_;
    replay.roundings = roundings();
    if (options_.before != nullptr) replay.truth = truth_;
  }
  FieldReplay::Level& level = replay.levels.emplace_back();
  level.coarser = history.levels - mesh_.level();
  for (std::size_t i = 0; i < places_.size(); ++i) {
    assert(places_[i].isMeasured);
    if (std::exchange(places_[i].isKept, true)) continue;
    const ErrorSample& sample = places_[i].sample;
    level.moved.push_back({static_cast<std::uint32_t>(i),
                           places_[i].wasOriginal && mesh_.isOriginal(sample.cell),
                           history.cells[sample.cell], sample.weights});
  }
}

bool FieldMeter::isOriginal(const Place& place, std::size_t field) const {
  return isCellField(mesh_.history().fields[field])
             ? squaredErrors_[field][static_cast<std::size_t>(&place - places_.data())] == 0
             : place.wasOriginal && mesh_.isOriginal(place.sample.cell);
}

std::vector<FieldError> FieldMeter::errors() const {
  const std::vector<FieldError> rounding = roundings();
  assert(rounding.size() == squaredErrors_.size());
  std::vector<FieldError> out;
  for (std::size_t f = 0; f < squaredErrors_.size(); ++f) {
    FieldError error = errorOf(squaredErrors_[f], uniform_, rounding[f],
                               [&](std::size_t i) { return isOriginal(places_[i], f); });
    if (isLabel(f)) error.rms *= error.rms;  // a share of places
    out.push_back(error);
  }
  return out;
}

// A value rounded to a step is off by step^2 / 12 in the mean of squares. Between the four corners
// of a cell, each off on its own, it is 0.4 of that: the sum of the squares of their weights.
std::vector<FieldError> FieldMeter::roundings() const {
  std::vector<FieldError> out(ranges_.size());
  for (std::size_t f = 0; f < ranges_.size() && options_.countsRounding; ++f) {
    const FieldInfo& field = mesh_.history().fields[f];
    const bool isExact = !isFloatType(field.type) && field.step == 1;
    if (isExact || !(ranges_[f] > 0)) continue;
    const double components = std::sqrt(static_cast<double>(field.components)) / ranges_[f];
    out[f] = {components * std::sqrt((isCellField(field) ? 1 : 0.4) / 12), components * 0.5};
  }
  return out;
}

}  // namespace qtet
