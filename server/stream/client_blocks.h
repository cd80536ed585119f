// Which blocks a client has, or will have once what was sent has arrived: of the mesh and of the
// fields that it asked for.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "codec/log/log_index.h"

namespace qtet {

/// A column is structure, positions, then one a field asked for. Holds the index's address, which
/// must outlive it. Everything REQUIRES chunks of the log and columns below columns().
class ClientBlocks {
 public:
  /// Nothing yet. REQUIRES: fields ascending, distinct, below the log's fields.
  ClientBlocks(const LogIndex& index, std::vector<std::uint32_t> fields)
      : index_(&index), fields_(std::move(fields)), held_(index.chunks.size() * columns(), false) {
    assert(std::ranges::adjacent_find(fields_, std::greater_equal()) == fields_.end());
    assert(fields_.empty() || fields_.back() < index.fields.size());
  }

  [[nodiscard]] std::size_t columns() const { return kFirstFieldPart + fields_.size(); }
  [[nodiscard]] std::uint32_t partOf(std::size_t column) const {
    assert(column < columns());
    return column < kFirstFieldPart ? static_cast<std::uint32_t>(column)
                                    : kFirstFieldPart + fields_[column - kFirstFieldPart];
  }
  [[nodiscard]] const std::vector<std::uint32_t>& fields() const { return fields_; }

  [[nodiscard]] bool has(std::uint32_t chunk, std::size_t column) const {
    assert(chunk < index_->chunks.size() && column < columns());
    return held_[chunk * columns() + column];
  }

  void add(std::uint32_t chunk, std::size_t column) {
    assert(chunk < index_->chunks.size() && column < columns());
    held_[chunk * columns() + column] = true;
  }
  /// The first `chunks` chunks. REQUIRES: the log has as many.
  void addLeading(std::uint32_t chunks, std::size_t column) {
    for (std::uint32_t c = 0; c < chunks; ++c) add(c, column);
  }
  /// Parts first..first+count-1 of a chunk. REQUIRES: parts of columns.
  void addRun(std::uint32_t chunk, std::uint32_t first, std::uint32_t count) {
    [[maybe_unused]] std::uint32_t added = 0;
    for (std::size_t column = 0; column < columns(); ++column)
      if (partOf(column) >= first && partOf(column) < first + count) add(chunk, column), ++added;
    assert(added == count);
  }

 private:
  const LogIndex* index_;
  std::vector<std::uint32_t> fields_;
  std::vector<bool> held_;
};

}  // namespace qtet
