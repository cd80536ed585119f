#include "simplify/commands/tool_main.h"

#include <malloc.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <string_view>

#include "simplify/commands/commands.h"

namespace qtet {
namespace {

// Blocks of this many bytes and more go back to the system when they are freed. Left alone, glibc
// raises the bound to the largest block that was freed (32 MB at most). Then the arrays of reading
// stay as holes among those of the simplifier, a fifth of the peak with a million cells.
[[maybe_unused]] constexpr int kReturnedBytes = 1 << 20;

}  // namespace

int toolMain(int argc, const char* const* argv) {
#ifdef M_MMAP_THRESHOLD  // glibc
  ::mallopt(M_MMAP_THRESHOLD, kReturnedBytes);
#endif
  const char *noColour = std::getenv("NO_COLOR"), *terminal = std::getenv("TERM");
  const bool plain = (noColour != nullptr && *noColour != '\0') || terminal == nullptr ||
                     std::string_view(terminal) == "dumb";
  Console console{std::cout, std::cerr, ::isatty(STDERR_FILENO) == 1,
                  !plain && ::isatty(STDOUT_FILENO) == 1};
  try {
    return runTool(argc < 1 ? Words() : Words(argv + 1, argv + argc), console);
  } catch (const std::bad_alloc&) {
    constexpr std::size_t kBytesOfWasm = 4;
    std::cerr << "qtet: the mesh does not fit into memory; use "
              << (sizeof(void*) == kBytesOfWasm ? "the tool of the Python or Debian package"
                                                : "a machine with more")
              << ", or a part of the mesh\n";
  } catch (const std::exception& error) {
    std::cerr << "qtet: " << error.what() << "\n";
  }
  return kExitFailed;
}

}  // namespace qtet
