#include "server/wire/loggable.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

#include "server/wire/token_limits.h"

namespace qtet {
namespace {

constexpr std::string_view kSeparators = "/?&=;, ";
/// A token in base64 may hold separators itself, so runs of parts are tried: 16 parts have 136.
constexpr std::size_t kMaxParts = 16;
constexpr std::array<std::string_view, 6> kSecretWords = {"ticket", "token",    "auth",
                                                          "bearer", "password", "secret"};

bool isHex(char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; }

/// Longer than every digest, and as long as the server makes tickets.
bool holdsTicket(std::string_view text) {
  std::size_t run = 0;
  for (const char c : text)
    if (run = isHex(c) ? run + 1 : 0; run >= limits::kTicketCharacters) return true;
  return false;
}

/// Where parts begin; behind them, one past the text.
std::vector<std::size_t> beginningsIn(std::string_view text) {
  std::vector<std::size_t> out = {0};
  for (std::size_t i = 0; i < text.size(); ++i)
    if (kSeparators.contains(text[i])) out.push_back(i + 1);
  out.push_back(text.size() + 1);
  return out;
}

bool holdsToken(std::string_view text, const Tokens& tokens) {
  const std::vector<std::size_t> at = beginningsIn(text);
  if (at.size() > kMaxParts + 1) return true;  // nobody's honest request; not searched
  for (std::size_t first = 0; first + 1 < at.size(); ++first)
    for (std::size_t last = first + 1; last < at.size(); ++last) {
      const std::string_view part = text.substr(at[first], at[last] - 1 - at[first]);
      if (part.size() >= limits::kMinTokenCharacters && tokens.knows(secretDigest(part)))
        return true;
    }
  return false;
}

/// Percent codes that are broken stay as they are.
std::string decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && isHex(text[i + 1]) && isHex(text[i + 2])) {
      out += static_cast<char>(std::stoi(std::string(text.substr(i + 1, 2)), nullptr, 16));
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

bool speaksOfSecret(std::string query) {
  std::ranges::transform(query, query.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::ranges::any_of(
      kSecretWords, [&](std::string_view word) { return query.find(word) != std::string::npos; });
}

}  // namespace

bool holdsSecret(std::string_view text, const Tokens* tokens) {
  const std::string plain = decoded(text);
  if (holdsTicket(text) || holdsTicket(plain)) return true;
  return tokens != nullptr && (holdsToken(text, *tokens) || holdsToken(plain, *tokens));
}

std::string loggableTarget(std::string_view target, const Tokens* tokens) {
  const std::size_t query = std::min(target.find('?'), target.size());
  if (speaksOfSecret(decoded(target.substr(query)))) target = target.substr(0, query);
  return std::string(holdsSecret(target, tokens) ? kWithheld : target);
}

}  // namespace qtet
