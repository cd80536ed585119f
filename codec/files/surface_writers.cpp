#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "codec/coding/number_type.h"
#include "codec/files/file_names.h"
#include "codec/files/mesh_file.h"

namespace qtet {
namespace {

using Point = std::array<double, 3>;

constexpr std::size_t kStlHeaderBytes = 80;

Status countable(const FileSurface& surface, const char* format) {
  if (surface.triangles.size() <= std::numeric_limits<std::int32_t>::max() &&
      surface.points.size() <= std::numeric_limits<std::int32_t>::max())
    return {};
  return fail(ErrorCode::kBadInput, std::string("the boundary has more triangles than a ") +
                                        format + " file can count; choose a coarser level");
}

/// The outward normal, of length 1; zero for a triangle without area.
Point normalOf(const Point& a, const Point& b, const Point& c) {
  Point u{}, v{};
  for (std::size_t k = 0; k < 3; ++k) u[k] = b[k] - a[k], v[k] = c[k] - a[k];
  Point n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (double& x : n) x = length > 0 ? x / length : 0;
  return n;
}

/// PLY's names of types: those of C without stdint, and no 64-bit integers.
const char* plyType(const std::string& type) {
  for (const auto& [name, ply] : {std::pair{"float32", "float"},
                                  {"int8", "char"},
                                  {"uint8", "uchar"},
                                  {"int16", "short"},
                                  {"uint16", "ushort"},
                                  {"int32", "int"},
                                  {"uint32", "uint"}})
    if (type == name) return ply;
  return "double";
}

const NumberType& plyNumbers(const std::string& type) {
  return numberType(std::string_view(plyType(type)) == "double" ? "float64" : type);
}

}  // namespace

Result<Bytes> stlBytes(const FileSurface& surface) {
  if (Status checked = countable(surface, ".stl"); !checked)
    return std::unexpected(checked.error());
  if (Status checked = fitsFloats(surface.points, ".stl"); !checked)
    return std::unexpected(checked.error());
  Bytes out;
  out.reserve(kStlHeaderBytes + 4 + 50 * surface.triangles.size());
  // must not begin with "solid", which text files do
  appendText(out, "boundary of a tetrahedral mesh, written by qtet");
  out.resize(kStlHeaderBytes, ' ');
  appendNumber(out, static_cast<std::uint32_t>(surface.triangles.size()));
  for (const Triangle& t : surface.triangles) {
    const Point &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
    for (const Point& p : {normalOf(a, b, c), a, b, c})
      for (const double x : p) appendNumber(out, static_cast<float>(x));
    appendNumber(out, std::uint16_t{0});
  }
  return out;
}

Result<Bytes> plyBytes(const FileSurface& surface, bool doublePoints) {
  if (Status checked = countable(surface, ".ply"); !checked)
    return std::unexpected(checked.error());
  const std::string position = doublePoints ? "double" : "float";
  std::string header =
      "ply\nformat binary_little_endian 1.0\ncomment boundary of a tetrahedral mesh, written by "
      "qtet\nelement vertex " +
      std::to_string(surface.points.size()) + "\n";
  std::set<std::string> names;
  for (const char* axis : {"x", "y", "z"})
    header += "property " + position + " " + newIdentifier(axis, names) + "\n";
  for (const FileField& field : surface.fields)
    for (std::uint32_t c = 0; c < field.components; ++c)
      header +=
          std::string("property ") + plyType(field.type) + " " +
          newIdentifier(field.components == 1 ? field.name : field.name + "_" + std::to_string(c),
                        names) +
          "\n";
  header += "element face " + std::to_string(surface.triangles.size()) +
            "\nproperty list uchar int vertex_indices\nend_header\n";

  Bytes out;
  appendText(out, header);
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    numberType(doublePoints ? "float64" : "float32").append(out, surface.points[i]);
    for (const FileField& field : surface.fields)
      plyNumbers(field.type)
          .append(out, std::span(field.values).subspan(i * field.components, field.components));
  }
  for (const Triangle& t : surface.triangles) {
    out.push_back(3);
    for (const VertexId v : t) appendNumber(out, static_cast<std::int32_t>(v));
  }
  return out;
}

Bytes objBytes(const FileSurface& surface) {
  std::string text = "# boundary of a tetrahedral mesh, written by qtet\n";
  for (const Point& p : surface.points) {
    text += "v";
    for (const double x : p) text += ' ', appendShortest(text, x);
    text += '\n';
  }
  for (const Triangle& t : surface.triangles) {
    text += "f";
    for (const VertexId v : t) text += ' ', appendShortest(text, v + 1);
    text += '\n';
  }
  return {text.begin(), text.end()};
}

}  // namespace qtet
