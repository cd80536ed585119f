// A coder that decides for itself: to a decoder's templates it is a stream, and what it answers it
// writes down. So a test makes streams of any answers, also those that no encoder would give.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "codec/coding/range_coder.h"

namespace qtet::testing {

class AuthorCoder {
 public:
  static constexpr bool kEncoding = false;
  /// The answer to a question whose probability of 1 is known, in 1/65536.
  using Answer = std::function<int(std::uint32_t probability)>;
  /// A raw number of `bits` bits.
  using Raw = std::function<std::uint32_t(int bits)>;

  AuthorCoder(Answer answer, Raw raw) : answer_(std::move(answer)), raw_(std::move(raw)) {}

  int bit(int /*unknown*/, BitModel& model) {
    return written.bit(answer_(range::clamped(model)), model);
  }
  int likely(int /*unknown*/, std::uint32_t probability) {
    return written.likely(answer_(probability), probability);
  }
  std::uint32_t raw(std::uint32_t /*unknown*/, int bits) {
    return bits == 0 ? 0 : written.raw(raw_(bits), bits);
  }

  RangeEncoder written;

 private:
  Answer answer_;
  Raw raw_;
};

}  // namespace qtet::testing
