#include "simplify/pipeline/moved_flips.h"

#include <array>
#include <span>
#include <vector>

#include "codec/mesh/predicates.h"
#include "simplify/mesh/moved_place.h"

namespace qtet {
namespace {

/// The live tetrahedra that are positive at rest.
std::vector<Tetrahedron> positiveCells(const FusionHistory& history) {
  std::vector<Tetrahedron> out;
  for (std::size_t c = 0; c < history.cells.size(); ++c) {
    const Tetrahedron& t = history.cells[c];
    if (!history.live[c] || t[3] == kGhost) continue;
    const auto at = [&](std::size_t i) { return history.points[t[i]]; };
    if (orientation(at(0), at(1), at(2), at(3)) > 0) out.push_back(t);
  }
  return out;
}

std::uint64_t flippedAt(const FusionHistory& history, std::span<const Tetrahedron> cells,
                        std::size_t field) {
  const std::span<const std::int32_t> values = history.values[field];
  const auto at = [&](VertexId v) {
    return movedPoint(history.lattice, history.fields[field], history.points[v],
                      values.subspan(3 * std::size_t{v}, 3));
  };
  std::uint64_t count = 0;
  for (const Tetrahedron& t : cells)
    count += movedOrientation(at(t[0]), at(t[1]), at(t[2]), at(t[3])) <= 0;
  return count;
}

}  // namespace

std::optional<std::string> MovedFlips::warning() const {
  if (flipped == 0) return std::nullopt;
  return "in the base mesh " + std::to_string(cells) +
         " cells are flat or inside out where it has moved, at " + worst +
         (instants == 1 ? std::string()
                        : ", and some at " + std::to_string(flipped) + " of its " +
                              std::to_string(instants) + " instants") +
         "; a base mesh of more cells has fewer of them (`baseCells`)";
}

MovedFlips movedFlips(const FusionHistory& history) {
  MovedFlips out;
  const std::vector<std::size_t> fields = displacementFields(history.fields);
  out.instants = fields.size();
  if (fields.empty()) return out;
  const std::vector<Tetrahedron> cells = positiveCells(history);
  for (const std::size_t f : fields) {
    const std::uint64_t count = flippedAt(history, cells, f);
    out.flipped += count > 0;
    if (count > out.cells) out.cells = count, out.worst = history.fields[f].name;
  }
  return out;
}

}  // namespace qtet
