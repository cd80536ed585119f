// The cost and quality of a log's levels, as the tool and the server report them. Includes
// nlohmann-json.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

namespace qtet {

struct LogIndex;
struct Manifest;

/// Length of the file's prefix that holds `level`. REQUIRES: a manifest that manifestOf(index)
/// gave, and one of its levels.
[[nodiscard]] std::uint64_t prefixBytes(const Manifest& manifest, const LogIndex& index,
                                        std::size_t level);

/// [{level, tetrahedra, vertices, boundaryTriangles, bytes, cumulativeBytes, error}], as `GET
/// /v1/meshes/{id}` has it (PROTOCOL.md); `error` where the manifest has it. REQUIRES: as
/// prefixBytes.
[[nodiscard]] nlohmann::ordered_json levelsJson(const Manifest& manifest, const LogIndex& index);

}  // namespace qtet
