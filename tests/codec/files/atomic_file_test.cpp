#include "codec/files/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "tests/support/meshes.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t filesIn(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(AtomicFile, replacesTheOldFileAndLeavesNothingBeside) {
  const fs::path path = testing::freshFolder("atomic-replace") / "a.qtet";
  ASSERT_TRUE(writeFileAtomically(path, Bytes{'o', 'l', 'd'}));
  ASSERT_TRUE(writeFileAtomically(path, Bytes{'n', 'e', 'w', '!'}));
  EXPECT_EQ(contentOf(path), "new!");
  EXPECT_EQ(filesIn(path.parent_path()), 1u);
}

TEST(AtomicFile, writesAnEmptyFile) {
  const fs::path path = testing::freshFolder("atomic-empty") / "a";
  ASSERT_TRUE(writeFileAtomically(path, Bytes{}));
  EXPECT_EQ(fs::file_size(path), 0u);
}

TEST(AtomicFile, aFolderThatDoesNotExistIsNotFound) {
  const Status status =
      writeFileAtomically(testing::freshFolder("atomic-none") / "no" / "a", Bytes{1});
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::kNotFound);
}

TEST(AtomicFile, aFolderInTheFilesPlaceIsRefusedAndNothingIsLeft) {
  const fs::path folder = testing::freshFolder("atomic-folder");
  fs::create_directory(folder / "a");
  const Status status = writeFileAtomically(folder / "a", Bytes{1});
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::kIo);
  EXPECT_EQ(filesIn(folder), 1u);
}

TEST(AtomicFile, keepsThePermissionsOfTheOldFile) {
  const fs::path path = testing::freshFolder("atomic-mode") / "a";
  ASSERT_TRUE(writeFileAtomically(path, Bytes{1}));
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  ASSERT_TRUE(writeFileAtomically(path, Bytes{2}));
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(AtomicFile, followsALink) {
  const fs::path folder = testing::freshFolder("atomic-link");
  fs::create_directory(folder / "real");
  ASSERT_TRUE(writeFileAtomically(folder / "real" / "a", Bytes{'o', 'l', 'd'}));
  fs::create_symlink("real/a", folder / "link");
  ASSERT_TRUE(writeFileAtomically(folder / "link", Bytes{'n', 'e', 'w'}));
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(contentOf(folder / "real" / "a"), "new");
  EXPECT_EQ(filesIn(folder / "real"), 1u);
  fs::create_symlink("loop", folder / "loop");
  EXPECT_FALSE(writeFileAtomically(folder / "loop", Bytes{1}));
  EXPECT_TRUE(fs::is_symlink(folder / "loop"));
}

TEST(AtomicFile, makesTheFileThatALinkLeadsTo) {
  const fs::path folder = testing::freshFolder("atomic-link-to-nothing");
  fs::create_directory(folder / "real");
  fs::create_symlink("real/second", folder / "first");
  fs::create_symlink(folder / "real" / "a", folder / "real" / "second");
  ASSERT_TRUE(writeFileAtomically(folder / "first", Bytes{'n', 'e', 'w'}));
  EXPECT_TRUE(fs::is_symlink(folder / "first") && fs::is_symlink(folder / "real" / "second"));
  EXPECT_FALSE(fs::is_symlink(folder / "real" / "a"));
  EXPECT_EQ(contentOf(folder / "real" / "a"), "new");
  EXPECT_EQ(filesIn(folder / "real"), 2u) << "the file and the link to it";
  fs::create_symlink("nowhere/a", folder / "lost");
  const Status lost = writeFileAtomically(folder / "lost", Bytes{1});
  ASSERT_FALSE(lost);
  EXPECT_NE(lost.error().message.find("nowhere"), std::string::npos) << lost.error().message;
  EXPECT_TRUE(fs::is_symlink(folder / "lost"));
}

TEST(AtomicFile, aPipeIsLeftAlone) {
  const fs::path path = testing::freshFolder("atomic-pipe") / "p";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  const Status status = writeFileAtomically(path, Bytes{1});
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().message.find("pipe"), std::string::npos) << status.error().message;
  EXPECT_TRUE(fs::is_fifo(path));
}

TEST(AtomicFile, aNameMayBeAsLongAsTheFileSystemTakesIt) {
  const fs::path folder = testing::freshFolder("atomic-long");
  for (const char last : {'a', 'b'})
    ASSERT_TRUE(writeFileAtomically(folder / (std::string(254, 'n') + last), Bytes{1}));
  EXPECT_EQ(filesIn(folder), 2u);
}

}  // namespace
}  // namespace qtet
