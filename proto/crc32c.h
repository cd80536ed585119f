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
/// The ways that this machine can go, the fastest first, which is the one that crc32c takes; the
/// last one is the tables, which all can.
[[nodiscard]] std::span<const Crc32cPath> crc32cPaths();

}  // namespace qtet
