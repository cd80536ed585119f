// Which level the words of `qtet extract` mean.
#pragma once

#include <cstdint>
#include <vector>

#include "proto/error.h"
#include "simplify/log/opened_log.h"
#include "simplify/words/parsed_words.h"

namespace qtet {

/// `--level` is not a target: a level that does not exist is an error. REQUIRES: one of the options
/// that choose a level is given. Throws UsageError.
[[nodiscard]] Result<std::uint32_t> chosenLevel(const ParsedWords& parsed, const OpenedLog& log);

/// A level of a list's log for some of its times. Errors of fields hold at each of these.
[[nodiscard]] Result<std::uint32_t> levelOfSegment(const ParsedWords& parsed, const OpenedLog& log,
                                                   const std::vector<double>& times);

}  // namespace qtet
