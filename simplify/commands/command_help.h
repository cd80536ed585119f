// The help of every command as data: what manual pages and completions are made of.
#pragma once

#include "simplify/commands/commands.h"
#include "simplify/words/json_report.h"

namespace qtet {

/// {name, usage, text, examples, words: [...], options: [{name, letter, takesValue, parameter,
/// group, text}]}, as `qtet COMMAND --help-json` prints it.
[[nodiscard]] OrderedJson helpOf(const Command& command);

/// The beginning of a sentence, up to its first full stop, semicolon or line end: what a menu has
/// room for.
[[nodiscard]] std::string firstClause(const std::string& text);

}  // namespace qtet
