#include "server/wire/http_date.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>

namespace qtet {
namespace {

constexpr std::array<std::string_view, 7> kDays = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
constexpr std::array<std::string_view, 7> kLongDays = {"Sunday",   "Monday", "Tuesday", "Wednesday",
                                                       "Thursday", "Friday", "Saturday"};
constexpr std::array<std::string_view, 12> kMonths = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                      "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
constexpr std::size_t kDateCharacters = 29, kAscTimeCharacters = 24;

/// Decimal digits alone.
std::optional<int> parseDigits(std::string_view text) {
  int out = 0;
  const bool digits =
      !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), out);
  return digits && result.ec == std::errc() ? std::optional(out) : std::nullopt;
}

void putDigits(char* at, unsigned value, std::size_t count) {
  for (; count-- > 0; value /= 10) at[count] = static_cast<char>('0' + value % 10);
}

}  // namespace

std::string httpDate(std::time_t time) {
  using namespace std::chrono;
  const sys_seconds at{seconds(time)};
  const sys_days day = floor<days>(at);
  const year_month_day date(day);
  const hh_mm_ss clock(at - day);
  std::string out = "Sun, 06 Nov 1994 08:49:37 GMT";
  kDays[weekday(day).c_encoding()].copy(out.data(), 3);
  putDigits(&out[5], static_cast<unsigned>(date.day()), 2);
  kMonths[static_cast<unsigned>(date.month()) - 1].copy(&out[8], 3);
  putDigits(&out[12], static_cast<unsigned>(static_cast<int>(date.year())), 4);
  putDigits(&out[17], static_cast<unsigned>(clock.hours().count()), 2);
  putDigits(&out[20], static_cast<unsigned>(clock.minutes().count()), 2);
  putDigits(&out[23], static_cast<unsigned>(clock.seconds().count()), 2);
  return out;
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
  int full = now - now % 100 + *year;
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
  const year_month_day date(std::chrono::year(*year),
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

const std::string& httpDateNow() {
  thread_local std::time_t second = -1;
  thread_local std::string text;
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  if (now != second) text = httpDate(second = now);
  return text;
}

}  // namespace qtet
