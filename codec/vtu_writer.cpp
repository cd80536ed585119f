#include "codec/vtu_writer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string_view>

#include "codec/float_rounding.h"

namespace qtet {
namespace {

constexpr std::uint8_t kVtkTetra = 10;

/// Appends `value` little-endian, whatever the machine.
template <class T>
void append(Bytes& out, T value) {
  if constexpr (sizeof(T) == 1) {
    out.push_back(static_cast<std::uint8_t>(value));
  } else if constexpr (std::endian::native == std::endian::little) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
    out.insert(out.end(), bytes, bytes + sizeof(T));
  } else {
    auto bytes = std::bit_cast<std::array<std::uint8_t, sizeof(T)>>(value);
    std::reverse(bytes.begin(), bytes.end());
    out.insert(out.end(), bytes.begin(), bytes.end());
  }
}

/// The nearest number of type T; what is not a number becomes 0 in an integer.
template <class T>
T nearest(double value) {
  if constexpr (std::is_floating_point_v<T>) {
    return static_cast<T>(value);
  } else {
    // The limits of 64-bit integers are no doubles: compare with the powers of two around them.
    if (std::isnan(value)) return 0;
    const double rounded = std::round(value);
    if (rounded <= static_cast<double>(std::numeric_limits<T>::min())) return std::numeric_limits<T>::min();
    if (rounded >= static_cast<double>(std::numeric_limits<T>::max())) return std::numeric_limits<T>::max();
    return static_cast<T>(rounded);
  }
}

template <class T>
void appendAll(Bytes& out, std::span<const double> values) {
  for (const double value : values) append(out, nearest<T>(value));
}

/// A type's name in the manifest and in VTK XML, its size, and how numbers become its bytes.
struct NumberType {
  std::string_view name;
  std::string_view vtkName;
  std::uint64_t sizeBytes;
  void (*appendAll)(Bytes&, std::span<const double>);
};

constexpr std::array<NumberType, 10> kNumberTypes{{
    {"float64", "Float64", 8, appendAll<double>},
    {"float32", "Float32", 4, appendAll<float>},
    {"int8", "Int8", 1, appendAll<std::int8_t>},
    {"uint8", "UInt8", 1, appendAll<std::uint8_t>},
    {"int16", "Int16", 2, appendAll<std::int16_t>},
    {"uint16", "UInt16", 2, appendAll<std::uint16_t>},
    {"int32", "Int32", 4, appendAll<std::int32_t>},
    {"uint32", "UInt32", 4, appendAll<std::uint32_t>},
    {"int64", "Int64", 8, appendAll<std::int64_t>},
    {"uint64", "UInt64", 8, appendAll<std::uint64_t>},
}};

const NumberType& numberType(std::string_view name) {
  const auto* found = std::find_if(kNumberTypes.begin(), kNumberTypes.end(), [&](const NumberType& type) { return type.name == name; });
  return found == kNumberTypes.end() ? kNumberTypes.front() : *found;
}

/// A text inside an attribute's double quotes. XML 1.0 has no way to write other control characters, so these become '?'.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      case '\t': out += "&#9;"; break;
      case '\n': out += "&#10;"; break;
      case '\r': out += "&#13;"; break;
      default: out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return out;
}

/// Header lines that name arrays, and the offsets that follow from the arrays' sizes.
class Arrays {
 public:
  explicit Arrays(bool wideHeader) : headerBytes_(wideHeader ? 8 : 4) {}

  [[nodiscard]] std::string declare(std::string_view vtkType, std::string_view name, std::uint32_t components, std::uint64_t sizeBytes) {
    std::string line = "        <DataArray type=\"" + std::string(vtkType) + "\" Name=\"" + escaped(name) + "\" NumberOfComponents=\"" +
                       std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(offset_) + "\"/>\n";
    offset_ += headerBytes_ + sizeBytes;
    return line;
  }
  void appendSize(Bytes& out, std::uint64_t sizeBytes) const {
    if (headerBytes_ == 8) {
      append(out, sizeBytes);
    } else {
      append(out, static_cast<std::uint32_t>(sizeBytes));
    }
  }
  [[nodiscard]] std::uint64_t totalBytes() const { return offset_; }

 private:
  std::uint64_t headerBytes_;
  std::uint64_t offset_ = 0;
};

/// The sizes of all arrays in bytes, and what they decide.
struct Sizes {
  explicit Sizes(const VtuMesh& mesh) {
    const std::uint64_t connectivityEntries = 4 * std::uint64_t{mesh.tetrahedra.size()};
    wideIds =
        connectivityEntries > std::numeric_limits<std::int32_t>::max() || mesh.points.size() > std::numeric_limits<std::int32_t>::max();
    points = mesh.points.size() * 3 * (mesh.doublePoints ? 8u : 4u);
    connectivity = connectivityEntries * (wideIds ? 8u : 4u);
    offsets = mesh.tetrahedra.size() * (wideIds ? 8u : 4u);
    types = mesh.tetrahedra.size();
    largest = std::max({points, connectivity, offsets, types});
    for (const auto* fields : {&mesh.pointFields, &mesh.cellFields})
      for (const VtuField& field : *fields) largest = std::max(largest, sizeOf(field));
  }

  static std::uint64_t sizeOf(const VtuField& field) { return field.values.size() * numberType(field.type).sizeBytes; }

  bool wideIds;
  std::uint64_t points, connectivity, offsets, types, largest;
};

/// The element `tag` (PointData or CellData) that declares the fields.
std::string fieldsText(const std::string& tag, const std::vector<VtuField>& fields, Arrays& arrays) {
  const auto scalar = std::find_if(fields.begin(), fields.end(), [](const VtuField& field) { return field.components == 1; });
  std::string text = "      <" + tag + (scalar == fields.end() ? "" : " Scalars=\"" + escaped(scalar->name) + "\"") + ">\n";
  for (const VtuField& field : fields)
    text += arrays.declare(numberType(field.type).vtkName, field.name, field.components, Sizes::sizeOf(field));
  return text + "      </" + tag + ">\n";
}

std::string headerText(const VtuMesh& mesh, const Sizes& sizes, Arrays& arrays) {
  const bool wideHeader = sizes.largest > std::numeric_limits<std::uint32_t>::max();
  const std::string_view idType = sizes.wideIds ? "Int64" : "Int32";
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"";
  text += wideHeader ? "UInt64" : "UInt32";
  text += "\">\n  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"" + std::to_string(mesh.points.size()) + "\" NumberOfCells=\"" +
          std::to_string(mesh.tetrahedra.size()) + "\">\n";
  text += fieldsText("PointData", mesh.pointFields, arrays);
  if (!mesh.cellFields.empty()) text += fieldsText("CellData", mesh.cellFields, arrays);
  text += "      <Points>\n";
  text += arrays.declare(mesh.doublePoints ? "Float64" : "Float32", "Points", 3, sizes.points);
  text += "      </Points>\n      <Cells>\n";
  text += arrays.declare(idType, "connectivity", 1, sizes.connectivity);
  text += arrays.declare(idType, "offsets", 1, sizes.offsets);
  text += arrays.declare("UInt8", "types", 1, sizes.types);
  text += "      </Cells>\n    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n   _";
  return text;
}

template <class Id>
void appendCells(Bytes& out, const VtuMesh& mesh, const Sizes& sizes, const Arrays& arrays) {
  arrays.appendSize(out, sizes.connectivity);
  for (const Tetrahedron& cell : mesh.tetrahedra) {
    for (const VertexId v : cell) append(out, static_cast<Id>(v));
  }
  arrays.appendSize(out, sizes.offsets);
  for (std::size_t i = 1; i <= mesh.tetrahedra.size(); ++i) append(out, static_cast<Id>(4 * i));
}

void appendPoints(Bytes& out, const VtuMesh& mesh) {
  for (const std::array<double, 3>& p : mesh.points) {
    for (const double x : p) {
      if (mesh.doublePoints) {
        append(out, x);
      } else {
        append(out, static_cast<float>(x));
      }
    }
  }
}

VtuField dequantised(const FieldInfo& info, const std::vector<std::int32_t>& integers) {
  VtuField field{info.name, info.type, info.components, {}};
  field.values.reserve(integers.size());
  for (std::size_t i = 0; i < integers.size(); ++i) field.values.push_back(info.value(i % info.components, integers[i]));
  return field;
}

bool survivesAsFloat(const Lattice& lattice, const LatticePoint& point) {
  const std::array<double, 3> exact = lattice.position(point);
  for (std::size_t k = 0; k < 3; ++k) {
    const double stored = roundedToFloat(exact[k]);
    // An eighth of a step more than rounding needs: readers' own arithmetic is not ours.
    if (!(std::abs((stored - lattice.origin[k]) / lattice.step - point[k]) < 0.375)) return false;
  }
  return true;
}

}  // namespace

Bytes vtuBytes(const VtuMesh& mesh) {
  const Sizes sizes(mesh);
  Arrays arrays(sizes.largest > std::numeric_limits<std::uint32_t>::max());
  const std::string header = headerText(mesh, sizes, arrays);
  constexpr std::string_view kFooter = "\n  </AppendedData>\n</VTKFile>\n";

  Bytes out;
  out.reserve(header.size() + arrays.totalBytes() + kFooter.size());
  out.insert(out.end(), header.begin(), header.end());
  for (const auto* fields : {&mesh.pointFields, &mesh.cellFields}) {
    for (const VtuField& field : *fields) {
      arrays.appendSize(out, Sizes::sizeOf(field));
      numberType(field.type).appendAll(out, field.values);
    }
  }
  arrays.appendSize(out, sizes.points);
  appendPoints(out, mesh);
  sizes.wideIds ? appendCells<std::int64_t>(out, mesh, sizes, arrays) : appendCells<std::int32_t>(out, mesh, sizes, arrays);
  arrays.appendSize(out, sizes.types);
  out.insert(out.end(), mesh.tetrahedra.size(), kVtkTetra);
  out.insert(out.end(), kFooter.begin(), kFooter.end());
  return out;
}

Bytes vtuBytes(const LatticeMesh& mesh) {
  std::vector<std::array<double, 3>> points;
  points.reserve(mesh.points.size());
  for (const LatticePoint& p : mesh.points) points.push_back(mesh.lattice.position(p));

  VtuMesh out{points, mesh.tetrahedra, true};
  out.doublePoints =
      !std::all_of(mesh.points.begin(), mesh.points.end(), [&](const LatticePoint& p) { return survivesAsFloat(mesh.lattice, p); });
  for (std::size_t f = 0; f < mesh.fields.size(); ++f)
    (isCellField(mesh.fields[f]) ? out.cellFields : out.pointFields).push_back(dequantised(mesh.fields[f], mesh.values[f]));
  return vtuBytes(out);
}

}  // namespace qtet
