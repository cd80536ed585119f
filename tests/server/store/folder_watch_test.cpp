#include "server/store/folder_watch.h"

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <mutex>

#include "server/store/mesh_store.h"
#include "tests/server/program/loopback.h"
#include "tests/server/program/served_folder.h"

namespace qtet {
namespace {

using test::eventually;

TEST(FolderWatch, newReplacedAndRemovedLogsAppearWithoutARestart) {
  test::TempFolder folder;
  folder.write("a.qtet", test::makeLog({.seed = 1}));
  const auto store = MeshStore::open(folder.path());
  ASSERT_TRUE(store);
  const auto watch = FolderWatch::start(folder.path(), [&] { (void)store->rescan(); });
  ASSERT_TRUE(watch);
  const ViewerFiles viewer;
  test::RunningServer server(*store, viewer);
  const auto status = [&](const char* target) {
    return test::RawClient(server.port()).get(target).status;
  };

  test::StreamClient stream(server.port());
  ASSERT_TRUE(stream.send(R"({"type":"open","mesh":"a","credit":1})"));
  const std::string opened = stream.receive()->text();
  const MeshPointer old = store->find("a");

  folder.write("b.qtet", test::makeLog({.seed = 2}));
  EXPECT_TRUE(eventually([&] { return status("/v1/meshes/b") == 200; }));
  folder.write("c.tmp", test::makeLog({.seed = 3}));
  std::filesystem::rename(folder.path() / "c.tmp", folder.path() / "a.qtet");
  EXPECT_TRUE(eventually([&] { return store->find("a") != old; }));
  std::filesystem::remove(folder.path() / "b.qtet");
  EXPECT_TRUE(eventually([&] { return status("/v1/meshes/b") == 404; }));

  ASSERT_TRUE(stream.send(R"({"type":"credit","bytes":100000000})"));
  std::size_t bytes = 0;
  for (auto message = stream.receive(); message && message->binary; message = stream.receive())
    bytes += message->bytes.size() - FrameHeader::kBytes;
  EXPECT_NE(opened.find(old->log.digest()), std::string::npos);
  EXPECT_NE(opened.find("\"planned\":" + std::to_string(bytes)), std::string::npos)
      << "the stream finishes on the old file";
}

TEST(FolderWatch, aFolderThatNeverRestsIsReadAllTheSame) {
  test::TempFolder folder;
  std::atomic<bool> read = false;
  const auto watch = FolderWatch::start(folder.path(), [&] { read = true; });
  ASSERT_TRUE(watch);
  EXPECT_TRUE(eventually([&] {
    folder.write("busy", std::string_view("again"));
    return read.load();
  }));
}

TEST(FolderWatch, aFolderThatIsNotThereIsAnError) {
  const auto watch = FolderWatch::start("/nonexistent", [] {});
  ASSERT_FALSE(watch);
  EXPECT_EQ(watch.error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace qtet
