#include "server/wire/header_lines.h"

#include <algorithm>
#include <cassert>

namespace qtet {
namespace {

constexpr std::string_view kBetween = ": ", kEnd = "\r\n";
constexpr std::string_view kType = "Content-Type", kNoSniff = "X-Content-Type-Options";
/// Bytes of most heads, so that they are allocated once.
constexpr std::size_t kUsualHeadBytes = 512;

[[maybe_unused]] bool isClean(std::string_view text) {
  return std::ranges::none_of(text, [](char c) { return c == '\r' || c == '\n' || c == '\0'; });
}

}  // namespace

HeaderLines::HeaderLines(std::initializer_list<Line> lines) {
  text_.reserve(kUsualHeadBytes);
  for (const auto& [name, value] : lines) add(name, value);
}

void HeaderLines::add(std::string_view name, std::string_view value) {
  assert(!name.empty() && isClean(name) && isClean(value));
  text_.append(name).append(kBetween).append(value).append(kEnd);
}

std::size_t HeaderLines::begin(std::string_view name) const {
  for (std::size_t at = 0; at < text_.size(); at += size(at)) {
    const std::string_view line(text_.data() + at, text_.size() - at);
    if (line.starts_with(name) && line.substr(name.size()).starts_with(kBetween)) return at;
  }
  return std::string::npos;
}

std::size_t HeaderLines::size(std::size_t begin) const {
  return text_.find(kEnd, begin) + kEnd.size() - begin;
}

std::optional<std::string_view> HeaderLines::find(std::string_view name) const {
  const std::size_t at = begin(name);
  if (at == std::string::npos) return std::nullopt;
  const std::size_t before = name.size() + kBetween.size();
  return std::string_view(text_).substr(at + before, size(at) - before - kEnd.size());
}

void HeaderLines::set(std::string_view name, std::string_view value) {
  assert(isClean(value));
  const std::size_t at = begin(name);
  if (at == std::string::npos) return add(name, value);
  const std::size_t before = name.size() + kBetween.size();
  text_.replace(at + before, size(at) - before - kEnd.size(), value);
}

void HeaderLines::remove(std::string_view name) {
  const std::size_t at = begin(name);
  if (at != std::string::npos) text_.erase(at, size(at));
}

void addType(HeaderLines& headers, std::string_view type) {
  headers.add(kType, type);
  headers.add(kNoSniff, "nosniff");
}

void removeType(HeaderLines& headers) {
  headers.remove(kType);
  headers.remove(kNoSniff);
}

void addCommonHeaders(HeaderLines& headers) {
  headers.add("Access-Control-Allow-Origin", "*");
  headers.add("Access-Control-Expose-Headers", "*");
}

}  // namespace qtet
