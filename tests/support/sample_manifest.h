// A manifest for tests to begin with: a lattice and a first field whose figures are no short
// decimals.
#pragma once

#include "proto/manifest.h"

namespace qtet::testing {

[[nodiscard]] inline Manifest manifestWithoutLevels() {
  Manifest m;
  m.generator = "qtet 0.1.0";
  m.source = "comb.vtu";
  m.latticeBits = 16;
  m.latticeStep = 0.1 + 0.2;
  m.latticeOrigin = {-1.5, 1e-17, 3};
  m.fields.push_back({"density", 1, "float32", "point", 12, 0.00025, {0.1}, {0.1, 0.9}});
  return m;
}

}  // namespace qtet::testing
