#include "codec/coding/level_columns.h"

#include <cassert>
#include <string>
#include <utility>

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
  if (column == kKnownColumn) return true;
  return column >= kFirstPairColumn && (column - kFirstPairColumn) % 2 == 1;
}

// Unsigned arithmetic wraps, so that any number follows any other.
template <class Coder>
void code(Coder& coder, LevelColumns& numbers, std::uint32_t levels, KnownErrors errors) {
  const auto isThere = [&](std::uint32_t column, std::uint32_t level) {
    return errors != KnownErrors::kSome || column <= kKnownColumn ||
           numbers[std::size_t{kKnownColumn} * levels + level] != 0;
  };
  for (std::uint32_t column = 0; column < numbers.size() / levels; ++column) {
    NumberModel model;
    const bool stays = staysOrJumps(column);
    std::uint32_t last = 0, difference = 0;
    bool isFirst = true;
    for (std::uint32_t level = 0; level < levels; ++level) {
      if (!isThere(column, level)) continue;
      std::uint32_t& at = numbers[std::size_t{column} * levels + level];
      const std::uint32_t predicted = last + (stays ? 0 : difference);
      at = predicted + unzigzag(model.code(coder, zigzag(at - predicted)));
      difference = std::exchange(isFirst, false) ? 0 : at - last;
      last = at;
    }
  }
}

bool isSoundLevel(const LevelColumns& numbers, std::uint32_t levels, std::uint32_t level,
                  KnownErrors errors) {
  const auto at = [&](std::uint32_t column) {
    return numbers[std::size_t{column} * levels + level];
  };
  for (std::uint32_t c = 0; c < kCountColumns; ++c)
    if (at(c) > kMaxElements) return false;
  if (errors == KnownErrors::kNone) return true;
  for (std::uint32_t c = kKnownColumn + 1; c < kFirstPairColumn; ++c)
    if (at(c) > kMaxVolumeFigure) return false;
  for (std::uint32_t c = kFirstPairColumn; c + 1 < numbers.size() / levels; c += 2)
    if (at(c) > at(c + 1) || at(c + 1) > kMaxErrorFigure) return false;
  const bool isEnd = level == 0 || level + 1 == levels;
  return at(kKnownColumn) == 1 || (at(kKnownColumn) == 0 && !isEnd);
}

}  // namespace

Bytes encodeLevelColumns(const LevelColumns& numbers, std::uint32_t levels, KnownErrors errors) {
  assert(levels > 0 && numbers.size() % levels == 0);
  RangeEncoder coder;
  LevelColumns copy = numbers;
  code(coder, copy, levels, errors);
  return coder.finish();
}

Result<LevelColumns> decodeLevelColumns(ByteView bytes, std::uint32_t levels, std::uint32_t fields,
                                        KnownErrors errors) {
  const std::uint32_t columns = levelColumnCount(fields, errors);
  // A number costs at least one decision.
  if (std::uint64_t{levels} * columns > kMaxDecisionsPerByte * bytes.size())
    return fail(ErrorCode::kLimitExceeded,
                "the manifest promises more figures of levels than its bytes can hold; build the "
                "log again");
  LevelColumns numbers(std::size_t{levels} * columns);
  RangeDecoder coder(bytes);
  code(coder, numbers, levels, errors);
  if (coder.overrun())
    return fail(ErrorCode::kTruncated,
                "the manifest ends within the figures of its levels; fetch or build the log again");
  if (!coder.atEnd())
    return fail(ErrorCode::kBadValue,
                "bytes behind the manifest's last figure; fetch or build the log again");
  for (std::uint32_t level = 0; level < levels; ++level)
    if (!isSoundLevel(numbers, levels, level, errors))
      return fail(ErrorCode::kBadValue, "the manifest's figures of level " + std::to_string(level) +
                                            " are out of range (a count above 2^29, a mean above "
                                            "its maximum, no error of an end); build the log "
                                            "again");
  return numbers;
}

}  // namespace qtet
