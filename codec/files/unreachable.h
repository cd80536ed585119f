// Tells "it does not exist" from "the operating system does not say".
#pragma once

#include <system_error>

namespace qtet {

/// Whether `code`, which asking for a file gave, is no answer to whether there is one: permission
/// denied, or a circle of links. `code.message()` is the reason.
[[nodiscard]] inline bool isUnreachable(const std::error_code& code) {
  return code && code != std::errc::no_such_file_or_directory && code != std::errc::not_a_directory;
}

}  // namespace qtet
