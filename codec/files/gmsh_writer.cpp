#include <string>
#include <utility>

#include "codec/coding/number_type.h"
#include "codec/files/field_limits.h"
#include "codec/files/mesh_file.h"
#include "codec/files/pieces.h"

namespace qtet {
namespace {

constexpr std::int32_t kGmshTetrahedron = 4;
constexpr std::size_t kMaxEntities = 0x7FFFFFFF;  ///< ids are signed 32-bit integers

std::uint32_t gmshComponents(std::uint32_t components) {
  return components == 1 ? 1 : components <= 3 ? 3 : kMaxGmshComponents;
}

/// A name between double quotes, for which the format has no escape.
std::string gmshQuoted(const std::string& name) {
  std::string out = "\"";
  for (const char c : name) out += c == '"' || static_cast<unsigned char>(c) < 0x20 ? '_' : c;
  return out + "\"";
}

void appendData(Bytes& out, const std::string& section, const FileField& field) {
  const FieldNumbers::Held values = field.values.get();
  const std::uint32_t shown = gmshComponents(field.components);
  const std::size_t tuples = field.values.size() / field.components;
  // One string tag (the name), one real tag (the time), three integer tags: step, components,
  // entities.
  appendText(out, "$" + section + "\n1\n" + gmshQuoted(field.name) + "\n1\n0\n3\n0\n" +
                      std::to_string(shown) + "\n" + std::to_string(tuples) + "\n");
  for (std::size_t i = 0; i < tuples; ++i) {
    appendNumber(out, static_cast<std::int32_t>(i + 1));
    for (std::uint32_t c = 0; c < shown; ++c)
      appendNumber(out, c < field.components ? (*values)[i * field.components + c] : 0.0);
  }
  appendText(out, "\n$End" + section + "\n");
}

}  // namespace

Status writeGmsh(const FileMesh& mesh, const ByteSink& sink) {
  if (mesh.points.size() > kMaxEntities || mesh.tetrahedra.size() > kMaxEntities)
    return fail(ErrorCode::kBadInput,
                "the mesh has more points or cells than a .msh file can number; write .vtu");
  if (Status checked = canHold(".msh", outlinesOf(mesh)); !checked) return checked;
  Pieces pieces(sink);
  Bytes out;
  appendText(out, "$MeshFormat\n2.2 1 8\n");
  appendNumber(out, std::int32_t{1});  // tells the order of bytes
  appendText(out, "\n$EndMeshFormat\n$Nodes\n" + std::to_string(mesh.points.size()) + "\n");
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    appendNumber(out, static_cast<std::int32_t>(i + 1));
    for (const double x : mesh.points[i]) appendNumber(out, x);
  }
  appendText(out, "\n$EndNodes\n$Elements\n" + std::to_string(mesh.tetrahedra.size()) + "\n");
  if (!mesh.tetrahedra.empty()) {
    for (const std::int32_t word :
         {kGmshTetrahedron, static_cast<std::int32_t>(mesh.tetrahedra.size()), 2})
      appendNumber(out, word);
  }
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    // Two tags, as all programs expect them: the physical and the elementary entity.
    for (const std::int32_t word : {static_cast<std::int32_t>(i + 1), 1, 1})
      appendNumber(out, word);
    for (const VertexId v : mesh.tetrahedra[i]) appendNumber(out, static_cast<std::int32_t>(v + 1));
  }
  appendText(out, "\n$EndElements\n");
  pieces.bytes(std::exchange(out, {}));
  for (const FileField& field : mesh.pointFields)
    pieces.piece(0, [&](Bytes& bytes) { appendData(bytes, "NodeData", field); });
  for (const FileField& field : mesh.cellFields)
    pieces.piece(0, [&](Bytes& bytes) { appendData(bytes, "ElementData", field); });
  return pieces.status();
}

}  // namespace qtet
