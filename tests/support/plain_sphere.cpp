#include "tests/support/plain_sphere.h"

#include <map>
#include <set>
#include <utility>
#include <vector>

namespace qtet::testing {

bool isPlainSphere(std::span<const Triangle> triangles) {
  if (triangles.size() < 4) return false;
  std::map<std::pair<VertexId, VertexId>, std::size_t> triangleAt;  // by directed edge
  std::set<VertexId> vertices;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t e = 0; e < 3; ++e) {
      const VertexId from = triangles[i][e], to = triangles[i][(e + 1) % 3];
      vertices.insert(from);
      if (from == to || !triangleAt.emplace(std::pair(from, to), i).second) return false;
    }
  std::set<std::size_t> reached{0};
  std::vector<std::size_t> waiting{0};
  while (!waiting.empty()) {
    const Triangle t = triangles[waiting.back()];
    waiting.pop_back();
    for (std::size_t e = 0; e < 3; ++e) {
      const auto across = triangleAt.find({t[(e + 1) % 3], t[e]});
      if (across == triangleAt.end()) return false;
      if (reached.insert(across->second).second) waiting.push_back(across->second);
    }
  }
  const std::size_t edges = triangleAt.size() / 2;
  return reached.size() == triangles.size() && vertices.size() + triangles.size() == edges + 2;
}

}  // namespace qtet::testing
