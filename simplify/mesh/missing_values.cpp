#include "simplify/mesh/missing_values.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace qtet {
namespace {

/// The cells round each point.
class CellsOfPoints {
 public:
  explicit CellsOfPoints(std::span<const Tetrahedron> cells) {
    VertexId points = 0;
    for (const Tetrahedron& t : cells) points = std::max(points, std::ranges::max(t) + 1);
    first_.assign(std::size_t{points} + 1, 0);
    for (const Tetrahedron& t : cells)
      for (const VertexId v : t) ++first_[v + 1];
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    cells_.resize(first_.back());
    std::vector<std::size_t> next = first_;
    for (CellId c = 0; c < cells.size(); ++c)
      for (const VertexId v : cells[c]) cells_[next[v]++] = c;
  }
  [[nodiscard]] std::size_t points() const { return first_.size() - 1; }
  [[nodiscard]] std::span<const CellId> of(VertexId v) const {
    if (v >= points()) return {};  // behind the last point that a cell uses
    return std::span(cells_).subspan(first_[v], first_[v + 1] - first_[v]);
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<CellId> cells_;
};

}  // namespace

void fillMissing(std::span<const Tetrahedron> cells, const FieldInfo& field,
                 std::span<const std::uint8_t> missing, std::vector<std::int32_t>& values) {
  assert(field.components > 0 && values.size() % field.components == 0);
  assert(missing.size() == values.size());
  assert(!isCellField(field) || values.size() == cells.size() * field.components);
  const CellsOfPoints around(cells);
  const std::size_t n = field.components;
  // points whose cells are all known: once is enough, however many cells meet there
  std::vector<std::uint8_t> crossed;
  const auto forNeighbours = [&](std::uint32_t i, const auto& visit) {
    if (isCellField(field)) {
      for (const VertexId v : cells[i])
        if (std::exchange(crossed[v], std::uint8_t{1}) == 0)
          for (const CellId c : around.of(v)) visit(c);
    } else {
      for (const CellId c : around.of(i))
        for (const VertexId v : cells[c]) visit(v);
    }
  };
  for (std::size_t c = 0; c < n; ++c) {
    std::vector<std::uint8_t> known(values.size() / n);
    crossed.assign(around.points(), 0);
    std::vector<std::uint32_t> queue;
    for (std::uint32_t i = 0; i < known.size(); ++i)
      if (missing[i * n + c] == 0) known[i] = 1, queue.push_back(i);
    for (std::size_t head = 0; head < queue.size(); ++head) {
      const std::uint32_t from = queue[head];
      forNeighbours(from, [&](std::uint32_t to) {
        if (std::exchange(known[to], std::uint8_t{1}) != 0) return;
        values[to * n + c] = values[from * n + c];
        queue.push_back(to);
      });
    }
  }
}

std::vector<std::uint8_t> missingOfFused(const FusionHistory& history, std::size_t n,
                                         std::vector<std::uint8_t> missing) {
  missing.resize(history.points.size() * n);
  for (const Fusion& fusion : history.fusions)
    for (std::size_t c = 0; c < n; ++c)
      missing[fusion.fused * n + c] =
          std::all_of(fusion.prey.begin(), fusion.prey.begin() + fusion.k,
                      [&](VertexId v) { return missing[v * n + c] != 0; });
  return missing;
}

std::vector<std::int32_t> withMissing(const FusionHistory& history, const FieldInfo& field,
                                      std::vector<std::uint8_t> missing,
                                      std::vector<std::int32_t> values) {
  assert(missing.size() <= values.size());
  if (!isCellField(field)) missing = missingOfFused(history, field.components, std::move(missing));
  assert(missing.size() == values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    if (missing[i] != 0) values[i] = kMissing;
  return values;
}

void restoreMissing(FusionHistory& history, const std::vector<std::vector<std::uint8_t>>& missing) {
  assert(missing.size() <= history.fields.size());
  for (std::size_t f = 0; f < missing.size(); ++f)
    if (!missing[f].empty())
      history.values[f] =
          withMissing(history, history.fields[f], missing[f], std::move(history.values[f]));
}

}  // namespace qtet
