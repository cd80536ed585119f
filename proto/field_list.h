// The fields that a message names when one is asked for that is not there.
#pragma once

#include <span>
#include <string>

namespace qtet {

/// Items of a list: more of them help nobody.
inline constexpr std::size_t kMaxListedFields = 30;

/// "p, T@0 to T@0.9 (10 instants)": the names in their order, each series once. Behind
/// kMaxListedFields items stands how many more there are. "none" without a name.
[[nodiscard]] std::string fieldList(std::span<const std::string> names);

}  // namespace qtet
