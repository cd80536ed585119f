#include "server/store/mesh_store.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "server/store/bus_guard.h"
#include "server/store/store_limits.h"
#include "server/wire/id_limits.h"
#include "tests/server/store/synthetic_log.h"

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
  ASSERT_EQ(store->catalogue()->meshes.size(), 2u);
  EXPECT_EQ(store->catalogue()->meshes.begin()->get()->id, "a");
  EXPECT_TRUE(store->catalogue()->refused.empty());
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
  const CataloguePointer catalogue = store->catalogue();
  EXPECT_EQ(catalogue->meshes.size(), 1u) << "the sound one is served all the same";
  EXPECT_EQ(catalogue->refused.size(), 1u);
  return catalogue->refused.empty() ? ErrorCode::kIo : (*catalogue->refused.begin())->error.code;
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
  EXPECT_EQ(refusalOfDamaged(rewritten([](LogIndex& index) { index.fields[0].components = 2; })),
            ErrorCode::kTruncated);
  EXPECT_EQ(refusalOfDamaged(rewritten(
                [](LogIndex& index) { index.fields.push_back({1, Association::kPoint}); })),
            ErrorCode::kBadValue);
  EXPECT_EQ(refusalOfDamaged(rewritten([](LogIndex& index) { index.manifest.push_back(0); })),
            ErrorCode::kBadValue);
  EXPECT_EQ(refusalOfDamaged(rewritten([](LogIndex& index) { index.manifest.resize(2); })),
            ErrorCode::kTruncated);
}

TEST(MeshStore, aFolderThatIsNotThereIsAnError) {
  const auto store = MeshStore::open("/nonexistent/folder");
  ASSERT_FALSE(store);
  EXPECT_EQ(store.error().code, ErrorCode::kIo);
  EXPECT_NE(store.error().message.find("/nonexistent/folder"), std::string::npos);
}

TEST(MeshStore, newReplacedAndRemovedLogsAreNoticed) {
  test::TempFolder folder;
  folder.write("a.qtet", test::makeLog({.seed = 1}));
  folder.write("b.qtet", test::makeLog({.seed = 2}));
  const auto store = MeshStore::open(folder.path());
  ASSERT_TRUE(store);
  const MeshPointer old = store->find("a");
  const std::string tag = store->catalogue()->etag();
  EXPECT_FALSE(store->rescan()->any());
  EXPECT_EQ(store->find("a"), old) << "what has not changed is not opened again";

  folder.write("new.tmp", test::makeLog({.seed = 3}));
  std::filesystem::rename(folder.path() / "new.tmp", folder.path() / "a.qtet");
  folder.write("c.qtet", test::makeLog({.seed = 4}));
  std::filesystem::remove(folder.path() / "b.qtet");
  const auto change = store->rescan();
  ASSERT_TRUE(change);
  EXPECT_EQ(change->added.size(), 2u);
  EXPECT_EQ(change->removed, std::vector<std::string>{"b"});
  EXPECT_NE(store->find("a")->log.digest(), old->log.digest());
  EXPECT_EQ(store->findLog(old->log.digest()), old) << "who reads it piece by piece may finish";
  EXPECT_EQ(store->find("b"), nullptr);
  EXPECT_NE(store->catalogue()->etag(), tag);
  EXPECT_TRUE(old->log.verifyChecksums()) << "the old file's mapping is untouched";
}

TEST(MeshStore, aDamagedReplacementLeavesTheSoundLogServed) {
  test::TempFolder folder;
  folder.write("a.qtet", test::makeLog({.seed = 1}));
  const auto store = MeshStore::open(folder.path());
  ASSERT_TRUE(store);
  const MeshPointer old = store->find("a");
  folder.write("new.tmp", "nonsense");
  std::filesystem::rename(folder.path() / "new.tmp", folder.path() / "a.qtet");
  EXPECT_EQ(store->rescan()->refused.size(), 1u);
  EXPECT_EQ(store->find("a"), old);
  EXPECT_TRUE(store->rescan()->refused.empty()) << "it is told of once";
  EXPECT_EQ(store->catalogue()->refused.size(), 1u);
  EXPECT_EQ(store->find("a"), old);
}

std::size_t openDescriptors() {
  const std::filesystem::directory_iterator files("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

TEST(MeshStore, moreLogsThanMayBeOpenAreServedAllTheSame) {
  constexpr std::size_t kLogs = 20, kMaxOpen = 3;
  test::TempFolder folder;
  std::vector<Bytes> logs;
  for (std::uint32_t i = 0; i < kLogs; ++i) {
    logs.push_back(test::makeLog({.seed = i + 1}));
    folder.write(std::to_string(i) + ".qtet", logs.back());
  }
  const std::size_t before = openDescriptors();
  const auto store = MeshStore::open(folder.path(), {.maxOpen = kMaxOpen});
  ASSERT_TRUE(store);
  EXPECT_EQ(store->catalogue()->meshes.size(), kLogs);
  EXPECT_LE(openDescriptors(), before + kMaxOpen);
  const MeshPointer kept = store->find("7");
  for (int round = 0; round < 2; ++round)
    for (std::size_t i = 0; i < kLogs; ++i) {
      const MeshPointer mesh = store->find(std::to_string(i));
      ASSERT_TRUE(mesh) << i;
      EXPECT_TRUE(std::ranges::equal(mesh->log.bytes(), logs[i]));
      EXPECT_EQ(store->findLog(mesh->log.digest()), mesh);
      EXPECT_LE(openDescriptors(), before + kMaxOpen + 2) << "the one kept, and the one in use";
    }
  EXPECT_EQ(store->find("7"), kept) << "not opened twice";
}

constexpr auto kNoTime = std::chrono::milliseconds::zero();

std::vector<std::string> unreadOf(const MeshStore& store) {
  const CataloguePointer now = store.catalogue();
  return {now->unread.begin(), now->unread.end()};
}

/// Logs 1000, 1001, ...: `more` than one look reads.
void fillWithMore(test::TempFolder& out, std::size_t more) {
  for (std::size_t i = 0; i < limits::kLogsReadAtOnce + more; ++i)
    out.write(std::to_string(1000 + i) + ".qtet",
              test::makeLog({.chunks = 1, .fields = {}, .seed = static_cast<std::uint32_t>(i)}));
}

TEST(MeshStore, whatThereWasNoTimeForIsReadByTheNextLooks) {
  test::TempFolder folder;
  fillWithMore(folder, 5);
  const auto store = MeshStore::open(folder.path(), {.readTime = kNoTime});
  ASSERT_TRUE(store);
  EXPECT_TRUE(store->catalogue()->named);
  EXPECT_EQ(store->catalogue()->meshes.size(), limits::kLogsReadAtOnce);
  EXPECT_EQ(unreadOf(*store), (std::vector<std::string>{"1064", "1065", "1066", "1067", "1068"}));
  EXPECT_EQ(store->readOn()->added.size(), 1u);
  EXPECT_EQ(unreadOf(*store), (std::vector<std::string>{"1065", "1066", "1067", "1068"}));
  EXPECT_EQ(store->rescan("1068")->added.size(), 1u);
  EXPECT_EQ(unreadOf(*store), (std::vector<std::string>{"1065", "1066", "1067"}));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(store->readOn());
  EXPECT_TRUE(store->catalogue()->complete());
  EXPECT_EQ(store->catalogue()->meshes.size(), limits::kLogsReadAtOnce + 5);
}

TEST(MeshStore, aNameThatIsAskedForIsReadByWhoAsks) {
  test::TempFolder folder;
  fillWithMore(folder, 5);
  const auto store = MeshStore::open(folder.path(), {.readTime = kNoTime});
  ASSERT_TRUE(store);
  const std::string tag = store->catalogue()->etag();
  const MeshPointer mesh = store->find("1067");
  ASSERT_TRUE(mesh);
  EXPECT_EQ(store->find("1067"), mesh);
  EXPECT_EQ(store->findLog(mesh->log.digest()), mesh);
  EXPECT_NE(store->catalogue()->etag(), tag);
  EXPECT_EQ(unreadOf(*store), (std::vector<std::string>{"1064", "1065", "1066", "1068"}));
  EXPECT_EQ(store->find("nothing"), nullptr);
  EXPECT_FALSE(store->mayHave("nothing")) << "no file has that name";
  const auto change = store->readOn();
  ASSERT_TRUE(change);
  EXPECT_EQ(change->added.size(), 2u) << "what was asked for is reported as well";
}

TEST(MeshStore, aDamagedLogThatIsAskedForIsNotToBeHad) {
  test::TempFolder folder;
  fillWithMore(folder, 3);
  folder.write("1065.qtet", "nonsense");
  folder.write("1066.qtet", "nonsense");
  const auto store = MeshStore::open(folder.path(), {.readTime = kNoTime});
  ASSERT_TRUE(store);
  std::filesystem::remove(folder.path() / "1066.qtet");
  for (const char* id : {"1065", "1066"}) {
    EXPECT_TRUE(store->mayHave(id)) << id;
    EXPECT_EQ(store->find(id), nullptr) << id;
    EXPECT_FALSE(store->mayHave(id)) << id;
  }
  EXPECT_EQ(store->catalogue()->refused.size(), 1u);
}

TEST(MeshStore, aLargeLogThatIsAskedForIsReadFirst) {
  test::TempFolder folder;
  fillWithMore(folder, 5);
  const auto store = MeshStore::open(folder.path(), {.readTime = kNoTime, .maxReadWhenAsked = 10});
  ASSERT_TRUE(store);
  EXPECT_EQ(store->find("1067"), nullptr);
  EXPECT_TRUE(store->mayHave("1067"));
  EXPECT_TRUE(store->awaitUnread({}, std::chrono::hours(1))) << "at once";
  ASSERT_TRUE(store->readOn());
  EXPECT_NE(store->find("1067"), nullptr);
  EXPECT_EQ(store->find("1064"), nullptr);
}

TEST(MeshStore, aStopEndsTheWaitForWork) {
  std::stop_source stop;
  stop.request_stop();
  for (const std::size_t unread : {0, 5}) {
    test::TempFolder folder;
    fillWithMore(folder, unread);
    const auto store = MeshStore::open(folder.path(), {.readTime = kNoTime});
    ASSERT_TRUE(store);
    ASSERT_EQ(store->catalogue()->unread.size(), unread);
    EXPECT_FALSE(store->awaitUnread(stop.get_token(), std::chrono::hours(1)));
  }
}

TEST(MeshStore, namesThatAreNotKnownYetAreServedAllTheSame) {
  const std::size_t files = 600;  // names are read by 256
  test::TempFolder folder, elsewhere;
  const Bytes log = test::makeLog({.chunks = 1, .fields = {}});
  for (std::size_t i = 0; i < files; ++i) folder.write(std::to_string(1000 + i) + ".qtet", log);
  elsewhere.write("a.qtet", log);
  std::filesystem::create_symlink(elsewhere.path() / "a.qtet", folder.path() / "a.qtet");
  const auto store = MeshStore::open(folder.path(), {.readTime = kNoTime, .nameTime = kNoTime});
  ASSERT_TRUE(store);
  EXPECT_FALSE(store->catalogue()->named);
  EXPECT_FALSE(store->catalogue()->complete());
  EXPECT_TRUE(store->catalogue()->meshes.empty());
  EXPECT_TRUE(store->mayHave("1599"));
  EXPECT_NE(store->find("1599"), nullptr);
  for (const char* id : {"a", "nothing", "../a", ""}) {
    EXPECT_EQ(store->find(id), nullptr) << id;
    EXPECT_FALSE(store->mayHave(id)) << id;
  }
  for (int looks = 0; looks < 5 && !store->catalogue()->named; ++looks)
    ASSERT_TRUE(store->readOn());
  EXPECT_TRUE(store->catalogue()->named);
  EXPECT_EQ(store->catalogue()->meshes.size() + store->catalogue()->unread.size(), files);
  EXPECT_EQ(store->catalogue()->meshes.size(), limits::kLogsReadAtOnce + 1);
}

TEST(MeshStore, unreadLogsThatGoAreForgotten) {
  test::TempFolder folder;
  fillWithMore(folder, 3);
  const auto store = MeshStore::open(folder.path(), {.readTime = kNoTime});
  ASSERT_TRUE(store);
  std::filesystem::remove(folder.path() / "1065.qtet");
  ASSERT_TRUE(store->rescan("1064"));
  EXPECT_EQ(unreadOf(*store), std::vector<std::string>{"1066"});
}

TEST(MeshStore, aLogThatWasChangedSinceItWasCheckedIsNotServedUnderItsDigest) {
  test::TempFolder folder;
  folder.write("a.qtet", test::makeLog({.seed = 1}));
  folder.write("b.qtet", test::makeLog({.seed = 2}));
  const auto store = MeshStore::open(folder.path(), {.maxOpen = 1});
  ASSERT_TRUE(store);
  const std::string digest = store->find("b")->log.digest();
  ASSERT_TRUE(store->find("a")) << "and so b is let go";
  folder.write("b.qtet", test::makeLog({.chunks = 5, .seed = 3}));
  EXPECT_EQ(store->find("b"), nullptr);
  EXPECT_EQ(store->findLog(digest), nullptr);
  EXPECT_TRUE(store->mayHave("b")) << "it is known, and to be asked for again";
  EXPECT_EQ(store->rescan()->added.size(), 1u);
  ASSERT_TRUE(store->find("b"));
  EXPECT_NE(store->find("b")->log.digest(), digest);
}

TEST(MeshStore, linksOutOfTheFolderAreNotFollowed) {
  test::TempFolder folder, elsewhere;
  elsewhere.write("a.qtet", test::makeLog({.seed = 1}));
  folder.write("real.qtet", test::makeLog({.seed = 2}));
  std::filesystem::create_symlink(elsewhere.path() / "a.qtet", folder.path() / "a.qtet");
  std::filesystem::create_symlink("real.qtet", folder.path() / "alias.qtet");
  const auto store = MeshStore::open(folder.path());
  ASSERT_TRUE(store);
  EXPECT_EQ(store->find("a"), nullptr);
  EXPECT_NE(store->find("alias"), nullptr);
}

TEST(MeshStore, onlyNamesOfFilesAreMeshes) {
  EXPECT_EQ(pathOfMesh("/d", "a b"), "/d/a b.qtet");
  EXPECT_EQ(pathOfMesh("/d", "\xc3\xa4"), "/d/\xc3\xa4.qtet");
  EXPECT_EQ(pathOfMesh("/d", "\xc2\xa0\xe2\x80\xa7\xe2\x80\xaa"),
            "/d/\xc2\xa0\xe2\x80\xa7\xe2\x80\xaa.qtet");
  EXPECT_TRUE(pathOfMesh("/d", std::string(limits::kMaxIdBytes, 'a')));
  for (const char* control :
       {"a\xc2\x80", "\xc2\x85z", "\xc2\x9f", "a\xe2\x80\xa8", "\xe2\x80\xa9z", "\x7f"})
    EXPECT_FALSE(pathOfMesh("/d", control)) << control;
  for (const std::string& id :
       {std::string(), std::string("a/b"), std::string(".."), std::string(".a"), std::string("a\n"),
        std::string("a\0b", 3), std::string("\xc0\xae"), std::string("\xff"), std::string("a\\b"),
        std::string(limits::kMaxIdBytes + 1, 'a')})
    EXPECT_FALSE(pathOfMesh("/d", id)) << id;
}

TEST(MeshStore, aLevelsPrefixEndsWithItsChunk) {
  test::TempFolder folder;
  folder.write("a.qtet", test::makeLog(test::SyntheticLog()));
  const auto store = MeshStore::open(folder.path());
  ASSERT_TRUE(store);
  const MeshPointer found = store->find("a");
  const ServedMesh& mesh = *found;
  EXPECT_EQ(mesh.prefixBytes(11), mesh.log.bytes().size());
  EXPECT_EQ(mesh.prefixBytes(0), mesh.log.index().chunks[1].offset);
}

/// As `cp` does it, which many people replace files with.
TEST(ServedMesh, aFileThatIsChangedInPlaceStaysWhatItsDigestSays) {
  const test::TempFolder folder;
  const Bytes log = test::makeLog({.chunks = 20});
  folder.write("noise.qtet", log);
  const Result<MeshPointer> mesh = openMesh(folder.path() / "noise.qtet", "noise");
  ASSERT_TRUE(mesh);
  folder.write("noise.qtet", test::makeLog({.chunks = 3, .seed = 9}));
  EXPECT_TRUE(std::ranges::equal((*mesh)->log.bytes(), log));
  EXPECT_TRUE((*mesh)->log.verifyChecksums());
}

TEST(MappedFileLoss, whatIsLostOfAMappedFileReadsAsZeros) {
  guardAgainstBusErrors();
  const test::TempFolder folder;
  folder.write("noise.qtet", test::makeLog({.chunks = 20}));
  const Result<LogFile> log = LogFile::open(folder.path() / "noise.qtet");
  ASSERT_TRUE(log);
  ASSERT_GT(log->bytes().size(), 3u * 4096);
  const std::uint64_t before = lostPages();
  std::filesystem::resize_file(folder.path() / "noise.qtet", 4096);
  EXPECT_EQ(log->bytes().back(), 0);
  EXPECT_GT(lostPages(), before);
  EXPECT_FALSE(log->verifyChecksums());
}

}  // namespace
}  // namespace qtet
