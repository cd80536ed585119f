// The numbers and lines of EnSight's files, as text or in either kind of binary.
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simplify/read/ensight/ensight_case.h"
#include "simplify/read/options/read_options.h"
#include "simplify/read/text/mesh_scanner.h"

namespace qtet {

/// How the files of a case hold numbers: integers and floats of four bytes, or text. Fortran puts
/// each record between its length and its length.
struct EnSightEncoding {
  enum Kind : std::uint8_t { kText, kC, kFortran } kind = kText;
  std::optional<std::endian> order;  ///< nullopt: not known yet
  bool isGold = false;               ///< else EnSight 6
};

/// Limits of reading.
struct EnSightBounds {
  std::chrono::seconds patience = kReadPatience;  ///< for each file (ReadingTime)
  /// Bytes that grids which few numbers describe, and variables, may have. Reading them takes off.
  std::uint64_t room = 0;
};

/// Looks at the first bytes of a geometry. Errors: io, not-found,
/// truncated (empty).
[[nodiscard]] Result<EnSightEncoding> encodingOf(const std::filesystem::path& file, bool isGold);

/// Reads files, or single steps of those that hold several between BEGIN TIME STEP and END TIME
/// STEP. It looks for them once.
class EnSightFiles {
 public:
  /// `patience` holds for each file.
  explicit EnSightFiles(std::chrono::seconds patience) : patience_(patience) {}

  /// The bytes of the file or of its step, without Fortran's lengths of records. Errors: io,
  /// not-found, truncated (empty; a record that goes beyond the end), bad-input (no such step).
  [[nodiscard]] Result<std::string> read(const EnSightPlace& place,
                                         const EnSightEncoding& encoding);

 private:
  struct Range {
    std::uint64_t begin = 0, end = 0;
  };
  Result<const std::vector<Range>*> stepsOf(const std::filesystem::path& file,
                                            const EnSightEncoding& encoding);

  std::chrono::seconds patience_;
  std::map<std::filesystem::path, std::vector<Range>> steps_;
};

/// The number in a line "part 12" of EnSight 6; 0: none.
[[nodiscard]] std::int64_t ensightPartNumber(std::string_view line);

/// Keeps its first error, as MeshScanner does, which names the byte (that of the step and without
/// Fortran's lengths of records) or the line.
class EnSightNumbers {
 public:
  /// REQUIRES: `bytes` outlive it.
  EnSightNumbers(std::string_view bytes, const std::filesystem::path& file,
                 const EnSightEncoding& encoding, std::chrono::seconds patience);

  /// The next line as it is: 80 bytes of a binary file.
  std::string_view line();
  /// The next line that is not empty; empty at the end.
  std::string_view keyword();
  /// Sets the order of bytes by the first one that has two readings: the smaller is meant.
  std::int64_t integer(const char* what);
  float real(const char* what);
  /// Passes so many numbers. REQUIRES: fits(count).
  void skipIntegers(std::uint64_t count);
  void skipReals(std::uint64_t count);
  /// An error if so many numbers cannot follow.
  bool fits(std::uint64_t count, const char* what) { return in_.fits(count, bytesEach(), what); }
  /// A count that the file has bytes for: an error if not, and 0.
  std::uint64_t count(const char* what);
  /// How many numbers may follow at most.
  [[nodiscard]] std::uint64_t room() const { return in_.remaining() / bytesEach(); }
  [[nodiscard]] bool atEnd();

  void fail(const std::string& what) { in_.fail(ErrorCode::kBadInput, what); }
  [[nodiscard]] bool failed() const { return in_.failed(); }
  [[nodiscard]] std::unexpected<Error> error() const { return in_.error(); }
  [[nodiscard]] const EnSightEncoding& encoding() const { return encoding_; }
  [[nodiscard]] bool isText() const { return encoding_.kind == EnSightEncoding::kText; }
  /// Sets the order of bytes of a geometry of EnSight 6, whose nodes come next: `numbersEach` for
  /// each, and then a part.
  void findOrder(std::uint64_t numbersEach);

 private:
  [[nodiscard]] std::uint64_t bytesEach() const { return isText() ? kMinTextBytes : 4; }
  std::uint32_t word(const char* what, bool isInteger);
  std::string_view digitsHere();
  void endLine();

  std::string_view bytes_;
  EnSightEncoding encoding_;
  MeshScanner in_;
  bool isWithinLine_ = false;  ///< numbers were read of the present line of text
};

}  // namespace qtet
