// The tool within the library of the Python package, which has no program of its own.
#include <dlfcn.h>

#include "simplify/commands/tool_main.h"

extern "C" {
/// `qtet WORDS...` in this process: what main() takes and returns. The output goes to the process's
/// own streams. Not to be called by two threads at once.
__attribute__((visibility("default"))) int qtet_main(int argc, const char* const* argv);
}

namespace qtet {

Installation installation() {
  Dl_info library{};
  if (::dladdr(reinterpret_cast<const void*>(&qtet_main), &library) == 0) return {};
  const auto package = std::filesystem::path(library.dli_fname).parent_path();
  return {package / "viewer", package};
}

}  // namespace qtet

int qtet_main(int argc, const char* const* argv) { return qtet::toolMain(argc, argv); }
