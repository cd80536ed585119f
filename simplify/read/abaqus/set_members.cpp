#include "simplify/read/abaqus/set_members.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "simplify/read/abaqus/abaqus_lines.h"

namespace qtet {
namespace {

constexpr std::uint32_t kCellsBetweenLooks = 1 << 14;

}  // namespace

std::vector<std::uint32_t> cellsByNumber(const AbaqusPart& part) {
  const std::vector<std::uint32_t>& numbers = part.numbers.all();
  std::vector<std::uint32_t> out(numbers.size());
  std::iota(out.begin(), out.end(), 0U);
  std::ranges::sort(out, {}, [&](std::uint32_t cell) { return numbers[cell]; });
  return out;
}

SetMembers::SetMembers(const AbaqusModel& model, const std::vector<AbaqusCopy>& copies,
                       std::size_t cells, ReadingTime time)
    : model_(model), copies_(copies), time_(time), copiesOf_(model.parts.size()), taken_(cells) {
  for (std::size_t c = 0; c < copies.size(); ++c) {
    copiesOf_[copies[c].part].push_back(c);
    if (copies[c].instance) instances_.emplace(abaqusName(copies[c].instance->name), c);
  }
  for (const AbaqusPart& part : model.parts) byNumber_.push_back(cellsByNumber(part));
}

void SetMembers::add(std::size_t part, std::string_view name, std::vector<std::uint32_t>& out) {
  ++call_;
  seen_.clear();
  for (const std::size_t copy : copiesOf_[part]) push(part, copy, name);
  if (copiesOf_[part].empty() && part == 0) push(part, kNone, name);
  while (!tasks_.empty() && look()) {
    const Task task = tasks_.back();
    tasks_.pop_back();
    for (const AbaqusSetPiece& piece : model_.parts[task.part].sets[task.set].pieces)
      addPiece(task, piece, out);
  }
  if (isOver_) out.clear();
}

void SetMembers::push(std::size_t part, std::size_t copy, std::string_view name) {
  const auto& numbers = model_.parts[part].setNumbers;
  const auto at = numbers.find(name);
  if (at == numbers.end()) {
    // a section of the assembly: "Part-1-1.Set-1"
    const std::size_t dot = name.find('.');
    const auto instance = instances_.find(name.substr(0, dot));
    if (part == 0 && dot != std::string_view::npos && instance != instances_.end())
      push(copies_[instance->second].part, instance->second, name.substr(dot + 1));
    return;
  }
  const Task task{part, copy, at->second};
  const auto place = std::ranges::lower_bound(seen_, task);
  if (place != seen_.end() && *place == task) return;
  seen_.insert(place, task);
  tasks_.push_back(task);
}

void SetMembers::addPiece(const Task& task, const AbaqusSetPiece& piece,
                          std::vector<std::uint32_t>& out) {
  std::size_t part = task.part, copy = task.copy;
  if (!piece.instance.empty()) {
    const auto at = instances_.find(piece.instance);
    if (at == instances_.end()) {
      // no instance: the set's name has a dot
      for (const std::string& name : piece.names) push(part, copy, piece.instance + "." + name);
      return;
    }
    copy = at->second;
    part = copies_[copy].part;
  }
  for (const std::string& name : piece.names) {
    if (!look()) return;
    push(part, copy, name);
  }
  if (copy == kNone) return;
  for (const NumberRange& range : piece.ranges) {
    if (!look()) return;
    addRange(copy, range, out);
  }
}

void SetMembers::addRange(std::size_t copy, const NumberRange& range,
                          std::vector<std::uint32_t>& out) {
  assert(copy < copies_.size() && range.step > 0);
  const AbaqusCopy& of = copies_[copy];
  const std::vector<std::uint32_t>& numbers = model_.parts[of.part].numbers.all();
  const std::vector<std::uint32_t>& cells = byNumber_[of.part];
  auto at = std::ranges::lower_bound(cells, range.first, {},
                                     [&](std::uint32_t cell) { return numbers[cell]; });
  for (; at != cells.end() && numbers[*at] <= range.last && look(); ++at) {
    const std::uint32_t cell = of.firstCell + *at;
    assert(cell < taken_.size());
    if ((numbers[*at] - range.first) % range.step != 0 || taken_[cell] == call_) continue;
    taken_[cell] = call_;
    out.push_back(cell);
  }
}

bool SetMembers::look() {
  if (--untilLook_ == 0) {
    untilLook_ = kCellsBetweenLooks;
    isOver_ = isOver_ || time_.isOver();
  }
  if (isOver_) tasks_.clear();
  return !isOver_;
}

}  // namespace qtet
