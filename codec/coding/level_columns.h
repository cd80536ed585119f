// The figures of all levels as columns of integers, range-coded (MANIFEST.md, "Level columns").
// Part of the decoder: the browser reads them by it too.
#pragma once

#include <cstdint>
#include <vector>

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// Column-major: number of level l in column c is at [c * levels + l].
using LevelColumns = std::vector<std::uint32_t>;

/// Which levels have a known error.
enum class KnownErrors : std::uint8_t {
  kNone,
  kSome,  ///< the first, the last, and others
};

/// Columns of the counts: tetrahedra, vertices, boundary triangles.
inline constexpr std::uint32_t kCountColumns = 3;
/// With errors: 1 where the error is known, else 0.
inline constexpr std::uint32_t kKnownColumn = 3;

/// The columns before the pairs of figures (codec/coding/error_figure.h), mean and max: to the
/// level, to the original, of each field.
/// Behind which are known, the volume lost and the volume gained (in 10^-6).
inline constexpr std::uint32_t kFirstPairColumn = kCountColumns + 3;
[[nodiscard]] constexpr std::uint32_t levelColumnCount(std::uint32_t fields, KnownErrors errors) {
  return errors == KnownErrors::kNone ? kCountColumns : kFirstPairColumn + 2 * (2 + fields);
}

/// Units in one original's volume, and the most of them: ten times the original is no
/// simplification of it.
inline constexpr std::uint32_t kVolumeFigure = 1'000'000, kMaxVolumeFigure = 10 * kVolumeFigure;

/// The entries behind kKnownColumn of a level whose error is not known are left out.
/// REQUIRES: at least one level, and as many numbers in each column.
[[nodiscard]] Bytes encodeLevelColumns(const LevelColumns& numbers, std::uint32_t levels,
                                       KnownErrors errors);

/// The inverse; an entry that was left out is 0. Errors: limit-exceeded (more numbers than the
/// bytes can hold, found before anything is allocated), truncated, bad-value (bytes left over, a
/// count above kMaxElements, a volume or figure out of range, a mean above the max beside it, a
/// first or last level whose error is not known).
[[nodiscard]] Result<LevelColumns> decodeLevelColumns(ByteView bytes, std::uint32_t levels,
                                                      std::uint32_t fields, KnownErrors errors);

}  // namespace qtet
