// The cards of Nastran's bulk data, from lines of three forms, with those of included files.
// MSC Nastran, "Quick Reference Guide", section 5: free field, small field and large field.
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

/// Gives the cards one by one: each a line with those that continue it. Comments are passed, and
/// INCLUDE is followed. Keeps its first error, after which there are no cards.
class BulkCards {
 public:
  /// Fields of a card that are kept, enough for an element of 20 nodes. Lists of loads go on for
  /// ever.
  static constexpr std::size_t kMaxFields = 32;
  /// A file of this depth of INCLUDE is read, a deeper one is refused.
  static constexpr std::size_t kMaxDepth = 16;

  BulkCards(const std::filesystem::path& path, std::chrono::seconds patience);

  /// Moves to the next card. False: there is none, or an error.
  bool next();
  /// In capitals, without the star of large fields.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// The data fields behind the name, from 0, without blanks; empty where there is none.
  [[nodiscard]] std::string_view field(std::size_t i) const {
    return i < fields_.size() ? std::string_view(fields_[i]) : std::string_view();
  }
  [[nodiscard]] std::size_t fields() const { return fields_.size(); }

  /// A field as an integer >= 0, or as a real number; an empty one is 0. An error where it is none.
  std::uint32_t id(std::size_t i, const char* what);
  double real(std::size_t i, const char* what);

  /// Records an error at the card's first line.
  void fail(ErrorCode code, const std::string& what);
  void fail(const std::string& what) { fail(ErrorCode::kBadInput, what); }
  [[nodiscard]] bool failed() const { return error_.has_value(); }
  [[nodiscard]] std::unexpected<Error> error() const { return std::unexpected(*error_); }

 private:
  void open(const std::filesystem::path& path);
  void skipToBulk();
  /// The present file's next line without comment and end of line; tabs are blanks.
  bool rawLine();
  /// The next line of bulk data into line_, from the innermost file that has one.
  bool nextLine();
  void include();
  void refuseParts();
  [[nodiscard]] bool continues() const;
  void startCard();
  void addFields();
  void addFree(std::size_t perLine);
  bool addOverfull();
  void addFixed(std::size_t width);

  std::filesystem::path root_;
  ReadingTime time_;
  std::vector<OpenText> files_;  ///< the innermost last
  std::set<std::filesystem::path> seen_;
  std::uint32_t untilLook_ = 1;
  bool ended_ = false, hasLine_ = false;
  std::string line_, name_;
  std::vector<std::string> fields_;
  std::string cardFile_;
  std::uint64_t cardLine_ = 0;
  std::optional<Error> error_;
};

}  // namespace qtet
