// The words of a command line are not understood.
#pragma once

#include <stdexcept>

namespace qtet {

/// Words that are not understood; the message, one line, says which and what would be. The tool
/// adds a line that leads to the command's help.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace qtet
