// The dates of HTTP (RFC 9110, 5.6.7).
#pragma once

#include <ctime>
#include <optional>
#include <string>
#include <string_view>

namespace qtet {

/// "Sun, 06 Nov 1994 08:49:37 GMT". REQUIRES: a year of four digits.
[[nodiscard]] std::string httpDate(std::time_t time);
/// The same of the present second, which a thread makes once. Valid until the thread's next call.
[[nodiscard]] const std::string& httpDateNow();
/// The form above, and the two that old clients send: "Sunday, 06-Nov-94 08:49:37 GMT" and "Sun Nov
///  6 08:49:37 1994". Anything else is no date.
[[nodiscard]] std::optional<std::time_t> parseHttpDate(std::string_view text);

}  // namespace qtet
