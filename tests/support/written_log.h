// Any mesh as a small real log in a file, made through the simplifier and the encoder.
#pragma once

#include <cstdint>
#include <filesystem>

#include "codec/mesh.h"
#include "simplify/qtetfusion.h"

namespace qtet::testing {

/// Chunks of about `chunkBytes`. Throws what went wrong.
void writeLog(const std::filesystem::path& path, const LatticeMesh& mesh, const FusionOptions& fusion = {}, std::uint32_t chunkBytes = 2048);

}  // namespace qtet::testing
