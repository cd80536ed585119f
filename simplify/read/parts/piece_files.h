// Results of parallel programs that lie in a file or a folder for each process, with no file that
// lists them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "proto/error.h"

namespace qtet {

/// Pieces of one result at most: more than the largest machines have processes.
inline constexpr std::uint64_t kMaxPieceFiles = 1U << 24;

/// All N pieces of an Exodus result, whichever of them is given: NAME.e.N.M is number M of N.
/// Errors: not-found (a piece is missing: its name), bad-input (no such name; M is not below N; too
/// many).
[[nodiscard]] Result<std::vector<std::filesystem::path>> exodusPieces(
    const std::filesystem::path& path);

/// Whether the folder is a case of OpenFOAM: it has constant/polyMesh, also that of a region, or a
/// folder of a process.
[[nodiscard]] bool isFoamCase(const std::filesystem::path& folder);

/// The folders processor0, processor1 ... beside an OpenFOAM case's marker, where the case is to be
/// read from them. It has no mesh of its own then; or it has no time that they lack, and they have
/// more. Empty: it is to be read as a whole. Errors: not-found (one of them is missing), bad-input
/// (all processes write into one folder).
[[nodiscard]] Result<std::vector<std::filesystem::path>> processorFolders(
    const std::filesystem::path& marker);

}  // namespace qtet
