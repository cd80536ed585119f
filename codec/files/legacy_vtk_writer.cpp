#include <string>
#include <utility>

#include "codec/coding/number_type.h"
#include "codec/files/field_limits.h"
#include "codec/files/file_names.h"
#include "codec/files/mesh_file.h"
#include "codec/files/pieces.h"

namespace qtet {
namespace {

constexpr std::uint8_t kVtkTetra = 10;
constexpr std::size_t kMaxIds = 0x7FFFFFFF;  ///< ids are signed 32-bit integers
constexpr auto kBig = std::endian::big;

void writeFields(Pieces& out, const char* kind, std::size_t tuples,
                 const std::vector<FileField>& fields) {
  if (fields.empty()) return;
  out.text(std::string(kind) + " " + std::to_string(tuples) + "\nFIELD FieldData " +
           std::to_string(fields.size()) + "\n");
  for (const FileField& field : fields) {
    const NumberType& type = numberType(field.type);
    out.text(vtkName(field.name) + " " + std::to_string(field.components) + " " +
             std::to_string(tuples) + " " + std::string(type.legacyName) + "\n");
    out.piece(field.values.size() * type.sizeBytes,
              [&](Bytes& bytes) { type.appendBigEndian(bytes, *field.values.get()); });
    out.text("\n");
  }
}

}  // namespace

Status writeLegacyVtk(const FileMesh& mesh, const ByteSink& sink) {
  if (mesh.points.size() > kMaxIds)
    return fail(ErrorCode::kBadInput,
                "the mesh has more points than a .vtk file can number; write .vtu");
  if (Status checked = canHold(".vtk", outlinesOf(mesh)); !checked) return checked;
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
  Pieces pieces(sink);
  pieces.bytes(std::exchange(out, {}));
  writeFields(pieces, "POINT_DATA", mesh.points.size(), mesh.pointFields);
  writeFields(pieces, "CELL_DATA", cells, mesh.cellFields);
  return pieces.status();
}

}  // namespace qtet
