// VTK's decimation as a program, for results.py:
//   vtk_decimate IN OUT_PREFIX SCALE REDUCTION...
// It reads IN (.vtu or .vtk) and multiplies its points and scalar, and the boundary weight, by
// SCALE. For each REDUCTION it removes that fraction of the cells, divides by SCALE and writes
// OUT_PREFIX_REDUCTION.vtu. It prints a JSON object a reduction: reduction, cellsIn, cellsOut,
// userSeconds and wallSeconds of the filter alone.
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "codec/files/atomic_file.h"
#include "simplify/log/write_mesh.h"
#include "simplify/read/read_mesh.h"
#include "tests/bench/vtk_decimation.h"

namespace {

int fail(const std::string& message) {
  std::cerr << "vtk_decimate: " << message << "\n";
  return EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  const std::span<char*> words(argv, static_cast<std::size_t>(argc));
  if (words.size() < 5) return fail("usage: vtk_decimate IN OUT_PREFIX SCALE REDUCTION...");
  const double scale = std::strtod(words[3], nullptr);
  if (!(scale > 0))
    return fail("SCALE '" + std::string(words[3]) +
                "' must be a number above 0, such as 1 or 1000");
  const auto read = qtet::readMesh(words[1]);
  if (!read) return fail(read.error().text());
  const auto grid = qtet::bench::gridOf(read->mesh, scale);
  const std::string field = grid->GetPointData()->GetScalars()->GetName();

  for (const std::string word : words.subspan(4)) {
    const double reduction = std::strtod(word.c_str(), nullptr);
    if (!(reduction > 0 && reduction < 1))
      return fail("REDUCTION '" + word + "' must lie between 0 and 1, such as 0.9");
    const qtet::bench::Decimated out = qtet::bench::decimate(grid, scale, reduction);
    const std::string path = std::string(words[2]) + "_" + word + ".vtu";
    if (const auto written = qtet::writeFileAtomically(
            path, qtet::vtuBytes(qtet::bench::meshOf(out.grid, scale, field)));
        !written)
      return fail(written.error().text());
    std::cout << nlohmann::ordered_json{{"reduction", reduction},
                                        {"file", path},
                                        {"cellsIn", read->mesh.tetrahedra.size()},
                                        {"cellsOut", out.grid->GetNumberOfCells()},
                                        {"userSeconds", out.seconds.user},
                                        {"wallSeconds", out.seconds.wall}}
              << std::endl;
  }
  return EXIT_SUCCESS;
}
