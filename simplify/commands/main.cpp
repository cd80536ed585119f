// The program `qtet`: see commands.h.
#include "simplify/commands/tool_main.h"

namespace qtet {

Installation installation() {
  std::error_code code;
  const auto programs = std::filesystem::read_symlink("/proc/self/exe", code).parent_path();
  return {programs / "../share/qtet/viewer", programs};
}

}  // namespace qtet

int main(int argc, char** argv) { return qtet::toolMain(argc, argv); }
