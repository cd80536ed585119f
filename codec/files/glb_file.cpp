#include "codec/files/glb_file.h"

#include <array>
#include <cassert>

#include "proto/version.h"

namespace qtet {
namespace {

using Json = nlohmann::ordered_json;

// glTF 2.0, 4.4
constexpr std::uint32_t kGlbMagic = 0x46546C67;
constexpr std::uint32_t kGlbVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

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

Json document(const GlbContent& content, std::size_t bytes) {
  Json primitive = {
      {"attributes", content.attributes}, {"indices", 0}, {"material", 0}, {"mode", 4}};
  if (!content.extensions.is_null()) primitive["extensions"] = content.extensions;
  Json out = {{"asset", {{"version", "2.0"}, {"generator", "qtet " + version()}}}};
  if (!content.requiredExtensions.empty())
    for (const char* list : {"extensionsUsed", "extensionsRequired"})
      out[list] = content.requiredExtensions;
  out["scene"] = 0;
  out["scenes"] = {{{"nodes", {0}}}};
  Json node = {{"mesh", 0}};
  if (content.translation != std::array<double, 3>{}) node["translation"] = content.translation;
  out["nodes"] = Json::array({node});
  out["meshes"] = {{{"primitives", {primitive}}}};
  out["materials"] = {
      {{"doubleSided", true},
       {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.8}}}}};
  out["accessors"] = content.accessors;
  out["bufferViews"] = content.bufferViews;
  out["buffers"] = {{{"byteLength", bytes}}};
  return out;
}

}  // namespace

const char* glbType(std::size_t components) {
  constexpr std::array<const char*, 4> kTypes = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  return components >= 1 && components <= kTypes.size() ? kTypes[components - 1] : nullptr;
}

Bytes glbBytes(const GlbContent& content, ByteView buffer) {
  assert(buffer.size() < kMaxGlbBytes);
  const std::string json =
      document(content, buffer.size()).dump(-1, ' ', false, Json::error_handler_t::replace);
  Bytes out;
  putU32(out, kGlbMagic);
  putU32(out, kGlbVersion);
  putU32(out, 0);  // the length, below
  putChunk(out, kJsonChunk, {reinterpret_cast<const std::uint8_t*>(json.data()), json.size()}, ' ');
  putChunk(out, kBinaryChunk, buffer, 0);
  for (std::size_t i = 0; i < 4; ++i) out[8 + i] = static_cast<std::uint8_t>(out.size() >> (8 * i));
  return out;
}

}  // namespace qtet
