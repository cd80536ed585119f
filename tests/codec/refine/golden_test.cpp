// Golden files: those of version 4.0 must decode to the same mesh and values for ever. Broken ones
// must fail with the code in their names.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <numeric>

#include "codec/log/log_index.h"
#include "codec/log/log_manifest.h"
#include "codec/mesh/mesh.h"
#include "codec/refine/log_file.h"
#include "codec/refine/refiner.h"
#include "proto/checksum.h"
#include "tests/support/closing_contents.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

std::vector<std::filesystem::path> filesIn(const char* folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(testing::kGoldenFolder) / folder))
    files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

/// The SHA-256 of a field's integers in slot order.
std::string fieldDigest(std::span<const std::int32_t> values) {
  ByteWriter w;
  for (const std::int32_t value : values) w.write(static_cast<std::uint32_t>(value));
  return sha256Hex(w.bytes());
}

/// Digests of a log's finest mesh.
struct Digests {
  std::string mesh;
  std::vector<std::string> fields;
};

/// Opens, checks and decodes the whole log, or returns the fault.
Result<Digests> decode(const std::filesystem::path& path) {
  const auto log = LogFile::open(path);
  if (!log) return std::unexpected(log.error());
  if (Status s = log->verifyChecksums(); !s) return std::unexpected(s.error());
  if (const Result<Manifest> manifest = manifestOf(log->index()); !manifest)
    return std::unexpected(manifest.error());
  Refiner refiner(log->index());
  std::vector<std::uint32_t> fields;
  for (std::uint32_t f = 0; f < log->index().fields.size(); ++f) fields.push_back(f);
  for (std::uint32_t c = 0; c < log->index().chunks.size(); ++c)
    if (Status s = applyChunk(*log, refiner, c, fields); !s) return std::unexpected(s.error());
  Digests out{toHex(refiner.digest()), {}};
  for (const std::uint32_t f : fields) out.fields.push_back(fieldDigest(refiner.fieldValues(f)));
  return out;
}

/// As Refiner::digest(), of a mesh taken out of it.
std::string meshDigest(const LatticeMesh& mesh) {
  ByteWriter w;
  const auto feed = [&w](const auto& tuples) {
    for (const auto& tuple : tuples)
      for (const auto value : tuple) w.write(static_cast<std::uint32_t>(value));
  };
  feed(mesh.points), feed(mesh.tetrahedra), feed(mesh.boundary);
  return sha256Hex(w.bytes());
}

/// "DIGEST  NAME" a line, as sha256sum writes.
std::map<std::string, std::string> digestsIn(const char* file) {
  std::ifstream in(std::filesystem::path(testing::kGoldenFolder) / file);
  std::map<std::string, std::string> out;
  for (std::string digest, name; in >> digest >> name;) out[name] = digest;
  return out;
}

TEST(Golden, validFilesDecodeToTheirDigests) {
  const auto expected = digestsIn("digests.txt"), expectedFields = digestsIn("field-digests.txt");
  const auto files = filesIn("valid");
  EXPECT_EQ(files.size(), expected.size());
  std::size_t fields = 0;
  for (const auto& path : files) {
    const auto digest = decode(path);
    ASSERT_TRUE(digest) << path << ": " << digest.error().text();
    const std::string name = path.filename().string();
    ASSERT_TRUE(expected.contains(name)) << path;
    EXPECT_EQ(digest->mesh, expected.at(name)) << path;
    for (std::size_t f = 0; f < digest->fields.size(); ++f, ++fields) {
      const std::string field = name + "/" + std::to_string(f);
      ASSERT_TRUE(expectedFields.contains(field)) << field << " is " << digest->fields[f];
      EXPECT_EQ(digest->fields[f], expectedFields.at(field)) << field;
    }
  }
  EXPECT_EQ(fields, expectedFields.size());
}

TEST(Golden, closingBlocksHoldWhatTheirDigestsSay) {
  const auto expected = digestsIn("closing-digests.txt");
  std::size_t blocks = 0;
  for (const auto& path : filesIn("valid")) {
    const LogFile log = LogFile::open(path).value();
    Refiner refiner(log.index());
    std::vector<std::uint32_t> fields(log.index().fields.size());
    std::iota(fields.begin(), fields.end(), 0u);
    for (std::uint32_t c = 0; c < log.index().chunks.size(); ++c)
      ASSERT_TRUE(applyChunk(log, refiner, c, fields)) << path;
    for (const auto& [block, bytes] : testing::closingContents(log, refiner)) {
      const std::string name = path.filename().string() + "#" + block;
      ASSERT_TRUE(expected.contains(name)) << name;
      EXPECT_EQ(sha256Hex(bytes), expected.at(name)) << name;
      ++blocks;
    }
  }
  EXPECT_GE(blocks, 4u);
  EXPECT_EQ(blocks, expected.size());
}

TEST(Golden, everyLevelDecodesToItsDigest) {
  const auto expected = digestsIn("level-digests.txt");
  std::size_t levels = 0;
  for (const auto& path : filesIn("valid")) {
    const auto log = LogFile::open(path);
    ASSERT_TRUE(log) << path;
    const std::uint32_t last = log->index().chunks.back().lastLevel;
    for (std::uint32_t level = 0; level <= last; ++level, ++levels) {
      const auto mesh = meshAtLevel(*log, level);
      ASSERT_TRUE(mesh) << path << " level " << level << ": " << mesh.error().text();
      const std::string name = path.filename().string() + "@" + std::to_string(level);
      ASSERT_TRUE(expected.contains(name)) << name;
      EXPECT_EQ(meshDigest(*mesh), expected.at(name)) << name;
    }
  }
  EXPECT_EQ(levels, expected.size());
}

TEST(Golden, brokenFilesFailWithTheCodeInTheirName) {
  const auto files = filesIn("must-fail");
  EXPECT_GE(files.size(), 40u);
  for (const auto& path : files) {
    const auto digest = decode(path);
    ASSERT_FALSE(digest) << path << " was accepted";
    const std::string name = path.filename().string();
    EXPECT_EQ(errorCodeName(digest.error().code), name.substr(0, name.find('.')))
        << name << ": " << digest.error().text();
  }
}

}  // namespace
}  // namespace qtet
