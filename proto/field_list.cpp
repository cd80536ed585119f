#include "proto/field_list.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "proto/field_key.h"

namespace qtet {
namespace {

/// Names that differ in their instant alone, or one name.
struct Item {
  std::string_view stem;
  std::string_view first, last;
  std::size_t count = 1;
};

std::string textOf(const Item& item) {
  std::string out(item.first);
  if (item.count == 1) return out;
  return out + " to " + std::string(item.last) + " (" + std::to_string(item.count) + " instants)";
}

}  // namespace

std::string fieldList(std::span<const std::string> names) {
  std::vector<Item> items;
  for (const std::string& name : names) {
    const auto stem = nameWithoutStep(name);
    const auto same = stem ? std::ranges::find(items, *stem, &Item::stem) : items.end();
    if (same == items.end())
      items.push_back({stem.value_or(std::string_view()), name, name});
    else
      same->last = name, ++same->count;
  }
  std::string out;
  for (std::size_t i = 0; i < std::min(items.size(), kMaxListedFields); ++i)
    out += (i == 0 ? "" : ", ") + textOf(items[i]);
  if (items.size() > kMaxListedFields)
    out += " and " + std::to_string(items.size() - kMaxListedFields) + " more";
  return out.empty() ? "none" : out;
}

}  // namespace qtet
