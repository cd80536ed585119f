// Who may change which meshes: bearer tokens (RFC 6750) from a file.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"

namespace qtet {

/// A file of lines `write PATTERN TOKEN` or `write PATTERN sha256:HEX`, PATTERN a shell pattern of mesh names such as `lab-*`; blank
/// lines and those that begin with # are left out. Immutable.
class Tokens {
 public:
  /// Nobody may change anything.
  Tokens() = default;
  /// Errors: io, limit-exceeded, bad-value (with the line's number, never with its token).
  [[nodiscard]] static Result<Tokens> load(const std::filesystem::path& path);
  [[nodiscard]] static Result<Tokens> parse(std::string_view text);

  [[nodiscard]] bool empty() const { return rules_.empty(); }

  enum class Verdict : std::uint8_t {
    kAllowed,
    kUnknown,    ///< no token, or one that nobody has: 401
    kForbidden,  ///< a token for other meshes: 403
  };
  /// `authorization` is the header's value. Compares digests, all of them and every byte, so that its time tells nothing of a token.
  [[nodiscard]] Verdict mayWrite(std::optional<std::string_view> authorization, const std::string& mesh) const;

 private:
  using Digest = std::array<std::uint8_t, 32>;
  struct Rule {
    std::string pattern;
    Digest digest{};
  };
  std::vector<Rule> rules_;
};

}  // namespace qtet
