// The integers that a chunk's value blocks hold, in both directions.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"

namespace qtet {

/// The integers of a value block: read one after the other by a decoder, collected by an encoder.
class Values {
 public:
  Values() = default;
  explicit Values(std::span<const std::int32_t> given) : given_(given) {}

  template <bool kEncoding>
  std::int32_t code(std::int64_t value) {
    if constexpr (kEncoding) {
      written_.push_back(static_cast<std::int32_t>(value));
      return static_cast<std::int32_t>(value);
    } else {
      if (next_ < given_.size()) return given_[next_++];
      bad_ = true;
      return 0;
    }
  }
  /// Codes a value as the difference to a prediction.
  template <bool kEncoding>
  std::int32_t code(std::int64_t predicted, std::int32_t truth) {
    const std::int64_t value = predicted + code<kEncoding>(truth - predicted);
    bad_ |= value < -kLargest || value > kLargest;
    return bad_ ? 0 : static_cast<std::int32_t>(value);
  }
  /// The same for a field with missing values. 0 means that the value is missing, and a difference
  /// that is not negative is coded as one more.
  template <bool kEncoding>
  std::int32_t codeOrMissing(std::int64_t predicted, std::int32_t truth) {
    if constexpr (kEncoding) {
      const std::int64_t difference = truth - predicted;
      code<true>(truth == kMissing ? 0 : difference < 0 ? difference : difference + 1);
      return truth;
    } else {
      const std::int32_t told = code<false>(0);
      if (told == 0) return kMissing;
      const std::int64_t value = predicted + (told < 0 ? told : told - 1);
      bad_ |= value < -kLargest || value > kLargest;
      return bad_ ? 0 : static_cast<std::int32_t>(value);
    }
  }
  /// One of the two above.
  template <bool kEncoding>
  std::int32_t codeField(bool hasMissing, std::int64_t predicted, std::int32_t truth) {
    return hasMissing ? codeOrMissing<kEncoding>(predicted, truth)
                      : code<kEncoding>(predicted, truth);
  }
  /// The value that is read next. REQUIRES: place <= the number of values.
  void seek(std::size_t place) {
    assert(place <= given_.size());
    next_ = place;
  }
  /// Marks the values as bad: a result is out of range.
  void spoil() { bad_ = true; }
  [[nodiscard]] bool bad() const { return bad_; }
  [[nodiscard]] bool atEnd() const { return next_ == given_.size(); }
  [[nodiscard]] std::vector<std::int32_t>& written() { return written_; }

 private:
  static constexpr std::int64_t kLargest = std::int64_t{1} << 30;

  std::span<const std::int32_t> given_;
  std::size_t next_ = 0;
  bool bad_ = false;
  std::vector<std::int32_t> written_;
};

}  // namespace qtet
