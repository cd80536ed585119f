#include "simplify/read/process/trial_process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>

namespace qtet {
namespace {

using namespace std::chrono_literals;

TEST(TrialProcess, whatComesToItsEndIsDoneAlsoByAnException) {
  EXPECT_EQ(tryOut([] {}, 60s), TrialEnd::kDone);
  EXPECT_EQ(tryOut([] { throw std::runtime_error("said later"); }, 60s), TrialEnd::kDone);
}

TEST(TrialProcess, aCrashIsTold) {
  EXPECT_EQ(tryOut([] { std::abort(); }, 60s), TrialEnd::kCrashed);
}

TEST(TrialProcess, whatReadsNothingForTooLongIsEnded) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(tryOut(
                [] {
                  for (;;) (void)::getppid();
                },
                1s),
            TrialEnd::kStuck);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 60s);
}

TEST(TrialProcess, whatReadsOnIsWaitedFor) {
  EXPECT_EQ(tryOut(
                [] {
                  for (int i = 0; i < 30; ++i) {
                    std::ifstream file("/proc/self/stat");
                    std::string word;
                    file >> word;
                    std::this_thread::sleep_for(100ms);
                  }
                },
                2s),
            TrialEnd::kDone);
}

TEST(TrialProcess, refusedMemoryIsTold) {
  EXPECT_EQ(tryOut([] { throw std::bad_alloc(); }, 60s), TrialEnd::kOutOfMemory);
}

// A reader that never ends used to run on at full load when the tool was killed.
TEST(TrialProcess, itEndsWithTheProcessThatMadeIt) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t tool = ::fork();
  if (tool == 0) {
    (void)tryOut(
        [&] {
          const pid_t self = ::getpid();
          (void)!::write(ends[1], &self, sizeof self);
          ::pause();
        },
        60s);
    ::_exit(0);
  }
  pid_t trial = 0;
  ASSERT_EQ(::read(ends[0], &trial, sizeof trial), static_cast<ssize_t>(sizeof trial));
  ::kill(tool, SIGKILL);
  ASSERT_EQ(::waitpid(tool, nullptr, 0), tool);
  ::close(ends[1]);
  char none = 0;
  EXPECT_EQ(::read(ends[0], &none, 1), 0) << "the pipe's last writer has gone";
  ::close(ends[0]);
}

}  // namespace
}  // namespace qtet
