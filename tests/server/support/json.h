// JSON that a test reads: nlohmann's templates stay in one file, since every file that uses them
// takes seconds more to compile.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>

namespace qtet::test {

/// A value, kept as its text. Numbers beyond 2^53 are only compared exactly with ==.
class Json {
 public:
  /// null.
  Json() = default;
  /// Throws for text that is no JSON.
  [[nodiscard]] static Json parse(std::string_view text);
  /// The JSON string of that value.
  [[nodiscard]] static Json ofString(std::string_view value);

  /// The member; null where there is none, or where this is no object.
  [[nodiscard]] Json operator[](std::string_view key) const;
  [[nodiscard]] Json operator[](const char* key) const { return (*this)[std::string_view(key)]; }
  /// Throws where this is no array, or a shorter one.
  [[nodiscard]] Json operator[](std::size_t index) const;
  [[nodiscard]] Json operator[](int index) const {
    return (*this)[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] bool contains(std::string_view key) const { return !(*this)[key].isNull(); }
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] bool isNull() const { return text_ == "null"; }
  [[nodiscard]] bool isTrue() const { return text_ == "true"; }

  /// They throw where this is no string, and no number.
  [[nodiscard]] std::string string() const;
  [[nodiscard]] std::uint64_t count() const;
  [[nodiscard]] double number() const;

  bool operator==(const Json& other) const = default;
  bool operator==(std::string_view value) const { return *this == ofString(value); }
  bool operator==(const char* value) const { return *this == ofString(value); }
  bool operator==(const std::string& value) const { return *this == ofString(value); }
  template <std::integral T>
  bool operator==(T value) const {
    return text_ == std::to_string(value);
  }
  friend std::ostream& operator<<(std::ostream& out, const Json& json);

 private:
  explicit Json(std::string text) : text_(std::move(text)) {}

  std::string text_ = "null";  // without blanks, members in the alphabet's order
};

}  // namespace qtet::test
