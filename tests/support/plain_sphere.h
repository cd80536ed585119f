// Whether triangles form one sphere, from the definition: what codec/mesh/link.h is held against.
#pragma once

#include <span>

#include "codec/mesh/mesh.h"

namespace qtet::testing {

/// There are four at least, every edge joins two vertices and is met once in each direction, all
/// hang together by edges, and the Euler characteristic is 2.
[[nodiscard]] bool isPlainSphere(std::span<const Triangle> triangles);

}  // namespace qtet::testing
