#include "simplify/commands/command_help.h"

#include <sstream>

namespace qtet {

OrderedJson helpOf(const Command& command) {
  std::ostringstream out, err;
  Console console{out, err};
  command.run({"--help-json"}, console);
  return OrderedJson::parse(out.str());
}

std::string firstClause(const std::string& text) {
  std::size_t end = text.size();
  for (const char* stop : {". ", "; ", "\n"}) end = std::min(end, text.find(stop));
  return text.substr(0, end);
}

}  // namespace qtet
