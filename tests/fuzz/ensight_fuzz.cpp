// Fuzzes the readers of EnSight's geometries and variables: an error, or arrays that agree in
// length. The first byte chooses the encoding. The next two say how many words of four bytes the
// geometry has; the variable follows.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "simplify/read/ensight/ensight_values.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace qtet;
  constexpr std::size_t kFront = 3;
  if (size < kFront) return 0;
  const bool isOfElements = (data[0] & 2) != 0;
  EnSightEncoding encoding;
  encoding.isGold = (data[0] & 1) != 0;
  if ((data[0] & 4) != 0) encoding.kind = EnSightEncoding::kC;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + kFront, size - kFront);
  const std::string_view geometry = bytes.substr(0, 4 * (data[1] + std::size_t{256} * data[2]));
  ReadReport report;
  EnSightBounds bounds{kReadPatience, 1 << 24};
  const auto read = readEnSightGeometry(geometry, "g", encoding, bounds, report);
  if (!read) return 0;
  for (const EnSightBlock& block : read->blocks)
    if (block.rows.size() != block.mesh.cells() ||
        block.mesh.begins.back() != block.mesh.vertices.size() ||
        (!block.rows.empty() && block.rows.back() >= block.elements))
      std::abort();
  const EnSightVariable variable{"V", isOfElements, 3, {}};
  const auto values =
      readEnSightValues(bytes.substr(geometry.size()), "v", variable, *read, bounds);
  for (std::size_t i = 0; values && i < values->size(); ++i) {
    const EnSightBlock& block = read->blocks[i];
    const std::uint64_t tuples = isOfElements ? block.elements : block.mesh.points.size();
    if (!(*values)[i].empty() && (*values)[i].size() != 3 * tuples) std::abort();
  }
  return 0;
}
