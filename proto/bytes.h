// Little-endian reading and writing of bytes. The reader keeps its first error, so decoders are
// straight lines with one check at the end.
#pragma once

#include <cassert>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "proto/error.h"

namespace qtet {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

/// The 32-bit integer in the four bytes from `p`, the lowest byte first.
[[nodiscard]] inline std::uint32_t loadLittle(const std::uint8_t* p) {
  return std::uint32_t{p[0]} | std::uint32_t{p[1]} << 8 | std::uint32_t{p[2]} << 16 |
         std::uint32_t{p[3]} << 24;
}

/// Reads integers from `view`; after the first failure every read gives 0 and `error()` stays what
/// it was. The bytes must outlive the reader. Offsets in errors count from `origin`, the view's own
/// place in a file.
class ByteReader {
 public:
  explicit ByteReader(ByteView view, std::uint64_t origin = 0) : view_(view), origin_(origin) {}

  template <class T>
  [[nodiscard]] T read() {
    static_assert(std::is_integral_v<T>);
    std::uint64_t value = 0;
    const ByteView bytes = take(sizeof(T));
    for (std::size_t i = 0; i < bytes.size(); ++i) value |= std::uint64_t{bytes[i]} << (8 * i);
    return static_cast<T>(value);
  }

  /// Seven bits a byte, the lowest first; the high bit says that more follow. The shortest form
  /// alone, so that a value has one.
  [[nodiscard]] std::uint32_t readVarint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      const auto byte = read<std::uint8_t>();
      value |= std::uint64_t{byte & 0x7Fu} << shift;
      if (byte & 0x80u) continue;
      if ((shift > 0 && byte == 0) || value > 0xFFFFFFFFu) break;
      return static_cast<std::uint32_t>(value);
    }
    fail(ErrorCode::kBadValue,
         "a varint is not the shortest one, or above 32 bits; fetch or build the log again");
    return 0;
  }

  /// The next `count` bytes, or an empty view and an error.
  ByteView take(std::uint64_t count) {
    if (failed_ || count > remaining()) {
      fail(ErrorCode::kTruncated, "the data ends inside a value; fetch or copy the file again");
      return {};
    }
    const ByteView out = view_.subspan(position_, static_cast<std::size_t>(count));
    position_ += static_cast<std::size_t>(count);
    return out;
  }

  void fail(ErrorCode code, const char* message) {
    if (failed_) return;
    failed_ = true;
    error_ = Error{code, message, origin_ + position_};
  }

  [[nodiscard]] bool failed() const { return failed_; }
  /// REQUIRES: failed().
  [[nodiscard]] const Error& error() const {
    assert(failed_);
    return error_;
  }
  [[nodiscard]] std::uint64_t remaining() const {
    assert(position_ <= view_.size());
    return view_.size() - position_;
  }
  [[nodiscard]] std::uint64_t offset() const { return origin_ + position_; }

 private:
  ByteView view_;
  std::uint64_t origin_;
  std::size_t position_ = 0;
  bool failed_ = false;
  Error error_;
};

/// Appends integers to a byte vector.
class ByteWriter {
 public:
  template <class T>
  void write(T value) {
    static_assert(std::is_integral_v<T>);
    const auto bits = static_cast<std::uint64_t>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bytes_.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
  }
  void writeVarint(std::uint32_t value) {
    for (; value >= 0x80u; value >>= 7) bytes_.push_back(static_cast<std::uint8_t>(value | 0x80u));
    bytes_.push_back(static_cast<std::uint8_t>(value));
  }
  void append(ByteView bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }

  [[nodiscard]] const Bytes& bytes() const { return bytes_; }
  [[nodiscard]] Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

}  // namespace qtet
