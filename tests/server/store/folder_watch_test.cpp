#include "server/store/folder_watch.h"

#include <gtest/gtest.h>
#include <sys/inotify.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstring>
#include <iterator>
#include <mutex>
#include <string_view>

#include "server/store/mesh_store.h"
#include "tests/server/program/loopback.h"
#include "tests/server/program/served_folder.h"

namespace qtet {
namespace {

using test::eventually;

/// An event as the kernel writes it: its name ends with zeros.
Bytes eventOf(std::string_view name) {
  inotify_event event{};
  event.mask = IN_CLOSE_WRITE;
  event.len = name.empty() ? 0 : static_cast<std::uint32_t>((name.size() / 16 + 1) * 16);
  Bytes out(sizeof(event) + event.len);
  std::memcpy(out.data(), &event, sizeof(event));
  std::ranges::copy(name, out.begin() + sizeof(event));
  return out;
}

TEST(FolderWatch, onlyEventsOfLogsCount) {
  Bytes others;
  for (const char* name : {"#10977484", ".upload-a.qtet", "notes.txt", "a.qtet.tmp"}) {
    EXPECT_FALSE(tellOfLogs(eventOf(name))) << name;
    std::ranges::copy(eventOf(name), std::back_inserter(others));
  }
  EXPECT_FALSE(tellOfLogs(others));
  EXPECT_FALSE(tellOfLogs({}));
  for (const char* name : {"a.qtet", "a name of sixteen or more.qtet", ""}) {
    Bytes events = others;
    std::ranges::copy(eventOf(name), std::back_inserter(events));
    EXPECT_TRUE(tellOfLogs(events)) << name;
  }
}

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
  for (const char* busy : {"busy.qtet", "busy"}) {
    test::TempFolder folder;
    std::atomic<bool> read = false;
    const auto watch = FolderWatch::start(folder.path(), [&] { read = true; });
    ASSERT_TRUE(watch);
    folder.write("a.qtet", std::string_view("once"));
    EXPECT_TRUE(eventually([&] {
      folder.write(busy, std::string_view("again"));
      return read.load();
    })) << busy;
  }
}

TEST(FolderWatch, aFolderThatIsNotThereIsAnError) {
  const auto watch = FolderWatch::start("/nonexistent", [] {});
  ASSERT_FALSE(watch);
  EXPECT_EQ(watch.error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace qtet
