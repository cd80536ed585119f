#include "simplify/blocks/piece_store.h"

#include <cassert>
#include <utility>

namespace qtet {

Status PieceStore::put(std::uint32_t to, std::uint32_t from, const MeshPiece& piece) {
  const Bytes bytes = toBytes(piece);
  const std::lock_guard lock(mutex_);
  assert(!pieces_.contains({to, from}));
  pieces_[{to, from}] = {spool_->size(), bytes.size()};
  return spool_->append(bytes);
}

Result<std::vector<Bytes>> PieceStore::bytesOf(std::uint32_t to) const {
  std::vector<Bytes> out;
  const std::lock_guard lock(mutex_);
  for (auto at = pieces_.lower_bound({to, 0}); at != pieces_.end() && at->first.first == to; ++at) {
    out.emplace_back(at->second.size);
    if (Status s = spool_->read(at->second.at, out.back()); !s) return std::unexpected(s.error());
  }
  return out;
}

Result<std::vector<MeshPiece>> PieceStore::get(std::uint32_t to) const {
  Result<std::vector<Bytes>> all = bytesOf(to);
  if (!all) return std::unexpected(all.error());
  std::vector<MeshPiece> out;
  for (Bytes& bytes : *all) {
    Result<MeshPiece> piece = pieceFrom(std::exchange(bytes, {}));
    if (!piece) return std::unexpected(piece.error());
    out.push_back(std::move(*piece));
  }
  return out;
}

}  // namespace qtet
