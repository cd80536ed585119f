// Any mesh as a small real log in a file, made through the simplifier and the encoder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "codec/mesh/mesh.h"
#include "proto/bytes.h"
#include "simplify/fuse/qtetfusion.h"

namespace qtet::testing {

/// Chunks of about `chunkBytes`; `source` is what it says that it was made from. Throws what went
/// wrong.
[[nodiscard]] Bytes logBytes(const LatticeMesh& mesh, const FusionOptions& fusion = {},
                             std::uint32_t chunkBytes = 2048,
                             const std::string& source = "mesh.vtu");
/// The same in a file.
void writeLog(const std::filesystem::path& path, const LatticeMesh& mesh,
              const FusionOptions& fusion = {}, std::uint32_t chunkBytes = 2048);

}  // namespace qtet::testing
