// Inflates one block of a compressed array of a .vtu file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "simplify/read/vtu/vtu_document.h"

namespace qtet {

/// The most bytes that so many compressed ones can hold; 2^64 - 1 where the method has no bound.
[[nodiscard]] std::uint64_t maxInflated(VtuCompressor compressor, std::uint64_t compressedBytes);

/// Keeps what the method needs between blocks. Not for several threads at once.
class BlockInflater {
 public:
  explicit BlockInflater(VtuCompressor compressor);
  BlockInflater(const BlockInflater&) = delete;
  BlockInflater& operator=(const BlockInflater&) = delete;
  BlockInflater(BlockInflater&&) noexcept;
  BlockInflater& operator=(BlockInflater&&) noexcept;
  ~BlockInflater();

  /// Whether the block inflates to exactly `bytes`, which `into` then holds. It grows with what
  /// is inflated where the method has no bound. REQUIRES: bytes <= maxInflated.
  [[nodiscard]] bool inflate(std::span<const std::byte> block, std::uint64_t bytes,
                             std::vector<std::byte>& into);

 private:
  struct Methods;
  VtuCompressor compressor_;
  std::unique_ptr<Methods> methods_;
};

}  // namespace qtet
