// Checks a refiner's invariants after any input. Every id is in its range, and every field is as
// long as its points or cells.
#pragma once

#include <cstdlib>

#include "codec/log/log_index.h"
#include "codec/refine/refiner.h"

namespace qtet::fuzz {

inline void abortUnlessSound(const Refiner& refiner) {
  const std::size_t vertices = refiner.points().size();
  for (const auto& cell : refiner.tetrahedra())
    for (const VertexId v : cell)
      if (v >= vertices) std::abort();
  for (const auto& triangle : refiner.boundary())
    for (const VertexId v : triangle)
      if (v >= vertices) std::abort();
  const std::int32_t size = std::int32_t{1} << refiner.index().positionBits;
  for (const LatticePoint& p : refiner.points())
    for (const std::int32_t x : p)
      if (x < 0 || x >= size) std::abort();
}

/// REQUIRES: every chunk and this field's part of it were applied without an error.
inline void abortUnlessWhole(const Refiner& refiner, std::uint32_t field) {
  const FieldShape shape = refiner.index().fields[field];
  const std::size_t owners = shape.association == Association::kCell ? refiner.tetrahedra().size()
                                                                     : refiner.points().size();
  if (refiner.fieldValues(field).size() != owners * shape.components) std::abort();
}

}  // namespace qtet::fuzz
