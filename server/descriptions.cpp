#include "server/descriptions.h"

#include "codec/log_levels.h"
#include "proto/json_reader.h"
#include "server/request_target.h"

namespace qtet {
namespace {

Json links(const ServedMesh& mesh) {
  const std::string self = "/v1/meshes/" + percentEncode(mesh.id);
  return {{"self", self}, {"log", self + "/log?digest=" + mesh.log.digest()}, {"stream", "/v1/stream"}};
}

Json identity(const ServedMesh& mesh) { return {{"id", mesh.id}, {"digest", mesh.log.digest()}, {"bytes", mesh.log.bytes().size()}}; }

}  // namespace

std::string describeMeshes(const MeshStore& store) {
  Json meshes = Json::array();
  for (const auto& [id, mesh] : store.meshes()) {
    Json entry = identity(mesh);
    const ManifestLevel& finest = mesh.manifest.levels.back();
    entry["tetrahedra"] = finest.tetrahedra;
    entry["vertices"] = finest.vertices;
    entry["fields"] = Json::array();
    for (std::size_t f = 0; f < mesh.manifest.fields.size(); ++f) entry["fields"].push_back(fieldKey(mesh.manifest, f));
    entry["links"] = links(mesh);
    meshes.push_back(std::move(entry));
  }
  return dumpJson({{"meshes", std::move(meshes)}});
}

std::string describeMesh(const ServedMesh& mesh) {
  Json out = identity(mesh);
  out["headBytes"] = mesh.log.index().headBytes();
  out["manifest"] = Json::parse(manifestToJson(mesh.manifest));
  out["levels"] = levelsJson(mesh.manifest, mesh.log.index());
  out["links"] = links(mesh);
  const std::string self = out["links"]["self"];
  out["links"]["vtu"] = self + "/levels/{k}.vtu";
  out["links"]["drc"] = self + "/levels/{k}.drc";
  return dumpJson(out);
}

}  // namespace qtet
