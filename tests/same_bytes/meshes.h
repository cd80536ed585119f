// The meshes of tests/same_bytes.txt: the built-in samples, or a few thousand cells of them, with
// fields and holes that the samples do not have. Made with + - * / sqrt alone: every machine makes
// the same.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "proto/error.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet::testing {

struct SameBytesMesh {
  std::string_view name;  ///< of its file, without .vtu
  TetMesh (*make)();
};

[[nodiscard]] std::span<const SameBytesMesh> sameBytesMeshes();

/// REQUIRES: a name of sameBytesMeshes().
[[nodiscard]] TetMesh sameBytesMesh(std::string_view name);

/// Steps of the series that is coded in windows: more than are sampled, and more than a window has.
inline constexpr std::size_t kSameBytesSteps = 20;
/// An InstantsReader of it (simplify/pipeline/series_pipeline.h).
[[nodiscard]] Result<TetMesh> sameBytesInstants(std::span<const std::size_t> steps);

}  // namespace qtet::testing
