// Parts for small meshes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "simplify/parts/parts_simplify.h"

namespace qtet::testing {

/// Each part grows over faces from the first cell that no part has yet.
inline std::vector<std::uint32_t> compactParts(const CellGraph& graph, std::uint32_t parts) {
  constexpr std::uint32_t kNobody = ~std::uint32_t{0};
  std::vector<std::uint32_t> out(graph.begins.size() - 1, kNobody);
  std::size_t seed = 0, done = 0;
  for (std::uint32_t part = 0; part < parts; ++part) {
    const std::size_t end = out.size() * (part + 1) / parts;
    std::deque<std::size_t> front;
    while (done < end) {
      if (front.empty()) {
        while (out[seed] != kNobody) ++seed;
        front.push_back(seed);
      }
      const std::size_t cell = front.front();
      front.pop_front();
      if (out[cell] != kNobody) continue;
      out[cell] = part, ++done;
      for (auto at = static_cast<std::size_t>(graph.begins[cell]);
           at < static_cast<std::size_t>(graph.begins[cell + 1]); ++at)
        front.push_back(static_cast<std::size_t>(graph.beside[at]));
    }
  }
  return out;
}

/// Some `cells` cells each, down to two of them.
inline PartsOptions smallParts(std::size_t cells) { return qtet::smallParts(compactParts, cells); }

}  // namespace qtet::testing
