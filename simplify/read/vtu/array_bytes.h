// The bytes of a binary array of a .vtu file, wherever and however they are stored: raw or base64,
// in compressed blocks or not. Any range of them can be read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "simplify/read/vtu/block_inflater.h"
#include "simplify/read/vtu/vtu_document.h"

namespace qtet {

/// Bytes that stand in the file as they are, or as base64 without blanks.
struct StoredRun {
  std::uint64_t begin = 0, end = 0;  ///< in the file; what it holds may end earlier
  bool isBase64 = false;

  /// How many bytes it can hold at most.
  [[nodiscard]] std::uint64_t room() const {
    return isBase64 ? (end - begin) / 4 * 3 : end - begin;
  }
  /// Where `bytes` from its begin end in the file, if they are padded to whole characters.
  [[nodiscard]] std::uint64_t behind(std::uint64_t bytes) const {
    return begin + (isBase64 ? (bytes + 2) / 3 * 4 : bytes);
  }
  /// Bytes `at` and on. Errors: truncated, bad-input (a sign that is none of base64's), io.
  [[nodiscard]] Status read(const VtuFile& file, std::uint64_t at, std::span<std::byte> into) const;
};

class ArrayBytes {
 public:
  /// Reads the header in front. Errors: bad-input (an array of text; sizes that contradict each
  /// other or promise more than the bytes of the file can hold), truncated, io. `file` must
  /// outlive it.
  [[nodiscard]] static Result<ArrayBytes> open(const VtuFile& file, const VtuDocument& document,
                                               const VtuArray& array);

  /// How many there are, as the header says.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// A bound of size() that follows from what the file holds, for what is reserved at once. It is
  /// smaller than size() if the method of compression has no bound.
  [[nodiscard]] std::uint64_t certain() const;
  /// Bytes `at` and on. Errors: bad-input (a block that does not inflate to its size), truncated,
  /// io. REQUIRES: at + into.size() <= size().
  [[nodiscard]] Status read(std::uint64_t at, std::span<std::byte> into);

 private:
  ArrayBytes(const VtuFile& file, const VtuDocument& document, const VtuArray& array, StoredRun run)
      : file_(&file), document_(&document), array_(&array), run_(run) {}
  [[nodiscard]] std::unexpected<Error> bad(const std::string& what) const;
  [[nodiscard]] Result<std::vector<std::uint64_t>> words(std::uint64_t first,
                                                         std::uint64_t count) const;
  [[nodiscard]] Status openBlocks();
  [[nodiscard]] std::uint64_t bytesOfBlock(std::uint64_t block) const;
  [[nodiscard]] Status loadBlock(std::uint64_t block);

  const VtuFile* file_;
  const VtuDocument* document_;
  const VtuArray* array_;
  StoredRun run_;  ///< of the data, without the header where that stands apart
  std::uint64_t size_ = 0, headerBytes_ = 0;
  // of compressed data alone
  std::uint64_t blockBytes_ = 0, lastBytes_ = 0;
  std::vector<std::uint64_t> ends_;  ///< of each block's compressed bytes in the run
  std::optional<BlockInflater> inflater_;
  std::vector<std::byte> compressed_, block_;
  std::uint64_t loaded_ = ~std::uint64_t{0};  ///< which block `block_` is
};

}  // namespace qtet
