#include "simplify/legality/flip_check.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "codec/mesh/growing_mesh.h"
#include "simplify/legality/lattice_rounding.h"

namespace qtet {
namespace {

// Whether the cell of prey vertex i turns from positive to flat or inverted, further than `error`.
// The result is unspecified for a cell that goes.
inline bool flips(const FusionMesh& mesh, const Prey& prey, std::uint32_t i, CellId c,
                  const Vector3& place, double error) {
  const auto& cell = mesh.cell(c);
  assert(mesh.isLive(c) && !mesh.isGhost(c) && mesh.holds(c, prey.vertex[i]));
  for (std::uint32_t j = 0; j < prey.k; ++j)
    if (j != i && mesh.holds(c, prey.vertex[j])) return false;
  const VertexId v = prey.vertex[i];
  const auto t = withLast(cell, (cell[1] == v) + 2 * (cell[2] == v) + 3 * (cell[3] == v));
  const Vector3 corner = mesh.position(t[0]),
                normal = cross(mesh.position(t[1]) - corner, mesh.position(t[2]) - corner);
  return dot(normal, place - corner) <= -error && dot(normal, mesh.position(v) - corner) > error;
}

}  // namespace

bool FlipCheck::flipsAt(const Prey& prey, const LatticePoint& p, std::uint32_t moving) const {
  assert(moving < 1u << prey.k);
  const Vector3 place = toVector(p);
  // Coordinates reach as far as the lattice; what is too close to call is not called.
  const double error =
      mesh_.latticeBits() <= kExactBits ? 0 : kRounding * std::ldexp(1.0, 3 * mesh_.latticeBits());
  for (std::uint32_t i = 0; i < prey.k; ++i)
    assert(last_[i] == kNoCell || mesh_.holds(last_[i], prey.vertex[i]));
  for (std::uint32_t i = 0; i < prey.k; ++i)
    if ((moving >> i & 1) != 0 && last_[i] != kNoCell &&
        flips(mesh_, prey, i, last_[i], place, error))
      return true;
  for (std::uint32_t i = 0; i < prey.k; ++i) {
    if ((moving >> i & 1) == 0 || mesh_.point(prey.vertex[i]) == p) continue;
    const auto cells = mesh_.innerStar(prey.vertex[i]);
    const auto flipped = std::ranges::find_if(
        cells, [&](CellId c) { return flips(mesh_, prey, i, c, place, error); });
    if (flipped == cells.end()) continue;
    last_[i] = *flipped;
    return true;
  }
  return false;
}

}  // namespace qtet
