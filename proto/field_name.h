// The name of a field. That of an instant of a series is NAME@TIME (codec/RECORDS.md, "Series").
// The text is split when the name is made, and nowhere else.
#pragma once

#include <compare>
#include <concepts>
#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

namespace qtet {

class FieldName;
/// Text, but no FieldName.
template <class T>
concept NameText = std::convertible_to<const T&, std::string_view> && !std::same_as<T, FieldName>;

/// The two parts of "T@0.5".
struct InstantName {
  std::string_view series;
  double time;
};

/// Converts from and to text, and compares as text does. A name that was moved from is good for
/// nothing but to be given another one.
class FieldName {
 public:
  FieldName() = default;
  FieldName(std::string text);  // NOLINT(google-explicit-constructor): text is a name
  FieldName(std::string_view text) : FieldName(std::string(text)) {}  // NOLINT(*-explicit-*)
  FieldName(const char* text) : FieldName(std::string(text)) {}       // NOLINT(*-explicit-*)

  [[nodiscard]] const std::string& text() const { return text_; }
  operator const std::string&() const { return text_; }  // NOLINT(google-explicit-constructor)
  operator std::string_view() const { return text_; }    // NOLINT(google-explicit-constructor)
  [[nodiscard]] bool empty() const { return text_.empty(); }
  [[nodiscard]] std::size_t size() const { return text_.size(); }
  [[nodiscard]] const char* c_str() const { return text_.c_str(); }  // NOLINT(*-naming): std

  /// Whether it ends in "@" and a finite number, and begins with something else.
  [[nodiscard]] bool isInstant() const { return seriesBytes_ > 0; }
  /// nullopt: no instant. The answer looks into this object.
  [[nodiscard]] std::optional<InstantName> instant() const& {
    return isInstant() ? std::optional(InstantName{withoutTime(), time_}) : std::nullopt;
  }
  std::optional<InstantName> instant() && = delete;
  /// "T" of "T@0.5", else the whole name. The answer looks into this object.
  [[nodiscard]] std::string_view withoutTime() const& {
    return std::string_view(text_).substr(0, isInstant() ? seriesBytes_ : text_.size());
  }
  std::string_view withoutTime() && = delete;

  /// NAME@TIME of this name.
  [[nodiscard]] FieldName at(const std::string& time) const { return text_ + "@" + time; }

  friend bool operator==(const FieldName& a, const FieldName& b) { return a.text_ == b.text_; }
  friend std::strong_ordering operator<=>(const FieldName& a, const FieldName& b) {
    return a.text_ <=> b.text_;
  }
  template <NameText Text>
  friend bool operator==(const FieldName& a, const Text& b) {
    return a.text_ == std::string_view(b);
  }
  template <NameText Text>
  friend std::strong_ordering operator<=>(const FieldName& a, const Text& b) {
    return std::string_view(a.text_) <=> std::string_view(b);
  }
  friend std::ostream& operator<<(std::ostream& out, const FieldName& name);
  friend std::string operator+(const FieldName& a, const std::string& b) { return a.text_ + b; }
  friend std::string operator+(const std::string& a, const FieldName& b) { return a + b.text_; }

 private:
  std::string text_;
  std::size_t seriesBytes_ = 0;  // 0: no instant
  double time_ = 0;
};

}  // namespace qtet
