#include "server/tokens.h"

#include <fnmatch.h>

#include <fstream>
#include <sstream>

#include "proto/checksum.h"
#include "server/limits.h"

namespace qtet {
namespace {

/// Characters of a token that is given as it is: as many as 16 random bytes in base64, below which it could be guessed.
constexpr std::size_t kLeastTokenCharacters = 22;
constexpr std::string_view kDigestMark = "sha256:";
constexpr std::string_view kScheme = "bearer ";

std::array<std::uint8_t, 32> digestOf(std::string_view token) {
  Sha256 hash;
  hash.update({reinterpret_cast<const std::uint8_t*>(token.data()), token.size()});
  return hash.finish();
}

std::optional<std::array<std::uint8_t, 32>> digestOfHex(std::string_view hex) {
  std::array<std::uint8_t, 32> out{};
  if (hex.size() != 2 * out.size() || hex.find_first_not_of("0123456789abcdef") != std::string_view::npos) return std::nullopt;
  const auto nibble = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<std::uint8_t>(nibble(hex[2 * i]) * 16 + nibble(hex[2 * i + 1]));
  return out;
}

template <class A>
bool equalInConstantTime(const A& a, const A& b) {
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned>(a[i] ^ b[i]);
  return difference == 0;
}

std::string_view tokenOf(std::string_view authorization) {
  if (authorization.size() <= kScheme.size()) return {};
  for (std::size_t i = 0; i < kScheme.size(); ++i)
    if (std::tolower(static_cast<unsigned char>(authorization[i])) != kScheme[i]) return {};
  std::string_view out = authorization.substr(kScheme.size());
  while (out.starts_with(' ')) out.remove_prefix(1);
  return out;
}

}  // namespace

Result<Tokens> Tokens::load(const std::filesystem::path& path) {
  std::error_code ec;
  const auto size = std::filesystem::file_size(path, ec);
  std::ifstream in(path, std::ios::binary);
  if (ec || !in) return fail(ErrorCode::kIo, path.string() + ": the tokens cannot be read");
  if (size > limits::kMaxTokenFileBytes)
    return fail(ErrorCode::kLimitExceeded, path.string() + " has more than " + std::to_string(limits::kMaxTokenFileBytes) + " bytes");
  std::stringstream text;
  text << in.rdbuf();
  Result<Tokens> out = parse(text.str());
  if (!out) out.error().message = path.string() + ", " + out.error().message;
  return out;
}

Result<Tokens> Tokens::parse(std::string_view text) {
  Tokens out;
  std::istringstream lines{std::string(text)};
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    std::string scope, pattern, token, more;
    if (!(words >> scope) || scope.starts_with('#')) continue;
    words >> pattern >> token;
    const auto wrong = [&](const std::string& what) { return fail(ErrorCode::kBadValue, "line " + std::to_string(number) + ": " + what); };
    if (scope != "write" || token.empty() || words >> more) return wrong("a line is: write PATTERN TOKEN, or write PATTERN sha256:HEX");
    if (token.starts_with(kDigestMark)) {
      const auto digest = digestOfHex(std::string_view(token).substr(kDigestMark.size()));
      if (!digest) return wrong("sha256: is followed by 64 hexadecimal digits in lower case");
      out.rules_.push_back({pattern, *digest});
    } else {
      if (token.size() < kLeastTokenCharacters)
        return wrong("the token has fewer than " + std::to_string(kLeastTokenCharacters) + " characters; 'openssl rand -base64 24' makes a good one");
      out.rules_.push_back({pattern, digestOf(token)});
    }
  }
  return out;
}

Tokens::Verdict Tokens::mayWrite(std::optional<std::string_view> authorization, const std::string& mesh) const {
  const std::string_view token = tokenOf(authorization.value_or(""));
  if (token.empty()) return Verdict::kUnknown;
  const Digest digest = digestOf(token);
  bool known = false, allowed = false;
  for (const Rule& rule : rules_) {
    const bool same = equalInConstantTime(digest, rule.digest);
    const bool matches = ::fnmatch(rule.pattern.c_str(), mesh.c_str(), 0) == 0;
    known |= same;
    allowed |= same && matches;
  }
  return allowed ? Verdict::kAllowed : known ? Verdict::kForbidden : Verdict::kUnknown;
}

}  // namespace qtet
