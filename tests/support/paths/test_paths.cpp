#include "tests/support/paths/test_paths.h"

namespace qtet::testing {

const char* const kSourceFolder = QTET_SOURCE_DIR;
const char* const kGoldenFolder = QTET_SOURCE_DIR "/tests/golden";
const char* const kTool = QTET_TOOL;
const char* const kServerProgram = QTET_SERVER;
const char* const kFaultsLibrary = QTET_FAULTS_LIBRARY;

}  // namespace qtet::testing
