// A small real log in a folder of its own, made through the simplifier and the encoder.
#pragma once

#include "tests/support/meshes.h"

namespace qtet::testing {

[[nodiscard]] inline std::filesystem::path sampleLog() {
  return writeSampleLog(freshFolder("sample-log"));
}

}  // namespace qtet::testing
