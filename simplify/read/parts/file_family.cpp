#include "simplify/read/parts/file_family.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <limits>
#include <tuple>

namespace qtet {
namespace {

constexpr std::string_view kDigits = "0123456789";

}  // namespace

std::optional<NumberedName> numberedName(const std::filesystem::path& file) {
  const std::string name = file.filename().string(), stem = file.stem().string();
  const std::size_t last = stem.find_last_of(kDigits);
  if (last == std::string::npos) return std::nullopt;
  const std::size_t before = stem.find_last_not_of(kDigits, last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  NumberedName out{name.substr(0, first), name.substr(first, last + 1 - first),
                   name.substr(last + 1)};
  std::from_chars(out.digits.data(), out.digits.data() + out.digits.size(), out.number);
  return out;
}

void sortByNumber(std::vector<std::filesystem::path>& files) {
  const auto keyOf = [](const std::filesystem::path& file) {
    const auto name = numberedName(file);
    return std::tuple(name ? name->number : std::numeric_limits<double>::infinity(), file.string());
  };
  std::ranges::sort(files, {}, keyOf);
}

std::string familyOf(std::span<const std::filesystem::path> files) {
  assert(!files.empty());
  const std::string first = files.front().string();
  if (files.size() == 1) return first;
  std::size_t front = first.size(), back = first.size();
  for (const std::filesystem::path& file : files.subspan(1)) {
    const std::string other = file.string();
    const auto same = std::ranges::mismatch(first, other);
    front = std::min(front, static_cast<std::size_t>(same.in1 - first.begin()));
    const auto ending = std::mismatch(first.rbegin(), first.rend(), other.rbegin(), other.rend());
    back = std::min(back, static_cast<std::size_t>(ending.first - first.rbegin()));
  }
  const auto isDigit = [](char c) { return kDigits.contains(c); };
  while (front > 0 && isDigit(first[front - 1])) --front;
  back = std::min(back, first.size() - front);
  while (back > 0 && isDigit(first[first.size() - back])) --back;
  return first.substr(0, front) + "*" + first.substr(first.size() - back);
}

}  // namespace qtet
