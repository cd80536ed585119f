// Golden files: what version 1.0 wrote must decode to the same mesh for ever, and what is broken must fail with the code in its name.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "codec/log_file.h"
#include "proto/checksum.h"

namespace qtet {
namespace {

std::vector<std::filesystem::path> filesIn(const char* folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(QTET_GOLDEN_DIR) / folder)) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

/// Opens, checks and decodes the whole log: the digest of its finest mesh, or what is wrong.
Result<std::string> decode(const std::filesystem::path& path) {
  const auto log = LogFile::open(path);
  if (!log) return std::unexpected(log.error());
  if (Status s = log->verifyChecksums(); !s) return std::unexpected(s.error());
  Refiner refiner(log->index());
  std::vector<std::uint32_t> fields;
  for (std::uint32_t f = 0; f < log->index().fieldComponents.size(); ++f) fields.push_back(f);
  for (std::uint32_t c = 0; c < log->index().chunks.size(); ++c)
    if (Status s = applyChunk(*log, refiner, c, fields); !s) return std::unexpected(s.error());
  return toHex(refiner.digest());
}

TEST(Golden, validFilesDecodeToTheirDigests) {
  std::ifstream in(std::filesystem::path(QTET_GOLDEN_DIR) / "digests.txt");  // "DIGEST  NAME" a line, as sha256sum writes
  std::map<std::string, std::string> expected;
  for (std::string digest, name; in >> digest >> name;) expected[name] = digest;
  const auto files = filesIn("valid");
  EXPECT_EQ(files.size(), expected.size());
  for (const auto& path : files) {
    const auto digest = decode(path);
    ASSERT_TRUE(digest) << path << ": " << digest.error().text();
    EXPECT_EQ(*digest, expected[path.filename().string()]) << path;
  }
}

TEST(Golden, brokenFilesFailWithTheCodeInTheirName) {
  const auto files = filesIn("must-fail");
  EXPECT_GE(files.size(), 20u);
  for (const auto& path : files) {
    const auto digest = decode(path);
    ASSERT_FALSE(digest) << path << " was accepted";
    const std::string name = path.filename().string();
    EXPECT_EQ(errorCodeName(digest.error().code), name.substr(0, name.find('.'))) << name << ": " << digest.error().text();
  }
}

}  // namespace
}  // namespace qtet
