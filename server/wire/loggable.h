// Keeps secrets out of logs, wherever a client has put them.
#pragma once

#include <string>
#include <string_view>

#include "server/wire/tokens.h"

namespace qtet {

/// Written instead of a text that holds a secret.
inline constexpr std::string_view kWithheld = "withheld";

/// Whether a part of the text, as it stands or percent-decoded, is a token of the file or as long
/// as a ticket. Parts are separated by / ? & = ; , and spaces. `tokens` may be nullptr.
[[nodiscard]] bool holdsSecret(std::string_view text, const Tokens* tokens);

/// The target as a log may have it. A query that speaks of a ticket, a token or a password is cut
/// off. A target that holds a secret elsewhere is kWithheld.
[[nodiscard]] std::string loggableTarget(std::string_view target, const Tokens* tokens);

}  // namespace qtet
