// The examples of PROTOCOL.md, STREAM.md and SESSION.md: fenced blocks whose first line says what
// they hold. `json KIND` or `text transcript`: each is judged by its kind's parser.
#pragma once

#include <string>
#include <vector>

namespace qtet::test {

/// The faults of the document's examples, one text each, with its line. A fault is a block of
/// unknown kind, or a kind without an example. So is a value that the kind's parser refuses or does
/// not read in full.
[[nodiscard]] std::vector<std::string> faultsOfExamples(const std::string& document);

}  // namespace qtet::test
