#include "proto/field_list.h"

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "proto/field_name.h"

namespace qtet {
namespace {

/// Names that differ in their instant alone, or one name.
struct Item {
  std::string_view first, last;  // by time
  double from = 0, to = 0;
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
  std::map<std::string, std::size_t, std::less<>> placeOf;
  for (const std::string& name : names) {
    const FieldName parts(name);
    const auto instant = parts.instant();
    if (!instant || placeOf.try_emplace(std::string(instant->series), items.size()).second) {
      const double time = instant ? instant->time : 0;
      items.push_back({name, name, time, time});
      continue;
    }
    const double time = instant->time;
    Item& item = items[placeOf.find(instant->series)->second];
    ++item.count;
    if (time < item.from) item.first = name, item.from = time;
    if (time > item.to) item.last = name, item.to = time;
  }
  std::string out;
  for (std::size_t i = 0; i < std::min(items.size(), kMaxListedFields); ++i)
    out += (i == 0 ? "" : ", ") + textOf(items[i]);
  if (items.size() > kMaxListedFields)
    out += " and " + std::to_string(items.size() - kMaxListedFields) + " more";
  return out.empty() ? "none" : out;
}

}  // namespace qtet
