#include "simplify/read/options/time_steps.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <expected>
#include <limits>
#include <optional>
#include <string_view>

#include "proto/number_text.h"
#include "proto/series.h"

namespace qtet {
namespace {

struct StepRange {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
  std::size_t every = 1;
};

/// Whether all of the text is a number, or nothing, which leaves `out` as it is.
template <class Number>
bool readPart(std::string_view text, Number& out) {
  if (text.empty()) return true;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc{} && end == text.data() + text.size();
}

/// FROM:TO:EVERY or FROM:TO; each part may be left out.
std::optional<StepRange> stepRange(std::string_view text) {
  StepRange out;
  const std::size_t first = text.find(':'), second = text.find(':', first + 1);
  const std::size_t end = std::min(second, text.size());
  if (!readPart(text.substr(0, first), out.from) ||
      !readPart(text.substr(first + 1, end - first - 1), out.to) ||
      !readPart(text.substr(std::min(end + 1, text.size())), out.every) || out.every == 0 ||
      std::isnan(out.from) || std::isnan(out.to))
    return std::nullopt;
  return out;
}

/// The time that a range's end means; itself if there is none.
double endAmong(const std::vector<double>& times, double end) {
  const auto place = std::isfinite(end) ? placeOfTime(times, end) : std::nullopt;
  return place ? times[*place] : end;
}

/// The steps from one time to another, every so many of them.
std::vector<std::size_t> stepsOf(const StepRange& range, const std::vector<double>& times) {
  std::vector<std::size_t> out;
  const double from = endAmong(times, range.from), to = endAmong(times, range.to);
  std::size_t within = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (times[i] < from || times[i] > to) continue;
    if (within++ % range.every == 0) out.push_back(i);
  }
  return out;
}

/// The step of "~T", the time nearest to T and of two the earlier, with a note where it is another.
/// nullopt: it is no number. REQUIRES: one time at least.
std::optional<std::size_t> nearestStep(std::string_view text, const std::vector<double>& times,
                                       std::vector<std::string>& notes) {
  double wanted = 0;
  if (text.empty() || !readPart(text, wanted) || !std::isfinite(wanted)) return std::nullopt;
  if (const auto exact = placeOfTime(times, wanted)) return exact;
  const std::size_t step = nearestTime(times, wanted);
  notes.push_back("time " + shortestText(wanted) + " is none; the nearest, " +
                  shortestText(times[step]) + ", is taken, which is " +
                  shortestText(static_cast<float>(std::abs(times[step] - wanted))) +
                  (times[step] < wanted ? " earlier" : " later"));
  return step;
}

/// The steps of the times between commas, ascending, or the first text that is none's.
std::expected<std::vector<std::size_t>, std::string> stepsAt(const std::string& asked,
                                                             const std::vector<double>& times,
                                                             std::vector<std::string>& notes) {
  std::vector<std::size_t> out;
  for (std::size_t at = 0, end = 0; at <= asked.size(); at = end + 1) {
    end = std::min(asked.find(',', at), asked.size());
    const std::string text = asked.substr(at, end - at);
    double wanted = 0;
    const bool isNumber = !text.empty() && readPart(std::string_view(text), wanted);
    const auto step = text.starts_with('~') ? nearestStep(text.substr(1), times, notes)
                      : isNumber            ? placeOfTime(times, wanted)
                                            : std::nullopt;
    if (!step) return std::unexpected(text);
    out.push_back(*step);
  }
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

std::string timeWord(const std::string& asked) {
  std::string small = asked;
  std::ranges::transform(small, small.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return small == "first" || small == "last" || small == "all" ? small : asked;
}

Result<std::vector<std::size_t>> chosenSteps(const std::vector<double>& times,
                                             const std::string& given,
                                             const std::filesystem::path& path,
                                             std::vector<std::string>& notes) {
  const std::string asked = timeWord(given);
  std::vector<std::size_t> all(times.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  if (asked == "all" || (times.size() <= 1 && (asked == "first" || asked == "last"))) return all;
  if (asked == "first") return std::vector<std::size_t>{0};
  if (asked == "last") {
    notes.push_back("of its " + std::to_string(times.size()) + " time steps the last is read, " +
                    shortestText(times.back()) + "; `time` names another, or all");
    return std::vector<std::size_t>{times.size() - 1};
  }
  if (asked.contains(':')) {
    const auto range = stepRange(asked);
    if (!range)
      return fail(ErrorCode::kBadValue,
                  "`time` " + asked +
                      " is not FROM:TO:EVERY, two times and a number of steps from 1 on; each of "
                      "them may be left out");
    if (std::vector<std::size_t> steps = stepsOf(*range, times); !steps.empty()) return steps;
  }
  if (times.empty())
    return fail(ErrorCode::kNotFound, path.string() + " has no time step " + asked +
                                          ", for it has no times; leave out `time`");
  const auto steps = stepsAt(asked, times, notes);
  if (steps) return *steps;
  constexpr std::size_t kShown = 12;
  std::string there;
  for (std::size_t i = 0; i < times.size() && i < kShown; ++i)
    there += (i ? ", " : "") + shortestText(times[i]);
  return fail(ErrorCode::kNotFound,
              path.string() + " has no time step " + steps.error() + "; it has " + there +
                  (times.size() > kShown ? ", ..." : "") +
                  "; give `time` one of them, several between commas, FROM:TO:EVERY, first, last, "
                  "all, or ~T for the nearest to T");
}

}  // namespace qtet
