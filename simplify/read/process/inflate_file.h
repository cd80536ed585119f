// Mesh files as other bytes: inflated (NAME.vtu.gz), or without a byte order mark.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "proto/error.h"

namespace qtet {

/// The bytes that the machine's memory has. A mesh whose file is larger cannot be read here, and
/// what inflates to more may be a bomb.
[[nodiscard]] std::uint64_t maxInflatedBytes();

/// Inflates the gzip file into a folder of its own, under its name without the last ending. Hands
/// the file to `use`, then removes the folder. Errors: io (not readable, no room), bad-input (no
/// gzip, damaged), truncated, limit-exceeded (more than `most` bytes), those of `use`, in which the
/// file has the name of the compressed one.
[[nodiscard]] Status inflated(const std::filesystem::path& path,
                              const std::function<Status(const std::filesystem::path&)>& use,
                              std::uint64_t most = maxInflatedBytes());

/// Copies a file without its byte order mark, as `inflated` does. Errors: io, those of `use`.
/// REQUIRES: isMarked(path).
[[nodiscard]] Status unmarked(const std::filesystem::path& path,
                              const std::function<Status(const std::filesystem::path&)>& use);

/// The first `bytes` bytes, or all of them, of a file that gzip may have compressed. Errors: io,
/// bad-input (it does not inflate), truncated.
[[nodiscard]] Result<std::string> beginningOf(const std::filesystem::path& path, std::size_t bytes);

/// The text, in which each `from` is `to`.
[[nodiscard]] std::string withName(std::string text, const std::string& from,
                                   const std::string& to);

}  // namespace qtet
