// Levels and checks in processes of their own: the same bytes, and nobody else notices when one
// dies.
#include "server/decode/decoders.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <thread>

#include "server/decode/confinement.h"
#include "server/decode/decode_task.h"
#include "server/store/level_maker.h"
#include "tests/server/program/loopback.h"
#include "tests/server/store/synthetic_log.h"
#include "tests/support/meshes.h"
#include "tests/support/paths/test_paths.h"
#include "tests/support/written_log.h"

namespace qtet {
namespace {

constexpr std::chrono::milliseconds kEnoughTime{9};

class DecodersTest : public ::testing::Test {
 protected:
  MeshPointer open(const std::string& name, const Bytes& log) const {
    folder_.write(name + ".qtet", log);
    return openMesh(folder_.path() / (name + ".qtet"), name).value();
  }
  [[nodiscard]] LevelRequest finest(LevelForm form = LevelForm::kVtu) const {
    return {mesh_, mesh_->manifest.levels.back().level, form, {0}};
  }
  static Bytes bytesOf(const LevelFile& file) { return {file.bytes.begin(), file.bytes.end()}; }
  static DecoderOptions options(std::size_t processes) {
    return {processes, 1u << 30, testing::kServerProgram};
  }
  /// Makes the level while its process stands still, and ends that by the signal.
  Result<LevelFile> whileKilled(Decoders& decoders, int signal) {
    const pid_t process = decoders.processes().front();
    ::kill(process, SIGSTOP);
    std::jthread killer([&] {
      while (decoders.counts().running == 0) std::this_thread::yield();
      ::kill(process, signal);
      ::kill(process, SIGCONT);
    });
    return decoders.level(finest(), {});
  }

  test::TempFolder folder_;
  MeshPointer mesh_ = open("a", testing::logBytes(testing::soundMesh(8, 1)));
  const CheckLimits enough_{.time = test::kNever};
};

TEST_F(DecodersTest, levelsHaveTheBytesThatThisProcessMakes) {
  Decoders decoders(options(1));
  const MeshPointer other = open("b", testing::logBytes(testing::soundMesh(6, 2)));
  for (const LevelForm form : {LevelForm::kVtu, LevelForm::kGlb, LevelForm::kObj})
    for (const MeshPointer& mesh : {mesh_, other}) {
      LevelRequest request = finest(form);
      request.mesh = mesh, request.level = mesh->manifest.levels.back().level;
      request.coding = form == LevelForm::kObj ? ContentCoding::kGzip : ContentCoding::kIdentity;
      const Result<LevelFile> made = decoders.level(request, {});
      ASSERT_TRUE(made) << made.error().text();
      EXPECT_EQ(bytesOf(*made), makeLevel(request, {}).value()) << formName(form);
    }
  EXPECT_EQ(decoders.counts().lost, 0u);
}

TEST_F(DecodersTest, errorsAndVerdictsComeThroughWhole) {
  Decoders decoders(options(1));
  LevelRequest outside = finest(LevelForm::kJson);
  outside.point = {1e9, 0, 0};
  const Error here = makeLevel(outside, {}).error();
  const Result<LevelFile> there = decoders.level(outside, {});
  ASSERT_FALSE(there);
  EXPECT_EQ(there.error().text(), here.text());

  EXPECT_EQ(decoders.check(*mesh_, enough_, {}).end, CheckVerdict::End::kSound);
  const MeshPointer noise = open("noise", test::makeLog({}));
  EXPECT_EQ(decoders.check(*noise, enough_, {}).reason, checkLog(*noise, enough_, {}).reason);
  EXPECT_EQ(decoders.check(*mesh_, {.bytes = 0}, {}).end, CheckVerdict::End::kTooLarge);
}

TEST_F(DecodersTest, aProcessThatDiesIsAnErrorOfItsOwnTaskAlone) {
  Decoders decoders(options(1));
  for (const auto& [signal, says] :
       {std::pair{SIGSEGV, "signal 11"}, {SIGXCPU, "too much processor time"}}) {
    const Result<LevelFile> died = whileKilled(decoders, signal);
    ASSERT_FALSE(died);
    EXPECT_EQ(died.error().code, ErrorCode::kIo);
    EXPECT_NE(died.error().message.find(says), std::string::npos) << died.error().message;
    EXPECT_TRUE(decoders.level(finest(), {})) << "by the next process";
  }
  EXPECT_EQ(decoders.counts().lost, 2u);

  const pid_t idle = decoders.processes().front();
  ::kill(idle, SIGKILL);
  siginfo_t end{};
  ASSERT_EQ(::waitid(P_PID, static_cast<id_t>(idle), &end, WEXITED | WNOWAIT), 0);
  EXPECT_TRUE(decoders.level(finest(), {})) << "one that died idle is replaced before the task";
  EXPECT_EQ(decoders.counts().running, 0u);
}

TEST_F(DecodersTest, aProcessThatAnswersNonsenseIsEnded) {
  // /bin/cat is no decoder: it sends nothing, and ends.
  DecoderOptions given = options(1);
  given.program = "/bin/cat";
  Decoders decoders(given);
  const Result<LevelFile> made = decoders.level(finest(), {});
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("ended with code"), std::string::npos);
  EXPECT_EQ(decoders.check(*mesh_, enough_, {}).end, CheckVerdict::End::kFailed);
}

TEST(DecodeTask, messagesComeBackAndNoOthersAreUnderstood) {
  LevelTask level{"d", {nullptr, 7, LevelForm::kCsv, {1, 300}, ContentCoding::kZstd, {"a", ""}}};
  level.request.point = {1.5, -2, 1e300};
  for (const DecodeTask& task :
       {DecodeTask(level), DecodeTask(CheckTask{{5, kEnoughTime}}), DecodeTask(StopTask())}) {
    const Bytes message = messageOf(task);
    const Result<DecodeTask> back = taskOf(message);
    ASSERT_TRUE(back);
    EXPECT_EQ(messageOf(*back), message);
    EXPECT_FALSE(answerOf(message));
  }
  const Error error{ErrorCode::kNotFound, "outside", 12};
  for (const DecodeAnswer& answer :
       {DecodeAnswer(DecoderReady{true}), DecodeAnswer(LevelEnd{}),
        DecodeAnswer(LevelEnd{std::unexpected(error)}),
        DecodeAnswer(CheckVerdict{CheckVerdict::End::kFailed, "why"})}) {
    const Bytes message = messageOf(answer);
    const Result<DecodeAnswer> back = answerOf(message);
    ASSERT_TRUE(back);
    EXPECT_EQ(messageOf(*back), message);
    EXPECT_FALSE(taskOf(message));
    // A process that was taken over may say anything.
    for (std::size_t size = 0; size < message.size(); ++size)
      EXPECT_FALSE(answerOf(ByteView(message).first(size)));
    for (std::size_t at = 0; at < message.size(); ++at)
      for (int bit = 0; bit < 8; ++bit) {
        Bytes other = message;
        other[at] ^= static_cast<std::uint8_t>(1 << bit);
        (void)answerOf(other);
      }
    Bytes longer = message;
    longer.push_back(0);
    EXPECT_FALSE(answerOf(longer));
  }
}

TEST_F(DecodersTest, aStopEndsAProcessThatDoesNotHeedIt) {
  Decoders decoders(options(1));
  ::kill(decoders.processes().front(), SIGSTOP);
  std::stop_source stop;
  stop.request_stop();
  const Result<LevelFile> stopped = decoders.level(finest(), stop.get_token());
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
  EXPECT_EQ(decoders.counts().lost, 0u);
  EXPECT_TRUE(decoders.level(finest(), {}));

  const pid_t heeding = decoders.processes().front();
  EXPECT_FALSE(decoders.level(finest(), stop.get_token()));
  EXPECT_EQ(decoders.check(*mesh_, enough_, stop.get_token()).end, CheckVerdict::End::kBusy);
  EXPECT_EQ(decoders.processes().front(), heeding);
}

TEST_F(DecodersTest, aLevelLeavesTheProcessAloneThatHasTheMeshForPoints) {
  Decoders decoders(options(2));
  LevelRequest point = finest(LevelForm::kJson);
  point.point = {1e9, 0, 0};
  EXPECT_FALSE(decoders.level(point, {}));
  const pid_t first = decoders.processes().front();
  ::kill(first, SIGSTOP);
  EXPECT_TRUE(decoders.level(finest(), {})) << "by the other one";
  ::kill(first, SIGCONT);
  EXPECT_FALSE(decoders.level(point, {}));
}

TEST_F(DecodersTest, aLevelHasRoomForSoManyBytesAndNoMore) {
  const std::uint64_t size = makeLevel(finest(), {}).value().size();
  for (const std::uint64_t room : {size - 1, size, size + 1}) {
    DecoderOptions given = options(1);
    given.levelBytes = room;
    Decoders decoders(given);
    EXPECT_EQ(decoders.level(finest(), {}).has_value(), room >= size) << room;
    EXPECT_EQ(decoders.counts().lost, 0u);
  }
}

TEST_F(DecodersTest, aProgramThatCannotBeStartedIsAnError) {
  DecoderOptions given = options(2);
  given.program = folder_.path() / "none";
  Decoders decoders(given);
  EXPECT_EQ(decoders.level(finest(), {}).error().code, ErrorCode::kIo);
  EXPECT_EQ(decoders.check(*mesh_, enough_, {}).end, CheckVerdict::End::kFailed);
}

/// In a process of its own, since there is no way back.
[[noreturn]] void tryEverything() {
  if (!confine()) ::_exit(1);
  const auto refused = [](long result) { return result == -1 && errno == EPERM; };
  const bool held =
      refused(::open("/etc/passwd", O_RDONLY)) && refused(::socket(AF_INET, SOCK_STREAM, 0)) &&
      refused(::fork()) && refused(::execl("/bin/true", "true", nullptr)) &&
      refused(::kill(::getppid(), SIGTERM)) &&
      ::mmap(nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) ==
          MAP_FAILED &&
      ::mmap(nullptr, 4096, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) != MAP_FAILED;
  ::_exit(held ? 0 : 2);
}

TEST(Confinement, nothingIsLeftButComputing) {
  EXPECT_EXIT(tryEverything(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace qtet
