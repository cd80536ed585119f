// The lists of labels and faces in a file of OpenFOAM, as text or binary.
// "12{0}" is a list of one value for all. No bytes of the file bound how long it is, so the caller
// or the file's size does.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"
#include "simplify/read/options/read_options.h"
#include "simplify/read/process/reading_time.h"

namespace qtet {

/// A file of a mesh of OpenFOAM in memory. Labels are at least -1 and below 2^32.
class FoamList {
 public:
  using Label = std::int64_t;

  /// Reads the file or, where it is not there, that with ".gz" behind its name. Errors: not-found
  /// (neither is there), io, bad-input (no header of OpenFOAM; no gzip), truncated. Every read has
  /// `patience` and what the size adds (ReadingTime), from now on; bad-input after it.
  [[nodiscard]] static Result<FoamList> open(const std::filesystem::path& path,
                                             std::chrono::seconds patience = kReadPatience);
  [[nodiscard]] static bool isThere(const std::filesystem::path& path);

  /// How many things the list has, as it says itself. Moves no place.
  [[nodiscard]] Result<std::uint64_t> size();
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

  [[nodiscard]] std::unexpected<Error> bad(const std::string& what) const;
  /// "FILE, line 12: WHAT".
  [[nodiscard]] std::unexpected<Error> badHere(const std::string& what) const;

 private:
  FoamList(std::filesystem::path path, std::string text, std::chrono::seconds patience)
      : path_(std::move(path)), text_(std::move(text)), time_(patience, text_.size()) {}

  Status readHeader();
  void skipBlanks();
  [[nodiscard]] bool take(char sign);
  [[nodiscard]] std::string_view word();
  [[nodiscard]] Result<Label> label();
  [[nodiscard]] Result<std::uint64_t> count(std::uint64_t bytesEach);
  [[nodiscard]] Result<std::vector<Label>> uniformLabels(Label count, std::uint64_t most);
  [[nodiscard]] Result<std::vector<Label>> binaryLabels(std::uint64_t count);
  [[nodiscard]] Status compactFaces(const std::function<Status(std::span<const Label>)>& take);

  std::filesystem::path path_;
  std::string text_;
  std::size_t at_ = 0;
  bool isBinary_ = false;
  bool isCompact_ = false;  ///< faces are two lists: where each begins, and all corners
  std::size_t labelBytes_ = 4;
  std::uint32_t labelsRead_ = 0;  ///< round 2^32
  ReadingTime time_;
};

}  // namespace qtet
