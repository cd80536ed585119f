// The numbers that a file gives to elements, and which cell has which.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "simplify/read/text/plain_numbers.h"

namespace qtet {

/// Different numbers, one a cell. Numbers ascend in most files, so only those behind the first one
/// that does not take a table.
class ElementNumbers {
 public:
  /// The next cell has this number. REQUIRES: no cell has it.
  void add(std::uint32_t number);
  /// The cell of that number.
  [[nodiscard]] std::optional<std::uint32_t> cellOf(std::uint32_t number) const;
  /// One a cell.
  [[nodiscard]] const std::vector<std::uint32_t>& all() const { return all_; }

 private:
  std::vector<std::uint32_t> all_;
  std::size_t ascending_ = 0;  ///< so many of them ascend, from the first
  NumberTable others_;         ///< the cells of the others
};

}  // namespace qtet
