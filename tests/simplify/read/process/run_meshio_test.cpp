#include "simplify/read/process/run_meshio.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "tests/support/meshes.h"

namespace qtet {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

/// A python3 that comes first on the path and does `script`; the path is as before afterwards.
class FakePython {
 public:
  explicit FakePython(const std::string& script) {
    const fs::path program = folder_ / "python3";
    std::ofstream(program) << "#!/bin/sh\n" << script << '\n';
    fs::permissions(program, fs::perms::owner_all);
    ::setenv("PATH", (folder_.string() + ":" + before_).c_str(), 1);
  }
  ~FakePython() { ::setenv("PATH", before_.c_str(), 1); }
  FakePython(const FakePython&) = delete;
  FakePython& operator=(const FakePython&) = delete;

 private:
  fs::path folder_ = testing::freshFolder("fake-python");
  std::string before_ = std::getenv("PATH");
};

Status neverUsed(const fs::path& file) {
  ADD_FAILURE() << file << " was handed on";
  return {};
}

TEST(RunMeshio, aProgramThatMovesNoByteForTooLongIsGivenUp) {
  const FakePython python("exec sleep 600");
  const auto start = std::chrono::steady_clock::now();
  const Status done = throughMeshio({.path = "beam.med", .kind = "", .patience = 1s}, neverUsed);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::kBadInput);
  EXPECT_NE(done.error().message.find("`readSeconds`"), std::string::npos) << done.error().message;
  EXPECT_LT(std::chrono::steady_clock::now() - start, 60s);
}

TEST(RunMeshio, aProgramThatWritesOnIsWaitedFor) {
  const FakePython python(
      "for i in 1 2 3 4 5 6; do echo $i; sleep 0.5; done; echo last words; exit 1");
  const Status done = throughMeshio({.path = "beam.med", .kind = "", .patience = 2s}, neverUsed);
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("last words"), std::string::npos) << done.error().message;
}

TEST(RunMeshio, aByteOrderMarkIsTakenOffTheTextButNotOffXdmf) {
  const FakePython python("head -c 6 \"$3\"; exit 1");
  const fs::path file = testing::freshFolder("marked") / "mesh.off";
  std::ofstream(file) << "\xEF\xBB\xBFOFF 4 4\n";
  for (const auto& [kind, begins] : {std::pair("", ": OFF 4 "), {"xdmf", ": \xEF\xBB\xBFOFF"}}) {
    const Status done = throughMeshio({.path = file, .kind = kind}, neverUsed);
    ASSERT_FALSE(done);
    EXPECT_NE(done.error().message.find(begins), std::string::npos) << done.error().message;
    EXPECT_TRUE(done.error().message.starts_with(file.string())) << done.error().message;
  }
}

TEST(RunMeshio, aProgramThatTheSystemEndsIsTold) {
  const FakePython python("kill -KILL $$");
  const Status done = throughMeshio({.path = "beam.med", .kind = ""}, neverUsed);
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("it ended without a word"), std::string::npos)
      << done.error().message;
}

}  // namespace
}  // namespace qtet
