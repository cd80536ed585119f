// The lists of labels and faces in a file of OpenFOAM, as text or binary.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"

namespace qtet {

/// A file of a mesh of OpenFOAM in memory. Labels are at least -1 and below 2^32.
class FoamList {
 public:
  using Label = std::int64_t;

  /// Reads the file or, where it is not there, that with ".gz" behind its name. Errors: not-found
  /// (neither is there), io, bad-input (no header of OpenFOAM; no gzip), truncated.
  [[nodiscard]] static Result<FoamList> open(const std::filesystem::path& path);
  [[nodiscard]] static bool isThere(const std::filesystem::path& path);

  /// How many things the list has, as it says itself.
  [[nodiscard]] Result<std::uint64_t> size();
  /// All labels of a list. Errors: bad-input (fewer or more than it says).
  [[nodiscard]] Result<std::vector<Label>> labels();
  /// Gives the corners of each face to `take`, in order. Errors: those of labels, and of `take`.
  [[nodiscard]] Status faces(const std::function<Status(std::span<const Label>)>& take);
  /// The sum of the entries `nFaces` of a file `boundary`, which must have as many patches as it
  /// says.
  [[nodiscard]] Result<std::uint64_t> patchFaces();

  [[nodiscard]] std::unexpected<Error> bad(const std::string& what) const;
  /// "FILE, line 12: WHAT".
  [[nodiscard]] std::unexpected<Error> badHere(const std::string& what) const;

 private:
  FoamList(std::filesystem::path path, std::string text)
      : path_(std::move(path)), text_(std::move(text)) {}

  Status readHeader();
  void skipBlanks();
  [[nodiscard]] bool take(char sign);
  [[nodiscard]] std::string_view word();
  [[nodiscard]] Result<Label> label();
  [[nodiscard]] Result<std::uint64_t> count(std::uint64_t bytesEach);
  [[nodiscard]] Result<std::vector<Label>> binaryLabels(std::uint64_t count);
  [[nodiscard]] Status compactFaces(const std::function<Status(std::span<const Label>)>& take);

  std::filesystem::path path_;
  std::string text_;
  std::size_t at_ = 0;
  bool isBinary_ = false;
  bool isCompact_ = false;  ///< faces are two lists: where each begins, and all corners
  std::size_t labelBytes_ = 4;
};

}  // namespace qtet
