#include "simplify/read/process/guarded_folder.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/support/meshes.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// A process that makes a folder in `parent`, writes a file into it, and waits to be killed.
pid_t startOwner(const fs::path& parent) {
  const pid_t owner = ::fork();
  if (owner != 0) return owner;
  ::setenv("TMPDIR", parent.c_str(), 1);
  const GuardedFolder folder("test");
  std::ofstream(folder.path() / "file") << "something";
  for (;;) ::pause();
}

TEST(GuardedFolder, goesWithItsProcessAtWhateverMomentThatIsKilled) {
  const fs::path parent = testing::freshFolder("guarded-folder");
  for (int run = 0; run < 60; ++run) {
    const pid_t owner = startOwner(parent);
    ASSERT_GT(owner, 0);
    while (fs::is_empty(parent)) {
    }
    ::usleep(static_cast<useconds_t>(run * 20));  // at once in the first run, then later and later
    ::kill(owner, run % 2 == 0 ? SIGKILL : SIGTERM);
    ASSERT_EQ(::waitpid(owner, nullptr, 0), owner);
    for (int turn = 0; turn < 10'000 && !fs::is_empty(parent); ++turn) ::usleep(5'000);
    ASSERT_TRUE(fs::is_empty(parent)) << "left behind in run " << run;
  }
}

TEST(GuardedFolder, isOnesOwnAndGoesWithEverythingInIt) {
  fs::path path;
  {
    const GuardedFolder one("test"), other("test");
    ASSERT_FALSE(one.failure());
    path = one.path();
    EXPECT_NE(path, other.path());
    EXPECT_TRUE(path.filename().string().starts_with("qtet-test-"));
    EXPECT_EQ(fs::status(path).permissions() & fs::perms::all, fs::perms::owner_all);
    fs::create_directory(path / "inner");
    std::ofstream(path / "inner" / "file") << "something";
  }
  EXPECT_FALSE(fs::exists(path));
}

}  // namespace
}  // namespace qtet
