// One simulated run: clients come and go, and after each step the invariants hold.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "server/routes/viewer_files.h"
#include "server/store/mesh_store.h"
#include "tests/server/simulator/kernel.h"

namespace qtet::simulator {

struct Outcome {
  std::string violation;  ///< "": every invariant held
  Time at{};              ///< when it was found, or the end
  std::uint64_t trace = 0, calls = 0;
  std::map<std::string, std::uint64_t> seen;
};

/// So much traffic, then the end of the server. The same for the same seed.
[[nodiscard]] Outcome simulate(std::uint64_t seed, Time traffic, const MeshStore& store,
                               const ViewerFiles& viewer);

}  // namespace qtet::simulator
