// Predicts what a level takes before a job makes it.
#pragma once

#include <cstdint>

#include "server/store/level_request.h"

namespace qtet {

namespace limits {
/// The default of --max-level-bytes: this part of the memory that the process may have. Three of
/// them (a level, a point, a check) leave the last quarter to the server and the system.
inline constexpr std::uint64_t kLevelPartOfMemory = 4;
/// Above so many bytes a level is sent as it is: compressing it takes it whole in memory, twice.
inline constexpr std::uint64_t kMaxCodedLevelBytes = 1u << 30;
}  // namespace limits

/// An upper bound of the memory that the process takes which makes the level, beside the log and
/// the program themselves.
[[nodiscard]] std::uint64_t memoryOf(const LevelRequest& request);

/// About the bytes of its file before any coding; at most a quarter too few.
[[nodiscard]] std::uint64_t fileBytesOf(const LevelRequest& request);

/// The memory that this process may have: the machine's, or less if its control group says so.
[[nodiscard]] std::uint64_t ownMemory();

}  // namespace qtet
