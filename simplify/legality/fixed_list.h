// A list with room for kMax from the start: it grows without asking for memory, and nothing is
// cleared that is written anyway.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <span>

namespace qtet {

/// T must need no constructor and no destructor.
template <class T, std::size_t kMax>
class FixedList {
 public:
  void clear() { size_ = 0; }
  /// REQUIRES: fewer than kMax so far.
  void add(const T& item) {
    assert(size_ < kMax);
    items_[size_++] = item;
  }
  /// The same without a branch. REQUIRES: fewer than kMax so far, even if `isWanted` is false.
  void addIf(bool isWanted, const T& item) {
    assert(size_ < kMax);
    items_[size_] = item;
    size_ += isWanted;
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// REQUIRES: i < size().
  [[nodiscard]] const T& operator[](std::size_t i) const {
    assert(i < size_);
    return items_[i];
  }
  [[nodiscard]] std::span<const T> all() const { return std::span(items_).first(size_); }

 private:
  std::array<T, kMax> items_;
  std::size_t size_ = 0;
};

}  // namespace qtet
