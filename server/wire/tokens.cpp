#include "server/wire/tokens.h"

#include <fnmatch.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "proto/checksum.h"
#include "server/wire/id_limits.h"
#include "server/wire/token_limits.h"

namespace qtet {
namespace {

constexpr std::string_view kDigestMark = "sha256:";
constexpr std::string_view kAnyone = "anyone";
constexpr std::string_view kNameMark = "name=";
constexpr std::size_t kShownDigest = 8;  ///< digits that tell the tokens of one file apart
constexpr std::string_view kScheme = "bearer ";

bool equalInConstantTime(const SecretDigest& a, const SecretDigest& b) {
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

bool isName(std::string_view text) {
  return !text.empty() && text.size() <= limits::kMaxTokenName &&
         std::ranges::all_of(text, [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.' || c == '@';
         });
}

/// A name that no mesh can have is matched by no pattern: fnmatch() takes a square of its length,
/// and clients send 16 KB.
bool matches(const std::string& pattern, const std::string& mesh) {
  return mesh.size() <= limits::kMaxIdBytes && ::fnmatch(pattern.c_str(), mesh.c_str(), 0) == 0;
}

}  // namespace

SecretDigest secretDigest(std::string_view secret) { return digestOf(secret); }

std::optional<SecretDigest> bearerDigest(std::optional<std::string_view> authorization) {
  const std::string_view token = tokenOf(authorization.value_or(""));
  return token.empty() ? std::nullopt : std::optional(secretDigest(token));
}

Result<Tokens> Tokens::load(const std::filesystem::path& path) {
  std::error_code ec;
  const auto size = std::filesystem::file_size(path, ec);
  std::ifstream in(path, std::ios::binary);
  if (ec || !in) return fail(ErrorCode::kIo, path.string() + ": the tokens cannot be read");
  if (size > limits::kMaxTokenFileBytes)
    return fail(
        ErrorCode::kLimitExceeded,
        path.string() + " has more than " + std::to_string(limits::kMaxTokenFileBytes) + " bytes");
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
    std::string scope, pattern, token, name, more;
    if (!(words >> scope) || scope.starts_with('#')) continue;
    words >> pattern >> token >> name;
    const auto wrong = [&](const std::string& what) {
      return fail(ErrorCode::kBadValue, "line " + std::to_string(number) + ": " + what);
    };
    if ((scope != "write" && scope != "read") || token.empty() || words >> more ||
        (!name.empty() && !name.starts_with(kNameMark)))
      return wrong(
          "a line is: read or write, a PATTERN of mesh names, a TOKEN or sha256:HEX, and perhaps "
          "name=NAME; or read PATTERN anyone");
    Rule rule{scope == "read" ? Scope::kRead : Scope::kWrite, pattern};
    if (!name.empty() && !isName(rule.name = name.substr(kNameMark.size())))
      return wrong("a token's name has 1 to " + std::to_string(limits::kMaxTokenName) +
                   " letters, digits and - _ . @");
    if (token.starts_with(kDigestMark)) {
      rule.digest = digestOfHex(std::string_view(token).substr(kDigestMark.size()));
      if (!rule.digest) return wrong("sha256: is followed by 64 hexadecimal digits in lower case");
    } else if (token == kAnyone) {
      if (rule.scope == Scope::kWrite) return wrong("anyone may read, but not write");
    } else {
      if (token.size() < limits::kMinTokenCharacters)
        return wrong("the token has fewer than " + std::to_string(limits::kMinTokenCharacters) +
                     " characters; 'openssl rand -base64 24' makes a good one");
      rule.digest = secretDigest(token);
    }
    out.guardReading_ |= rule.scope == Scope::kRead;
    out.rules_.push_back(std::move(rule));
  }
  // As a file is that was cut off while it was written; taken at its word it would open everything.
  if (out.rules_.empty())
    return fail(
        ErrorCode::kBadValue,
        "line 1: there is no line of a token; leave --tokens out where there is to be none");
  return out;
}

Tokens::Verdict Tokens::may(Scope scope, const std::optional<SecretDigest>& bearer,
                            const std::string& mesh) const {
  bool known = false, allowed = scope == Scope::kRead && !guardReading_;
  for (const Rule& rule : rules_) {
    const bool same = bearer && rule.digest && equalInConstantTime(*bearer, *rule.digest);
    const bool enough = scope == Scope::kRead || rule.scope == Scope::kWrite;
    known |= same;
    allowed |= (same || !rule.digest) && enough && matches(rule.pattern, mesh);
  }
  return allowed ? Verdict::kAllowed : known ? Verdict::kForbidden : Verdict::kUnknown;
}

std::string Tokens::nameOf(const std::optional<SecretDigest>& bearer) const {
  std::string out;
  if (!knows(bearer)) return out;
  for (const Rule& rule : rules_)
    if (out.empty() && rule.digest && equalInConstantTime(*bearer, *rule.digest)) out = rule.name;
  return out.empty() ? std::string(kDigestMark) + toHex(*bearer).substr(0, kShownDigest) : out;
}

bool Tokens::knows(const std::optional<SecretDigest>& bearer) const {
  bool known = false;
  for (const Rule& rule : rules_)
    known |= bearer && rule.digest && equalInConstantTime(*bearer, *rule.digest);
  return known;
}

}  // namespace qtet
