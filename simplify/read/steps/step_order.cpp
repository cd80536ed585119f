#include "simplify/read/steps/step_order.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <compare>
#include <numeric>

namespace qtet {
namespace {

/// An edge whose length changes by less than this share has only turned.
constexpr double kSameLength = 1e-6;

/// By coordinates, bit by bit but for the sign of 0. NaNs have their places, too.
std::strong_ordering orderOf(const Position& a, const Position& b) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (const auto order = std::strong_order(a[axis] + 0.0, b[axis] + 0.0); order != 0)
      return order;
  return std::strong_ordering::equal;
}

bool hasIdsOfPoints(const CellMesh& mesh) {
  bool out = true;
  for (std::size_t c = 0; c < mesh.cells(); ++c)
    forEachId(mesh.types[c], mesh.cell(c), [&](VertexId v) { out &= v < mesh.points.size(); });
  return out;
}

/// The cells with their points' new names, and the order of the cells by type and points.
struct SortedCells {
  CellMesh cells;
  std::vector<std::size_t> order;

  [[nodiscard]] bool areOne(std::size_t a, const SortedCells& other, std::size_t b) const {
    return cells.types[a] == other.cells.types[b] &&
           std::ranges::equal(cells.cell(a), other.cells.cell(b));
  }
};

SortedCells sortedCells(const CellMesh& mesh, std::span<const VertexId> names) {
  SortedCells out;
  CellMesh& cells = out.cells;
  cells.types = mesh.types, cells.begins = mesh.begins, cells.vertices = mesh.vertices;
  cells.renamePoints(names);
  for (std::size_t c = 0; c < cells.cells(); ++c)
    if (cells.types[c] == kTetrahedronCell)
      std::ranges::sort(std::span(cells.vertices)
                            .subspan(cells.begins[c], cells.begins[c + 1] - cells.begins[c]));
  out.order.resize(cells.cells());
  std::iota(out.order.begin(), out.order.end(), std::size_t{0});
  std::ranges::sort(out.order, [&](std::size_t a, std::size_t b) {
    if (cells.types[a] != cells.types[b]) return cells.types[a] < cells.types[b];
    return std::ranges::lexicographical_compare(cells.cell(a), cells.cell(b));
  });
  return out;
}

std::vector<VertexId> ownNames(std::size_t points) {
  std::vector<VertexId> out(points);
  std::iota(out.begin(), out.end(), VertexId{0});
  return out;
}

/// Moves the tuple i to names[i]. A field of a wrong length is refused later.
template <class Number>
void renumber(MeshField& field, std::span<const Number> names) {
  const std::size_t n = field.components;
  if (field.values.size() != names.size() * n) return;
  std::vector<double> moved(field.values.size());
  for (std::size_t i = 0; i < names.size(); ++i)
    std::copy_n(field.values.begin() + static_cast<std::ptrdiff_t>(i * n), n,
                moved.begin() + static_cast<std::ptrdiff_t>(std::size_t{names[i]} * n));
  field.values = std::move(moved);
}

double lengthOf(const CellMesh& mesh, VertexId a, VertexId b) {
  const Position &p = mesh.points[a], &q = mesh.points[b];
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

/// Whether some edge between successive vertices of a cell has another length.
bool hasOtherEdges(const CellMesh& rest, const CellMesh& step) {
  for (std::size_t c = 0; c < rest.cells(); ++c) {
    std::optional<VertexId> last;
    bool differs = false;
    forEachId(rest.types[c], rest.cell(c), [&](VertexId v) {
      if (v >= rest.points.size()) return;
      if (last) {
        const double before = lengthOf(rest, *last, v), after = lengthOf(step, *last, v);
        differs |= std::abs(before - after) > kSameLength * std::max(before, after);
      }
      last = v;
    });
    if (differs) return true;
  }
  return false;
}

}  // namespace

void StepOrder::sortPoints() {
  if (sorted_.size() == rest_.points.size()) return;
  const std::vector<Position>& points = rest_.points;
  sorted_ = ownNames(points.size());
  std::ranges::sort(sorted_, [&](VertexId a, VertexId b) {
    const auto order = orderOf(points[a], points[b]);
    return order != 0 ? order < 0 : a < b;
  });
  isUnique_ = std::ranges::adjacent_find(sorted_, [&](VertexId a, VertexId b) {
                return orderOf(points[a], points[b]) == 0;
              }) == sorted_.end();
}

/// The numbers in the first step, by those in the step; nullopt: one lies elsewhere.
std::optional<StepOrder::Names> StepOrder::namesByPlace(std::span<const Position> points) {
  sortPoints();
  Names out;
  std::vector<VertexId> taken(sorted_.size());  // by the first of a place: how many of its points
  for (const Position& p : points) {
    const auto first = std::ranges::lower_bound(
        sorted_, p, [](const Position& a, const Position& b) { return orderOf(a, b) < 0; },
        [&](VertexId v) { return rest_.points[v]; });
    if (first == sorted_.end()) return std::nullopt;
    const auto rank = static_cast<std::size_t>(first - sorted_.begin());
    const std::size_t next = rank + taken[rank]++;
    if (next >= sorted_.size() || orderOf(rest_.points[sorted_[next]], p) != 0) return std::nullopt;
    out.push_back(sorted_[next]);
  }
  return out;
}

/// The numbers of the step's cells in the first step; nullopt: it has others, or one twice.
std::optional<std::vector<std::size_t>> StepOrder::cellsByPoints(const CellMesh& step,
                                                                 const Names& names) {
  const SortedCells there = sortedCells(rest_, ownNames(rest_.points.size()));
  const SortedCells here = sortedCells(step, names);
  std::vector<std::size_t> out(here.order.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (!here.areOne(here.order[i], there, there.order[i])) return std::nullopt;
    if (i > 0 && there.areOne(there.order[i - 1], there, there.order[i])) return std::nullopt;
    out[here.order[i]] = there.order[i];
  }
  return out;
}

bool StepOrder::restore(CellMesh& step) {
  if (step.points.size() != rest_.points.size() || step.cells() != rest_.cells() ||
      !hasIdsOfPoints(step) || !hasIdsOfPoints(rest_))
    return false;
  std::optional<Names> names = namesByPlace(step.points);
  if (!isUnique_) names.reset();
  std::optional<std::vector<std::size_t>> cells;
  if (names) cells = cellsByPoints(step, *names);
  const bool isByPlace = cells.has_value();
  if (!isByPlace) {
    names = ownNames(step.points.size());
    cells = cellsByPoints(step, *names);
  }
  if (!cells) return false;
  for (MeshField& field : step.fields)
    isCellField(field) ? renumber(field, std::span<const std::size_t>(*cells))
                       : renumber(field, std::span<const VertexId>(*names));
  if (isByPlace) step.points = rest_.points;
  step.types = rest_.types, step.begins = rest_.begins, step.vertices = rest_.vertices;
  step.cellIds = rest_.cellIds, step.pointIds = rest_.pointIds;
  return true;
}

bool StepOrder::isTorn(const CellMesh& step) {
  assert(step.points.size() == rest_.points.size());
  const std::optional<Names> names = namesByPlace(step.points);
  if (!names) return false;
  for (std::size_t v = 0; v < names->size(); ++v)
    if (orderOf(step.points[v], rest_.points[v]) != 0) return hasOtherEdges(rest_, step);
  return false;
}

}  // namespace qtet
