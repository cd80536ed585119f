// A few triangles that a bound rests on.
#pragma once

#include <array>
#include <cassert>
#include <cstdint>

#include "simplify/mesh/vector3.h"

namespace qtet {

/// The corners of a triangle.
using Corners = std::array<Vector3, 3>;

/// A few triangles of a surface; `isAll` is false where there were more.
struct BoundTriangles {
  std::array<std::uint32_t, 10> triangles{};
  std::uint8_t count = 0;
  bool isAll = true;

  void add(std::uint32_t triangle) {
    assert(count <= triangles.size());
    for (std::size_t i = 0; i < count; ++i)
      if (triangles[i] == triangle) return;
    if (count == triangles.size()) {
      isAll = false;
    } else {
      triangles[count++] = triangle;
    }
  }
  void add(const BoundTriangles& other) {
    for (std::size_t i = 0; i < other.count; ++i) add(other.triangles[i]);
    isAll &= other.isAll;
  }
};

}  // namespace qtet
