// A fuzzer's bytes read as choices; what is beyond their end is 0.
#pragma once

#include <algorithm>
#include <cstdint>

#include "proto/bytes.h"

namespace qtet::fuzz {

class ByteSource {
 public:
  explicit ByteSource(ByteView bytes) : bytes_(bytes) {}

  [[nodiscard]] bool empty() const { return bytes_.empty(); }
  std::uint8_t next() {
    if (bytes_.empty()) return 0;
    const std::uint8_t byte = bytes_[0];
    bytes_ = bytes_.subspan(1);
    return byte;
  }
  std::uint16_t next16() {
    const std::uint8_t low = next();
    return static_cast<std::uint16_t>(low | next() << 8);
  }
  ByteView take(std::size_t count) {
    const ByteView out = bytes_.first(std::min(count, bytes_.size()));
    bytes_ = bytes_.subspan(out.size());
    return out;
  }

 private:
  ByteView bytes_;
};

}  // namespace qtet::fuzz
