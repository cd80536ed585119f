// A text as its bytes.
#pragma once

#include <cstdint>
#include <string_view>

#include "proto/bytes.h"

namespace qtet {

/// The text must outlive the view.
[[nodiscard]] inline ByteView viewOf(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace qtet
