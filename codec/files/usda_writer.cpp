#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "codec/files/file_names.h"
#include "codec/files/mesh_file.h"
#include "codec/mesh/boundary.h"

namespace qtet {
namespace {

void appendUsd(std::string& out, double value) {
  if (std::isfinite(value)) return appendShortest(out, value);
  out += std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

/// "(1, 2, 3)", or a bare number where there is one.
template <class Range, class Append>
void appendTuple(std::string& out, const Range& numbers, const Append& append) {
  const bool bare = std::size(numbers) == 1;
  if (!bare) out += '(';
  const char* between = "";
  for (const auto x : numbers) out += between, append(out, x), between = ", ";
  if (!bare) out += ')';
}

template <class Tuples, class Append>
std::string arrayText(const Tuples& tuples, const Append& append) {
  std::string out = "[";
  const char* between = "";
  for (const auto& tuple : tuples) out += between, appendTuple(out, tuple, append), between = ", ";
  return out + "]";
}

constexpr auto kInteger = [](std::string& out, VertexId v) { appendShortest(out, v); };
constexpr auto kDouble = [](std::string& out, double x) { appendUsd(out, x); };
constexpr auto kFloat = [](std::string& out, double x) {
  std::isfinite(x) ? appendShortest(out, static_cast<float>(x)) : appendUsd(out, x);
};

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + "\"";
}

/// Numbers of 1 to 4 components are a type of USD's own, others a flat array with elementSize.
std::string primvarText(const FileField& field, const char* interpolation,
                        std::set<std::string>& names) {
  const bool isDouble = field.type != "float32";
  const bool tuple = field.components <= 4;
  const std::string type = std::string(isDouble ? "double" : "float") +
                           (tuple && field.components > 1 ? std::to_string(field.components) : "");
  std::vector<std::span<const double>> tuples;
  const std::size_t width = tuple ? field.components : 1;
  for (std::size_t i = 0; i < field.values.size(); i += width)
    tuples.push_back(std::span(field.values).subspan(i, width));
  std::string out = "    " + type + "[] primvars:" + newIdentifier(field.name, names) + " = " +
                    (isDouble ? arrayText(tuples, kDouble) : arrayText(tuples, kFloat)) +
                    " (\n        displayName = " + quoted(field.name) +
                    "\n        interpolation = \"" + interpolation + "\"\n";
  if (!tuple) out += "        elementSize = " + std::to_string(field.components) + "\n";
  return out + "    )\n";
}

std::string extentText(const FileMesh& mesh) {
  if (mesh.points.empty()) return {};
  std::array<std::array<double, 3>, 2> box{mesh.points[0], mesh.points[0]};
  for (const auto& p : mesh.points)
    for (std::size_t k = 0; k < 3; ++k)
      box[0][k] = std::min(box[0][k], p[k]), box[1][k] = std::max(box[1][k], p[k]);
  return "    float3[] extent = " + arrayText(box, kFloat) + "\n";
}

}  // namespace

Result<Bytes> usdaBytes(const FileMesh& mesh) {
  if (Status checked = fitsFloats(mesh.points, ".usda"); !checked)
    return std::unexpected(checked.error());
  // Its faces [123] [032] [013] [021] of a right-handed tetrahedron are those of
  // codec/mesh/boundary.h.
  std::string text =
      "#usda 1.0\n(\n    defaultPrim = \"mesh\"\n    doc = \"written by qtet\"\n    metersPerUnit "
      "= 1\n    upAxis = \"Z\"\n)\n\n"
      "def TetMesh \"mesh\"\n{\n    uniform token orientation = \"rightHanded\"\n" +
      extentText(mesh) + "    point3f[] points = " + arrayText(mesh.points, kFloat) +
      "\n    int4[] tetVertexIndices = " + arrayText(mesh.tetrahedra, kInteger) +
      "\n    int3[] surfaceFaceVertexIndices = " +
      arrayText(boundaryOf(mesh.tetrahedra), kInteger) + "\n";
  std::set<std::string> names;
  for (const FileField& field : mesh.pointFields) text += primvarText(field, "vertex", names);
  for (const FileField& field : mesh.cellFields) text += primvarText(field, "uniform", names);
  text += "}\n";
  return Bytes(text.begin(), text.end());
}

}  // namespace qtet
