// Puts floats on the lattice: positions and fields become integers, and everything after this is
// exact.
#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "proto/error.h"
#include "simplify/clean/clean_mesh.h"
#include "simplify/clean/value_bounds.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// At most this share of the cells may be flattened or inverted at the finest lattice. Beyond it
/// little of the shape would be left.
inline constexpr double kMostWorseCells = 0.5;

struct QuantiseOptions {
  /// KMinPositionBits..kMaxPositionBits; raised when cells would be flattened or inverted.
  int positionBits = 16;
  int fieldBits = 12;    ///< kMinFieldBits..kMaxFieldBits, of fields that are not stored exactly
  ValueBounds errors{};  ///< of fields that take the bits of a bound instead
};

struct QuantiseReport {
  int requestedBits = 0;
  /// Cells that would have lost their sign at the bits asked for.
  std::uint64_t worseAtRequestedBits = 0;
  /// Cells that lose it at the bits used; none below kMaxPositionBits.
  Occurrences worseCells;
  std::uint64_t nonFiniteValues = 0;       ///< field values that were NaN or infinite: missing
  std::vector<std::uint64_t> nonFiniteOf;  ///< the same, one a field
  /// The same and more in sentences, empty when there is nothing to say.
  std::vector<std::string> notes;
  std::vector<std::string> warnings;  ///< values that lead far away from those of their series
};

struct QuantisedMesh {
  /// Missing values are filled with the nearest value: fillMissing.
  LatticeMesh mesh;
  QuantiseReport report;
  std::vector<std::vector<std::uint8_t>> missing{};  ///< one a field: QuantisedField::missing
};

/// Puts `mesh` on a lattice whose step is the largest extent / (2^bits - 1) and whose origin is the
/// lowest corner. It takes as many bits above `positionBits` as it needs for no cell to become
/// worse: positive volume to zero or less, zero to less. Float fields take `fieldBits`: step =
/// largest component's extent / (2^bits - 1) and a minimum a component. A field with a bound takes
/// the largest step that holds it and divides that extent, and the fewest bits for it
/// (FieldPrecision). Integer fields take step 1 and lose nothing where kMaxFieldBits bits hold
/// their range. Points and cells keep their order; the boundary is `boundary` where that is known,
/// else boundaryOf's. Errors: bad-value (bits outside their limits), quantiseField's, bad-input
/// (extents that a double cannot hold or divide; more than kMostWorseCells), cancelled. REQUIRES: a
/// mesh that cleanMesh has passed, errors that checkValueBounds has passed.
[[nodiscard]] Result<QuantisedMesh> quantise(const TetMesh& mesh,
                                             const QuantiseOptions& options = {},
                                             const std::stop_token& stop = {},
                                             std::vector<Triangle> boundary = {});

}  // namespace qtet
