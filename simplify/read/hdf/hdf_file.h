// A file of HDF5: its groups, attributes and arrays of numbers, with errors as values.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "proto/error.h"

namespace qtet {

/// An array of a file. A row is one number, or all numbers with the same first index.
struct HdfArray {
  std::string name;  ///< its path in the file
  std::uint64_t rows = 0;
  std::uint64_t columns = 1;  ///< numbers a row
  std::string type;           ///< as MeshField's; empty: it holds no numbers
};

class HdfFile {
 public:
  /// Errors: bad-input (no file of HDF5, or a damaged one).
  [[nodiscard]] static Result<HdfFile> open(const std::filesystem::path& path);
  HdfFile(HdfFile&& other) noexcept;
  HdfFile& operator=(HdfFile&&) = delete;
  ~HdfFile();

  [[nodiscard]] std::unexpected<Error> bad(const std::string& what) const;
  [[nodiscard]] bool has(const std::string& name) const;
  /// The names of a group's arrays, sorted; none if there is no such group.
  [[nodiscard]] std::vector<std::string> arraysIn(const std::string& group) const;
  /// An attribute of a group; nullopt if it is not there or is no text.
  [[nodiscard]] std::optional<std::string> textOf(const std::string& group,
                                                  const char* attribute) const;

  /// Errors: bad-input (no such array; its bytes cannot hold its numbers).
  [[nodiscard]] Result<HdfArray> array(const std::string& name) const;
  /// The numbers of `count` rows from `first` on. Floats keep every bit of a NaN. Errors: bad-input
  /// (the array has fewer rows or holds no numbers; its bytes do not inflate). Throws
  /// std::bad_alloc and std::length_error.
  [[nodiscard]] Result<std::vector<double>> reals(const HdfArray& array, std::uint64_t first,
                                                  std::uint64_t count) const;
  [[nodiscard]] Result<std::vector<std::int64_t>> integers(const HdfArray& array,
                                                           std::uint64_t first,
                                                           std::uint64_t count) const;
  /// All numbers of an array by its name.
  [[nodiscard]] Result<std::vector<std::int64_t>> allIntegers(const std::string& name) const;
  [[nodiscard]] Result<std::vector<double>> allReals(const std::string& name) const;

 private:
  HdfFile(std::filesystem::path path, std::int64_t id) : path_(std::move(path)), id_(id) {}

  template <class T>
  Status read(const HdfArray& array, std::uint64_t first, std::uint64_t count, std::int64_t type,
              std::vector<T>& out) const;

  std::filesystem::path path_;
  std::int64_t id_;  ///< HDF5's number of the file; negative: moved away
};

}  // namespace qtet
