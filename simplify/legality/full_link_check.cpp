#include "simplify/legality/full_link_check.h"

#include <algorithm>
#include <cassert>

#include "codec/mesh/growing_mesh.h"

namespace qtet {

bool FullLinkCheck::passes(const FusionMesh& mesh, const Prey& prey, const Star& star) {
  assert(prey.k >= 2 && prey.k <= 4);
  assert(star.labels.size() == star.affected.size());
  mesh_ = &mesh;
  prey_ = prey;
  build(star);
  if (!link_.close() || link_.vertices().size() != star.link.size() || !link_.isSphere())
    return false;
  return deletedOnLink(star) && patchIsDisc(star) && describable(star);
}

int FullLinkCheck::preyIndex(VertexId v) const {
  for (int i = 0; i < prey_.k; ++i)
    if (prey_.vertex[static_cast<std::size_t>(i)] == v) return i;
  return -1;
}

void FullLinkCheck::build(const Star& star) {
  link_.clear(mesh_->vertexSlots());
  for (std::size_t i = 0; i < star.affected.size(); ++i) {
    const auto& cell = mesh_->cell(star.affected[i]);
    const auto at = static_cast<std::size_t>(std::ranges::find(cell, prey_.vertex[star.labels[i]]) -
                                             cell.begin());
    assert(at < 4 && star.labels[i] < prey_.k);
    const auto turned = withLast(cell, at);
    link_.add(turned[0], turned[1], turned[2]);
  }
}

// Every edge of a deleted cell between two vertices that stay must be an edge of the link.
bool FullLinkCheck::deletedOnLink(const Star& star) const {
  for (const CellId c : star.deleted) {
    std::array<std::uint32_t, 4> stay{};
    std::size_t n = 0;
    for (const VertexId v : mesh_->cell(c))
      if (preyIndex(v) < 0) stay[n++] = link_.localOf(v);
    assert(n <= 2);  // or it had but one prey vertex
    if (n == 2 && link_.triangleAtEdge(stay[0], stay[1]) == kNoNeighbour) return false;
  }
  return true;
}

// The boundary faces that touch the prey must form one disc: then the new fan round the fused
// vertex, a disc too, replaces them.
bool FullLinkCheck::patchIsDisc(const Star& star) const {
  std::int64_t ring = 0;
  for (const LinkTriangle& t : link_.triangles()) ring += t.ghost;
  std::int64_t faces = ring;
  for (const CellId c : star.deleted)
    faces += std::ranges::find(mesh_->cell(c), kGhost) != mesh_->cell(c).end();
  assert(faces >= ring);
  if (faces == 0) return true;
  std::int64_t inner = 0;
  for (const VertexId v : prey_.vertices()) inner += mesh_->onBoundary(v);
  if ((3 * faces + ring) % 2 != 0) return false;
  return inner + ring - (3 * faces + ring) / 2 + faces == 1;
}

bool FullLinkCheck::describable(const Star& star) {
  assert(link_.triangles().size() == star.labels.size());
  for (std::uint32_t i = 0; i < star.labels.size(); ++i) link_.label(i, star.labels[i]);
  truth_.clear();
  for (const CellId c : star.deleted) {
    LocalCell local{};
    for (std::size_t i = 0; i < 4; ++i) {
      const int p = preyIndex(mesh_->cell(c)[i]);
      local[i] = p >= 0 ? kPreyBit | static_cast<LocalVertex>(p) : link_.localOf(mesh_->cell(c)[i]);
    }
    truth_.push_back(sorted(local));
  }
  std::ranges::sort(truth_);
  EchoCoder echo;
  return codeDeletedCells(echo, models_, link_, prey_.k, truth_, derived_);
}

}  // namespace qtet
