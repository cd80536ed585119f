// Reports and proofs of what a log keeps of its input: sizes for reports, exact comparison for
// `qtet verify`. For .cpp files only: it drags nlohmann-json in.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "proto/error.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

class LogFile;
struct ClosingBlock;
struct Manifest;

/// {"point order": bytes, "cell order": bytes, "original cells": bytes, "exact positions": bytes,
/// "exact NAME": bytes}, as far as they are there.
[[nodiscard]] nlohmann::ordered_json closingJson(std::span<const ClosingBlock> blocks,
                                                 const Manifest& manifest);

/// Compares what the log kept with the input. `placed` is the cleaned input on the log's lattice.
/// `input` is the same in floats, with its cells' vertices as read. `cells` is takeOriginalCells'
/// result for it. Returns the proofs: {"order": bool, "positions": bool, "fields": {NAME: bool}},
/// and "originalCells": true where the log has them. Errors: bad-value (the first point, cell or
/// value that differs), and restoreInput's. REQUIRES: sameMesh(finest, placed).
[[nodiscard]] Result<nlohmann::ordered_json> compareKept(
    const LogFile& log, const LatticeMesh& finest, const LatticeMesh& placed, const TetMesh& input,
    const std::optional<std::vector<std::uint32_t>>& cells);

}  // namespace qtet
