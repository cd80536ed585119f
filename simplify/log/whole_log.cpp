#include "simplify/log/whole_log.h"

#include <string>

namespace qtet {

Status checkWhole(const Manifest& manifest) {
  if (!manifest.original) return {};
  return fail(ErrorCode::kBadInput,
              "the log ends at " + std::to_string(manifest.levels.back().tetrahedra) + " of " +
                  std::to_string(manifest.original->tetrahedra) +
                  " tetrahedra, so no mesh has the points of its last level; make a log without "
                  "`finest`, or one with all fields at once");
}

}  // namespace qtet
