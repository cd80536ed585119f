#include "server/http/http_conditions.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <limits>

namespace qtet {
namespace {

constexpr std::array<std::string_view, 7> kDays = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
constexpr std::array<std::string_view, 7> kLongDays = {"Sunday",   "Monday", "Tuesday", "Wednesday",
                                                       "Thursday", "Friday", "Saturday"};
constexpr std::array<std::string_view, 12> kMonths = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                      "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
constexpr std::size_t kDateCharacters = 29, kAscTimeCharacters = 24;

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

std::string httpDate(std::time_t time) {
  std::tm t{};
  ::gmtime_r(&time, &t);
  std::array<char, 64> out{};
  std::snprintf(out.data(), out.size(), "%s, %02d %s %04d %02d:%02d:%02d GMT",
                kDays[static_cast<std::size_t>(t.tm_wday)].data(), t.tm_mday,
                kMonths[static_cast<std::size_t>(t.tm_mon)].data(), t.tm_year + 1900, t.tm_hour,
                t.tm_min, t.tm_sec);
  return out.data();
}

namespace {

/// "Sunday, 06-Nov-94 08:49:37 GMT" as RFC 9110 writes it today; "" where it is of another form.
/// A year that lies more than 50 years ahead is one of the century before (5.6.7).
std::string ofRfc850(std::string_view text) {
  const std::size_t comma = text.find(',');
  constexpr std::string_view kRest = ", 06-Nov-94 08:49:37 GMT";
  if (comma == std::string_view::npos || text.size() - comma != kRest.size()) return "";
  if (std::ranges::find(kLongDays, text.substr(0, comma)) == kLongDays.end()) return "";
  const std::string_view rest = text.substr(comma);
  const auto year = parseDigits(rest.substr(9, 2));
  if (!year || rest[4] != '-' || rest[8] != '-') return "";
  using namespace std::chrono;
  const year_month_day today(floor<days>(system_clock::now()));
  const int now = static_cast<int>(today.year());
  int full = now - now % 100 + static_cast<int>(*year);
  if (full > now + 50) full -= 100;
  return std::string(text.substr(0, 3)) + std::string(rest.substr(0, 4)) + " " +
         std::string(rest.substr(5, 3)) + " " + std::to_string(full) + std::string(rest.substr(11));
}

/// The same for "Sun Nov  6 08:49:37 1994".
std::string ofAscTime(std::string_view text) {
  if (text.size() != kAscTimeCharacters || text[3] != ' ' || text[7] != ' ') return "";
  std::string day(text.substr(8, 2));
  if (day[0] == ' ') day[0] = '0';
  return std::string(text.substr(0, 3)) + ", " + day + " " + std::string(text.substr(4, 3)) +
         std::string(text.substr(19)) + std::string(text.substr(10, 9)) + " GMT";
}

/// The form that httpDate() writes, alone.
std::optional<std::time_t> parseImfDate(std::string_view text) {
  if (text.size() != kDateCharacters) return std::nullopt;
  const auto number = [&](std::size_t at, std::size_t digits) {
    return parseDigits(text.substr(at, digits));
  };
  const auto month = std::ranges::find(kMonths, text.substr(8, 3));
  const auto day = number(5, 2), year = number(12, 4), hour = number(17, 2), minute = number(20, 2),
             second = number(23, 2);
  if (month == kMonths.end() || !day || !year || !hour || !minute || !second) return std::nullopt;

  using namespace std::chrono;
  const year_month_day date(std::chrono::year(static_cast<int>(*year)),
                            std::chrono::month(static_cast<unsigned>(month - kMonths.begin() + 1)),
                            std::chrono::day(static_cast<unsigned>(*day)));
  if (!date.ok()) return std::nullopt;
  const auto time = sys_days(date) + hours(*hour) + minutes(*minute) + seconds(*second);
  const std::time_t out = system_clock::to_time_t(time);
  // Written back it must be what was read: that checks the separators, the day of the week and an
  // hour of 25.
  return httpDate(out) == text ? std::optional(out) : std::nullopt;
}

}  // namespace

std::optional<std::time_t> parseHttpDate(std::string_view text) {
  if (const auto time = parseImfDate(text)) return time;
  if (const auto time = parseImfDate(ofRfc850(text))) return time;
  return parseImfDate(ofAscTime(text));
}

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
