// The error of a file that is not what it should be.
#pragma once

#include <filesystem>
#include <string>

#include "proto/error.h"

namespace qtet {

/// bad-input: "PATH: WHAT".
[[nodiscard]] inline std::unexpected<Error> badFile(const std::filesystem::path& path,
                                                    const std::string& what) {
  return fail(ErrorCode::kBadInput, path.string() + ": " + what);
}

}  // namespace qtet
