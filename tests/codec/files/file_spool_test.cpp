#include "codec/files/file_spool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>

#include "tests/support/meshes.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

Bytes counted(std::size_t bytes) {
  Bytes out(bytes);
  for (std::size_t i = 0; i < bytes; ++i) out[i] = static_cast<std::uint8_t>(i * 7 / 3);
  return out;
}

TEST(FileSpool, givesBackWhatWasAppendedAndLeavesNothing) {
  const fs::path folder = testing::freshFolder("spool");
  const Bytes whole = counted(3'500'001);
  const auto spool = fileSpoolBeside(folder / "part.qtet");
  ASSERT_TRUE(spool) << spool.error().text();
  Bytes got;
  ASSERT_TRUE((*spool)->writeTo(appendTo(got)));
  EXPECT_TRUE(got.empty());
  const ByteView view(whole);
  std::size_t at = 0;
  for (const std::size_t size : {1u, 0u, 1'048'576u, 1'048'575u, 1'402'849u}) {
    ASSERT_TRUE((*spool)->append(view.subspan(at, size)));
    at += size;
  }
  EXPECT_EQ((*spool)->size(), whole.size());
  for (int twice = 0; twice < 2; ++twice) {
    got.clear();
    ASSERT_TRUE((*spool)->writeTo(appendTo(got)));
    EXPECT_EQ(got, whole);
  }
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST(FileSpool, saysWhichFolderIsNotThere) {
  const auto spool = fileSpoolBeside(testing::freshFolder("spool-none") / "no" / "part.qtet");
  ASSERT_FALSE(spool);
  EXPECT_EQ(spool.error().code, ErrorCode::kNotFound);
  EXPECT_NE(spool.error().message.find("no does not exist"), std::string::npos);
}

TEST(FileSpool, liesBehindSymbolicLinks) {
  const fs::path folder = testing::freshFolder("spool-link");
  fs::create_directory(folder / "real");
  fs::create_symlink(folder / "real" / "part.qtet", folder / "link.qtet");
  EXPECT_TRUE(fileSpoolBeside(folder / "link.qtet"));
  fs::remove_all(folder / "real");
  const auto spool = fileSpoolBeside(folder / "link.qtet");
  ASSERT_FALSE(spool);
  EXPECT_NE(spool.error().message.find("real does not exist"), std::string::npos)
      << spool.error().message;
}

/// A disk that is full after so many bytes.
class FullDisk final : public FileCalls {
 public:
  explicit FullDisk(std::size_t bytes) : left_(bytes) {}
  int open(const char* path, int flags, mode_t mode) override {
    return systemFileCalls().open(path, flags, mode);
  }
  int lock(int file, int operation) override { return systemFileCalls().lock(file, operation); }
  ssize_t write(int file, const std::uint8_t* bytes, std::size_t count) override {
    if (left_ == 0) return errno = ENOSPC, -1;
    const ssize_t written = systemFileCalls().write(file, bytes, std::min(count, left_));
    if (written > 0) left_ -= static_cast<std::size_t>(written);
    return written;
  }
  int sync(int file) override { return systemFileCalls().sync(file); }
  int close(int file) override { return systemFileCalls().close(file); }
  int rename(const char* from, const char* to) override {
    return systemFileCalls().rename(from, to);
  }
  int unlink(const char* path) override { return systemFileCalls().unlink(path); }

 private:
  std::size_t left_;
};

TEST(FileSpool, aFullDiskIsAnErrorThatNamesTheFolder) {
  const fs::path folder = testing::freshFolder("spool-full");
  FullDisk disk(2'000'000);
  const auto spool = fileSpoolBeside(folder / "part.qtet", disk);
  ASSERT_TRUE(spool);
  ASSERT_TRUE((*spool)->append(counted(1'900'000)));
  const Status full = (*spool)->append(counted(1'100'000));
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().code, ErrorCode::kIo);
  EXPECT_NE(full.error().message.find(folder.string() + ": No space left"), std::string::npos)
      << full.error().message;
  EXPECT_TRUE(fs::is_empty(folder));
}

}  // namespace
}  // namespace qtet
