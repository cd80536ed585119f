// Makes logs that lie: taken apart, changed, and put together with every offset and checksum right.
// Only a check of the meaning can notice.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/log/log_index.h"
#include "proto/crc32c.h"

namespace qtet::testing {

struct TakenApart {
  LogIndex index;
  std::vector<std::vector<Bytes>> blocks;  ///< chunk, part
  std::vector<Bytes> closing{};

  /// Header, manifest, table, blocks. Offsets, sizes and checksums are those of `blocks`.
  [[nodiscard]] Bytes together() {
    for (std::size_t c = 0; c < blocks.size(); ++c) {
      index.chunks[c].blocks.resize(blocks[c].size());
      for (std::size_t p = 0; p < blocks[c].size(); ++p)
        index.chunks[c].blocks[p].size = static_cast<std::uint32_t>(blocks[c][p].size());
    }
    for (std::size_t i = 0; i < closing.size(); ++i)
      index.closing[i].block.size = static_cast<std::uint32_t>(closing[i].size());
    std::uint64_t offset = index.encode().size();  // which depends on the sizes
    Bytes tail;
    for (std::size_t c = 0; c < blocks.size(); ++c) {
      index.chunks[c].offset = offset;
      for (std::size_t p = 0; p < blocks[c].size(); ++p) {
        index.chunks[c].blocks[p] = {offset, static_cast<std::uint32_t>(blocks[c][p].size()),
                                     crc32c(blocks[c][p])};
        offset += blocks[c][p].size();
        tail.insert(tail.end(), blocks[c][p].begin(), blocks[c][p].end());
      }
    }
    for (std::size_t i = 0; i < closing.size(); ++i) {
      index.closing[i].block = {offset, static_cast<std::uint32_t>(closing[i].size()),
                                crc32c(closing[i])};
      offset += closing[i].size();
      tail.insert(tail.end(), closing[i].begin(), closing[i].end());
    }
    const Bytes later = index.encodeLater();
    index.fileBytes = offset + later.size();
    Bytes out = index.encode();
    out.insert(out.end(), tail.begin(), tail.end());
    out.insert(out.end(), later.begin(), later.end());
    return out;
  }
};

/// `good` with another front, the blocks as they are: its length in the header becomes right,
/// everything else is as `index` says.
[[nodiscard]] inline Bytes withFront(ByteView good, LogIndex index) {
  const LogIndex before = LogIndex::parse(good).value();
  const std::size_t blocks =
      static_cast<std::size_t>(before.fileBytes - before.headBytes()) - before.encodeLater().size();
  const Bytes later = index.encodeLater();
  index.fileBytes += index.encode().size() + blocks + later.size() - good.size();
  Bytes out = index.encode();
  const ByteView kept = good.subspan(static_cast<std::size_t>(before.headBytes()), blocks);
  out.insert(out.end(), kept.begin(), kept.end());
  out.insert(out.end(), later.begin(), later.end());
  return out;
}

/// REQUIRES a log that LogIndex::parse accepts.
[[nodiscard]] inline TakenApart takeApart(ByteView log) {
  TakenApart out{LogIndex::parse(log).value(), {}};
  for (const ChunkEntry& entry : out.index.chunks) {
    out.blocks.emplace_back();
    for (const BlockEntry& block : entry.blocks) {
      const ByteView bytes = log.subspan(static_cast<std::size_t>(block.offset), block.size);
      out.blocks.back().emplace_back(bytes.begin(), bytes.end());
    }
  }
  for (const ClosingBlock& c : out.index.closing) {
    const ByteView bytes = log.subspan(static_cast<std::size_t>(c.block.offset), c.block.size);
    out.closing.emplace_back(bytes.begin(), bytes.end());
  }
  return out;
}

/// Makes the checksums of header, manifest, table and later instants right, after bytes of them
/// were changed.
inline void mendChecksums(Bytes& log) {
  constexpr std::size_t kManifestBytesAt = 24, kTableBytesAt = 28, kManifestCrcAt = 32,
                        kTableCrcAt = 36, kLaterBytesAt = 56, kHeaderCrcAt = 60;
  if (log.size() < LogIndex::kHeaderBytes) return;
  const auto get = [&](std::size_t at) {
    return std::uint64_t{ByteReader(ByteView(log).subspan(at, 4)).read<std::uint32_t>()};
  };
  const auto put = [&](std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) log[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
  };
  const std::uint64_t manifest = get(kManifestBytesAt), table = get(kTableBytesAt);
  const std::uint64_t tableAt = LogIndex::kHeaderBytes + manifest, later = get(kLaterBytesAt);
  if (later > 0 && table > 6 && tableAt + table <= log.size() && later <= log.size()) {
    std::size_t at = tableAt;  // of the number of later fields
    while (log[at] >= 0x80 && at < tableAt + 2) ++at;
    put(at + 1, crc32c(ByteView(log).last(later)));
  }
  if (LogIndex::kHeaderBytes + manifest + table <= log.size()) {
    put(kManifestCrcAt, crc32c(ByteView(log).subspan(LogIndex::kHeaderBytes, manifest)));
    put(kTableCrcAt, crc32c(ByteView(log).subspan(LogIndex::kHeaderBytes + manifest, table)));
  }
  put(kHeaderCrcAt, crc32c(ByteView(log).first(kHeaderCrcAt)));
}

}  // namespace qtet::testing
