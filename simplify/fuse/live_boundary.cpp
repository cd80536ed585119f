#include "simplify/fuse/live_boundary.h"

#include <algorithm>
#include <cassert>

#include "codec/mesh/predicates.h"
#include "simplify/mesh/cell_corners.h"

namespace qtet {
namespace {

/// The fused vertex before it has a number: no boundary triangle has the ghost as a corner.
constexpr VertexId kFused = kGhost;

bool isPrey(const Prey& prey, VertexId v) {
  return std::ranges::find(prey.vertices(), v) != prey.vertices().end();
}

// p lies in the closed tetrahedron of the face and a point outside of it.
bool isIn(const LatticePoint& p, const std::array<LatticePoint, 3>& face, const LatticePoint& top) {
  return orientation(face[0], face[1], face[2], p) >= 0 &&
         orientation(face[1], face[0], top, p) >= 0 && orientation(face[2], face[1], top, p) >= 0 &&
         orientation(face[0], face[2], top, p) >= 0;
}

}  // namespace

LiveBoundary::LiveBoundary(const FusionMesh& mesh)
    : mesh_(mesh), firstGhost_(mesh.firstGhost()), tree_([&] {
        const std::size_t count = mesh.boundaryTriangles();
        triangles_.resize(count), points_.resize(3 * count), vertices_.resize(count);
        live_.resize(count);
        for (std::uint32_t i = 0; i < count; ++i) {
          assert(mesh.isGhost(firstGhost_ + i));
          live_[i] = mesh.isLive(firstGhost_ + i);
          triangles_[i] = {3 * i, 3 * i + 1, 3 * i + 2, kGhost};
          const auto& cell = mesh.cell(firstGhost_ + i);
          for (std::size_t corner = 0; corner < 3; ++corner)
            place(firstGhost_ + i, corner, cell[corner], mesh.point(cell[corner]));
        }
        return treeOfLive();
      }()) {}

TriangleTree LiveBoundary::treeOfLive() const {
  std::vector<std::uint32_t> ids;
  for (std::uint32_t i = 0; i < live_.size(); ++i)
    if (live_[i] != 0) ids.push_back(i);
  TriangleTree out(points_, triangles_, std::move(ids));
  out.allowGrowth();
  return out;
}

void LiveBoundary::beginLevel() {
  const auto live = static_cast<std::size_t>(std::ranges::count(live_, 1));
  if (live > 0 && live <= tree_.builtOver() / 2)
    tree_ = treeOfLive();
  else
    tree_.refit(live_);
}

void LiveBoundary::place(CellId ghost, std::size_t corner, VertexId vertex,
                         const LatticePoint& at) {
  assert(corner < 3 && numberOf(ghost) < vertices_.size());
  assert(vertex != kGhost);
  vertices_[numberOf(ghost)][corner] = vertex;
  points_[3 * numberOf(ghost) + corner] = at;
}

PlacedTriangle LiveBoundary::triangle(std::uint32_t number) const {
  assert(number < vertices_.size());
  return {vertices_[number],
          {points_[3 * number], points_[3 * number + 1], points_[3 * number + 2]}};
}

void LiveBoundary::collect(const Proposal& proposal) {
  assert(proposal.prey.k >= 2 && proposal.prey.k <= 4);
  new_.clear(), left_.clear();
  const LatticePoint& p = proposal.where.point;
  const auto addLeft = [&](const PlacedTriangle& t) {
    if (orientation(t.at[0], t.at[1], t.at[2], p) > 0) left_.push_back(t);
  };
  for (const CellId c : proposal.star.deleted)
    if (mesh_.isGhost(c)) addLeft(triangle(numberOf(c)));
  for (const CellId c : proposal.star.affected) {
    if (!mesh_.isGhost(c)) continue;
    PlacedTriangle t = triangle(numberOf(c));
    addLeft(t);
    for (std::size_t i = 0; i < 3; ++i)
      if (isPrey(proposal.prey, t.vertex[i])) t.vertex[i] = kFused, t.at[i] = p;
    new_.push_back(t);
  }
}

bool LiveBoundary::foldsOnItself() const {
  for (std::size_t i = 0; i < new_.size(); ++i)
    for (std::size_t j = i + 1; j < new_.size(); ++j)
      if (overlap(new_[i], new_[j])) return true;
  return false;
}

// Whether a corner of the triangle that no new one has lies in what the solid gains. The gain lies
// between a triangle that the prey leaves and the fused vertex.
bool LiveBoundary::swallows(const LatticePoint& p, const PlacedTriangle& other) const {
  const auto isNew = [&](VertexId v) {
    return std::ranges::any_of(new_, [&](const PlacedTriangle& t) {
      return std::ranges::find(t.vertex, v) != t.vertex.end();
    });
  };
  for (std::size_t i = 0; i < 3; ++i)
    if (!isNew(other.vertex[i]) && std::ranges::any_of(left_, [&](const PlacedTriangle& t) {
          return isIn(other.at[i], t.at, p);
        }))
      return true;
  return false;
}

bool LiveBoundary::isMetBy(const Proposal& proposal, std::uint32_t other) const {
  if (live_[other] == 0) return false;
  const PlacedTriangle t = triangle(other);
  if (std::ranges::any_of(t.vertex, [&](VertexId v) { return isPrey(proposal.prey, v); }))
    return false;  // of the star itself
  return std::ranges::any_of(new_, [&](const PlacedTriangle& n) { return overlap(n, t); }) ||
         swallows(proposal.where.point, t);
}

bool LiveBoundary::isMetBy(const Proposal& proposal) {
  collect(proposal);
  if (foldsOnItself()) return true;
  LatticePoint low = proposal.where.point, high = low;
  const auto enclose = [&](const LatticePoint& p) {
    for (std::size_t k = 0; k < 3; ++k)
      low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  };
  for (const auto* triangles : {&new_, &left_})
    for (const PlacedTriangle& t : *triangles) std::ranges::for_each(t.at, enclose);
  bool meets = false;
  tree_.touching(low, high, [&](std::uint32_t other, const auto&) {
    return !(meets = isMetBy(proposal, other));
  });
  return meets;
}

void LiveBoundary::decideOn(const Proposal& proposal, VertexId fused) {
  for (const CellId c : proposal.star.deleted)
    if (mesh_.isGhost(c)) {
      assert(live_[numberOf(c)] != 0);
      live_[numberOf(c)] = 0;
    }
  for (const CellId c : proposal.star.affected) {
    if (!mesh_.isGhost(c)) continue;
    assert(live_[numberOf(c)] != 0);
    for (std::size_t i = 0; i < 3; ++i)
      if (isPrey(proposal.prey, vertices_[numberOf(c)][i]))
        place(c, i, fused, proposal.where.point);
    tree_.grow(numberOf(c));
  }
}

}  // namespace qtet
