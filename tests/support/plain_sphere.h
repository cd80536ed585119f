// Whether triangles form one sphere, from the definition: what codec/mesh/link.h is held against.
#pragma once

#include <span>

#include "codec/mesh/mesh.h"

namespace qtet::testing {

/// There are at least four triangles, and edges connect all of them. Every edge joins two vertices
/// and occurs once in each direction. The Euler characteristic is 2.
[[nodiscard]] bool isPlainSphere(std::span<const Triangle> triangles);

}  // namespace qtet::testing
