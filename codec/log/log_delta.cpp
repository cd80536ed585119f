#include "codec/log/log_delta.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <map>
#include <utility>
#include <vector>

#include "codec/log/log_index.h"

namespace qtet {
namespace {

/// Bytes that stand in both logs.
struct Piece {
  std::uint64_t offset = 0, oldOffset = 0, bytes = 0;
};

/// Smaller pieces cost more as an instruction than they save.
constexpr std::uint32_t kMinPieceBytes = 64;

/// The blocks of at least kMinPieceBytes, in file order.
std::vector<BlockEntry> blocksOf(const LogIndex& index) {
  std::vector<BlockEntry> out;
  const auto add = [&out](const BlockEntry& block) {
    if (block.size >= kMinPieceBytes) out.push_back(block);
  };
  for (const ChunkEntry& chunk : index.chunks) std::ranges::for_each(chunk.blocks, add);
  for (const ClosingBlock& closing : index.closing) add(closing.block);
  return out;
}

/// In the order of both logs, neighbours joined.
std::vector<Piece> commonPieces(const LogIndex& old, const LogIndex& index) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint64_t>> places;
  for (const BlockEntry& block : blocksOf(old))
    places[{block.size, block.crc}].push_back(block.offset);
  std::vector<Piece> out;
  std::uint64_t oldEnd = 0;
  for (const BlockEntry& block : blocksOf(index)) {
    const auto found = places.find({block.size, block.crc});
    if (found == places.end()) continue;
    const auto place = std::ranges::lower_bound(found->second, oldEnd);
    if (place == found->second.end()) continue;
    Piece* last = out.empty() ? nullptr : &out.back();
    if (last && *place == oldEnd && block.offset == last->offset + last->bytes)
      last->bytes += block.size;
    else
      out.push_back({block.offset, *place, block.size});
    oldEnd = *place + block.size;
  }
  return out;
}

}  // namespace

std::optional<Bytes> makeDelta(const LogIndex& old, const LogIndex& index, ByteView log,
                               std::uint64_t first, std::uint64_t most) {
  assert(old.unreadBytes() == 0 && index.unreadBytes() == 0 && first <= log.size());
  std::vector<Piece> pieces = commonPieces(old, index);
  std::erase_if(pieces, [&](const Piece& p) { return p.offset + p.bytes <= first; });
  if (!pieces.empty() && pieces.front().offset < first) {
    const std::uint64_t there = first - pieces.front().offset;
    pieces.front().offset += there;
    pieces.front().oldOffset += there;
    pieces.front().bytes -= there;
  }
  std::uint64_t bytes = log.size() - first + DeltaReader::kHeadBytes * (pieces.size() + 1);
  for (const Piece& piece : pieces) bytes -= piece.bytes;
  if (bytes > most) return std::nullopt;
  ByteWriter out;
  const auto write = [&](const Piece& piece, std::uint64_t literalEnd) {
    const std::uint64_t literal = piece.offset + piece.bytes;
    out.write(piece.oldOffset);
    out.write(piece.bytes);
    out.write(literalEnd - literal);
    out.append(log.subspan(literal, literalEnd - literal));
  };
  Piece last{.offset = first};
  for (const Piece& piece : pieces) {
    if (last.bytes > 0 || piece.offset > last.offset) write(last, piece.offset);
    last = piece;
  }
  if (last.bytes > 0 || first < log.size()) write(last, log.size());
  return out.take();
}

void DeltaReader::feed(ByteView delta) {
  assert(needsBytes());
  fed_ = delta;
}

Status DeltaReader::readHead() {
  ByteReader in(head_);
  const auto from = in.read<std::uint64_t>();
  copyBytes_ = in.read<std::uint64_t>();
  literalBytes_ = in.read<std::uint64_t>();
  if (copyBytes_ == 0 && literalBytes_ == 0)
    return fail(ErrorCode::kBadValue, "an instruction of a delta gives no byte");
  if (copyBytes_ > 0 &&
      (from < copyFrom_ || from > base_.size() || copyBytes_ > base_.size() - from))
    return fail(ErrorCode::kBadValue, "a delta's piece lies before the last one, or beyond the " +
                                          std::to_string(base_.size()) + " bytes of the old log");
  if (copyBytes_ > left_ || literalBytes_ > left_ - copyBytes_)
    return fail(ErrorCode::kBadValue, "a delta gives more bytes than the new log has");
  left_ -= copyBytes_ + literalBytes_;
  if (copyBytes_ > 0) copyFrom_ = from;
  return {};
}

Result<ByteView> DeltaReader::next(std::size_t most) {
  while (copyBytes_ == 0 && literalBytes_ == 0 && !fed_.empty()) {
    const std::size_t n = std::min(kHeadBytes - headBytes_, fed_.size());
    std::memcpy(head_.data() + headBytes_, fed_.data(), n);
    fed_ = fed_.subspan(n);
    headBytes_ = (headBytes_ + n) % kHeadBytes;
    if (headBytes_ != 0) break;
    if (Status s = readHead(); !s) return std::unexpected(s.error());
  }
  if (copyBytes_ > 0) {
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(copyBytes_, most));
    const ByteView out = base_.subspan(copyFrom_, n);
    copyFrom_ += n;
    copyBytes_ -= n;
    return out;
  }
  const auto n =
      static_cast<std::size_t>(std::min<std::uint64_t>({literalBytes_, most, fed_.size()}));
  const ByteView out = fed_.first(n);
  fed_ = fed_.subspan(n);
  literalBytes_ -= n;
  return out;
}

}  // namespace qtet
