#include "codec/files/vtu_writer.h"

#include <algorithm>
#include <limits>
#include <string_view>

#include "codec/coding/number_type.h"
#include "codec/files/file_names.h"
#include "codec/files/pieces.h"

namespace qtet {
namespace {

constexpr std::uint8_t kVtkTetra = 10;
constexpr std::string_view kFooter = "\n  </AppendedData>\n</VTKFile>\n";

/// Header lines that name arrays, and the offsets that follow from the arrays' sizes.
class Arrays {
 public:
  explicit Arrays(bool wideHeader) : headerBytes_(wideHeader ? 8 : 4) {}

  [[nodiscard]] std::string declare(std::string_view vtkType, std::string_view name,
                                    std::uint32_t components, std::uint64_t sizeBytes) {
    std::string line = "        <DataArray type=\"" + std::string(vtkType) + "\" Name=\"" +
                       xmlText(name) + "\" NumberOfComponents=\"" + std::to_string(components) +
                       "\" format=\"appended\" offset=\"" + std::to_string(offset_) + "\"/>\n";
    offset_ += headerBytes_ + sizeBytes;
    return line;
  }
  void appendSize(Bytes& out, std::uint64_t sizeBytes) const {
    if (headerBytes_ == 8) {
      appendNumber(out, sizeBytes);
    } else {
      appendNumber(out, static_cast<std::uint32_t>(sizeBytes));
    }
  }
  [[nodiscard]] std::uint64_t totalBytes() const { return offset_; }

 private:
  std::uint64_t headerBytes_;
  std::uint64_t offset_ = 0;
};

/// The sizes of all arrays in bytes, and what they decide.
struct Sizes {
  explicit Sizes(const FileMesh& mesh) {
    const std::uint64_t connectivityEntries = 4 * std::uint64_t{mesh.tetrahedra.size()};
    wideIds = connectivityEntries > std::numeric_limits<std::int32_t>::max() ||
              mesh.points.size() > std::numeric_limits<std::int32_t>::max();
    points = mesh.points.size() * 3 * (mesh.doublePoints ? 8u : 4u);
    connectivity = connectivityEntries * (wideIds ? 8u : 4u);
    offsets = mesh.tetrahedra.size() * (wideIds ? 8u : 4u);
    types = mesh.tetrahedra.size();
    largest = std::max({points, connectivity, offsets, types});
    for (const auto* fields : {&mesh.pointFields, &mesh.cellFields})
      for (const FileField& field : *fields) largest = std::max(largest, sizeOf(field));
  }

  static std::uint64_t sizeOf(const FileField& field) {
    return field.values.size() * numberType(field.type).sizeBytes;
  }

  bool wideIds;
  std::uint64_t points, connectivity, offsets, types, largest;
};

/// The element `tag` (PointData or CellData) that declares the fields.
std::string fieldsText(const std::string& tag, const std::vector<FileField>& fields,
                       Arrays& arrays) {
  const auto scalar = std::find_if(fields.begin(), fields.end(),
                                   [](const FileField& field) { return field.components == 1; });
  std::string text = "      <" + tag +
                     (scalar == fields.end() ? "" : " Scalars=\"" + xmlText(scalar->name) + "\"") +
                     ">\n";
  for (const FileField& field : fields)
    text += arrays.declare(numberType(field.type).xmlName, field.name, field.components,
                           Sizes::sizeOf(field));
  return text + "      </" + tag + ">\n";
}

/// The names of each label's values, an array of the file each: "Material=steel", which holds 1.
/// (No arrays of texts, because meshio refuses a file that has some.)
std::string labelsText(const FileMesh& mesh) {
  std::string text;
  for (const FileField& field : mesh.cellFields)
    for (const auto& [value, name] : field.labelNames)
      text +=
          "      <DataArray type=\"Int32\" Name=\"" + xmlText(field.name + kLabelNameSign + name) +
          "\" NumberOfTuples=\"1\" format=\"ascii\">" + std::to_string(value) + "</DataArray>\n";
  return text.empty() ? text : "    <FieldData>\n" + text + "    </FieldData>\n";
}

std::string headerText(const FileMesh& mesh, const Sizes& sizes, Arrays& arrays) {
  const bool wideHeader = sizes.largest > std::numeric_limits<std::uint32_t>::max();
  const std::string_view idType = sizes.wideIds ? "Int64" : "Int32";
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"";
  text += wideHeader ? "UInt64" : "UInt32";
  text += "\">\n  <UnstructuredGrid>\n" + labelsText(mesh) + "    <Piece NumberOfPoints=\"" +
          std::to_string(mesh.points.size()) + "\" NumberOfCells=\"" +
          std::to_string(mesh.tetrahedra.size()) + "\">\n";
  text += fieldsText("PointData", mesh.pointFields, arrays);
  if (!mesh.cellFields.empty()) text += fieldsText("CellData", mesh.cellFields, arrays);
  text += "      <Points>\n";
  text += arrays.declare(mesh.doublePoints ? "Float64" : "Float32", "Points", 3, sizes.points);
  text += "      </Points>\n      <Cells>\n";
  text += arrays.declare(idType, "connectivity", 1, sizes.connectivity);
  text += arrays.declare(idType, "offsets", 1, sizes.offsets);
  text += arrays.declare("UInt8", "types", 1, sizes.types);
  text +=
      "      </Cells>\n    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n   "
      "_";
  return text;
}

template <class Id>
void appendConnectivity(Bytes& out, const FileMesh& mesh) {
  for (const Tetrahedron& cell : mesh.tetrahedra)
    for (const VertexId v : cell) appendNumber(out, static_cast<Id>(v));
}

template <class Id>
void appendOffsets(Bytes& out, const FileMesh& mesh) {
  for (std::size_t i = 1; i <= mesh.tetrahedra.size(); ++i)
    appendNumber(out, static_cast<Id>(4 * i));
}

void appendPoints(Bytes& out, const FileMesh& mesh) {
  for (const std::array<double, 3>& p : mesh.points) {
    for (const double x : p) {
      if (mesh.doublePoints) {
        appendNumber(out, x);
      } else {
        appendNumber(out, static_cast<float>(x));
      }
    }
  }
}

}  // namespace

Status writeVtu(const FileMesh& mesh, const ByteSink& sink) {
  const Sizes sizes(mesh);
  Arrays arrays(sizes.largest > std::numeric_limits<std::uint32_t>::max());
  const std::string header = headerText(mesh, sizes, arrays);
  Pieces out(sink);
  out.text(header);
  const auto array = [&](std::uint64_t sizeBytes, const auto& append) {
    out.piece(sizeBytes + sizeof(std::uint64_t), [&](Bytes& bytes) {
      arrays.appendSize(bytes, sizeBytes);
      append(bytes);
    });
  };
  for (const auto* fields : {&mesh.pointFields, &mesh.cellFields})
    for (const FileField& field : *fields)
      array(Sizes::sizeOf(field),
            [&](Bytes& bytes) { numberType(field.type).append(bytes, *field.values.get()); });
  array(sizes.points, [&](Bytes& bytes) { appendPoints(bytes, mesh); });
  array(sizes.connectivity, [&](Bytes& bytes) {
    sizes.wideIds ? appendConnectivity<std::int64_t>(bytes, mesh)
                  : appendConnectivity<std::int32_t>(bytes, mesh);
  });
  array(sizes.offsets, [&](Bytes& bytes) {
    sizes.wideIds ? appendOffsets<std::int64_t>(bytes, mesh)
                  : appendOffsets<std::int32_t>(bytes, mesh);
  });
  array(sizes.types,
        [&](Bytes& bytes) { bytes.insert(bytes.end(), mesh.tetrahedra.size(), kVtkTetra); });
  out.text(kFooter);
  return out.status();
}

Bytes vtuBytes(const FileMesh& mesh) {
  const Sizes sizes(mesh);
  Arrays arrays(sizes.largest > std::numeric_limits<std::uint32_t>::max());
  const std::size_t headerBytes = headerText(mesh, sizes, arrays).size();
  Bytes out;
  out.reserve(headerBytes + arrays.totalBytes() + kFooter.size());
  (void)writeVtu(mesh, appendTo(out));  // such a sink takes everything
  return out;
}

Bytes vtuBytes(const LatticeMesh& mesh) { return vtuBytes(fileMesh(mesh).mesh); }

}  // namespace qtet
