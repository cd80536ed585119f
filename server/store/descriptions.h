// Describes the server's meshes: the JSON of `/v1/meshes` and `/v1/meshes/{id}` (PROTOCOL.md,
// "HTTP").
#pragma once

#include <string>

namespace qtet {

struct ServedMesh;

/// The mesh's object in the list. Uses id, log and manifest.
[[nodiscard]] std::string describeEntry(const ServedMesh& mesh);
[[nodiscard]] std::string describeMesh(const ServedMesh& mesh);

}  // namespace qtet
