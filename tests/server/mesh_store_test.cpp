#include "server/mesh_store.h"

#include <gtest/gtest.h>

#include "tests/server/synthetic_log.h"

namespace qtet {
namespace {

TEST(MeshStore, servesTheSoundLogsInTheOrderOfTheirNames) {
  test::TempFolder folder;
  folder.write("b.qtet", test::makeLog({.seed = 1}));
  folder.write("a.qtet", test::makeLog({.seed = 2}));
  folder.write("c.txt", "no log");
  folder.write("sub/d.qtet", test::makeLog({.seed = 3}));
  const auto store = MeshStore::open(folder.path());
  ASSERT_TRUE(store);
  ASSERT_EQ(store->meshes().size(), 2u);
  EXPECT_EQ(store->meshes().begin()->first, "a");
  EXPECT_TRUE(store->refused().empty());
  EXPECT_NE(store->find("b"), nullptr);
  EXPECT_EQ(store->find("c"), nullptr);
  EXPECT_EQ(store->find("../b"), nullptr);
}

ErrorCode refusalOfDamaged(const Bytes& bytes) {
  test::TempFolder folder;
  folder.write("good.qtet", test::makeLog({.seed = 1}));
  folder.write("bad.qtet", bytes);
  const auto store = MeshStore::open(folder.path());
  EXPECT_TRUE(store);
  EXPECT_EQ(store->meshes().size(), 1u) << "the sound one is served all the same";
  EXPECT_EQ(store->refused().size(), 1u);
  return store->refused().empty() ? ErrorCode::kIo : store->refused()[0].error.code;
}

TEST(MeshStore, aDamagedLogIsRefusedWithItsReason) {
  const Bytes whole = test::makeLog(test::SyntheticLog());
  EXPECT_EQ(refusalOfDamaged({}), ErrorCode::kTruncated);
  EXPECT_EQ(refusalOfDamaged(Bytes(whole.begin(), whole.end() - 1)), ErrorCode::kTruncated);
  Bytes flipped = whole;
  flipped.back() ^= 1;  // in the last block: only its CRC-32C can tell
  EXPECT_EQ(refusalOfDamaged(flipped), ErrorCode::kBadChecksum);
  flipped = whole;
  flipped[100] ^= 1;  // in the manifest
  EXPECT_EQ(refusalOfDamaged(flipped), ErrorCode::kBadChecksum);
  flipped = whole;
  flipped[0] ^= 1;
  EXPECT_EQ(refusalOfDamaged(flipped), ErrorCode::kBadMagic);
}

/// Rewrites a sound log's front, checksums and all.
template <class Change>
Bytes rewritten(Change change) {
  const Bytes whole = test::makeLog(test::SyntheticLog());
  LogIndex index = *LogIndex::parse(whole);
  const Bytes blocks(whole.begin() + static_cast<std::ptrdiff_t>(index.headBytes()), whole.end());
  change(index);
  const auto shift = index.encode().size() - index.headBytes();
  for (ChunkEntry& chunk : index.chunks) chunk.offset += shift;
  index.fileBytes += shift;
  Bytes out = index.encode();
  out.insert(out.end(), blocks.begin(), blocks.end());
  return out;
}

TEST(MeshStore, aManifestThatContradictsTheTableIsRefused) {
  EXPECT_EQ(refusalOfDamaged(rewritten([](LogIndex& index) { index.fields[0].components = 2; })), ErrorCode::kTruncated);
  EXPECT_EQ(refusalOfDamaged(rewritten([](LogIndex& index) { index.fields.push_back({1, Association::kPoint}); })), ErrorCode::kBadValue);
  EXPECT_EQ(refusalOfDamaged(rewritten([](LogIndex& index) { index.manifest.push_back(0); })), ErrorCode::kBadValue);
  EXPECT_EQ(refusalOfDamaged(rewritten([](LogIndex& index) { index.manifest.resize(2); })), ErrorCode::kTruncated);
}

TEST(MeshStore, aFolderThatIsNotThereIsAnError) {
  const auto store = MeshStore::open("/nonexistent/folder");
  ASSERT_FALSE(store);
  EXPECT_EQ(store.error().code, ErrorCode::kIo);
  EXPECT_NE(store.error().message.find("/nonexistent/folder"), std::string::npos);
}

TEST(MeshStore, aLevelsPrefixEndsWithItsChunk) {
  test::TempFolder folder;
  folder.write("a.qtet", test::makeLog(test::SyntheticLog()));
  const auto store = MeshStore::open(folder.path());
  ASSERT_TRUE(store);
  const ServedMesh& mesh = *store->find("a");
  EXPECT_EQ(mesh.prefixBytes(11), mesh.log.bytes().size());
  EXPECT_EQ(mesh.prefixBytes(0), mesh.log.index().chunks[1].offset);
}

}  // namespace
}  // namespace qtet
