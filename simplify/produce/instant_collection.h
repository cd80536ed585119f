// The files of a ParaView collection, NAME.pvd: a .vtu for each instant, in a folder NAME.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proto/byte_sink.h"
#include "simplify/words/json_report.h"

namespace qtet {

/// Makes the folder with the first file. Unless finish() succeeds, nothing stays of it.
class InstantCollection {
 public:
  explicit InstantCollection(std::filesystem::path file) : file_(std::move(file)) {}
  InstantCollection(const InstantCollection&) = delete;
  InstantCollection& operator=(const InstantCollection&) = delete;
  ~InstantCollection();

  /// Writes NAME/NAME_0000.vtu and so on. Times ascend. Errors: io (also if there is a folder NAME
  /// at the first file).
  [[nodiscard]] Status add(std::optional<double> time, ByteView bytes);
  /// Writes NAME.pvd. Errors: writeFileAtomically's.
  [[nodiscard]] Status finish();
  /// Writes it with another text, for files that are no instants. Errors: the same.
  [[nodiscard]] Status finish(std::string_view text);

  /// The size of all files, with the collection itself when it is finished.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  /// The files so far, relative to the collection.
  [[nodiscard]] std::vector<std::string> names() const;
  /// [{time, file}]
  [[nodiscard]] OrderedJson filesJson() const;
  /// "3 instants in wake"
  [[nodiscard]] std::string sentence() const;

 private:
  [[nodiscard]] std::filesystem::path folder() const;

  std::filesystem::path file_;
  std::vector<std::pair<std::optional<double>, std::string>> written_;
  std::uint64_t bytes_ = 0;
  bool ownsFolder_ = false;  // it was made, and the collection is not finished
};

}  // namespace qtet
