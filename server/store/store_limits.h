// How much the store holds and how often it looks, with units and reasons.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace qtet::limits {

using namespace std::chrono_literals;

/// Logs held open beside those that are being read, a descriptor and a mapping each: as many as are
/// popular at a time. Opening another takes a millisecond or so.
inline constexpr std::size_t kMaxOpenLogs = 256;
/// Between two looks at a folder that is not read to its end, at least: as long as a look takes.
inline constexpr auto kFolderReadRest = 50ms;
/// The niceness of the thread that reads such a folder, so that requests go first.
inline constexpr int kReadingNiceness = 10;
/// Up to so many logs that arrive together are logged one by one.
inline constexpr std::size_t kMaxLoggedMeshes = 20;
/// Meshes of one page of the list: about 1 KB each.
inline constexpr std::size_t kMaxListPage = 1000;
/// Keys of fields that the list names of one mesh, and their bytes. Nobody reads more in a list,
/// and a page stays below 10 MB.
inline constexpr std::size_t kMaxListedKeys = 256;
inline constexpr std::size_t kMaxListedKeyBytes = 8u << 10;
/// Bytes of one log that is served from a nameless copy, and of all of them. People overwrite files
/// in place, which changes a mapping under its digest. Most logs are smaller; larger ones are
/// replaced by renaming (`qtet`, uploads).
inline constexpr std::uintmax_t kMaxCopiedLogBytes = 64u << 20;
inline constexpr std::uintmax_t kMaxCopiedBytes = 1u << 30;
/// How long, and how many, replaced logs are still to be had under their digests, for those who are
/// reading them piece by piece.
inline constexpr auto kReplacedLogTime = 10min;
inline constexpr std::size_t kMaxReplacedLogs = 16;
/// How long the folder must be quiet before it is read again: one copied file causes many events.
inline constexpr auto kFolderRest = 200ms;
/// A folder that never rests is read anyway after this many changes.
inline constexpr int kMaxFolderRests = 25;
/// It is read this often in any case, because network folders report no changes, and to release
/// replaced logs.
inline constexpr auto kFolderInterval = 60s;

// ---- levels

/// Levels being made or waiting at a time: one that waits holds its log open, one that is made a
/// whole mesh in memory.
inline constexpr std::size_t kMaxLevelJobs = 64;
/// The part of them that one address may want. A browser opens six connections to one server, so no
/// page is refused, and other addresses still find places.
inline constexpr std::size_t kMaxLevelJobsPerAddress = 6;
/// Threads that make them, beside the I/O threads.
inline constexpr std::size_t kLevelThreads = 1;
/// Bytes of finished levels kept on disk: some hundred of a mesh of a million cells.
inline constexpr std::uintmax_t kMaxCacheBytes = std::uintmax_t{2} << 30;
/// Files of finished levels. This many take 20 MB of memory for their names, and 256 MiB of a disk
/// that gives each 4 KiB.
inline constexpr std::size_t kMaxCachedLevels = 65'536;
/// Finished levels held open, a mapping each, whose checksum was compared: as many as are asked for
/// again and again, whole or range by range.
inline constexpr std::size_t kMaxOpenLevels = 64;

// ---- values of series at points

/// Jobs waiting or running at a time, beside those of levels. The part of one address is as there.
inline constexpr std::size_t kMaxPointJobs = 64;
/// Threads that wait for the processes that make them.
inline constexpr std::size_t kPointThreads = 1;
/// Answers kept in memory, and their bytes: 1,000 of a series of 8,192 instants, or all of short
/// ones.
inline constexpr std::size_t kMaxKeptPoints = 16'384;
inline constexpr std::uint64_t kMaxKeptPointBytes = 64u << 20;

}  // namespace qtet::limits
