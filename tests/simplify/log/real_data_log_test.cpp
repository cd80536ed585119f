// Every mesh of the folder QTET_DATA goes through the tool and comes back, cell for cell.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/meshes.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

TEST(RealDataLog, everyMeshIsVerifiedAgainstItself) {
  const char* folder = std::getenv("QTET_DATA");
  if (!folder) GTEST_SKIP() << "QTET_DATA is not set";
  std::vector<std::filesystem::path> meshes;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".vtu") meshes.push_back(entry.path());
  std::sort(meshes.begin(), meshes.end());
  ASSERT_FALSE(meshes.empty()) << "no .vtu in " << folder;
  const auto out = testing::freshFolder("real-data");
  for (const auto& mesh : meshes) {
    const std::string log = (out / "log.qtet").string();
    const std::string tool = std::string("\"") + testing::kTool + "\" ";
    ASSERT_EQ(std::system((tool + "simplify \"" + mesh.string() + "\" -o \"" + log +
                           "\" 2>/dev/null >/dev/null")
                              .c_str()),
              0)
        << mesh;
    EXPECT_EQ(std::system((tool + "verify \"" + log + "\" --against \"" + mesh.string() +
                           "\" 2>/dev/null >/dev/null")
                              .c_str()),
              0)
        << mesh;
  }
}

}  // namespace
}  // namespace qtet
