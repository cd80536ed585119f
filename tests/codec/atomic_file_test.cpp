#include "codec/atomic_file.h"

#include <gtest/gtest.h>

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
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
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
  ASSERT_TRUE(writeFileAtomically(path, {}));
  EXPECT_EQ(fs::file_size(path), 0u);
}

TEST(AtomicFile, aFolderThatDoesNotExistIsNotFound) {
  const Status status = writeFileAtomically(testing::freshFolder("atomic-none") / "no" / "a", Bytes{1});
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

}  // namespace
}  // namespace qtet
