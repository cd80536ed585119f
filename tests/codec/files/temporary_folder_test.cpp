#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "codec/files/temporary_folder.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// TMPDIR for a while.
class TmpDir {
 public:
  explicit TmpDir(const fs::path& path) {
    if (const char* now = ::getenv("TMPDIR")) before_ = now;
    ::setenv("TMPDIR", path.c_str(), 1);
  }
  ~TmpDir() {
    if (before_)
      ::setenv("TMPDIR", before_->c_str(), 1);
    else
      ::unsetenv("TMPDIR");
  }

 private:
  std::optional<std::string> before_;
};

TEST(TemporaryFolder, isOnesOwnAndGoesWithEverythingInIt) {
  const fs::path parent = testing::freshFolder("temporary-folder");
  const TmpDir where(parent);
  fs::path first;
  {
    const TemporaryFolder one("test"), other("test");
    ASSERT_FALSE(one.failure());
    first = one.path();
    EXPECT_NE(first, other.path());
    EXPECT_EQ(first.parent_path(), parent);
    EXPECT_TRUE(first.filename().string().starts_with("qtet-test-"));
    EXPECT_EQ(fs::status(first).permissions() & fs::perms::all, fs::perms::owner_all);
    fs::create_directory(first / "inner");
    std::ofstream(first / "inner" / "file") << "something";
  }
  EXPECT_FALSE(fs::exists(first));
  EXPECT_TRUE(fs::is_empty(parent));
}

TEST(TemporaryFolder, canHaveAnotherPlaceAndName) {
  const fs::path parent = testing::freshFolder("temporary-folder");
  std::array<char, 256> host{};
  ASSERT_EQ(::gethostname(host.data(), host.size() - 1), 0);
  const std::string mine = std::string(".mine-") + host.data() + "-";
  fs::create_directory(parent / (mine + "abcdef"));
  fs::create_directory(parent / (mine + "abcdefg"));
  fs::create_directory(parent / ".mine-another-abcdef");
  const TemporaryFolder one(parent, ".mine-"), none(parent / "missing", ".mine-");
  EXPECT_TRUE(one.path().string().starts_with((parent / mine).string()));
  EXPECT_FALSE(fs::exists(parent / (mine + "abcdef"))) << "abandoned";
  EXPECT_TRUE(fs::exists(parent / (mine + "abcdefg")));
  EXPECT_TRUE(fs::exists(parent / ".mine-another-abcdef")) << "of another machine";
  EXPECT_EQ(none.failure(), std::errc::no_such_file_or_directory);
}

TEST(TemporaryFolder, takesAwayWhatAKilledProcessLeftAndNothingElse) {
  const fs::path parent = testing::freshFolder("temporary-folder");
  const TmpDir where(parent);
  std::array<int, 2> told{};
  ASSERT_EQ(::pipe(told.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const TemporaryFolder folder("test");
    std::ofstream(folder.path() / "file") << "something";
    (void)!::write(told[1], "x", 1);
    for (;;) ::pause();
  }
  char byte = 0;
  ASSERT_EQ(::read(told[0], &byte, 1), 1);
  const auto count = [&] {
    return std::distance(fs::directory_iterator(parent), fs::directory_iterator());
  };
  for (const char* name : {"qtet-test-12345", "qtet-test-1234567", "qtet-other-123456"})
    fs::create_directory(parent / name);
  std::ofstream(parent / "qtet-test-123456") << "a file";
  fs::create_directory_symlink(parent, parent / "qtet-test-abcdef");
  const auto others = count();  // that of the process, and what is none
  {
    const TemporaryFolder mine("test");
    EXPECT_EQ(count(), others + 1) << "who lives keeps what is his";
  }
  ::kill(child, SIGKILL);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_EQ(count(), others);
  const TemporaryFolder mine("test");
  EXPECT_EQ(count(), others) << "one went, one came";
  ::close(told[0]);
  ::close(told[1]);
}

TEST(TemporaryFolder, saysWhyThereIsNone) {
  const TmpDir where(testing::freshFolder("temporary-folder") / "missing");
  const TemporaryFolder folder("test");
  EXPECT_TRUE(folder.failure());
  EXPECT_TRUE(folder.path().empty());
}

}  // namespace
}  // namespace qtet
