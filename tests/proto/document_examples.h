// The examples of PROTOCOL.md, STREAM.md and SESSION.md: fenced blocks whose first line says what
// they hold, `json KIND` or `text transcript`, each judged by the parser of its kind.
#pragma once

#include <string>
#include <vector>

namespace qtet::test {

/// What is wrong with the document's examples, one text a fault, with its line: a block of no known
/// kind, a value that the kind's parser refuses or of which it leaves a member out, a kind without
/// an example.
[[nodiscard]] std::vector<std::string> faultsOfExamples(const std::string& document);

}  // namespace qtet::test
