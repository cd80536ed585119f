// What a program as WebAssembly says of a file that a reader which it lacks would have read.
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
