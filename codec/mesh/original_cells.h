// Which cell of a file each cell of the input was split from (FORMAT.md, "Original cells").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// The file's numbers of cells lie below it, so that int32 holds them.
inline constexpr std::uint32_t kOriginalCellEnd = std::uint32_t{1} << 31;

/// `ids`: one for each cell of the input, in its order. REQUIRES: below kOriginalCellEnd.
[[nodiscard]] Bytes encodeOriginalCells(std::span<const std::uint32_t> ids);
/// Errors: bad-value (a number that is none, a block longer or shorter than `cells` numbers).
[[nodiscard]] Result<std::vector<std::uint32_t>> decodeOriginalCells(ByteView bytes,
                                                                     std::size_t cells);

}  // namespace qtet
