// The link test for prey of three and four vertices: the whole link is built and judged
// (ALGORITHM.md, "Legality").
#pragma once

#include <vector>

#include "codec/mesh/deleted_cells.h"
#include "codec/mesh/link.h"
#include "simplify/mesh/fusion_mesh.h"

namespace qtet {

class FullLinkCheck {
 public:
  /// Whether fusing the prey, whose star is given, keeps topology and can be described by the log.
  [[nodiscard]] bool passes(const FusionMesh& mesh, const Prey& prey, const Star& star);

 private:
  [[nodiscard]] int preyIndex(VertexId v) const;
  void build(const Star& star);
  [[nodiscard]] bool deletedOnLink(const Star& star) const;
  [[nodiscard]] bool patchIsDisc(const Star& star) const;
  [[nodiscard]] bool describable(const Star& star);

  const FusionMesh* mesh_ = nullptr;
  Prey prey_;
  Link link_;
  DeletedModels models_;
  std::vector<LocalCell> truth_, derived_;
};

}  // namespace qtet
