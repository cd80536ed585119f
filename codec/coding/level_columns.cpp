#include "codec/coding/level_columns.h"

#include <cassert>
#include <string>

#include "codec/coding/error_figure.h"
#include "codec/coding/range_coder.h"
#include "proto/limits.h"

namespace qtet {
namespace {

constexpr std::uint32_t zigzag(std::uint32_t difference) {
  return difference << 1 ^ (difference >> 31 ? ~0u : 0u);
}
constexpr std::uint32_t unzigzag(std::uint32_t code) { return code >> 1 ^ (code & 1 ? ~0u : 0u); }

// Maxima stay for some levels and then jump; everything else goes on as it did.
constexpr bool staysOrJumps(std::uint32_t column) {
  return column > kCountColumns && (column - kCountColumns) % 2 == 0;
}

// Unsigned arithmetic wraps, so that any number follows any other.
template <class Coder>
void code(Coder& coder, LevelColumns& numbers, std::uint32_t levels) {
  for (std::uint32_t column = 0; column < numbers.size() / levels; ++column) {
    NumberModel model;
    std::uint32_t* const at = numbers.data() + std::size_t{column} * levels;
    for (std::uint32_t level = 0; level < levels; ++level) {
      std::uint32_t predicted = level > 0 ? at[level - 1] : 0;
      if (level > 1 && !staysOrJumps(column)) predicted += at[level - 1] - at[level - 2];
      at[level] = predicted + unzigzag(model.code(coder, zigzag(at[level] - predicted)));
    }
  }
}

bool soundLevel(const LevelColumns& numbers, std::uint32_t levels, std::uint32_t level) {
  const auto at = [&](std::uint32_t column) {
    return numbers[std::size_t{column} * levels + level];
  };
  for (std::uint32_t c = 0; c < kCountColumns; ++c)
    if (at(c) > kMaxElements) return false;
  if (numbers.size() / levels > kCountColumns && at(kCountColumns) > kMaxVolumeFigure) return false;
  for (std::uint32_t c = kCountColumns + 1; c + 1 < numbers.size() / levels; c += 2)
    if (at(c) > at(c + 1) || at(c + 1) > kMaxErrorFigure) return false;
  return true;
}

}  // namespace

Bytes encodeLevelColumns(const LevelColumns& numbers, std::uint32_t levels) {
  assert(levels > 0 && numbers.size() % levels == 0);
  RangeEncoder coder;
  LevelColumns copy = numbers;
  code(coder, copy, levels);
  return coder.finish();
}

Result<LevelColumns> decodeLevelColumns(ByteView bytes, std::uint32_t levels,
                                        std::uint32_t columns) {
  // A number costs at least one decision.
  if (std::uint64_t{levels} * columns > kMaxDecisionsPerByte * bytes.size())
    return fail(ErrorCode::kLimitExceeded,
                "the manifest promises more figures of levels than its bytes can hold; build the "
                "log again");
  LevelColumns numbers(std::size_t{levels} * columns);
  RangeDecoder coder(bytes);
  code(coder, numbers, levels);
  if (coder.overrun())
    return fail(ErrorCode::kTruncated,
                "the manifest ends within the figures of its levels; fetch or build the log again");
  if (!coder.atEnd())
    return fail(ErrorCode::kBadValue,
                "bytes behind the manifest's last figure; fetch or build the log again");
  for (std::uint32_t level = 0; level < levels; ++level)
    if (!soundLevel(numbers, levels, level))
      return fail(ErrorCode::kBadValue, "the manifest's figures of level " + std::to_string(level) +
                                            " are out of range (a count above 2^29, a mean above "
                                            "its maximum); build the log again");
  return numbers;
}

}  // namespace qtet
