// Fields of a mesh file for a log that is there already (ALGORITHM.md, "Fields added later").
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "codec/refine/log_edit.h"
#include "codec/refine/log_history.h"
#include "simplify/measure/measure_error.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

struct AddFieldsOptions {
  int fieldBits = 12;
  Effort effort = Effort::kLevels;  ///< for measuring, where the log knows the errors of its levels
  int threads = 1;
  std::function<void(double)> progress;  ///< fraction done
};

struct AddedFields {
  std::vector<NewField> fields;
  std::vector<std::string> notes;
};

/// The fields of `mesh` as blocks for `log`, whose last level must be the mesh; its geometry stays
/// as it is. Errors: matchMesh's, quantiseField's, bad-value (a position off the log's lattice),
/// and all that decoding gives. REQUIRES: a mesh that cleanMesh has passed.
[[nodiscard]] Result<AddedFields> addFields(const LogFile& log, const TetMesh& mesh,
                                            const AddFieldsOptions& options = {});

/// Values of all of the history's vertices from those of the last level's, `components` integers
/// each. A fused vertex on an edge takes the values of its two prey at its place there. With more
/// than two prey it takes their mean by the volume that they stand for.
[[nodiscard]] std::vector<std::int32_t> fusedValues(const LogHistory& log,
                                                    std::vector<std::int32_t> values,
                                                    std::uint32_t components);

}  // namespace qtet
