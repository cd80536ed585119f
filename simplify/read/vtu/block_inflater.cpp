#include "simplify/read/vtu/block_inflater.h"

#include <libdeflate.h>
#include <lz4.h>
#include <lzma.h>

#include <algorithm>
#include <cassert>
#include <limits>

namespace qtet {
namespace {

/// zlib: 258 bytes by two bits. LZ4: a byte more of a length stands for 255 bytes.
constexpr std::uint64_t kMaxByZlib = 1032, kMaxByLz4 = 255;
/// Memory of LZMA's dictionary: the method's highest level takes 65 MiB.
constexpr std::uint64_t kLzmaBytes = std::uint64_t{128} << 20;
/// Bytes that LZMA inflates at once.
constexpr std::size_t kLzmaStep = std::size_t{1} << 16;

bool inflateLz4(std::span<const std::byte> block, std::span<std::byte> into) {
  constexpr std::size_t kMax = std::numeric_limits<int>::max();
  if (block.size() > kMax || into.size() > kMax) return false;
  const int got = LZ4_decompress_safe(
      reinterpret_cast<const char*>(block.data()), reinterpret_cast<char*>(into.data()),
      static_cast<int>(block.size()), static_cast<int>(into.size()));
  return got >= 0 && static_cast<std::size_t>(got) == into.size();
}

/// Step by step, so that the promise of a damaged file takes no memory.
bool inflateLzma(std::span<const std::byte> block, std::uint64_t bytes,
                 std::vector<std::byte>& into) {
  lzma_stream stream = LZMA_STREAM_INIT;
  const std::unique_ptr<lzma_stream, void (*)(lzma_stream*)> ended(&stream, lzma_end);
  if (lzma_stream_decoder(&stream, kLzmaBytes, 0) != LZMA_OK) return false;
  stream.next_in = reinterpret_cast<const std::uint8_t*>(block.data());
  stream.avail_in = block.size();
  into.clear();
  while (true) {
    assert(into.size() <= bytes);
    const std::size_t before = into.size();
    const auto step = static_cast<std::size_t>(std::min<std::uint64_t>(kLzmaStep, bytes - before));
    into.resize(before + step);
    stream.next_out = reinterpret_cast<std::uint8_t*>(into.data() + before);
    stream.avail_out = step;
    const lzma_ret code = lzma_code(&stream, LZMA_FINISH);
    into.resize(before + step - stream.avail_out);
    if (code == LZMA_STREAM_END) return into.size() == bytes;
    // no output, or no room for more
    if (code != LZMA_OK || (into.size() == before && step > 0) || step == 0) return false;
  }
}

}  // namespace

std::uint64_t maxInflated(VtuCompressor compressor, std::uint64_t compressedBytes) {
  constexpr std::uint64_t kAll = ~std::uint64_t{0};
  if (compressor == VtuCompressor::kNone) return compressedBytes;
  if (compressor == VtuCompressor::kLzma) return compressedBytes == 0 ? 0 : kAll;
  const std::uint64_t most = compressor == VtuCompressor::kZlib ? kMaxByZlib : kMaxByLz4;
  return compressedBytes > kAll / most ? kAll : compressedBytes * most;
}

struct BlockInflater::Methods {
  struct Free {
    void operator()(libdeflate_decompressor* freed) const { libdeflate_free_decompressor(freed); }
  };
  std::unique_ptr<libdeflate_decompressor, Free> zlib;
};

BlockInflater::BlockInflater(VtuCompressor compressor)
    : compressor_(compressor), methods_(std::make_unique<Methods>()) {
  if (compressor == VtuCompressor::kZlib) methods_->zlib.reset(libdeflate_alloc_decompressor());
}
BlockInflater::BlockInflater(BlockInflater&&) noexcept = default;
BlockInflater& BlockInflater::operator=(BlockInflater&&) noexcept = default;
BlockInflater::~BlockInflater() = default;

bool BlockInflater::inflate(std::span<const std::byte> block, std::uint64_t bytes,
                            std::vector<std::byte>& into) {
  assert(compressor_ != VtuCompressor::kNone);
  assert(bytes <= maxInflated(compressor_, block.size()));
  if (compressor_ == VtuCompressor::kLzma) return inflateLzma(block, bytes, into);
  into.resize(bytes);
  if (compressor_ == VtuCompressor::kLz4) return inflateLz4(block, into);
  return methods_->zlib &&
         libdeflate_zlib_decompress(methods_->zlib.get(), block.data(), block.size(), into.data(),
                                    into.size(), nullptr) == LIBDEFLATE_SUCCESS;
}

}  // namespace qtet
