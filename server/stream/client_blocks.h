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
#include "server/stream/field_turns.h"

namespace qtet {

/// A column is structure, positions, then one a field asked for. Holds the index's address, which
/// must outlive it. Everything REQUIRES chunks of the log and columns below columns().
class ClientBlocks {
 public:
  /// Nothing yet. REQUIRES: fieldTurns's order, fields of the log.
  ClientBlocks(const LogIndex& index, FieldTurns turns) : index_(&index), turns_(std::move(turns)) {
    for (const std::vector<std::uint32_t>& turn : turns_)
      fields_.insert(fields_.end(), turn.begin(), turn.end());
    std::ranges::sort(fields_);
    held_.assign(index.chunks.size() * columns(), false);
    assert(std::ranges::adjacent_find(fields_, std::greater_equal()) == fields_.end());
    assert(fields_.empty() || fields_.back() < index.fields.size());
  }

  [[nodiscard]] std::size_t columns() const { return kFirstFieldPart + fields_.size(); }
  [[nodiscard]] std::uint32_t partOf(std::size_t column) const {
    assert(column < columns());
    return column < kFirstFieldPart ? static_cast<std::uint32_t>(column)
                                    : kFirstFieldPart + fields_[column - kFirstFieldPart];
  }
  /// Ascending.
  [[nodiscard]] const std::vector<std::uint32_t>& fields() const { return fields_; }
  [[nodiscard]] const FieldTurns& turns() const { return turns_; }
  /// Those of a turn, ascending. The first one begins with the mesh.
  [[nodiscard]] std::vector<std::size_t> columnsOf(std::size_t turn) const {
    assert(turn < turns_.size());
    std::vector<std::size_t> out;
    if (turn == 0) out = {kStructurePart, kPositionsPart};
    for (const std::uint32_t f : turns_[turn])
      out.push_back(kFirstFieldPart + static_cast<std::size_t>(
                                          std::ranges::lower_bound(fields_, f) - fields_.begin()));
    return out;
  }

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
    assert(chunks <= index_->chunks.size());
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
  FieldTurns turns_;
  std::vector<std::uint32_t> fields_;
  std::vector<bool> held_;
};

}  // namespace qtet
