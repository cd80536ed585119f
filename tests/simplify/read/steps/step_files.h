// Files of time steps, to read them from.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "simplify/log/write_mesh.h"
#include "tests/simplify/mesh/tet_meshes.h"

namespace qtet::testing {

/// A .pvd of these meshes at the times 0, 1, 2 ...
[[nodiscard]] inline std::filesystem::path seriesOf(const std::vector<TetMesh>& steps) {
  const std::filesystem::path folder = freshFolder("series-of-steps");
  std::string sets;
  for (std::size_t s = 0; s < steps.size(); ++s) {
    const std::string name = "step" + std::to_string(s) + ".vtu";
    const Bytes bytes = vtuBytes(steps[s]);
    std::ofstream(folder / name, std::ios::binary)
        << std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    sets += "<DataSet timestep=\"" + std::to_string(s) + "\" file=\"" + name + "\"/>";
  }
  std::ofstream(folder / "run.pvd")
      << "<VTKFile type=\"Collection\"><Collection>" + sets + "</Collection></VTKFile>";
  return folder / "run.pvd";
}

}  // namespace qtet::testing
