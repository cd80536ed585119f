#include "simplify/read/vtu/array_bytes.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "simplify/read/vtu/base64_digits.h"

namespace qtet {
namespace {

/// Groups of four characters that are decoded at once.
constexpr std::size_t kGroupsAtOnce = 16384;
/// Numbers in front of compressed blocks: how many there are, the size of one, that of the last.
constexpr std::uint64_t kBlockWords = 3;

/// Decodes a group of four characters; how many bytes it gives: 3, before the end of the data
/// fewer; 0: it is no base64.
std::size_t decodeGroup(const unsigned char* c, std::byte* out) {
  const unsigned a = kBase64Digits[c[0]], b = kBase64Digits[c[1]];
  const unsigned d = c[2] == '=' && c[3] == '=' ? 0u : kBase64Digits[c[2]];
  const unsigned e = c[3] == '=' ? 0u : kBase64Digits[c[3]];
  if ((a | b | d | e) > 63) return 0;
  const unsigned bits = a << 18 | b << 12 | d << 6 | e;
  out[0] = static_cast<std::byte>(bits >> 16);
  out[1] = static_cast<std::byte>(bits >> 8);
  out[2] = static_cast<std::byte>(bits);
  return c[2] == '=' ? 1 : c[3] == '=' ? 2 : 3;
}

}  // namespace

Status StoredRun::read(const VtuFile& file, std::uint64_t at, std::span<std::byte> into) const {
  const auto endsWithin = [&](std::uint64_t where) {
    return fail(ErrorCode::kTruncated,
                file.path().string() + ": the data of an array end at byte " +
                    std::to_string(where) +
                    ", within the array; the file is damaged, export it again",
                where);
  };
  if (at > room() || into.size() > room() - at) return endsWithin(end);
  if (!isBase64) return file.read(begin + at, into);
  std::vector<unsigned char> text;
  std::vector<std::byte> bytes;
  std::uint64_t group = at / 3;
  std::size_t skip = static_cast<std::size_t>(at % 3);
  while (!into.empty()) {
    const std::size_t groups = std::min(kGroupsAtOnce, (skip + into.size() + 2) / 3);
    text.resize(4 * groups);
    bytes.resize(3 * groups);
    const std::uint64_t from = begin + 4 * group;
    if (Status read = file.read(from, std::as_writable_bytes(std::span(text))); !read) return read;
    std::size_t decoded = 0;
    for (std::size_t i = 0; i < groups && decoded == 3 * i; ++i) {
      const std::size_t got = decodeGroup(text.data() + 4 * i, bytes.data() + 3 * i);
      if (got == 0)
        return file.bad("byte " + std::to_string(from + 4 * i) +
                            " is no base64, though the array goes on; the file is damaged, "
                            "export it again",
                        from + 4 * i);
      decoded += got;
    }
    assert(skip < 3 && decoded <= 3 * groups);
    const std::size_t wanted = std::min(into.size(), 3 * groups - skip);
    if (decoded < skip + wanted) return endsWithin(from + 4 * ((decoded + 2) / 3));
    std::memcpy(into.data(), bytes.data() + skip, wanted);
    into = into.subspan(wanted);
    group += groups;
    skip = 0;
  }
  return {};
}

Result<ArrayBytes> ArrayBytes::open(const VtuFile& file, const VtuDocument& document,
                                    const VtuArray& array) {
  assert(array.place != VtuArray::Place::kAscii);
  StoredRun run{array.begin, array.end, true};
  if (array.place == VtuArray::Place::kAppended) {
    const std::uint64_t first = document.appendedBegin.value_or(file.size());
    if (!document.appendedBegin || array.begin > file.size() - first)
      return file.bad(array.called() + " begins at byte " + std::to_string(array.begin) +
                          " of the appended data, which the file does not have; it is damaged, "
                          "export it again",
                      first);
    run = {first + array.begin, file.size(), document.appendedIsBase64};
  } else {  // blanks stand round it
    std::byte c{};
    while (run.begin < run.end) {
      if (Status read = file.read(run.begin, std::span(&c, 1)); !read)
        return std::unexpected(read.error());
      if (c > std::byte{' '}) break;
      ++run.begin;
    }
  }
  ArrayBytes out(file, document, array, run);
  if (document.compressor != VtuCompressor::kNone) {
    if (Status opened = out.openBlocks(); !opened) return std::unexpected(opened.error());
    return out;
  }
  const auto header = out.words(0, 1);
  if (!header) return std::unexpected(header.error());
  out.headerBytes_ = document.wordBytes;
  out.size_ = header->front();
  if (out.size_ > run.room() - out.headerBytes_)
    return out.bad("says that it has " + std::to_string(out.size_) + " bytes, of which at most " +
                   std::to_string(run.room() - out.headerBytes_) + " are left in the file");
  return out;
}

std::unexpected<Error> ArrayBytes::bad(const std::string& what) const {
  return file_->bad(array_->called() + " " + what + "; the file is damaged, export it again",
                    run_.begin);
}

Result<std::vector<std::uint64_t>> ArrayBytes::words(std::uint64_t first,
                                                     std::uint64_t count) const {
  const std::uint64_t wordBytes = document_->wordBytes;
  if (count > run_.room() / wordBytes || first > run_.room() / wordBytes - count)
    return bad("has a header that goes beyond the file's end");
  std::vector<std::byte> bytes(count * wordBytes);
  if (Status read = run_.read(*file_, first * wordBytes, bytes); !read)
    return std::unexpected(read.error());
  std::vector<std::uint64_t> out(count);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::size_t within =
        document_->isBigEndian ? wordBytes - 1 - i % wordBytes : i % wordBytes;
    out[i / wordBytes] |= static_cast<std::uint64_t>(bytes[i]) << (8 * within);
  }
  return out;
}

Status ArrayBytes::openBlocks() {
  const auto sizes = words(0, kBlockWords);
  if (!sizes) return std::unexpected(sizes.error());
  const std::uint64_t blocks = (*sizes)[0];
  blockBytes_ = (*sizes)[1];
  lastBytes_ = (*sizes)[2] == 0 ? blockBytes_ : (*sizes)[2];
  if (blocks == 0) return {};
  if (lastBytes_ > blockBytes_) return bad("has a last block that is larger than the others");
  if (blocks > run_.room() / document_->wordBytes - kBlockWords)
    return bad("says that it has " + std::to_string(blocks) +
               " blocks, whose sizes alone go beyond the file's end");
  if (__builtin_mul_overflow(blocks - 1, blockBytes_, &size_) ||
      __builtin_add_overflow(size_, lastBytes_, &size_))
    return bad("says that its blocks have more than 2^64 bytes");
  const auto compressed = words(kBlockWords, blocks);
  if (!compressed) return std::unexpected(compressed.error());
  run_.begin = run_.behind((kBlockWords + blocks) * document_->wordBytes);
  if (run_.begin > run_.end) return bad("has a header that goes beyond the file's end");
  std::uint64_t end = 0;
  for (std::uint64_t i = 0; i < blocks; ++i) {
    const std::uint64_t bytes = (*compressed)[i];
    if (bytes > run_.room() - end)
      return bad("says that its block " + std::to_string(i) + " has " + std::to_string(bytes) +
                 " bytes, of which at most " + std::to_string(run_.room() - end) +
                 " are left in the file");
    const std::uint64_t inflated = i + 1 == blocks ? lastBytes_ : blockBytes_;
    if (inflated > maxInflated(document_->compressor, bytes))
      return bad("says that the " + std::to_string(bytes) + " bytes of its block " +
                 std::to_string(i) + " inflate to " + std::to_string(inflated) +
                 ", which they cannot");
    end += bytes;
    ends_.push_back(end);
  }
  inflater_.emplace(document_->compressor);
  return {};
}

std::uint64_t ArrayBytes::bytesOfBlock(std::uint64_t block) const {
  assert(block < ends_.size());
  return block + 1 == ends_.size() ? lastBytes_ : blockBytes_;
}

std::uint64_t ArrayBytes::certain() const {
  constexpr std::uint64_t kLzmaRatio = 1024;  // a usual bound; what goes beyond grows as it comes
  if (document_->compressor != VtuCompressor::kLzma) return size_;
  const std::uint64_t stored = ends_.empty() ? 0 : ends_.back();
  return std::min(size_, stored > size_ / kLzmaRatio ? size_ : stored * kLzmaRatio);
}

Status ArrayBytes::loadBlock(std::uint64_t block) {
  assert(block < ends_.size() && inflater_);
  const std::uint64_t from = block == 0 ? 0 : ends_[block - 1];
  compressed_.resize(ends_[block] - from);
  loaded_ = ~std::uint64_t{0};
  if (Status read = run_.read(*file_, from, compressed_); !read) return read;
  if (!inflater_->inflate(compressed_, bytesOfBlock(block), block_))
    return bad("has a block, number " + std::to_string(block) + ", that does not inflate to its " +
               std::to_string(bytesOfBlock(block)) + " bytes");
  loaded_ = block;
  return {};
}

Status ArrayBytes::read(std::uint64_t at, std::span<std::byte> into) {
  assert(at <= size_ && into.size() <= size_ - at);
  if (!inflater_) return run_.read(*file_, headerBytes_ + at, into);
  while (!into.empty()) {
    const std::uint64_t block = at / blockBytes_;
    if (loaded_ != block) {
      if (Status loaded = loadBlock(block); !loaded) return loaded;
    }
    assert(block_.size() == bytesOfBlock(block) && at % blockBytes_ < block_.size());
    const std::uint64_t within = at % blockBytes_;
    const auto bytes =
        static_cast<std::size_t>(std::min<std::uint64_t>(into.size(), block_.size() - within));
    std::memcpy(into.data(), block_.data() + within, bytes);
    into = into.subspan(bytes);
    at += bytes;
  }
  return {};
}

}  // namespace qtet
