// How large a mesh is as VTK writes it by default, for sizes.py:
//   vtu_size IN.vtu...
// prints a JSON object a file: file, field (the first point field, which alone is kept), cells,
// bytes (parts/default_vtu.h).
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <span>

#include "tests/bench/parts/default_vtu.h"

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "vtu_size: usage: vtu_size IN.vtu...\n";
    return EXIT_FAILURE;
  }
  for (const char* file : std::span(argv, static_cast<std::size_t>(argc)).subspan(1)) {
    const auto vtu = qtet::bench::defaultVtu(file);
    if (!vtu) {
      std::cerr << "vtu_size: " << vtu.error().text() << "\n";
      return EXIT_FAILURE;
    }
    std::cout << nlohmann::ordered_json{{"file", file},
                                        {"field", vtu->field},
                                        {"cells", vtu->cells},
                                        {"bytes", vtu->bytes}}
              << std::endl;
  }
  return EXIT_SUCCESS;
}
