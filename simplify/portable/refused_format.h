// The refusal of a file whose reader a program as WebAssembly lacks.
#pragma once

#include <filesystem>

#include "proto/error.h"

namespace qtet {

[[nodiscard]] inline std::unexpected<Error> refusedFormat(const std::filesystem::path& path) {
  return fail(ErrorCode::kBadInput,
              path.filename().string() +
                  ": qtet reads this format neither in browsers nor in node; make a log by `qtet "
                  "simplify` of the Python package and open that, or save the mesh as .vtu");
}

}  // namespace qtet
