// Limits on uploads and their checks, with units and reasons.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace qtet::limits {

using namespace std::chrono_literals;

/// Bytes of one log that is taken: the format's own end is at 16 GB or so (proto/limits.h,
/// kMaxChunks).
inline constexpr std::uintmax_t kMaxUploadBytes = std::uintmax_t{16} << 30;
/// Uploads at a time, those that wait for their check included: each holds a file and a piece. And
/// those of one token: a client that trickles its bytes keeps nobody else out.
inline constexpr std::size_t kMaxUploads = 32;
inline constexpr std::size_t kMaxUploadsOfToken = 4;
/// Parts kept so that their uploads can be resumed, with the one under way, and their bytes. One
/// token may have two of the largest logs, and all tokens together as much as four.
inline constexpr std::size_t kMaxParts = 32;
inline constexpr std::size_t kMaxPartsOfToken = 8;
inline constexpr std::uintmax_t kMaxPartBytes = std::uintmax_t{128} << 30;
inline constexpr std::uintmax_t kMaxPartBytesOfToken = std::uintmax_t{32} << 30;
/// Threads that check complete uploads by decoding them whole, beside those that make levels.
inline constexpr std::size_t kCheckThreads = 1;
/// Bytes of the old log that a delta copies at a time, on a thread that may wait for the disk.
inline constexpr std::size_t kDeltaPiece = 1u << 20;
/// Bytes of a body that go to the disk together, on a thread that may wait for it. So there are few
/// changes of threads, and all uploads hold 32 MiB.
inline constexpr std::size_t kUploadPiece = 1u << 20;
/// Threads that write them and remove meshes. One that removes may wait for another's publishing.
inline constexpr std::size_t kWriteThreads = 2;
/// The part of an interrupted upload is kept for so long, so that the upload can be resumed.
inline constexpr auto kPartialUploadTime = 24h;

}  // namespace qtet::limits
