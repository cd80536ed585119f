#include "simplify/words/did_you_mean.h"

#include <algorithm>
#include <tuple>
#include <vector>

namespace qtet {
namespace {

constexpr std::size_t kMostEdits = 2;
constexpr std::size_t kLongestWord = 64;  // no command and no option is longer

std::string inSmallLetters(std::string_view word) {
  std::string out(word);
  std::ranges::transform(out, out.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return out;
}

/// The least number of letters to insert, remove, replace or swap with the next (the "optimal
/// string alignment" distance).
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> rows(a.size() + 1,
                                             std::vector<std::size_t>(b.size() + 1, 0));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        rows[i][j] = i + j;
        continue;
      }
      rows[i][j] = std::min({rows[i - 1][j] + 1, rows[i][j - 1] + 1,
                             rows[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        rows[i][j] = std::min(rows[i][j], rows[i - 2][j - 2] + 1);
    }
  }
  return rows[a.size()][b.size()];
}

}  // namespace

std::string didYouMean(std::string_view word, std::span<const std::string> known,
                       std::string_view mark) {
  if (word.empty() || word.size() > kLongestWord) return "";
  const std::string meant = inSmallLetters(word);
  const std::size_t most = std::min(kMostEdits, meant.size() / 2);
  std::tuple<std::size_t, std::size_t, std::string> best{most + 1, 0, ""};
  for (const std::string& candidate : known) {
    const bool isPrefix = meant.size() > 1 && candidate.starts_with(meant);
    best = std::min(best,
                    {isPrefix ? 0 : editDistance(meant, candidate), candidate.size(), candidate});
  }
  const std::string& closest = std::get<std::string>(best);
  return closest.empty() ? "" : "; did you mean '" + std::string(mark) + closest + "'?";
}

}  // namespace qtet
