#include "codec/log/log_delta.h"

#include <algorithm>
#include <array>
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

/// A block in file order, and the chunk that it belongs to; that of a closing block is the number
/// of chunks.
struct Placed {
  BlockEntry block;
  std::size_t chunk = 0;
};

/// The blocks with bytes.
std::vector<Placed> blocksOf(const LogIndex& index) {
  std::vector<Placed> out;
  const auto add = [&out](const BlockEntry& block, std::size_t chunk) {
    if (block.size > 0) out.push_back({block, chunk});
  };
  for (std::size_t chunk = 0; chunk < index.chunks.size(); ++chunk)
    for (const BlockEntry& block : index.chunks[chunk].blocks) add(block, chunk);
  for (const ClosingBlock& closing : index.closing) add(closing.block, index.chunks.size());
  return out;
}

/// Collects pieces, which come in the order of both logs, and joins neighbours.
class Pieces {
 public:
  /// Behind the last byte of the old log that is taken.
  [[nodiscard]] std::uint64_t oldEnd() const { return oldEnd_; }
  void add(const Piece& piece) {
    assert(all_.empty() ||
           (piece.oldOffset >= oldEnd_ && piece.offset >= all_.back().offset + all_.back().bytes));
    Piece* const last = all_.empty() ? nullptr : &all_.back();
    if (last && piece.oldOffset == oldEnd_ && piece.offset == last->offset + last->bytes)
      last->bytes += piece.bytes;
    else
      all_.push_back(piece);
    oldEnd_ = piece.oldOffset + piece.bytes;
  }
  /// Those that are worth an instruction.
  [[nodiscard]] std::vector<Piece> take() {
    std::erase_if(all_, [](const Piece& piece) { return piece.bytes < kMinPieceBytes; });
    return std::move(all_);
  }

 private:
  std::vector<Piece> all_;
  std::uint64_t oldEnd_ = 0;
};

/// The blocks of the logs that agree. A small one counts where the block before it agreed, or one
/// of the same chunk: many small blocks look alike.
void addBlocks(const LogIndex& old, const LogIndex& index, Pieces& out) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Placed>> places;
  for (const Placed& placed : blocksOf(old))
    places[{placed.block.size, placed.block.crc}].push_back(placed);
  for (const auto& [block, chunk] : blocksOf(index)) {
    const auto found = places.find({block.size, block.crc});
    if (found == places.end()) continue;
    const auto place = std::ranges::lower_bound(
        found->second, out.oldEnd(), {}, [](const Placed& there) { return there.block.offset; });
    if (place == found->second.end()) continue;
    if (block.size >= kMinPieceBytes || place->block.offset == out.oldEnd() ||
        place->chunk == chunk)
      out.add({block.offset, place->block.offset, block.size});
  }
}

/// Bytes by which equal places of two lists of later instants are found. Their checksums are as
/// good as random, and a name has more.
constexpr std::size_t kWordBytes = 16;

/// The runs of bytes that stand in both logs' lists of later instants. The lists begin at
/// `oldOffset` and `offset`.
void addLater(ByteView old, std::uint64_t oldOffset, ByteView later, std::uint64_t offset,
              Pieces& out) {
  const auto wordAt = [](ByteView bytes, std::size_t at) {
    std::array<std::uint64_t, kWordBytes / sizeof(std::uint64_t)> word{};
    std::memcpy(word.data(), bytes.data() + at, kWordBytes);
    return word;
  };
  std::map<std::array<std::uint64_t, 2>, std::vector<std::size_t>> places;
  for (std::size_t at = 0; at + kWordBytes <= old.size(); at += kWordBytes)
    places[wordAt(old, at)].push_back(at);
  std::size_t oldEnd = 0, laterEnd = 0;  // behind the last run
  for (std::size_t at = 0; at + kWordBytes <= later.size();) {
    const auto found = places.find(wordAt(later, at));
    const auto place = found == places.end()
                           ? std::vector<std::size_t>::const_iterator{}
                           : std::ranges::lower_bound(std::as_const(found->second), oldEnd);
    if (found == places.end() || place == found->second.end()) {
      ++at;
      continue;
    }
    std::size_t begin = at, oldBegin = *place, end = at + kWordBytes, oldStop = *place + kWordBytes;
    while (begin > laterEnd && oldBegin > oldEnd && later[begin - 1] == old[oldBegin - 1])
      --begin, --oldBegin;
    while (end < later.size() && oldStop < old.size() && later[end] == old[oldStop])
      ++end, ++oldStop;
    if (end - begin < kMinPieceBytes) {
      ++at;
      continue;
    }
    out.add({offset + begin, oldOffset + oldBegin, end - begin});
    at = laterEnd = end, oldEnd = oldStop;
  }
}

/// In the order of both logs.
std::vector<Piece> commonPieces(const LogIndex& old, const LogIndex& index, ByteView log) {
  Pieces out;
  addBlocks(old, index, out);
  const Bytes before = old.encodeLater();
  const std::size_t later = index.encodeLater().size();
  addLater(before, old.fileBytes - before.size(), log.last(later), log.size() - later, out);
  return out.take();
}

}  // namespace

std::optional<Bytes> makeDelta(const LogIndex& old, const LogIndex& index, ByteView log,
                               std::uint64_t first, std::uint64_t most) {
  assert(old.unreadBytes() == 0 && index.unreadBytes() == 0 && first <= log.size());
  std::vector<Piece> pieces = commonPieces(old, index, log);
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
