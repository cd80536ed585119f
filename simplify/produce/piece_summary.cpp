#include "simplify/produce/piece_summary.h"

#include "codec/files/file_names.h"

namespace qtet {
namespace {

/// VTK's name of a type.
std::string vtkType(const std::string& type) {
  if (type == "float32") return "Float32";
  if (type == "float64") return "Float64";
  return type.starts_with("uint") ? "UInt" + type.substr(4) : "Int" + type.substr(3);
}

std::string arraysOf(const TetMesh& shape, const std::string& association) {
  std::string out;
  for (const MeshField& field : shape.fields)
    if (field.association == association)
      out += "<PDataArray type=\"" + vtkType(field.type) + "\" Name=\"" + xmlText(field.name) +
             "\" NumberOfComponents=\"" + std::to_string(field.components) + "\"/>\n";
  return out;
}

}  // namespace

std::string pieceSummary(const TetMesh& shape, std::span<const std::string> files) {
  const std::string points = shape.pointType == "float64" ? "Float64" : "Float32";
  std::string out =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "<PUnstructuredGrid GhostLevel=\"0\">\n<PPointData>\n" +
      arraysOf(shape, "point") + "</PPointData>\n<PCellData>\n" + arraysOf(shape, "cell") +
      "</PCellData>\n<PPoints>\n<PDataArray type=\"" + points +
      "\" NumberOfComponents=\"3\"/>\n</PPoints>\n";
  for (const std::string& file : files) out += "<Piece Source=\"" + xmlText(file) + "\"/>\n";
  return out + "</PUnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace qtet
