// Bytes that are written once, wait, and are read once or more: the blocks of a log whose head is
// not known yet.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>

#include "proto/byte_sink.h"

namespace qtet {

class ByteSpool {
 public:
  virtual ~ByteSpool() = default;
  /// Errors: io. After one the spool is of no use.
  virtual Status append(ByteView bytes) = 0;
  [[nodiscard]] virtual std::uint64_t size() const = 0;
  /// Fills `into` with the bytes from `at` on. REQUIRES: they are there. Errors: io.
  [[nodiscard]] virtual Status read(std::uint64_t at, std::span<std::uint8_t> into) const = 0;
  /// All bytes, in order, in pieces. Errors: io, the sink's.
  [[nodiscard]] virtual Status writeTo(const ByteSink& sink) const = 0;
};

class MemorySpool final : public ByteSpool {
 public:
  Status append(ByteView bytes) override {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return {};
  }
  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }
  [[nodiscard]] Status read(std::uint64_t at, std::span<std::uint8_t> into) const override {
    assert(at <= bytes_.size() && into.size() <= bytes_.size() - at);
    std::ranges::copy(ByteView(bytes_).subspan(at, into.size()), into.begin());
    return {};
  }
  [[nodiscard]] Status writeTo(const ByteSink& sink) const override { return sink(bytes_); }

 private:
  Bytes bytes_;
};

}  // namespace qtet
