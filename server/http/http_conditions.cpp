#include "server/http/http_conditions.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <string_view>

#include "server/wire/http_date.h"

namespace qtet {
namespace {

std::string_view trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Decimal digits alone; what does not fit becomes the largest number, which lies behind every
/// file's end.
std::optional<std::uint64_t> parseDigits(std::string_view text) {
  if (text.empty() || text.find_first_not_of("0123456789") != std::string_view::npos)
    return std::nullopt;
  std::uint64_t out = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), out);
  return result.ec == std::errc() ? out : std::numeric_limits<std::uint64_t>::max();
}

/// Whether a list of entity tags holds `etag`; `weak` compares as If-None-Match does, W/ or not.
bool listHolds(std::string_view list, std::string_view etag, bool weak) {
  if (trim(list) == "*") return true;
  while (!list.empty()) {
    const std::size_t comma = std::min(list.find(','), list.size());  // our own tags hold no comma
    std::string_view tag = trim(list.substr(0, comma));
    if (weak && tag.starts_with("W/")) tag.remove_prefix(2);
    // a star among others is none of the grammar's: read so that nothing is overwritten
    if (tag == etag || (weak && tag == "*")) return true;
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
  return false;
}

bool modifiedAfter(const Validators& resource, std::string_view date, bool whenNoDate) {
  const auto time = parseHttpDate(trim(date));
  return time ? resource.modified > *time : whenNoDate;
}

bool sameVersion(std::string_view ifRange, const Validators& resource) {
  const std::string_view value = trim(ifRange);
  return value == resource.etag || parseHttpDate(value) == resource.modified;
}

ByteRange cut(std::uint64_t first, std::uint64_t last, std::uint64_t bytes) {
  if (first >= bytes) return {ByteRange::Kind::kUnsatisfiable, 0, 0};
  return {ByteRange::Kind::kPart, first, std::min(last, bytes - 1) - first + 1};
}

ByteRange parseRange(std::string_view text, std::uint64_t bytes) {
  constexpr std::string_view kUnit = "bytes=";
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  text = trim(text);
  if (text.size() < kUnit.size() ||
      !std::ranges::equal(text.substr(0, kUnit.size()), kUnit, {}, lower))
    return {};
  const std::string_view spec = trim(text.substr(kUnit.size()));
  const std::size_t dash = spec.find('-');
  if (dash == std::string_view::npos) return {};

  const auto first = parseDigits(spec.substr(0, dash));
  const auto last = parseDigits(spec.substr(dash + 1));
  if (dash == 0) {  // the last so many bytes
    if (!last) return {};
    if (*last == 0 || bytes == 0) return {ByteRange::Kind::kUnsatisfiable, 0, 0};
    return cut(bytes - std::min(*last, bytes), bytes - 1, bytes);
  }
  const bool open = dash + 1 == spec.size();
  if (!first || (!open && (!last || *last < *first))) return {};
  return cut(*first, open ? std::numeric_limits<std::uint64_t>::max() : *last, bytes);
}

}  // namespace

Verdict evaluateConditions(const RequestView& request, const Validators& resource) {
  if (request.ifMatch) {
    const bool holds =
        listHolds(*request.ifMatch, resource.etag, false) ||
        (!resource.plainEtag.empty() && listHolds(*request.ifMatch, resource.plainEtag, false));
    if (!holds) return Verdict::kPreconditionFailed;
  } else if (request.ifUnmodifiedSince &&
             modifiedAfter(resource, *request.ifUnmodifiedSince, false)) {
    return Verdict::kPreconditionFailed;
  }
  if (request.ifNoneMatch)
    return listHolds(*request.ifNoneMatch, resource.etag, true) ? Verdict::kNotModified
                                                                : Verdict::kSend;
  if (request.ifModifiedSince && !modifiedAfter(resource, *request.ifModifiedSince, true))
    return Verdict::kNotModified;
  return Verdict::kSend;
}

ByteRange selectRange(const RequestView& request, const Validators& resource, std::uint64_t bytes) {
  if (!request.range || request.method != "GET") return {};
  if (request.ifRange && !sameVersion(*request.ifRange, resource)) return {};
  return parseRange(*request.range, bytes);
}

}  // namespace qtet
