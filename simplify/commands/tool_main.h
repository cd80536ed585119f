// The tool as a function. A program calls it, and so does Python with the library of its package.
#pragma once

#include <filesystem>

namespace qtet {

/// Runs the command that the words behind the first name, as a shell gives them. Returns the exit
/// code.
[[nodiscard]] int toolMain(int argc, const char* const* argv);

/// The files beside the tool where it is installed. The file with main() or qtet_main() knows.
struct Installation {
  std::filesystem::path viewer;    ///< the viewer's files
  std::filesystem::path programs;  ///< may hold qtet-server
};
[[nodiscard]] Installation installation();

}  // namespace qtet
