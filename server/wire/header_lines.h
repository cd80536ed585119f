// The lines of an answer's head as one text, ready to be sent.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace qtet {

/// Names are compared as they are spelled. REQUIRES: no control characters in names and values.
class HeaderLines {
 public:
  using Line = std::pair<std::string_view, std::string_view>;

  HeaderLines() = default;
  HeaderLines(std::initializer_list<Line> lines);

  void add(std::string_view name, std::string_view value);
  void add(const HeaderLines& lines) { text_ += lines.text_; }
  /// The value of the first line of that name.
  [[nodiscard]] std::optional<std::string_view> find(std::string_view name) const;
  /// Gives the first line of that name another value, or adds one.
  void set(std::string_view name, std::string_view value);
  /// Removes the first line of that name, if there is one.
  void remove(std::string_view name);

  /// "NAME: VALUE\r\n" for each.
  [[nodiscard]] const std::string& text() const { return text_; }

  bool operator==(const HeaderLines&) const = default;

 private:
  /// Where the first line of that name begins; npos: nowhere.
  [[nodiscard]] std::size_t begin(std::string_view name) const;
  /// Bytes of the line that begins there.
  [[nodiscard]] std::size_t size(std::size_t begin) const;

  std::string text_;
};

/// Adds the type of a body, which browsers are not to guess.
void addType(HeaderLines& headers, std::string_view type);
/// For an answer that has no body after all.
void removeType(HeaderLines& headers);

/// Adds what every answer carries. There are no cookies, and what needs no token is public, so any
/// page may read an answer with all of its headers. These lines stand without an `Origin`, too: a
/// cache gives the answer to other pages.
void addCommonHeaders(HeaderLines& headers);

}  // namespace qtet
