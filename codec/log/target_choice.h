// The level and the chunks that a target takes of a log. Tool, server and C API choose by cells,
// bytes, errors or levels here alone. Figures are the manifest's.
#pragma once

#include <cstdint>
#include <span>

#include "proto/error.h"
#include "proto/target.h"

namespace qtet {

struct LogIndex;
struct Manifest;

/// The finest level of at most so many tetrahedra; 0 if there is none. By bytes the finest level
/// that a prefix of at most so many bytes of the file holds; 0 if there is none. By errors the
/// coarsest level that is known to be good enough, both ways for the boundary, or the last one. A
/// level beyond the last is the last, and so is everything's. Errors: not-found (no such field; no
/// level's error is known). REQUIRES: a manifest that manifestOf(index) gave.
[[nodiscard]] Result<std::uint32_t> levelFor(const Target& target, const Manifest& manifest,
                                             const LogIndex& index);

/// The coarsest level at which the rms error of each of these fields is known to be at most
/// `error`, or the last one. Errors: not-found (no level's error is known). REQUIRES: numbers of
/// fields of the manifest.
[[nodiscard]] Result<std::uint32_t> levelOfFieldErrors(double error,
                                                       std::span<const std::uint32_t> fields,
                                                       const Manifest& manifest);

/// The last chunk that the target takes: that of levelFor, but bytes are counted in whole chunks,
/// not in levels. If no level's error is known, the last level is good enough. Errors: not-found
/// (no such field). REQUIRES: as levelFor.
[[nodiscard]] Result<std::uint32_t> lastChunkFor(const Target& target, const Manifest& manifest,
                                                 const LogIndex& index);

}  // namespace qtet
