#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "codec/files/field_colours.h"
#include "codec/files/file_names.h"
#include "codec/files/mesh_file.h"
#include "codec/files/pieces.h"
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

std::string usdQuoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + "\"";
}

/// The indent of a prim's content, two levels deep.
constexpr const char* kIndent = "        ";

/// Values of 1 to 4 components have a USD type of their own; others are a flat array with
/// elementSize.
std::string primvarText(const FileField& field, const char* interpolation,
                        std::set<std::string>& names) {
  const bool isDouble = field.type != "float32";
  const bool tuple = field.components <= 4;
  const std::string type = std::string(isDouble ? "double" : "float") +
                           (tuple && field.components > 1 ? std::to_string(field.components) : "");
  const FieldNumbers::Held values = field.values.get();
  std::vector<std::span<const double>> tuples;
  const std::size_t width = tuple ? field.components : 1;
  for (std::size_t i = 0; i < values->size(); i += width)
    tuples.push_back(std::span(*values).subspan(i, width));
  std::string out = kIndent + type + "[] primvars:" + newIdentifier(field.name, names) + " = " +
                    (isDouble ? arrayText(tuples, kDouble) : arrayText(tuples, kFloat)) + " (\n" +
                    kIndent + "    displayName = " + usdQuoted(field.name) + "\n" + kIndent +
                    "    interpolation = \"" + interpolation + "\"\n";
  if (!tuple)
    out += kIndent + std::string("    elementSize = ") + std::to_string(field.components) + "\n";
  return out + kIndent + ")\n";
}

/// "TYPE NAME = VALUE" as a line of a prim.
std::string attribute(const std::string& name, const std::string& value) {
  return kIndent + name + " = " + value + "\n";
}

/// The attributes that both prims have: orientation, extent and points.
std::string shapeText(std::span<const std::array<double, 3>> points) {
  std::string out = attribute("uniform token orientation", "\"rightHanded\"");
  if (points.empty()) return out + attribute("point3f[] points", "[]");
  std::array<std::array<double, 3>, 2> box{points[0], points[0]};
  for (const auto& p : points)
    for (std::size_t k = 0; k < 3; ++k)
      box[0][k] = std::min(box[0][k], p[k]), box[1][k] = std::max(box[1][k], p[k]);
  return out + attribute("float3[] extent", arrayText(box, kFloat)) +
         attribute("point3f[] points", arrayText(points, kFloat));
}

void writeCells(Pieces& out, const FileMesh& mesh) {
  // Its faces [123] [032] [013] [021] of a right-handed tetrahedron are those of
  // codec/mesh/boundary.h. Guides are not drawn unless somebody asks: the other prim is.
  out.text("    def TetMesh \"tetrahedra\"\n    {\n" +
           attribute("uniform token purpose", "\"guide\"") + shapeText(mesh.points) +
           attribute("int4[] tetVertexIndices", arrayText(mesh.tetrahedra, kInteger)) +
           attribute("int3[] surfaceFaceVertexIndices",
                     arrayText(boundaryOf(mesh.tetrahedra), kInteger)));
  std::set<std::string> names;
  for (const FileField& field : mesh.pointFields) out.text(primvarText(field, "vertex", names));
  for (const FileField& field : mesh.cellFields) out.text(primvarText(field, "uniform", names));
  out.text("    }\n");
}

/// The values of a point.
std::span<const double> valueOf(const FileField& field, const std::vector<double>& values,
                                std::size_t point) {
  return std::span(values).subspan(point * field.components, field.components);
}

/// The range of the values, or of their magnitude if components > 1. Missing values do not count.
std::array<double, 2> rangeOf(const FileField& field, const std::vector<double>& values) {
  if (field.range) return *field.range;
  std::array<double, 2> range{std::numeric_limits<double>::max(),
                              std::numeric_limits<double>::lowest()};
  for (std::size_t i = 0; i * field.components < values.size(); ++i) {
    // in a range from 0 to 1 the fraction is the value
    const double value = rangeFraction(valueOf(field, values, i), {0, 1});
    if (!std::isfinite(value)) continue;
    range[0] = std::min(range[0], value), range[1] = std::max(range[1], value);
  }
  return range;
}

/// A surface is coloured by its first field, as a .glb is.
std::string coloursText(const FileSurface& surface) {
  if (surface.fields.empty()) return {};
  const FileField& field = surface.fields.front();
  const FieldNumbers::Held values = field.values.get();
  const std::array<double, 2> range = rangeOf(field, *values);
  std::vector<Colour> colours;
  for (std::size_t i = 0; i < surface.points.size(); ++i)
    colours.push_back(linearLight(viridis(rangeFraction(valueOf(field, *values, i), range))));
  constexpr auto kShort = [](std::string& out, double x) {
    appendShortest(out, std::round(1000 * x) / 1000);
  };
  return attribute("color3f[] primvars:displayColor", arrayText(colours, kShort) + " (") + kIndent +
         "    interpolation = \"vertex\"\n" + kIndent + ")\n";
}

void writeBoundary(Pieces& out, const FileSurface& surface) {
  std::vector<std::array<VertexId, 1>> counts(surface.triangles.size(), {3}), corners;
  for (const Triangle& triangle : surface.triangles)
    for (const VertexId v : triangle) corners.push_back({v});
  out.text("    def Mesh \"boundary\"\n    {\n" +
           attribute("uniform token subdivisionScheme", "\"none\"") +
           attribute("uniform bool doubleSided", "1") + shapeText(surface.points) +
           attribute("int[] faceVertexCounts", arrayText(counts, kInteger)) +
           attribute("int[] faceVertexIndices", arrayText(corners, kInteger)) +
           coloursText(surface));
  std::set<std::string> names{"displayColor"};
  for (const FileField& field : surface.fields) out.text(primvarText(field, "vertex", names));
  out.text("    }\n");
}

}  // namespace

Status writeUsda(const FileMesh& mesh, const ByteSink& sink) {
  if (Status checked = fitsFloats(mesh.points, ".usda"); !checked) return checked;
  Pieces out(sink);
  out.text(
      "#usda 1.0\n(\n    defaultPrim = \"mesh\"\n    doc = \"written by qtet\"\n    metersPerUnit "
      "= 1\n    upAxis = \"Z\"\n)\n\ndef Xform \"mesh\"\n{\n");
  writeCells(out, mesh);
  out.text("\n");
  writeBoundary(out, surfaceOf(mesh));
  out.text("}\n");
  return out.status();
}

}  // namespace qtet
