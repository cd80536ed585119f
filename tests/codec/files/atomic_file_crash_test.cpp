// Tests a writer that fails, or is killed, at any of its system calls; a full disk; and the files
// that a killed writer leaves.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/file.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <functional>

#include "codec/files/atomic_file.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kOldBytes = 3000;
constexpr std::size_t kNewBytes = 5000;
constexpr std::size_t kStep = 1500;  // bytes a write takes at most, so that one file needs several

Bytes noise(std::size_t count, std::uint8_t seed) {
  Bytes out(count);
  for (std::size_t i = 0; i < count; ++i)
    out[i] = static_cast<std::uint8_t>(i * 131 + i / 256 * 7 + seed);
  return out;
}
const Bytes& oldBytes() {
  static const Bytes bytes = noise(kOldBytes, 1);
  return bytes;
}
const Bytes& newBytes() {
  static const Bytes bytes = noise(kNewBytes, 2);
  return bytes;
}

Bytes bytesIn(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(file), {});
}

std::vector<std::string> namesIn(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

/// The real calls, counted; at the chosen one `happens` decides. A write takes kStep bytes, so
/// short writes are met on the way.
class ChosenCall final : public FileCalls {
 public:
  enum class Fate { kFail, kKillBefore, kKillAfter };
  ChosenCall(int chosen, Fate fate, int number = EIO)
      : chosen_(chosen), fate_(fate), number_(number) {}

  [[nodiscard]] int made() const { return made_; }
  [[nodiscard]] const std::string& failed() const { return failed_; }
  [[nodiscard]] const std::vector<fs::path>& opened() const { return opened_; }

  int open(const char* path, int flags, mode_t mode) override {
    opened_.emplace_back(path);
    return call("open", [&] { return real_.open(path, flags, mode); });
  }
  int lock(int file, int operation) override {
    return call("lock", [&] { return real_.lock(file, operation); });
  }
  int sync(int file) override {
    return call("sync", [&] { return real_.sync(file); });
  }
  int rename(const char* from, const char* to) override {
    return call("rename", [&] { return real_.rename(from, to); });
  }
  int unlink(const char* path) override {
    return call("unlink", [&] { return real_.unlink(path); });
  }
  int close(int file) override {
    // A close that fails has closed all the same.
    const auto really = [&] { return real_.close(file); };
    if (made_ == chosen_ && fate_ == Fate::kFail) really();
    return call("close", really);
  }
  ssize_t write(int file, const std::uint8_t* bytes, std::size_t count) override {
    return call("write", [&] { return real_.write(file, bytes, std::min(count, kStep)); });
  }

 private:
  template <class Call>
  auto call(const char* name, const Call& really) -> decltype(really()) {
    const bool chosen = made_++ == chosen_;
    if (chosen && fate_ == Fate::kKillBefore) ::raise(SIGKILL);
    if (chosen && fate_ == Fate::kFail) {
      failed_ = name;
      errno = number_;
      return -1;
    }
    const auto result = really();
    if (chosen && fate_ == Fate::kKillAfter) ::raise(SIGKILL);
    return result;
  }

  FileCalls& real_ = systemFileCalls();
  int chosen_;
  Fate fate_;
  int number_;
  int made_ = 0;
  std::string failed_;
  std::vector<fs::path> opened_;
};

/// Runs `work` in a process of its own; the wait status.
int inChild(const std::function<int()>& work) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(work());
  int status = -1;
  ::waitpid(child, &status, 0);
  return status;
}

int callsOfOneWrite(const fs::path& path) {
  ChosenCall counting(-1, ChosenCall::Fate::kFail);
  EXPECT_TRUE(writeFileAtomically(path, newBytes(), counting));
  EXPECT_EQ(bytesIn(path), newBytes());
  return counting.made();
}

class AtomicFileCrash : public ::testing::Test {
 protected:
  void SetUp() override {
    calls_ = callsOfOneWrite(path_);
    ASSERT_GE(calls_, 10);  // opens, a lock, four writes, two flushes, a rename, closes
    startAnew();
  }
  void startAnew() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(oldBytes().data()),
               static_cast<std::streamsize>(kOldBytes));
  }

  fs::path folder_ = testing::freshFolder(
      std::string("crash-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
  fs::path path_ = folder_ / "a.qtet";
  int calls_ = 0;
};

TEST_F(AtomicFileCrash, aCallThatFailsLeavesTheOldFileAndNothingBeside) {
  int refused = 0;
  for (const int number : {EIO, ENOSPC, EDQUOT})
    for (int n = 0; n < calls_; ++n) {
      startAnew();
      ChosenCall calls(n, ChosenCall::Fate::kFail, number);
      const Status status = writeFileAtomically(path_, newBytes(), calls);
      EXPECT_EQ(namesIn(folder_), std::vector<std::string>{"a.qtet"})
          << "call " << n << ", " << calls.failed();
      if (status) {  // only what is of no consequence may fail unnoticed
        EXPECT_TRUE(calls.failed() == "lock" || calls.failed() == "close") << calls.failed();
        EXPECT_EQ(bytesIn(path_), newBytes());
        continue;
      }
      ++refused;
      EXPECT_EQ(status.error().code, ErrorCode::kIo);
      const std::string& message = status.error().message;
      EXPECT_NE(message.find(std::strerror(number)), std::string::npos) << message;
      EXPECT_NE(message.find(folder_.string()), std::string::npos) << message;
      const bool written = message.find("is written") != std::string::npos;
      EXPECT_EQ(bytesIn(path_), written ? newBytes() : oldBytes()) << message;
      EXPECT_EQ(written,
                calls.failed() == "sync" && calls.made() > n + 1 && bytesIn(path_) == newBytes())
          << message;
    }
  EXPECT_EQ(refused, 3 * 9);  // two opens, four writes, two flushes, the rename
}

TEST_F(AtomicFileCrash, anInterruptedWriteGoesOn) {
  for (int n = 0; n < calls_; ++n) {
    startAnew();
    ChosenCall calls(n, ChosenCall::Fate::kFail, EINTR);
    const Status status = writeFileAtomically(path_, newBytes(), calls);
    if (calls.failed() != "write") continue;
    EXPECT_TRUE(status) << status.error().text();
    EXPECT_EQ(bytesIn(path_), newBytes());
  }
}

TEST_F(AtomicFileCrash, aWriterKilledAtAnyCallLeavesTheOldFileOrTheWholeNewOne) {
  std::size_t oldKept = 0, newThere = 0, leftOvers = 0;
  for (const auto fate : {ChosenCall::Fate::kKillBefore, ChosenCall::Fate::kKillAfter})
    for (int n = 0; n < calls_; ++n) {
      startAnew();
      const int status = inChild([&] {
        ChosenCall calls(n, fate);
        return writeFileAtomically(path_, newBytes(), calls) ? 0 : 1;
      });
      ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL)
          << "call " << n << ": " << status;
      const Bytes content = bytesIn(path_);
      ASSERT_TRUE(content == oldBytes() || content == newBytes())
          << "call " << n << " left " << content.size() << " bytes";
      (content == oldBytes() ? oldKept : newThere) += 1;
      const auto names = namesIn(folder_);
      ASSERT_LE(names.size(), 2u);
      leftOvers += names.size() - 1;

      ASSERT_TRUE(writeFileAtomically(path_, newBytes()));
      EXPECT_EQ(bytesIn(path_), newBytes());
      EXPECT_EQ(namesIn(folder_), std::vector<std::string>{"a.qtet"})
          << "the next writer cleans up after a death at call " << n;
    }
  EXPECT_GT(oldKept, 10u);
  EXPECT_GT(newThere, 2u);
  EXPECT_GT(leftOvers, 8u);
}

TEST_F(AtomicFileCrash, theTemporaryFileOfALivingWriterIsLetAlone) {
  const fs::path living = folder_ / ".a.qtet.1.0.tmp", stale = folder_ / ".a.qtet.1.1.tmp";
  const std::vector<fs::path> others{folder_ / ".a.qtet.bak.tmp", folder_ / ".b.qtet.1.0.tmp",
                                     folder_ / ".a.qtet.1.0.tmp2", folder_ / "a.qtet.1.0.tmp"};
  for (const fs::path& name : others) std::ofstream(name) << "not ours";
  std::ofstream(living) << "half";
  std::ofstream(stale) << "half";
  const int lock = ::open(living.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(lock, LOCK_EX), 0);
  ASSERT_TRUE(writeFileAtomically(path_, newBytes()));
  EXPECT_TRUE(fs::exists(living));
  EXPECT_FALSE(fs::exists(stale));
  for (const fs::path& name : others) EXPECT_TRUE(fs::exists(name)) << name;
  ::close(lock);
}

TEST_F(AtomicFileCrash, aNameThatIsTakenIsNotWrittenOver) {
  // A file that a process of this number is writing on another machine with the same disk. It is
  // locked, so not stale.
  ChosenCall counting(-1, ChosenCall::Fate::kFail);
  ASSERT_TRUE(writeFileAtomically(path_, newBytes(), counting));
  // .a.qtet.PROCESS.NUMBER.tmp
  const int used = std::stoi(counting.opened().back().stem().extension().string().substr(1));
  std::vector<fs::path> taken;
  std::vector<int> locks;
  for (int i = 1; i <= 50; ++i) {
    const fs::path& name = taken.emplace_back(folder_ / (".a.qtet." + std::to_string(::getpid()) +
                                                         "." + std::to_string(used + i) + ".tmp"));
    std::ofstream(name) << "theirs";
    locks.push_back(::open(name.c_str(), O_RDONLY | O_CLOEXEC));
    ASSERT_EQ(::flock(locks.back(), LOCK_EX), 0);
  }
  ChosenCall calls(-1, ChosenCall::Fate::kFail);
  EXPECT_TRUE(writeFileAtomically(path_, oldBytes(), calls));
  EXPECT_EQ(bytesIn(path_), oldBytes());
  EXPECT_GT(calls.opened().size(), 100u);  // every one as a stale one, and then as its own
  for (const fs::path& name : taken) EXPECT_EQ(fs::file_size(name), 6u) << name;
  for (const int lock : locks) ::close(lock);
}

TEST_F(AtomicFileCrash, writersAtTheSameTimeLeaveOneWholeFile) {
  std::vector<pid_t> children;
  for (std::uint8_t seed = 10; seed < 14; ++seed) {
    const pid_t child = ::fork();
    if (child == 0) {
      int failures = 0;
      for (int i = 0; i < 50; ++i) failures += !writeFileAtomically(path_, noise(kNewBytes, seed));
      ::_exit(failures);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = -1;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  const Bytes content = bytesIn(path_);
  EXPECT_TRUE(content == noise(kNewBytes, 10) || content == noise(kNewBytes, 11) ||
              content == noise(kNewBytes, 12) || content == noise(kNewBytes, 13));
  EXPECT_EQ(namesIn(folder_), std::vector<std::string>{"a.qtet"});
}

/// In a child: whether a write of 200 KB over the old file fails with `number` and leaves all as it
/// was. Exit codes, for EXPECT_EQ.
int failsCleanly(const fs::path& path, int number) {
  const Status status = writeFileAtomically(path, noise(200'000, 3));
  if (status) return 10;
  if (status.error().code != ErrorCode::kIo ||
      status.error().message.find(std::strerror(number)) == std::string::npos)
    return 11;
  if (status.error().message.find(path.string()) == std::string::npos) return 12;
  if (bytesIn(path) != oldBytes()) return 13;
  return namesIn(path.parent_path()) == std::vector<std::string>{path.filename().string()} ? 0 : 14;
}

TEST_F(AtomicFileCrash, aFileAboveTheUsersLimitIsAnErrorLikeAnyOther) {
  const int status = inChild([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{64 << 10, 64 << 10};
    return ::setrlimit(RLIMIT_FSIZE, &limit) == 0 ? failsCleanly(path_, EFBIG) : 1;
  });
  ASSERT_TRUE(WIFEXITED(status)) << status;
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST_F(AtomicFileCrash, aFullDiskLeavesTheOldFile) {
  constexpr int kCannotMount = 77;
  const fs::path disk = folder_ / "disk";
  fs::create_directories(disk);
  const int status = inChild([&] {
    // A disk of 64 KB that lives as long as this process: as root or, where users may, in a
    // namespace of its own.
    if (::unshare(CLONE_NEWNS) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0)
      return kCannotMount;
    if (::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return kCannotMount;
    if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=64k") != 0) return kCannotMount;
    if (!writeFileAtomically(disk / "a.qtet", oldBytes())) return 1;
    return failsCleanly(disk / "a.qtet", ENOSPC);
  });
  ASSERT_TRUE(WIFEXITED(status)) << status;
  if (WEXITSTATUS(status) == kCannotMount)
    GTEST_SKIP() << "this machine lets nobody mount a small disk";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace qtet
