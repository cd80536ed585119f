// The figures of all levels as columns of integers, range-coded (FORMAT.md, "Level columns"). Part
// of the decoder: the browser reads them by it too.
#pragma once

#include <cstdint>
#include <vector>

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// Column-major: number of level l in column c is at [c * levels + l].
using LevelColumns = std::vector<std::uint32_t>;

/// Columns of the counts: tetrahedra, vertices, boundary triangles.
inline constexpr std::uint32_t kCountColumns = 3;
/// With known errors: then the volume kept (in 10^-6), then pairs of figures
/// (codec/coding/error_figure.h) mean and max: to the level, to the original, of each field.
[[nodiscard]] constexpr std::uint32_t levelColumnCount(std::uint32_t fields, bool hasErrors) {
  return kCountColumns + (hasErrors ? 1 + 2 * (2 + fields) : 0);
}

/// Units in one original's volume, and the most of them: ten times the original is no
/// simplification of it.
inline constexpr std::uint32_t kVolumeFigure = 1'000'000, kMaxVolumeFigure = 10 * kVolumeFigure;

/// REQUIRES: at least one level, and as many numbers in each column.
[[nodiscard]] Bytes encodeLevelColumns(const LevelColumns& numbers, std::uint32_t levels);

/// The inverse. Errors: limit-exceeded (more numbers than the bytes can hold, found before anything
/// is allocated), truncated, bad-value (bytes left over, a count above kMaxElements, a volume or
/// figure out of range, a mean above the max beside it).
[[nodiscard]] Result<LevelColumns> decodeLevelColumns(ByteView bytes, std::uint32_t levels,
                                                      std::uint32_t columns);

}  // namespace qtet
