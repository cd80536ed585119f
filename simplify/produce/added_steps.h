// Steps of a run that goes on, from its files to the fields of a log.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "simplify/log/add_fields.h"
#include "simplify/log/opened_log.h"
#include "simplify/read/options/read_options.h"
#include "simplify/words/progress.h"

namespace qtet {

struct StepsRequest {
  std::vector<std::string> files;
  std::vector<double> times;  ///< one a file, or none where the files know them
  ReadOptions reading;        ///< `fields` nullopt: those of which the log has a series
  AddFieldsOptions adding;
  /// Steps before one that cannot be read are added, and the error is AddedSteps::stopped.
  bool keepsEarlier = false;
};

struct AddedSteps {
  AddedFields added;        ///< without fields: there is nothing that the log does not have
  std::size_t steps = 0;    ///< that were added
  std::size_t skipped = 0;  ///< steps that the log has already; they are not read
  std::optional<Error> stopped{};
};

/// Reads the steps that the log does not have, a window at a time, and codes them. Steps of a time
/// that the log has are skipped, fields of which it has no series are noted. Errors: readMesh's,
/// cleanMesh's, FieldAdder's; bad-input (a file without a time, or with one that is given as well;
/// a field of another type or number of components than its series), not-found (no field of a
/// series of the log).
[[nodiscard]] Result<AddedSteps> addedSteps(const OpenedLog& log, const StepsRequest& request,
                                            Progress& progress);

}  // namespace qtet
