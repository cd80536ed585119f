#include "simplify/read/options/time_steps.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace qtet {

std::string timeText(double x) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x).ptr;
  return {text.data(), end};
}

Result<std::vector<std::size_t>> chosenSteps(const std::vector<double>& times,
                                             const std::string& asked,
                                             const std::filesystem::path& path,
                                             std::vector<std::string>& notes) {
  std::vector<std::size_t> all(times.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  if (asked == "all" || (times.size() <= 1 && (asked == "first" || asked == "last"))) return all;
  if (asked == "first") return std::vector<std::size_t>{0};
  if (asked == "last") {
    notes.push_back("of its " + std::to_string(times.size()) + " time steps the last is read, " +
                    timeText(times.back()) + "; `time` names another, or all");
    return std::vector<std::size_t>{times.size() - 1};
  }
  double wanted = 0;
  const auto parsed = std::from_chars(asked.data(), asked.data() + asked.size(), wanted);
  if (parsed.ec == std::errc{} && parsed.ptr == asked.data() + asked.size()) {
    for (const std::size_t i : all) {
      if (std::abs(times[i] - wanted) <= 1e-9 * std::max(std::abs(wanted), std::abs(times[i])))
        return std::vector<std::size_t>{i};
    }
  }
  if (times.empty())
    return fail(ErrorCode::kNotFound, path.string() + " has no time step " + asked +
                                          ", for it has no times; leave out `time`");
  constexpr std::size_t kShown = 12;
  std::string there;
  for (std::size_t i = 0; i < times.size() && i < kShown; ++i)
    there += (i ? ", " : "") + timeText(times[i]);
  return fail(ErrorCode::kNotFound, path.string() + " has no time step " + asked + "; it has " +
                                        there + (times.size() > kShown ? ", ..." : "") +
                                        "; give `time` one of them, first, last or all");
}

}  // namespace qtet
