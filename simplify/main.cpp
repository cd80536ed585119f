// The `qtet` tool: see commands.h.
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <string_view>

#include "simplify/commands.h"

int main(int argc, char** argv) {
  const char *noColour = std::getenv("NO_COLOR"), *terminal = std::getenv("TERM");
  const bool plain = (noColour != nullptr && *noColour != '\0') || terminal == nullptr || std::string_view(terminal) == "dumb";
  qtet::Console console{std::cout, std::cerr, ::isatty(STDERR_FILENO) == 1, !plain && ::isatty(STDOUT_FILENO) == 1};
  try {
    return qtet::runTool(qtet::Words(argv + 1, argv + argc), console);
  } catch (const std::bad_alloc&) {
    std::cerr << "qtet: the mesh does not fit into memory; use a machine with more, or a part of the mesh\n";
  } catch (const std::exception& error) {
    std::cerr << "qtet: " << error.what() << "\n";
  }
  return qtet::kExitFailed;
}
