// The lines of an Abaqus or CalculiX input file with those of the files that it includes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"
#include "simplify/read/process/reading_time.h"
#include "simplify/read/text/open_text.h"

namespace qtet {

/// Capital letters, without blanks and quotes: keywords and names are compared so.
[[nodiscard]] std::string abaqusName(std::string_view text);

/// A line "*KEYWORD, PARAMETER=VALUE, PARAMETER", with the lines that continue it.
struct AbaqusKeyword {
  struct Parameter {
    std::string name;   ///< by abaqusName
    std::string value;  ///< as it stands, without quotes
  };
  std::string name;  ///< by abaqusName
  std::vector<Parameter> parameters;

  /// nullptr: there is none.
  [[nodiscard]] const std::string* find(std::string_view parameter) const;
};

/// Gives keyword lines and data lines one by one. Comments and empty lines are passed; *INCLUDE is
/// followed. Keeps its first error, after which there are no lines. A file is held as long as its
/// lines are read.
class AbaqusLines {
 public:
  /// A file of this depth of *INCLUDE is read, a deeper one is refused.
  static constexpr std::size_t kMaxDepth = 16;
  static constexpr std::uint32_t kMaxFiles = 4096;
  /// Files that are included again have together at most this, and kMaxTimesAgain times the bytes
  /// of all files.
  static constexpr std::uint64_t kMaxBytesAgain = std::uint64_t{1} << 26;
  static constexpr std::uint64_t kMaxTimesAgain = 16;

  explicit AbaqusLines(const std::filesystem::path& path, std::chrono::seconds patience);

  /// Moves to the next line. False: there is none, or an error.
  bool next();
  /// Whether next() was false, or there is an error.
  [[nodiscard]] bool ended() const { return ended_ || failed(); }
  [[nodiscard]] bool isKeyword() const { return isKeyword_; }
  /// REQUIRES: isKeyword().
  [[nodiscard]] const AbaqusKeyword& keyword() const { return keyword_; }
  /// The parts of a data line between its commas, without blanks. A comma within quotes is none;
  /// quotes stay, for a number within them is a name. Empty parts at the end are left out.
  /// REQUIRES: not isKeyword().
  [[nodiscard]] const std::vector<std::string_view>& fields() const { return fields_; }
  /// Whether the data line ends with a comma.
  [[nodiscard]] bool goesOn() const { return goesOn_; }

  /// The next lines are those of the file `name`, beside the present one.
  void include(const std::string& name);
  /// The data line's field as an integer >= 0, or as a real number; an empty one is 0. An error
  /// where it is none.
  std::uint32_t id(std::size_t field, const char* what);
  double real(std::size_t field, const char* what);

  void fail(ErrorCode code, const std::string& what);
  void fail(const std::string& what) { fail(ErrorCode::kBadInput, what); }
  [[nodiscard]] bool failed() const { return error_.has_value(); }
  [[nodiscard]] std::unexpected<Error> error() const { return std::unexpected(*error_); }
  /// The size of all files up to here, each counted once.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  /// Began with the first file, and has time for all files.
  [[nodiscard]] const ReadingTime& time() const { return time_; }
  /// An error if no time is left. Ask it within loops that no line bounds.
  void look();

 private:
  bool open(const std::filesystem::path& path);
  /// The file's next line that is neither empty nor a comment.
  std::optional<std::string_view> lineOf(OpenText& file);
  /// The next line of the innermost file that has one; files without one are closed.
  std::optional<std::string_view> rawLine();
  void readKeyword(std::string_view line);
  void readFields(std::string_view line);
  void includeParameter();

  std::filesystem::path root_;
  ReadingTime time_;
  std::vector<OpenText> files_;  ///< the innermost last
  std::uint32_t opened_ = 0;
  std::set<std::filesystem::path> seen_;
  std::uint64_t bytes_ = 0, bytesAgain_ = 0;
  std::uint32_t untilLook_ = 1;
  bool ended_ = false, isKeyword_ = false, goesOn_ = false;
  AbaqusKeyword keyword_;
  std::vector<std::string_view> fields_;
  std::optional<Error> error_;
};

}  // namespace qtet
