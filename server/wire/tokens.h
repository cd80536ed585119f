// Who may read and who may change which meshes: bearer tokens (RFC 6750) from a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"
#include "server/wire/digest.h"

namespace qtet {

/// SHA-256 of a secret: what is kept and compared instead of it.
using SecretDigest = Digest;

[[nodiscard]] SecretDigest secretDigest(std::string_view secret);
/// That of the token in the value of an Authorization header; nullopt: there is none.
[[nodiscard]] std::optional<SecretDigest> bearerDigest(
    std::optional<std::string_view> authorization);

/// A file of lines `SCOPE PATTERN TOKEN` or `SCOPE PATTERN sha256:HEX`, with `name=NAME` behind it
/// if the token has a name in logs. SCOPE is read or write
/// (which reads, too). PATTERN is a shell pattern of mesh names such as `lab-*`. `read PATTERN
/// anyone` needs no token. Blank lines and those that begin with # are left out; at least one other
/// is there. Without a line that begins with read everybody may read everything. Immutable.
class Tokens {
 public:
  /// Nobody may change anything, everybody may read.
  Tokens() = default;
  /// Errors: io, limit-exceeded, bad-value (with the line's number, never with its token).
  [[nodiscard]] static Result<Tokens> load(const std::filesystem::path& path);
  [[nodiscard]] static Result<Tokens> parse(std::string_view text);

  enum class Scope : std::uint8_t { kRead, kWrite };
  enum class Verdict : std::uint8_t {
    kAllowed,
    kUnknown,    ///< no token, or one that nobody has: 401
    kForbidden,  ///< a token for other meshes, or for less: 403
  };
  /// Whether reading needs a token.
  [[nodiscard]] bool guardReading() const { return guardReading_; }
  /// Compares digests, all of them and every byte, so that its time reveals nothing about a token.
  [[nodiscard]] Verdict may(Scope scope, const std::optional<SecretDigest>& bearer,
                            const std::string& mesh) const;
  [[nodiscard]] bool knows(const std::optional<SecretDigest>& bearer) const;
  /// The first name that the file gives to the token; without one, `sha256:` and eight digits of
  /// its digest. "" if nobody has it.
  [[nodiscard]] std::string nameOf(const std::optional<SecretDigest>& bearer) const;

 private:
  struct Rule {
    Scope scope = Scope::kRead;
    std::string pattern;
    std::optional<SecretDigest> digest{};  ///< nullopt: anyone
    std::string name{};                    ///< "": none
  };
  std::vector<Rule> rules_;
  bool guardReading_ = false;
};

}  // namespace qtet
