#include "simplify/read/vtu/old_hexahedra.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "simplify/split/higher_cells.h"

namespace qtet {
namespace {

std::array<int, 2> versionNumbers(std::string_view text) {
  std::array<int, 2> out{};
  const char *at = text.data(), *end = at + text.size();
  at = std::from_chars(at, end, out[0]).ptr;
  if (at != end && *at == '.') std::from_chars(at + 1, end, out[1]);
  return out;
}

const MeshField* statedDegrees(const CellMesh& mesh) {
  const auto at = std::ranges::find_if(mesh.fields, [&](const MeshField& field) {
    return isCellField(field) && field.name == kDegreesField && field.components == 3 &&
           field.values.size() == 3 * mesh.cells();
  });
  return at == mesh.fields.end() ? nullptr : &*at;
}

}  // namespace

bool isOlderVersion(std::string_view version, std::string_view other) {
  return versionNumbers(version) < versionNumbers(other);
}

void renumberOldHexahedra(CellMesh& mesh) {
  const MeshField* stated = statedDegrees(mesh);
  for (std::size_t i = 0; i < mesh.cells(); ++i) {
    const std::uint8_t type = mesh.types[i];
    if (type != kLagrangeHexahedronCell && type != kBezierHexahedronCell) continue;
    const std::span<VertexId> ids =
        std::span(mesh.vertices).subspan(mesh.begins[i], mesh.begins[i + 1] - mesh.begins[i]);
    const std::optional<Degrees> degrees =
        degreesOf(type, ids.size(),
                  stated ? std::span(stated->values).subspan(3 * i, 3) : std::span<const double>());
    if (!degrees) continue;
    const auto [x, y, z] = *degrees;
    // behind the corners, the edges along x and y, and edges 8 and 9
    const auto edge = static_cast<std::size_t>(z - 1),
               tenth = 8 + 4 * static_cast<std::size_t>(x + y - 2) + 2 * edge;
    std::ranges::swap_ranges(ids.subspan(tenth, edge), ids.subspan(tenth + edge, edge));
  }
}

}  // namespace qtet
