// Where a test finds the programs under test and the files of the repository. They are no compile
// definitions: objects would differ from folder to folder, and a compiler cache would miss them.
#pragma once

namespace qtet::testing {

extern const char* const kSourceFolder;   ///< the repository's root
extern const char* const kGoldenFolder;   ///< tests/golden
extern const char* const kTool;           ///< the program qtet
extern const char* const kServerProgram;  ///< the program qtet-server
extern const char* const kFaultsLibrary;  ///< support/faults, for LD_PRELOAD

}  // namespace qtet::testing
