// Fuzzes a value block: components, tuples, then Draco's bytes. An accepted block is encoded and
// decoded again and must be the same.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "codec/coding/draco_block.h"
#include "proto/limits.h"
#include "tests/fuzz/byte_source.h"

namespace {
constexpr std::int32_t kMaxToEncode = 1 << 18;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  qtet::fuzz::ByteSource in{{data, size}};
  const std::uint32_t components = 1 + in.next() % qtet::kMaxFieldComponents;
  const std::uint32_t tuples = in.next16();
  const auto values =
      qtet::decodeDracoBlock(in.take(std::numeric_limits<std::size_t>::max()), components, tuples);
  if (!values) return 0;
  if (values->size() != std::size_t{components} * tuples) std::abort();
  // Draco's encoder counts symbols in an array as long as the largest of them: gigabytes from 2^28
  // on.
  const auto small = [](std::int32_t value) {
    return value > -kMaxToEncode && value < kMaxToEncode;
  };
  if (!std::ranges::all_of(*values, small)) return 0;
  const auto again = qtet::encodeDracoBlock(*values, components);
  if (!again) std::abort();
  const auto decoded = qtet::decodeDracoBlock(*again, components, tuples);
  if (!decoded || *decoded != *values) std::abort();
  return 0;
}
