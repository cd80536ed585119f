// A picture of a mesh for lists and links: its boundary, drawn in software.
#pragma once

#include "codec/mesh/mesh.h"
#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

inline constexpr int kPreviewWidth = 640;
inline constexpr int kPreviewHeight = 480;
/// The preview shows the finest level of at most this many boundary triangles. More would be
/// smaller than a pixel.
inline constexpr std::uint32_t kMaxPreviewTriangles = 100'000;

/// A PNG with a transparent ground: seen from (1, -1.3, 0.8) without perspective, z upwards, the
/// whole mesh in the picture, lit from beside the eye, flat. The mesh's first field colours it if
/// it is a point field: by its one component, or by the magnitude of several, over its range. A
/// missing value and a mesh without such a field are grey. Deterministic.
/// REQUIRES: indices within range. Errors: bad-input (no boundary), io (libpng refused).
[[nodiscard]] Result<Bytes> previewPng(const LatticeMesh& mesh);

}  // namespace qtet
