// AVS UCD files in text, before VTK reads them.
#pragma once

#include <filesystem>

#include "proto/error.h"

namespace qtet {

/// Compares the counts of an AVS UCD file with its lines: one for each point, cell and tuple. VTK
/// compares none, and takes what a file lacks for zeros. A binary file passes unseen. Errors:
/// truncated (the file ends too early), bad-input (a line is not what the counts say).
[[nodiscard]] Status checkAvs(const std::filesystem::path& path);

}  // namespace qtet
