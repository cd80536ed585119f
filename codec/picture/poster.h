// A poster: the viewer's first picture of a mesh, small enough to come with the page.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "codec/mesh/mesh.h"
#include "proto/bytes.h"
#include "proto/error.h"
#include "proto/manifest.h"

namespace qtet {

/// A line of 400 kbit/s brings so much in an eighth of a second.
inline constexpr std::size_t kMaxPosterBytes = 6000;
/// The larger side has so many. More pixels would not fit into the bytes.
inline constexpr int kMaxPosterPixels = 640;
inline constexpr int kMinPosterPixels = 80;

/// The level that the viewer draws first: the last one of the base mesh's chunk. REQUIRES: a level.
[[nodiscard]] std::uint32_t posterLevel(const Manifest& manifest);
/// The field that colours it, or none. Behind it may come the one that moves it.
[[nodiscard]] std::vector<std::uint32_t> posterFields(const Manifest& manifest);

/// A WebP of at most kMaxPosterBytes with a transparent ground. It holds the rectangle that the
/// viewer fits into the free area. Scaled to that share of the area, it shows the mesh in its
/// place. The opening's plane cuts the mesh. Large displacements move it. Cell edges are left out.
/// Where the viewer looks at a part, the picture fades out towards its edges. `mesh` is at
/// posterLevel with posterFields. Deterministic. Errors: bad-input (no boundary), io (libwebp
/// refused), limit-exceeded (the smallest picture takes more bytes).
[[nodiscard]] Result<Bytes> posterWebp(const LatticeMesh& mesh, const Manifest& manifest);

}  // namespace qtet
