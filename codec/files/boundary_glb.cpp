#include "codec/files/boundary_glb.h"

#include <draco/compression/decode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

#include "codec/files/boundary_drc.h"
#include "codec/files/field_colours.h"

namespace qtet {
namespace {

using Json = nlohmann::ordered_json;

// glTF 2.0, 3.6.2.2 and 4.4
constexpr int kUnsignedByte = 5121;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr std::uint32_t kGlbMagic = 0x46546C67;
constexpr std::uint32_t kGlbVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr std::array<const char*, 4> kTypes = {"SCALAR", "VEC2", "VEC3", "VEC4"};
constexpr const char* kExtension = "KHR_draco_mesh_compression";

void putU32(Bytes& out, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8)
    out.push_back(static_cast<std::uint8_t>(value >> shift));
}

void putChunk(Bytes& out, std::uint32_t type, ByteView content, std::uint8_t padding) {
  const std::size_t padded = (content.size() + 3) / 4 * 4;
  putU32(out, static_cast<std::uint32_t>(padded));
  putU32(out, type);
  out.insert(out.end(), content.begin(), content.end());
  out.insert(out.end(), padded - content.size(), padding);
}

/// POSITION must tell its bounds (glTF 2.0, 3.7.2.1): of what a reader decodes, not of what was put
/// in.
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
  return {{"componentType", kFloat},
          {"count", points},
          {"type", "VEC3"},
          {"min", least},
          {"max", most}};
}

/// glTF's colours are linear (glTF 2.0, 3.9.2), sRGB's are not (IEC 61966-2-1).
std::uint8_t linearByte(double srgb) {
  const double linear = srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
  return static_cast<std::uint8_t>(std::lround(255 * linear));
}

/// By the first point field; none without one.
std::vector<std::array<std::uint8_t, 3>> coloursOf(const LatticeMesh& mesh) {
  const auto field =
      std::ranges::find_if(mesh.fields, [](const FieldInfo& f) { return !isCellField(f); });
  if (field == mesh.fields.end()) return {};
  const RangeFractions fractions(mesh, static_cast<std::size_t>(field - mesh.fields.begin()));
  std::vector<std::array<std::uint8_t, 3>> out(mesh.points.size());
  for (VertexId v = 0; v < out.size(); ++v) {
    const Colour colour = viridis(fractions[v]);
    out[v] = {linearByte(colour[0]), linearByte(colour[1]), linearByte(colour[2])};
  }
  return out;
}

/// What the Draco bytes hold, in glTF's words. Draco may split vertices where the surface is not
/// manifold, so it is asked for its counts.
Json describe(const draco::Mesh& mesh, std::span<const FieldInfo> fields, std::size_t bytes) {
  Json accessors = {
      {{"componentType", kUnsignedInt}, {"count", mesh.num_faces() * 3}, {"type", "SCALAR"}}};
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
          {{"componentType", kUnsignedByte},
           {"normalized", true},
           {"count", mesh.num_points()},
           {"type", "VEC3"}});
      continue;
    }
    const auto components = static_cast<std::size_t>(attribute.num_components());
    std::string name;
    const draco::AttributeMetadata* metadata = mesh.GetAttributeMetadataByAttributeId(i);
    if (components > kTypes.size() || metadata == nullptr ||
        !metadata->GetEntryString("name", &name))
      continue;
    if (std::ranges::any_of(fields, [&](const FieldInfo& f) {
          return f.hasMissing && !isCellField(f) && f.name == name;
        }))
      continue;  // glTF has no NaN
    add("_" + name, i,
        {{"componentType", kFloat},
         {"count", mesh.num_points()},
         {"type", kTypes[components - 1]}});
  }
  const Json primitive = {{"attributes", attributes},
                          {"indices", 0},
                          {"material", 0},
                          {"mode", 4},
                          {"extensions", {{kExtension, {{"bufferView", 0}, {"attributes", ids}}}}}};
  return {{"asset", {{"version", "2.0"}, {"generator", "qtet " QTET_VERSION}}},
          {"extensionsUsed", {kExtension}},
          {"extensionsRequired", {kExtension}},
          {"scene", 0},
          {"scenes", {{{"nodes", {0}}}}},
          {"nodes", {{{"mesh", 0}}}},
          {"meshes", {{{"primitives", {primitive}}}}},
          {"materials",
           {{{"doubleSided", true},
             {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.8}}}}}},
          {"accessors", accessors},
          {"bufferViews", {{{"buffer", 0}, {"byteLength", bytes}}}},
          {"buffers", {{{"byteLength", bytes}}}}};
}

}  // namespace

Result<Bytes> boundaryGlb(const LatticeMesh& mesh) {
  const Result<Bytes> drc = boundaryDrc(mesh, coloursOf(mesh));
  if (!drc) return drc;
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(drc->data()), drc->size());
  draco::Decoder decoder;
  const auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    return fail(ErrorCode::kBadCodec,
                std::string("Draco cannot read what it wrote: ") + decoded.status().error_msg());

  const std::string json = describe(*decoded.value(), mesh.fields, drc->size())
                               .dump(-1, ' ', false, Json::error_handler_t::replace);
  Bytes out;
  putU32(out, kGlbMagic);
  putU32(out, kGlbVersion);
  putU32(out, 0);  // the length, below
  putChunk(out, kJsonChunk, {reinterpret_cast<const std::uint8_t*>(json.data()), json.size()}, ' ');
  putChunk(out, kBinaryChunk, *drc, 0);
  for (std::size_t i = 0; i < 4; ++i) out[8 + i] = static_cast<std::uint8_t>(out.size() >> (8 * i));
  return out;
}

}  // namespace qtet
