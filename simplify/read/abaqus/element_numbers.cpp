#include "simplify/read/abaqus/element_numbers.h"

#include <algorithm>
#include <cassert>
#include <span>

namespace qtet {

void ElementNumbers::add(std::uint32_t number) {
  assert(!cellOf(number));
  const auto cell = static_cast<std::uint32_t>(all_.size());
  if (ascending_ == all_.size() && (all_.empty() || all_.back() < number))
    ++ascending_;
  else
    others_.emplace(number, cell);
  all_.push_back(number);
}

std::optional<std::uint32_t> ElementNumbers::cellOf(std::uint32_t number) const {
  const auto ascending = std::span(all_).first(ascending_);
  // the common question: a new element's number
  if (!ascending.empty() && number <= ascending.back()) {
    const auto at = std::ranges::lower_bound(ascending, number);
    if (*at == number) return static_cast<std::uint32_t>(at - ascending.begin());
  }
  const auto at = others_.find(number);
  return at == others_.end() ? std::nullopt : std::optional(at->second);
}

}  // namespace qtet
