// The fields of a mesh as integers (quantise.h), and what to say about them.
#pragma once

#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "simplify/clean/quantise.h"
#include "simplify/clean/quantise_field.h"

namespace qtet {

struct PlacedFields {
  std::vector<QuantisedField> fields;  ///< missing values are 0
  /// The finest step of a log is too coarse for the values, which span so much; 0: it is not.
  std::vector<double> tooFine;
  std::vector<std::string> warnings;  ///< QuantiseReport::warnings
};

/// Errors: those of quantiseBy. REQUIRES: as quantise.
[[nodiscard]] Result<PlacedFields> placeFields(std::span<const MeshField> fields,
                                               const QuantiseOptions& options,
                                               const std::stop_token& stop);

/// Notes missing and rounded values, and sums up the report's nonFiniteOf. `infos` are those of the
/// fields. REQUIRES: nonFiniteOf.
void noteFields(const PlacedFields& placed, std::span<const FieldInfo> infos,
                QuantiseReport& report);

}  // namespace qtet
