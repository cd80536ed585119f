#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>
#include <optional>
#include <string>

#include "codec/temporary_folder.h"
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

TEST(TemporaryFolder, saysWhyThereIsNone) {
  const TmpDir where(testing::freshFolder("temporary-folder") / "missing");
  const TemporaryFolder folder("test");
  EXPECT_TRUE(folder.failure());
  EXPECT_TRUE(folder.path().empty());
}

}  // namespace
}  // namespace qtet
