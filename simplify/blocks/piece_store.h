// The pieces of a mesh between two bands, in a spool: in memory or on disk (BLOCKS.md).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "codec/files/byte_spool.h"
#include "simplify/blocks/mesh_piece.h"

namespace qtet {

using MakeSpool = std::function<Result<std::unique_ptr<ByteSpool>>()>;

/// Threads may call at once.
class PieceStore {
 public:
  explicit PieceStore(std::unique_ptr<ByteSpool> spool) : spool_(std::move(spool)) {}

  /// The piece that goes to block `to` from block `from` of the band before. Errors: io.
  Status put(std::uint32_t to, std::uint32_t from, const MeshPiece& piece);
  /// All pieces of a block, by the block that they come from. Errors: io, bad-checksum.
  [[nodiscard]] Result<std::vector<MeshPiece>> get(std::uint32_t to) const;
  /// The bytes of all pieces.
  [[nodiscard]] std::uint64_t sizeBytes() const { return spool_->size(); }

 private:
  struct Extent {
    std::uint64_t at = 0, size = 0;
  };

  [[nodiscard]] Result<std::vector<Bytes>> bytesOf(std::uint32_t to) const;

  mutable std::mutex mutex_;
  std::unique_ptr<ByteSpool> spool_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Extent> pieces_;  // by to and from
};

}  // namespace qtet
