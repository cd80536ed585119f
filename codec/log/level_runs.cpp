#include "codec/log/level_runs.h"

#include <algorithm>
#include <optional>

namespace qtet {
namespace {

// A picture sharpens when a chunk is whole, so that each is a share of what a viewer has already
// waited for, up to LogWriterOptions::chunkBytes. Smaller chunks cost more than they gain. A row of
// the table and Draco's fixed bytes are 130 bytes a chunk with one field, 3 % of 4 KB.
constexpr std::uint64_t kMinChunkBytes = 4 << 10;
constexpr std::uint64_t kGrowth = 3;

class LevelRuns {
 public:
  LevelRuns(RecordWriter& writer, std::uint64_t chunkBytes)
      : writer_(writer), chunks_(writer.chunks()), chunkBytes_(chunkBytes) {}

  /// Writes a level, and closes its last chunk unless another level should join that or `isLast`.
  Status write(std::uint32_t level, bool isLast) {
    writer_.mesh().beginLevel(level);
    writer_.meter().spend(1);
    // none once a chunk ended within the level
    std::optional<std::uint64_t> begun = chunks_.estimatedBytes();
    for (VertexId v = 0; v < writer_.mesh().levelVertices(); ++v) {
      if (!writer_.mesh().maysplit(v)) continue;
      const Fusion* fusion = writer_.flag(v);
      if (fusion == nullptr) continue;
      if (Status s = writer_.record(v, *fusion); !s) return s;
      if (chunks_.estimatedBytes() < target()) continue;
      if (Status s = cut(level, v + 1, level); !s) return s;
      begun.reset();
    }
    if (isLast || !endsNearTarget(begun)) return {};
    return cut(level, kLevelEnd, level + 1);
  }

  /// Closes the open chunk; the next one begins in `nextLevel`.
  Status cut(std::uint32_t lastLevel, std::uint32_t endSlot, std::uint32_t nextLevel) {
    if (Status s = writer_.closeChunk(lastLevel, endSlot); !s) return s;
    chunks_.begin(nextLevel);
    if (nextLevel == lastLevel) writer_.meter().spend(1);
    return {};
  }

 private:
  [[nodiscard]] std::uint64_t target() const {
    return std::min(chunkBytes_, std::max(kMinChunkBytes, chunks_.closedBytes() / kGrowth));
  }

  // Whether the next chunk should begin with the next level. It should if another level, like the
  // one that began at `begun` bytes, would overshoot the target by more than this one falls short.
  [[nodiscard]] bool endsNearTarget(std::optional<std::uint64_t> begun) const {
    const std::uint64_t bytes = chunks_.estimatedBytes();
    const std::uint64_t levelBytes = begun ? bytes - *begun : target();
    return 2 * bytes + levelBytes >= 2 * target();
  }

  RecordWriter& writer_;
  ChunkWriter& chunks_;
  std::uint64_t chunkBytes_;
};

}  // namespace

Status writeLevelRuns(RecordWriter& writer, std::uint32_t levels, const LogWriterOptions& options) {
  if (levels == 0) return {};
  LevelRuns runs(writer, options.chunkBytes);
  if (Status s = runs.cut(0, kLevelEnd, 1); !s) return s;
  for (std::uint32_t level = 1; level <= levels; ++level) {
    if (Status s = runs.write(level, level == levels); !s) return s;
    if (options.progress) options.progress(writer.done());
  }
  return {};
}

}  // namespace qtet
