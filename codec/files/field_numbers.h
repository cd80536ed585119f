// The numbers of a field that is to be written.
#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace qtet {

/// Either held, or made whenever they are asked for. So a file of many fields takes the memory of
/// one.
class FieldNumbers {
 public:
  using Held = std::shared_ptr<const std::vector<double>>;

  FieldNumbers() : FieldNumbers(std::vector<double>()) {}
  // NOLINTNEXTLINE(google-explicit-constructor): they are the numbers
  FieldNumbers(std::vector<double> numbers)
      : size_(numbers.size()), held_(std::make_shared<std::vector<double>>(std::move(numbers))) {}
  FieldNumbers(std::initializer_list<double> numbers)
      : FieldNumbers(std::vector<double>(numbers)) {}
  /// `make` gives `size` numbers, the same each time, and outlives the object.
  FieldNumbers(std::size_t size, std::function<std::vector<double>()> make)
      : size_(size), make_(std::move(make)) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Writers ask once for each field, in the order of the fields.
  [[nodiscard]] Held get() const {
    return held_ ? held_ : std::make_shared<const std::vector<double>>(make_());
  }

 private:
  std::size_t size_;
  Held held_;
  std::function<std::vector<double>()> make_;
};

}  // namespace qtet
