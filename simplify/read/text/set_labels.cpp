#include "simplify/read/text/set_labels.h"

#include <algorithm>
#include <numeric>

#include "proto/limits.h"

namespace qtet {
namespace {

constexpr std::size_t kNamedInANote = 3;

/// `what`: says that sets are left out, and why.
void noteLeftOut(const std::string& what, const std::vector<std::string>& left,
                 std::vector<std::string>& notes) {
  if (left.empty()) return;
  std::string text;
  for (std::size_t i = 0; i < std::min(left.size(), kNamedInANote); ++i)
    text += (i == 0 ? "" : ", ") + left[i];
  if (left.size() > kNamedInANote)
    text += " and " + std::to_string(left.size() - kNamedInANote) + " more";
  notes.push_back(what + ": " + text);
}

}  // namespace

std::optional<MeshField> labelOfSets(const std::string& name, std::size_t cells,
                                     const CellSets& sets, std::vector<std::string>& notes) {
  std::vector<std::uint32_t> members;
  std::vector<std::size_t> sizes(sets.names.size()), order;
  for (std::size_t s = 0; s < sizes.size(); ++s) {
    members.clear();
    sets.cellsOf(s, members);
    sizes[s] = members.size();
    if (sizes[s] > 0 && sizes[s] < cells) order.push_back(s);
  }
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    return sizes[a] != sizes[b] ? sizes[a] > sizes[b] : a > b;
  });
  std::vector<std::uint32_t> values(cells);
  std::vector<std::size_t> kept;
  std::vector<std::string> overlapping, beyond;
  for (const std::size_t s : order) {
    members.clear();
    sets.cellsOf(s, members);
    if (std::ranges::any_of(members, [&](std::uint32_t cell) { return values[cell] != 0; })) {
      overlapping.push_back(sets.names[s]);
      continue;
    }
    if (kept.size() == kMaxLabelNames) {
      beyond.push_back(sets.names[s]);
      continue;
    }
    kept.push_back(s);
    for (const std::uint32_t cell : members) values[cell] = static_cast<std::uint32_t>(kept.size());
  }
  noteLeftOut("sets of cells that overlap with those in the label " + name + " are left out",
              overlapping, notes);
  noteLeftOut("sets of cells are left out, since the label " + name + " has names for only " +
                  std::to_string(kMaxLabelNames),
              beyond, notes);
  // numbered in the file's order
  std::vector<std::size_t> inFile = kept;
  std::ranges::sort(inFile);
  LabelNames names;
  std::vector<std::uint32_t> renamed(kept.size() + 1);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const auto at = std::ranges::lower_bound(inFile, kept[i]) - inFile.begin();
    renamed[i + 1] = static_cast<std::uint32_t>(at + 1);
    names.emplace(static_cast<std::int32_t>(at + 1), sets.names[kept[i]]);
  }
  for (std::uint32_t& value : values) value = renamed[value];
  return labelOf(name, values, std::move(names));
}

std::optional<MeshField> labelOf(const std::string& name, const std::vector<std::uint32_t>& values,
                                 LabelNames names) {
  if (std::ranges::adjacent_find(values, std::not_equal_to{}) == values.end()) return std::nullopt;
  while (names.size() > kMaxLabelNames) names.erase(std::prev(names.end()));
  MeshField field{name, 1, "int32", {}, "cell", std::move(names)};
  field.values.assign(values.begin(), values.end());
  return field;
}

}  // namespace qtet
