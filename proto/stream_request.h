// Plain values for the blocks that a client of `/v1/stream` has, and for its wishes (STREAM.md,
// "What a client has", "View").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proto/target.h"

namespace qtet {

/// Most planes of a frustum, clip planes and isovalues. A camera has six sides, the viewer cuts
/// with three planes, and nobody distinguishes more isovalues.
inline constexpr std::size_t kMaxFrustumPlanes = 6;
inline constexpr std::size_t kMaxClipPlanes = 3;
inline constexpr std::size_t kMaxIsovalues = 8;
/// Ranges of one set of chunks: a message holds fewer.
inline constexpr std::size_t kMaxChunkRanges = 8192;

/// Chunks first..end-1.
struct ChunkRange {
  std::uint32_t first = 0;
  std::uint32_t end = 0;

  bool operator==(const ChunkRange&) const = default;
};

/// Chunks that a client has applied: the leading ones, and others behind them.
struct HeldChunks {
  std::uint32_t leading = 0;
  /// Ascending; there are gaps before each, of at least one chunk.
  std::vector<ChunkRange> ranges{};

  /// Behind the last chunk held.
  [[nodiscard]] std::uint32_t end() const { return ranges.empty() ? leading : ranges.back().end; }
  /// Whether all of them are held.
  [[nodiscard]] bool holds(const ChunkRange& asked) const {
    if (asked.end <= leading) return true;
    for (const ChunkRange& r : ranges)
      if (r.first <= asked.first && asked.end <= r.end) return true;
    return false;
  }
};

struct Have {
  HeldChunks mesh{};
  std::vector<std::pair<std::string, HeldChunks>> fields{};  ///< by key; within `mesh` each
};

// ---- what is looked at, in the mesh's own units

/// a x + b y + c z + d.
using Plane = std::array<double, 4>;

struct Isovalue {
  std::string field{};
  /// None: the value itself, or of several components their length.
  std::optional<std::uint32_t> component{};
  std::vector<double> values{};
};

struct View {
  std::vector<Plane> frustum{};  ///< seen is what lies on the side >= 0 of all of them
  std::vector<Plane> planes{};   ///< clip planes: what lies on one is wanted
  std::optional<std::array<double, 6>> box{};  ///< least corner, greatest corner
  std::optional<Isovalue> isovalue{};
  std::optional<std::array<double, 3>> point{};
};

}  // namespace qtet
