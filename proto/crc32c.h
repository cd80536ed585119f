// CRC-32C, which guards every part of a log: one result everywhere, by the processor's own
// instruction where there is one.
#pragma once

#include <cstdint>
#include <span>

#include "proto/bytes.h"

namespace qtet {

/// CRC-32C (Castagnoli; RFC 3720, section 12.1: polynomial 0x1EDC6F41, reflected 0x82F63B78,
/// initial and final complement).
[[nodiscard]] std::uint32_t crc32c(ByteView bytes);

/// One way of computing it.
struct Crc32cPath {
  const char* name;
  std::uint32_t (*run)(ByteView bytes);
};
/// The implementations that this machine supports, the fastest first; crc32c uses that one. The
/// last one uses tables, which every machine supports.
[[nodiscard]] std::span<const Crc32cPath> crc32cPaths();

}  // namespace qtet
