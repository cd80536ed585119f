// The header, lists and values in a file of OpenFOAM, as text or binary.
// "12{0}" is a list of one value for all. No bytes of the file bound how long it is, so the caller
// or the file's size does.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"
#include "simplify/read/options/read_options.h"
#include "simplify/read/process/reading_time.h"

namespace qtet {

/// A file of OpenFOAM in memory. Labels are at least -1 and below 2^32.
class FoamList {
 public:
  using Label = std::int64_t;

  /// Reads the file or, where it is not there, that with ".gz" behind its name. Errors: not-found
  /// (neither is there), io, bad-input (no header of OpenFOAM; no gzip), truncated. Every read has
  /// `patience` and what the size adds (ReadingTime), from now on; bad-input after it.
  [[nodiscard]] static Result<FoamList> open(const std::filesystem::path& path,
                                             std::chrono::seconds patience = kReadPatience);
  [[nodiscard]] static bool isThere(const std::filesystem::path& path);
  /// The class in the header of the file, which may be compressed; empty: the file does not begin
  /// with a header. Reads kMostHeaderBytes. Errors: bad-input (a header that does not end), those
  /// of beginningOf.
  [[nodiscard]] static Result<std::string> classOf(const std::filesystem::path& path);
  /// A banner and a header take about 1,000 bytes.
  static constexpr std::size_t kMostHeaderBytes = 1 << 14;

  /// float32 or float64: how wide the header says that numbers are.
  [[nodiscard]] const char* realType() const { return realBytes_ == 4 ? "float32" : "float64"; }
  /// The number of faces of a file `faces`, as it says itself. Moves no place.
  [[nodiscard]] Result<std::uint64_t> faceCount();
  /// All labels of a list. Errors: bad-input (fewer or more than it says; more than `mostUniform`
  /// of one value for all).
  [[nodiscard]] Result<std::vector<Label>> labels(std::uint64_t mostUniform);
  /// Gives the corners of each face to `take`, in order. All faces of one value for all together
  /// have at most as many corners as the file has bytes. Errors: those of labels, and of `take`.
  [[nodiscard]] Status faces(const std::function<Status(std::span<const Label>)>& take);
  /// The sum of the entries `nFaces` of a file `boundary`, which must have as many patches as it
  /// says.
  [[nodiscard]] Result<std::uint64_t> patchFaces();
  /// Gives the name and the labels of each zone of a file `cellZones` to `take`, in order. All
  /// zones of one value for all together have at most `mostUniform` labels. Errors: those of
  /// labels, and of `take`; bad-input (other zones than it says).
  [[nodiscard]] Status zones(
      std::uint64_t mostUniform,
      const std::function<Status(std::string_view, std::span<const Label>)>& take);
  /// A list of tuples of so many numbers. Errors: bad-input (another number of them than `count`,
  /// if it is given, or than the list says).
  [[nodiscard]] Result<std::vector<double>> tuples(std::uint32_t components,
                                                   std::optional<std::uint64_t> count);
  /// The value of the entry `key` of a field, which is uniform or a list, for `count` cells or
  /// points. nullopt: it is a macro ("$T", "#calc"), which is not read. Errors: as tuples';
  /// bad-input (there is no such entry).
  [[nodiscard]] Result<std::optional<std::vector<double>>> field(std::string_view key,
                                                                 std::uint32_t components,
                                                                 std::uint64_t count);

  [[nodiscard]] std::unexpected<Error> bad(const std::string& what) const;
  /// "FILE, line 12: WHAT".
  [[nodiscard]] std::unexpected<Error> badHere(const std::string& what) const;

 private:
  /// Readings between two looks at the clock: about a millisecond.
  static constexpr std::uint32_t kReadingsBetweenLooks = 1 << 14;

  FoamList(std::filesystem::path path, std::string text, std::chrono::seconds patience)
      : path_(std::move(path)), text_(std::move(text)), time_(patience, text_.size()) {}

  Status readHeader();
  /// Faces are two lists: where each begins, and all corners.
  [[nodiscard]] bool isCompact() const {
    return isBinary_ && class_.starts_with("faceCompactList");
  }
  /// The word in quotes, or its beginning.
  [[nodiscard]] static std::string shown(std::string_view word);
  [[nodiscard]] bool find(std::string_view key);
  Status readTuple(std::span<double> out);
  Status readReals(std::span<double> out, std::uint32_t components);
  [[nodiscard]] bool isLate() { return readings_++ % kReadingsBetweenLooks == 0 && time_.isOver(); }
  void skipBlanks();
  [[nodiscard]] bool take(char sign);
  [[nodiscard]] std::string_view word();
  [[nodiscard]] Result<Label> label();
  /// The labels of a zone, up to the end of its entries.
  [[nodiscard]] Result<std::vector<Label>> zoneLabels(std::uint64_t mostUniform);
  [[nodiscard]] Result<std::uint64_t> count(std::uint64_t bytesEach);
  [[nodiscard]] Result<std::vector<Label>> uniformLabels(Label count, std::uint64_t most);
  [[nodiscard]] Result<std::vector<Label>> binaryLabels(std::uint64_t count);
  [[nodiscard]] Status compactFaces(const std::function<Status(std::span<const Label>)>& take);

  std::filesystem::path path_;
  std::string text_;
  std::size_t at_ = 0;
  bool isBinary_ = false;
  std::size_t labelBytes_ = 4, realBytes_ = 8;
  std::string class_;
  std::uint32_t readings_ = 0;  ///< of labels and numbers as text; round 2^32
  ReadingTime time_;
};

}  // namespace qtet
