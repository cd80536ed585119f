// Brings back the mesh that a process of its own has read. A reader that has written beyond its
// arrays has spoilt the memory of that process alone.
#pragma once

#include <vector>

#include "simplify/read/options/read_options.h"
#include "simplify/read/steps/timed_cells.h"

namespace qtet {

/// Writes both to the file, from its present place on. Throws std::bad_alloc where there is no
/// room, as it is in memory (memfd_create).
void sendCells(int file, const Result<std::vector<TimedCells>>& steps, const ReadReport& report);

/// Reads from the file's beginning what sendCells wrote; the counts of `report` grow and its notes
/// are appended. The sender may have been spoilt: lengths are compared with the bytes that remain,
/// and what they hold is unchecked as any reader's. Errors: the sender's; bad-input (no such
/// bytes), io.
[[nodiscard]] Result<std::vector<TimedCells>> receiveCells(int file, ReadReport& report);

}  // namespace qtet
