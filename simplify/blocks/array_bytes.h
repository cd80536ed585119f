// Arrays as bytes, for this machine alone: CRC-32C of what follows, then each array's length and
// elements.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

#include "proto/bytes.h"
#include "proto/crc32c.h"
#include "proto/error.h"

namespace qtet {

class ArrayWriter {
 public:
  template <class T>
  void put(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    putRaw(values.size());
    const std::size_t at = bytes_.size(), size = values.size() * sizeof(T);
    bytes_.resize(at + size);
    if (size > 0) std::memcpy(bytes_.data() + at, values.data(), size);
  }
  template <class T>
  void put(const std::vector<std::vector<T>>& lists) {
    putRaw(lists.size());
    for (const std::vector<T>& list : lists) put(list);
  }
  [[nodiscard]] Bytes take() {
    const std::uint32_t sum = crc32c(ByteView(bytes_).subspan(sizeof sum));
    std::memcpy(bytes_.data(), &sum, sizeof sum);
    return std::move(bytes_);
  }

 private:
  void putRaw(std::uint64_t n) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof n);
    std::memcpy(bytes_.data() + at, &n, sizeof n);
  }

  Bytes bytes_ = Bytes(sizeof(std::uint32_t));
};

/// Stays empty-handed once the bytes end early.
class ArrayReader {
 public:
  /// Errors: bad-checksum, truncated.
  [[nodiscard]] static Result<ArrayReader> of(ByteView bytes) {
    std::uint32_t sum = 0;
    if (bytes.size() < sizeof sum)
      return fail(ErrorCode::kTruncated, "a piece of the mesh ends early");
    std::memcpy(&sum, bytes.data(), sizeof sum);
    const ByteView content = bytes.subspan(sizeof sum);
    if (crc32c(content) != sum)
      return fail(ErrorCode::kBadChecksum, "a piece of the mesh is not what was written");
    return ArrayReader(content);
  }

  template <class T>
  void get(std::vector<T>& values) {
    const std::uint64_t count = size(sizeof(T));
    values.resize(count);
    if (count > 0) std::memcpy(values.data(), left_.data(), count * sizeof(T));
    left_ = left_.subspan(count * sizeof(T));
  }
  template <class T>
  void get(std::vector<std::vector<T>>& lists) {
    lists.resize(size(sizeof(std::uint64_t)));
    for (std::vector<T>& list : lists) get(list);
  }
  [[nodiscard]] bool isWhole() const { return isWhole_ && left_.empty(); }

 private:
  explicit ArrayReader(ByteView bytes) : left_(bytes) {}

  std::uint64_t size(std::size_t element) {
    std::uint64_t n = 0;
    if (isWhole_ && left_.size() >= sizeof n) {
      std::memcpy(&n, left_.data(), sizeof n);
      left_ = left_.subspan(sizeof n);
      if (n <= left_.size() / element) return n;
    }
    isWhole_ = false;
    left_ = {};
    return 0;
  }

  ByteView left_;
  bool isWhole_ = true;
};

}  // namespace qtet
