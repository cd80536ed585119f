// The `qtet` tool: see commands.h.
#include <unistd.h>

#include <exception>
#include <iostream>
#include <new>

#include "simplify/commands.h"

int main(int argc, char** argv) {
  qtet::Console console{std::cout, std::cerr, ::isatty(STDERR_FILENO) == 1};
  try {
    return qtet::runTool(qtet::Words(argv + 1, argv + argc), console);
  } catch (const std::bad_alloc&) {
    std::cerr << "qtet: the mesh does not fit into memory; use a machine with more, or a part of the mesh\n";
  } catch (const std::exception& error) {
    std::cerr << "qtet: " << error.what() << "\n";
  }
  return qtet::kExitFailed;
}
