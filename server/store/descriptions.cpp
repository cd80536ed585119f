#include "server/store/descriptions.h"

#include "codec/log/log_levels.h"
#include "proto/json_reader.h"
#include "server/store/served_mesh.h"
#include "server/store/store_limits.h"
#include "server/wire/request_target.h"

namespace qtet {
namespace {

Json links(const ServedMesh& mesh) {
  const std::string log = "/v1/logs/" + mesh.log.digest();
  return {{"self", "/v1/meshes/" + percentEncode(mesh.id)},
          {"stream", "/v1/stream"},
          {"log", log + "/log"},
          {"manifest", log + "/manifest"},
          {"base", log + "/base"},
          {"chunk", log + "/chunks/{n}"},
          {"fieldChunk", log + "/fields/{field}/chunks/{n}"},
          {"level", log + "/levels/{k}.{form}"},
          {"vtu", log + "/levels/{k}.vtu"},
          {"glb", log + "/levels/{k}.glb"},
          {"drc", log + "/levels/{k}.drc"},
          {"poster", log + "/poster.webp"}};
}

Json identity(const ServedMesh& mesh) {
  return {{"id", mesh.id}, {"digest", mesh.log.digest()}, {"bytes", mesh.log.bytes().size()}};
}

/// Every field with what it costs.
Json fields(const ServedMesh& mesh) {
  Json out = Json::array();
  const FieldKeys& keys = mesh.keys();
  for (std::size_t f = 0; f < mesh.manifest.fields.size(); ++f) {
    const ManifestField& field = mesh.manifest.fields[f];
    std::uint64_t bytes = 0;
    for (const ChunkEntry& chunk : mesh.log.chunks())
      bytes += chunk.blocks[kFirstFieldPart + f].size;
    out.push_back({{"key", keys.keyOf(f)},
                   {"name", field.name},
                   {"components", field.components},
                   {"type", field.type},
                   {"association", field.association},
                   {"range", field.range},
                   {"bytes", bytes}});
  }
  return out;
}

/// The fields as a list of meshes names them, each series once.
void listFields(const FieldKeys& keys, Json& out) {
  const std::vector<ListedKey> all = keys.listed();
  Json fields = Json::array(), series = Json::array();
  std::size_t bytes = 0;
  for (const auto& [key, isSeries] : all) {
    bytes += key.size();
    if (fields.size() == limits::kMaxListedKeys || bytes > limits::kMaxListedKeyBytes) break;
    fields.push_back(key);
    if (isSeries) series.push_back(key);
  }
  if (fields.size() < all.size()) out["moreFields"] = all.size() - fields.size();
  if (!series.empty()) out["series"] = std::move(series);
  out["fields"] = std::move(fields);
}

}  // namespace

std::string describeEntry(const ServedMesh& mesh) {
  Json out = identity(mesh);
  const ManifestLevel& finest = mesh.manifest.levels.back();
  out["tetrahedra"] = finest.tetrahedra;
  out["vertices"] = finest.vertices;
  listFields(mesh.keys(), out);
  out["firstField"] = firstField(mesh.manifest);
  out["links"] = links(mesh);
  return dumpJson(out);
}

std::string describeMesh(const ServedMesh& mesh) {
  Json out = identity(mesh);
  out["headBytes"] = mesh.log.headBytes();
  out["chunks"] = mesh.log.chunks().size();
  out["fields"] = fields(mesh);
  out["manifest"] = Json::parse(manifestToJson(mesh.manifest));
  out["levels"] = levelsJson(mesh.manifest, mesh.log.index());
  out["links"] = links(mesh);
  return dumpJson(out);
}

}  // namespace qtet
