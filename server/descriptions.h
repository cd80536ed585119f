// What the server says about its meshes: the JSON of `/v1/meshes` and `/v1/meshes/{id}` (PROTOCOL.md, "HTTP").
#pragma once

#include <string>

#include "server/mesh_store.h"

namespace qtet {

[[nodiscard]] std::string describeMeshes(const MeshStore& store);
[[nodiscard]] std::string describeMesh(const ServedMesh& mesh);

}  // namespace qtet
