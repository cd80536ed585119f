#include "codec/files/boundary_glb.h"

#include <draco/compression/decode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "codec/coding/number_type.h"
#include "codec/files/boundary_drc.h"
#include "codec/files/field_colours.h"
#include "codec/files/file_mesh.h"
#include "codec/files/glb_file.h"
#include "codec/mesh/boundary.h"

namespace qtet {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kExtension = "KHR_draco_mesh_compression";
/// More than the frame of a file can have: a manifest's fields have shorter names together.
constexpr std::uint64_t kMaxFrameBytes = std::uint64_t{64} << 20;

/// The origin of the positions. float32 holds six to seven digits, and a map's coordinates have
/// more.
std::array<double, 3> placeOf(const Lattice& lattice) {
  return floatsHold(lattice) ? std::array<double, 3>{} : lattice.origin;
}

/// POSITION must state its bounds (glTF 2.0, 3.7.2.1). They are those of the decoded values, not of
/// the input.
Json positionAccessor(const draco::PointAttribute& attribute, std::uint32_t points) {
  std::array<float, 3> least{}, most{};
  least.fill(std::numeric_limits<float>::max());
  most.fill(std::numeric_limits<float>::lowest());
  for (std::uint32_t i = 0; i < attribute.size(); ++i) {
    std::array<float, 3> p{};
    attribute.GetValue(draco::AttributeValueIndex(i), p.data());
    for (std::size_t a = 0; a < 3; ++a)
      least[a] = std::min(least[a], p[a]), most[a] = std::max(most[a], p[a]);
  }
  return {{"componentType", kGlbFloat},
          {"count", points},
          {"type", "VEC3"},
          {"min", least},
          {"max", most}};
}

/// Whether a .glb counts the bytes of its buffer.
Status fitsGlb(std::uint64_t bytes) {
  if (bytes < kMaxGlbBytes - kMaxFrameBytes) return {};
  return fail(ErrorCode::kBadInput,
              "the boundary has more bytes than a .glb can count; choose a "
              "coarser level or fewer fields");
}

/// By the first point field; none without one.
std::vector<std::array<std::uint8_t, 3>> coloursOf(const LatticeMesh& mesh) {
  const auto field =
      std::ranges::find_if(mesh.fields, [](const FieldInfo& f) { return !isCellField(f); });
  if (field == mesh.fields.end()) return {};
  const RangeFractions fractions(mesh, static_cast<std::size_t>(field - mesh.fields.begin()));
  std::vector<std::array<std::uint8_t, 3>> out(mesh.points.size());
  for (VertexId v = 0; v < out.size(); ++v) {
    const Colour colour = linearLight(viridis(fractions[v]));
    for (std::size_t c = 0; c < 3; ++c)
      out[v][c] = static_cast<std::uint8_t>(std::lround(255 * colour[c]));
  }
  return out;
}

/// Describes the Draco bytes in glTF's terms. The counts are Draco's, since it may split vertices
/// where the surface is not manifold.
GlbContent describe(const draco::Mesh& mesh, std::span<const FieldInfo> fields,
                    const std::array<double, 3>& place, std::size_t bytes) {
  Json accessors = {
      {{"componentType", kGlbUnsignedInt}, {"count", mesh.num_faces() * 3}, {"type", "SCALAR"}}};
  Json attributes = Json::object(), ids = Json::object();
  const auto add = [&](const std::string& name, int attribute, Json accessor) {
    attributes[name] = accessors.size();
    ids[name] = mesh.attribute(attribute)->unique_id();
    accessors.push_back(std::move(accessor));
  };
  for (int i = 0; i < mesh.num_attributes(); ++i) {
    const draco::PointAttribute& attribute = *mesh.attribute(i);
    if (attribute.attribute_type() == draco::GeometryAttribute::POSITION) {
      add("POSITION", i, positionAccessor(attribute, mesh.num_points()));
      continue;
    }
    if (attribute.attribute_type() == draco::GeometryAttribute::COLOR) {
      add("COLOR_0", i,
          {{"componentType", kGlbUnsignedByte},
           {"normalized", true},
           {"count", mesh.num_points()},
           {"type", "VEC3"}});
      continue;
    }
    const auto components = static_cast<std::size_t>(attribute.num_components());
    std::string name;
    const draco::AttributeMetadata* metadata = mesh.GetAttributeMetadataByAttributeId(i);
    if (glbType(components) == nullptr || metadata == nullptr ||
        !metadata->GetEntryString("name", &name))
      continue;
    if (std::ranges::any_of(fields, [&](const FieldInfo& f) {
          return f.hasMissing && !isCellField(f) && f.name == name;
        }))
      continue;  // glTF has no NaN
    add("_" + name, i,
        {{"componentType", kGlbFloat},
         {"count", mesh.num_points()},
         {"type", glbType(components)}});
  }
  return {.accessors = accessors,
          .bufferViews = Json::array({{{"buffer", 0}, {"byteLength", bytes}}}),
          .attributes = attributes,
          .extensions = {{kExtension, {{"bufferView", 0}, {"attributes", ids}}}},
          .requiredExtensions = {kExtension},
          .translation = place};
}

/// A .glb's buffer and what is in it, array by array.
class PlainArrays {
 public:
  PlainArrays(std::size_t points, const std::array<double, 3>& place) : points_(points) {
    content_.translation = place;
    content_.accessors = content_.bufferViews = Json::array();
    content_.attributes = Json::object();
  }

  void addIndices(const std::vector<Triangle>& triangles) {
    begin(kElementArrayBuffer);
    for (const Triangle& triangle : triangles)
      for (const VertexId v : triangle) appendNumber(buffer_, v);
    end({{"componentType", kGlbUnsignedInt}, {"count", 3 * triangles.size()}, {"type", "SCALAR"}});
  }
  /// `values`: as many for each point as `accessor`'s type has.
  template <class T>
  void addAttribute(const std::string& name, const std::vector<T>& values, Json accessor) {
    begin(kArrayBuffer);
    for (const T value : values) appendNumber(buffer_, value);
    content_.attributes[name] = content_.accessors.size();
    accessor["count"] = points_;
    end(std::move(accessor));
  }
  [[nodiscard]] Bytes file() const { return glbBytes(content_, buffer_); }

 private:
  // glTF 2.0, 5.11.5
  static constexpr int kArrayBuffer = 34962;
  static constexpr int kElementArrayBuffer = 34963;

  // Every array has a multiple of 4 bytes, as glTF wants its elements to begin.
  void begin(int target) {
    content_.bufferViews.push_back(
        {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"target", target}});
  }
  void end(Json accessor) {
    Json& view = content_.bufferViews.back();
    view["byteLength"] = buffer_.size() - view["byteOffset"].get<std::size_t>();
    accessor["bufferView"] = content_.bufferViews.size() - 1;
    content_.accessors.push_back(std::move(accessor));
  }

  std::size_t points_;
  GlbContent content_;
  Bytes buffer_;
};

void addPositions(PlainArrays& arrays, std::span<const std::array<double, 3>> points) {
  std::vector<float> values;
  std::array<float, 3> least{}, most{};
  least.fill(std::numeric_limits<float>::max());
  most.fill(std::numeric_limits<float>::lowest());
  for (const auto& point : points)
    for (std::size_t a = 0; a < 3; ++a) {
      values.push_back(static_cast<float>(point[a]));
      least[a] = std::min(least[a], values.back()), most[a] = std::max(most[a], values.back());
    }
  arrays.addAttribute(
      "POSITION", values,
      {{"componentType", kGlbFloat}, {"type", "VEC3"}, {"min", least}, {"max", most}});
}

void addField(PlainArrays& arrays, const LatticeMesh& mesh, std::size_t number,
              std::span<const VertexId> vertices) {
  const FieldInfo& field = mesh.fields[number];
  constexpr double kMax = std::numeric_limits<float>::max();
  std::vector<float> values;
  values.reserve(vertices.size() * field.components);
  for (const VertexId v : vertices)
    for (std::uint32_t c = 0; c < field.components; ++c) {
      const double value =
          field.value(c, mesh.values[number][std::size_t{v} * field.components + c]);
      values.push_back(static_cast<float>(std::clamp(value, -kMax, kMax)));
    }
  arrays.addAttribute("_" + field.name, values,
                      {{"componentType", kGlbFloat}, {"type", glbType(field.components)}});
}

/// With a fourth byte, opaque: elements of three would not begin at multiples of 4.
void addColours(PlainArrays& arrays, std::span<const std::array<std::uint8_t, 3>> colours,
                std::span<const VertexId> vertices) {
  constexpr std::uint8_t kOpaque = 255;
  std::vector<std::uint8_t> values;
  for (const VertexId v : vertices) {
    values.insert(values.end(), colours[v].begin(), colours[v].end());
    values.push_back(kOpaque);
  }
  arrays.addAttribute(
      "COLOR_0", values,
      {{"componentType", kGlbUnsignedByte}, {"normalized", true}, {"type", "VEC4"}});
}

}  // namespace

Result<Bytes> plainBoundaryGlb(const LatticeMesh& mesh) {
  if (mesh.boundary.empty())
    return fail(ErrorCode::kBadInput, "the mesh has no boundary triangle to encode");
  const CompactTriangles surface = compactTriangles(mesh.boundary, mesh.points.size());
  std::vector<std::array<double, 3>> points;
  for (const VertexId v : surface.vertices) points.push_back(mesh.lattice.position(mesh.points[v]));
  if (Status checked = fitsFloats(points, ".glb"); !checked)
    return std::unexpected(checked.error());
  // glTF has no NaN
  const auto isNamed = [](const FieldInfo& field) {
    return !isCellField(field) && !field.hasMissing && glbType(field.components) != nullptr;
  };
  std::uint64_t bytes = 12 * surface.triangles.size() + 16 * points.size();
  for (const FieldInfo& field : mesh.fields)
    if (isNamed(field)) bytes += 4 * field.components * points.size();
  if (Status checked = fitsGlb(bytes); !checked) return std::unexpected(checked.error());

  const std::array<double, 3> place = placeOf(mesh.lattice);
  for (auto& point : points)
    for (std::size_t a = 0; a < 3; ++a) point[a] -= place[a];
  PlainArrays arrays(points.size(), place);
  arrays.addIndices(surface.triangles);
  addPositions(arrays, points);
  for (std::size_t f = 0; f < mesh.fields.size(); ++f)
    if (isNamed(mesh.fields[f])) addField(arrays, mesh, f, surface.vertices);
  if (const auto colours = coloursOf(mesh); !colours.empty())
    addColours(arrays, colours, surface.vertices);
  return arrays.file();
}

Result<Bytes> boundaryGlb(const LatticeMesh& mesh) {
  const auto colours = coloursOf(mesh);
  const std::array<double, 3> place = placeOf(mesh.lattice);
  const Result<Bytes> drc = boundaryDrc(mesh, {.colours = colours, .from = place});
  if (!drc) return drc;
  if (Status checked = fitsGlb(drc->size()); !checked) return std::unexpected(checked.error());
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(drc->data()), drc->size());
  draco::Decoder decoder;
  const auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    return fail(ErrorCode::kBadCodec,
                std::string("Draco cannot read what it wrote: ") + decoded.status().error_msg());

  return glbBytes(describe(*decoded.value(), mesh.fields, place, drc->size()), *drc);
}

}  // namespace qtet
