#include <string>

#include "codec/coding/number_type.h"
#include "codec/files/mesh_file.h"

namespace qtet {
namespace {

constexpr std::uint8_t kVtkTetra = 10;
constexpr auto kBig = std::endian::big;

/// Names hold no white space in this format: VTK's own way round it is that of URLs.
std::string encoded(const std::string& name) {
  constexpr const char* kHex = "0123456789ABCDEF";
  std::string out;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte > 0x20 && byte < 0x7F && c != '%' && c != '"') {
      out += c;
    } else {
      out += {'%', kHex[byte >> 4], kHex[byte & 15]};
    }
  }
  return out.empty() ? "%20" : out;
}

void appendFields(Bytes& out, const char* kind, std::size_t tuples,
                  const std::vector<FileField>& fields) {
  if (fields.empty()) return;
  appendText(out, std::string(kind) + " " + std::to_string(tuples) + "\nFIELD FieldData " +
                      std::to_string(fields.size()) + "\n");
  for (const FileField& field : fields) {
    const NumberType& type = numberType(field.type);
    appendText(out, encoded(field.name) + " " + std::to_string(field.components) + " " +
                        std::to_string(tuples) + " " + std::string(type.legacyName) + "\n");
    type.appendBigEndian(out, field.values);
    out.push_back('\n');
  }
}

}  // namespace

Bytes legacyVtkBytes(const FileMesh& mesh) {
  Bytes out;
  const std::size_t cells = mesh.tetrahedra.size();
  appendText(
      out,
      "# vtk DataFile Version 3.0\nwritten by qtet\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS " +
          std::to_string(mesh.points.size()) + (mesh.doublePoints ? " double\n" : " float\n"));
  for (const auto& p : mesh.points)
    (mesh.doublePoints ? numberType("float64") : numberType("float32")).appendBigEndian(out, p);
  appendText(out, "\nCELLS " + std::to_string(cells) + " " + std::to_string(5 * cells) + "\n");
  for (const Tetrahedron& cell : mesh.tetrahedra) {
    appendNumber<kBig>(out, std::int32_t{4});
    for (const VertexId v : cell) appendNumber<kBig>(out, static_cast<std::int32_t>(v));
  }
  appendText(out, "\nCELL_TYPES " + std::to_string(cells) + "\n");
  for (std::size_t i = 0; i < cells; ++i) appendNumber<kBig>(out, std::int32_t{kVtkTetra});
  out.push_back('\n');
  appendFields(out, "POINT_DATA", mesh.points.size(), mesh.pointFields);
  appendFields(out, "CELL_DATA", cells, mesh.cellFields);
  return out;
}

}  // namespace qtet
