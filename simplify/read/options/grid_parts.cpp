#include "simplify/read/options/grid_parts.h"

#include <algorithm>
#include <array>

#include "proto/limits.h"
#include "simplify/read/options/select_fields.h"

namespace qtet {
namespace {

/// VTK's types of dimension 0, 1 and 2.
constexpr std::array<std::uint8_t, 3> kOfPoints{0, 1, 2};
constexpr std::array<std::uint8_t, 6> kOfLines{3, 4, 21, 35, 68, 75};
constexpr std::array<std::uint8_t, 15> kOfFaces{5,  6,  7,  8,  9,  22, 23, 28,
                                                30, 34, 36, 69, 70, 76, 77};

constexpr auto kDimensions = [] {
  std::array<std::uint8_t, 256> out{};
  out.fill(3);
  for (const std::uint8_t type : kOfPoints) out[type] = 0;
  for (const std::uint8_t type : kOfLines) out[type] = 1;
  for (const std::uint8_t type : kOfFaces) out[type] = 2;
  return out;
}();

}  // namespace

int dimensionOf(std::uint8_t type) { return kDimensions[type]; }

VertexId narrowedId(std::int64_t id) {
  return id >= 0 && id < std::int64_t{kGhost} ? static_cast<VertexId>(id) : kGhost;
}

std::string verticesOutside(std::uint64_t cell) {
  return "cell " + std::to_string(cell) +
         " has vertices outside the list of vertices; the file is damaged, export it again";
}

std::string withoutFaces(std::uint64_t cell) {
  return "cell " + std::to_string(cell) +
         " is a polyhedron without its faces; the file is damaged, export it again";
}

bool appendFaces(std::span<const std::int64_t> faces, std::size_t& at, CellMesh& out) {
  if (at >= faces.size()) return false;
  const std::int64_t count = faces[at++];
  out.vertices.push_back(narrowedId(count));
  for (std::int64_t face = 0; face < count; ++face) {
    if (at >= faces.size()) return false;
    const std::int64_t corners = faces[at++];
    if (corners < 0 || static_cast<std::uint64_t>(corners) > faces.size() - at) return false;
    out.vertices.push_back(narrowedId(corners));
    for (std::int64_t k = 0; k < corners; ++k) out.vertices.push_back(narrowedId(faces[at++]));
  }
  return true;
}

void keepRows(MeshField& field, std::span<const std::uint64_t> rows) {
  const std::size_t n = field.components;
  if (rows.size() * n == field.values.size()) return;
  for (std::size_t i = 0; i < rows.size(); ++i)
    std::copy_n(field.values.data() + rows[i] * n, n, field.values.data() + i * n);
  field.values.resize(rows.size() * n);
}

std::optional<std::string> FieldChoice::nameOf(const GridArray& array,
                                               const std::string& association, CellMesh& out) {
  std::string name = array.name;
  if (!isStorableName(name)) {
    const std::string number = std::to_string(array.number);
    name = "unnamed-" + number;
    report_.notes.push_back(association + " field number " + number +
                            " has no name, or none of at most " + std::to_string(kMaxNameBytes) +
                            " bytes of UTF-8, and is called " + name);
  }
  if (name == kGhostTypes || name == kGhostLevels) return std::nullopt;
  if (!array.hasNumbers || array.components < 1 || array.components > kMaxFieldComponents) {
    report_.ignoredFields.push_back(name);
    report_.notes.push_back(
        association + " field " + name + " was ignored: " +
        (array.hasNumbers ? "more than " + std::to_string(kMaxFieldComponents) + " components"
                          : std::string("it holds no numbers")));
    return std::nullopt;
  }
  if (!array.isOfTheShape && !isMeant(wanted_, association, name)) {
    out.otherFields.push_back(name);
    return std::nullopt;
  }
  return name;
}

}  // namespace qtet
