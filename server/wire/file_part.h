// Bytes that stand in an open file.
#pragma once

#include <cstdint>

namespace qtet {

/// A place in a file that somebody else holds open.
struct FilePart {
  int descriptor = -1;
  std::uint64_t offset = 0;
};

}  // namespace qtet
