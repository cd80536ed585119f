// A mesh without the slots that nothing has filled yet. Files and measurements need it from a
// refiner that has only some of the packets.
#pragma once

#include "codec/mesh/mesh.h"

namespace qtet {

/// Removes holes (mesh.h) with their values; the others keep their order and get the ids that are
/// then theirs.
void dropHoles(LatticeMesh& mesh);

}  // namespace qtet
