// The error of one decoded mesh against another, measured without knowing how it came about: every
// place is looked for among all cells. It is the reference for the known errors of a log, which are
// followed from level to level.
#pragma once

#include <cstddef>

#include "codec/mesh/mesh.h"

namespace qtet::bench {

struct DirectError {
  double boundary = 0;  ///< as LevelError::boundaryMean()
  double field = 0;     ///< as FieldError::rms, of the first field
};

/// `samples` places on each boundary and in the original's volume; searching them takes samples x
/// cells box tests. REQUIRES: both meshes on one lattice, their first field a point field of one
/// component, not constant.
[[nodiscard]] DirectError directError(const LatticeMesh& original, const LatticeMesh& level,
                                      std::size_t samples);

}  // namespace qtet::bench
