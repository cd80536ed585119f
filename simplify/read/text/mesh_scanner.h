// Reads numbers and words of a mesh file that is in memory whole, as text or as bytes. Errors name
// the file and the line or byte.
#pragma once

#include <bit>
#include <charconv>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "proto/error.h"
#include "simplify/read/process/reading_time.h"

namespace qtet {

/// Bytes that a number takes at least as text, with the blank beside it.
inline constexpr std::uint64_t kMinTextBytes = 2;

/// Keeps its first error; after it every read gives 0 or an empty word, and no place moves. Bytes
/// are little-endian.
class MeshScanner {
 public:
  /// `comment`: the sign from which on a line says nothing; 0: none. The text must outlive the
  /// scanner.
  MeshScanner(std::string_view text, std::filesystem::path path, char comment = 0)
      : text_(text), path_(std::move(path)), comment_(comment) {}

  /// From now on the reader has `patience` and what the text's size adds (ReadingTime). Soon after
  /// it a read is an error.
  void giveUpAfter(std::chrono::seconds patience) { time_ = {patience, text_.size()}; }

  /// The next word between blanks; empty at the end.
  std::string_view word();
  /// The rest of this line, without blanks round it; then the place is at the next line.
  std::string_view line();
  [[nodiscard]] bool atEnd();
  /// All that follows, from the next word on. The place moves to that word alone.
  std::string_view rest();

  /// The next word as a number. `what` is what it should be: "a coordinate". A real number beyond
  /// what T holds is infinite or 0.
  template <class T>
  T number(const char* what) {
    const std::size_t before = place_;
    std::string_view text = word();
    if (text.starts_with('+')) text.remove_prefix(1);
    T value{};
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    if (!failed() && (text.empty() || read.ec == std::errc::invalid_argument ||
                      read.ptr != text.data() + text.size())) {
      refuse(before, text, what);
      return T{};
    }
    if (read.ec == std::errc::result_out_of_range) {
      if constexpr (std::floating_point<T>)
        value = static_cast<T>(beyondRange(text));
      else
        refuse(before, text, what);
    }
    return failed() ? T{} : value;
  }

  /// The value of a number that no double comes near: infinite or 0.
  [[nodiscard]] static double beyondRange(std::string_view number);

  /// The next sizeof(T) bytes.
  template <class T>
  T raw(const char* what) {
    T value{};
    if (--untilLook_ == 0) look();
    if (failed() || sizeof(T) > text_.size() - place_) {
      endsWithin(what);
      return T{};
    }
    std::memcpy(&value, text_.data() + place_, sizeof(T));
    place_ += sizeof(T);
    return value;
  }

  /// Whether `count` things of at least `bytesEach` can follow; an error if not. Ask it before
  /// anything is allocated or looped over.
  bool fits(std::uint64_t count, std::uint64_t bytesEach, const char* what);

  /// Ends a list of `count` things as text. If a number follows, it is an error, for then the file
  /// holds more of them than it announced.
  void endsList(std::uint64_t count, const char* what);

  /// Passes the rest of a line that bytes follow.
  void skipLine();
  void seek(std::uint64_t place);
  [[nodiscard]] std::uint64_t place() const { return place_; }
  [[nodiscard]] std::uint64_t remaining() const { return text_.size() - place_; }

  /// Records an error at the present place: "FILE, line N: WHAT", or the byte where `bytes_` are
  /// read.
  void fail(ErrorCode code, const std::string& what);
  void readsBytes(bool bytes) { bytes_ = bytes; }
  [[nodiscard]] bool failed() const { return error_.has_value(); }
  [[nodiscard]] std::unexpected<Error> error() const { return std::unexpected(*error_); }
  [[nodiscard]] Status status() const {
    return error_ ? Status(std::unexpected(*error_)) : Status{};
  }

 private:
  /// Reads between two looks at the clock: about a millisecond.
  static constexpr std::uint32_t kReadsBetweenLooks = 1 << 14;

  void look();
  void refuse(std::size_t place, std::string_view found, const char* what);
  void endsWithin(const char* what);
  void skipBlanks();

  std::string_view text_;
  std::filesystem::path path_;
  char comment_;
  bool bytes_ = false;
  std::uint32_t untilLook_ = 1;  ///< how many reads
  ReadingTime time_;
  std::size_t place_ = 0;
  std::optional<Error> error_;
};

/// The file's bytes, without a byte order mark of UTF-8. Errors: io; bad-input (UTF-16).
[[nodiscard]] Result<std::string> wholeFile(const std::filesystem::path& path);

}  // namespace qtet
