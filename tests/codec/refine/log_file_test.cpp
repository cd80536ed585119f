#include "codec/refine/log_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "codec/files/atomic_file.h"
#include "codec/files/temporary_folder.h"
#include "codec/log/log_index.h"
#include "codec/refine/refiner.h"
#include "proto/checksum.h"
#include "tests/support/forged_log.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

/// Bytes of the mapped file that are in memory.
std::uint64_t residentBytes(const std::filesystem::path& path) {
  std::ifstream maps("/proc/self/smaps");
  bool isOurs = false;
  for (std::string line; std::getline(maps, line);) {
    if (line.ends_with(path.string())) isOurs = true;
    if (isOurs && line.starts_with("Rss:")) return 1024 * std::stoull(line.substr(4));
  }
  ADD_FAILURE() << path << " is not mapped";
  return 0;
}

/// Logs larger than memory can be checked and decoded: what was read need not stay.
TEST(LogFile, littleOfItIsInMemory) {
  constexpr std::uint64_t kBytes = 32 << 20, kMax = kBytes / 4;
  const std::string golden = std::string(testing::kGoldenFolder) + "/valid/solid.qtet";
  testing::TakenApart parts = testing::takeApart(LogFile::open(golden).value().bytes());
  parts.index.closing.push_back({static_cast<ClosingKind>(1000), 0, {}});
  parts.closing.push_back(Bytes(kBytes, 0x5A));
  const Bytes bytes = parts.together();
  const TemporaryFolder folder("test");
  const std::filesystem::path path = folder.path() / "large.qtet";
  ASSERT_TRUE(writeFileAtomically(path, bytes));

  const Result<LogFile> log = LogFile::open(path);
  ASSERT_TRUE(log) << log.error().text();
  EXPECT_EQ(log->digest(), sha256Hex(bytes));
  EXPECT_LT(residentBytes(path), kMax) << "after its digest";
  ASSERT_TRUE(log->verifyChecksums());
  EXPECT_LT(residentBytes(path), kMax) << "after its checksums";
  const auto closing = log->closing(static_cast<ClosingKind>(1000));
  ASSERT_TRUE(closing);
  log->release(0, bytes.size());
  EXPECT_LT(residentBytes(path), kMax) << "after it was let go";
  EXPECT_EQ(closing->back(), 0x5A) << "it can be read again";
  EXPECT_TRUE(meshAtLevel(*log, 1));
}

}  // namespace
}  // namespace qtet
