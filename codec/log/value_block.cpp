#include "codec/log/value_block.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "codec/coding/adaptive_block.h"
#include "codec/coding/draco_block.h"
#include "codec/coding/value_digits.h"

namespace qtet {
namespace {

constexpr std::size_t kCountBytes = 4;

}  // namespace

Result<Bytes> encodeValueBlock(std::span<const std::int32_t> values, std::uint32_t components,
                               CodecId codec) {
  assert(codec == CodecId::kDraco || codec == CodecId::kAdaptive);
  if (values.empty()) return Bytes{};
  if (std::ranges::find(values, std::numeric_limits<std::int32_t>::min()) != values.end())
    return fail(ErrorCode::kLimitExceeded,
                "a difference of 2^31, which a value block cannot hold; use fewer bits");
  if (codec == CodecId::kAdaptive) return encodeAdaptiveBlock(values, components);
  const SymbolsAndDigits parts = splitValues(values);
  Result<Bytes> bytes = encodeDracoBlock(parts.symbols, components);
  if (!bytes) return bytes;
  ByteWriter out;
  out.append(*bytes);
  out.append(parts.digits);
  out.write(static_cast<std::uint32_t>(parts.digits.size()));
  return out.take();
}

Result<std::vector<std::int32_t>> decodeValueBlock(ByteView bytes, std::uint32_t components,
                                                   std::uint32_t tuples, CodecId codec) {
  assert(codec == CodecId::kDraco || codec == CodecId::kAdaptive);
  if (codec == CodecId::kAdaptive) return decodeAdaptiveBlock(bytes, components, tuples);
  if (tuples == 0)
    return bytes.empty() ? Result<std::vector<std::int32_t>>{}
                         : fail(ErrorCode::kBadValue, "a value block of no values has bytes");
  if (bytes.size() < kCountBytes)
    return fail(ErrorCode::kTruncated, "a value block of less than four bytes");
  const auto digits = ByteReader(bytes.last(kCountBytes)).read<std::uint32_t>();
  bytes = bytes.first(bytes.size() - kCountBytes);
  if (digits > bytes.size())
    return fail(ErrorCode::kBadValue, "a value block has fewer bytes than its digits");
  const auto symbols = decodeDracoBlock(bytes.first(bytes.size() - digits), components, tuples);
  if (!symbols) return std::unexpected(symbols.error());
  return joinValues(*symbols, bytes.last(digits));
}

}  // namespace qtet
