// SHA-256 of whole logs: the same code natively and in the browser, where outside secure contexts
// no WebCrypto is to be had.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "proto/bytes.h"

namespace qtet {

/// SHA-256 (FIPS 180-4), fed in pieces.
class Sha256 {
 public:
  using Digest = std::array<std::uint8_t, 32>;

  void update(ByteView bytes);
  /// Ends the message; the object must not be used afterwards.
  [[nodiscard]] Digest finish();

 private:
  void compress(const std::uint8_t* block);

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> block_{};
  std::uint64_t length_ = 0;
};

/// Lower-case hexadecimal.
[[nodiscard]] std::string toHex(ByteView bytes);
[[nodiscard]] std::string sha256Hex(ByteView bytes);

}  // namespace qtet
