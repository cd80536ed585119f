// Small meshes in floats, and files to read them from.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "simplify/mesh/tet_mesh.h"
#include "simplify/samples/samples.h"
#include "tests/support/meshes.h"

namespace qtet::testing {

/// One positive cell.
[[nodiscard]] inline TetMesh oneCell() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}, {}};
}

/// Two positive cells that share the face (1, 2, 3).
[[nodiscard]] inline TetMesh twoCells() {
  TetMesh mesh = oneCell();
  mesh.points.push_back({1, 1, 1});
  mesh.tetrahedra.push_back({1, 2, 3, 4});
  return mesh;
}

/// Writes `text` as the file `name` in a fresh folder.
[[nodiscard]] inline std::filesystem::path fileWith(const std::string& name,
                                                    const std::string& text) {
  const std::filesystem::path path = freshFolder("file-" + name) / name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

}  // namespace qtet::testing
