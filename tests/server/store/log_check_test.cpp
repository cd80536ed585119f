// Tests the check's answer to a log: sound or not, and at each limit and past it.
#include "server/store/log_check.h"

#include <gtest/gtest.h>

#include "codec/log/decoding_memory.h"
#include "tests/server/program/loopback.h"
#include "tests/server/store/synthetic_log.h"
#include "tests/support/meshes.h"
#include "tests/support/written_log.h"

namespace qtet {
namespace {

using End = CheckVerdict::End;

class LogCheckTest : public ::testing::Test {
 protected:
  MeshPointer open(const Bytes& log) const {
    folder_.write("a.qtet", log);
    return openMesh(folder_.path() / "a.qtet", "a").value();
  }

  test::TempFolder folder_;
  const CheckLimits enough_{.time = test::kNever};
};

TEST_F(LogCheckTest, aSoundLogHasNoAnswerAndNoiseHasOne) {
  EXPECT_EQ(checkLog(*open(testing::logBytes(testing::soundMesh(8, 1))), enough_, {}).end,
            End::kSound);
  EXPECT_EQ(checkLog(*open(test::makeLog({})), enough_, {}).end, End::kUnsound);
}

TEST_F(LogCheckTest, theFirstByteBeyondTheLimitOfMemoryIsTooMuch) {
  const MeshPointer mesh = open(testing::logBytes(testing::soundMesh(6, 1)));
  const std::uint64_t needed = decodingBytes(mesh->log.index());
  EXPECT_EQ(checkLog(*mesh, {.bytes = needed, .time = test::kNever}, {}).end, End::kSound);
  EXPECT_EQ(checkLog(*mesh, {.bytes = needed - 1, .time = test::kNever}, {}).end, End::kTooLarge);
  EXPECT_EQ(checkLog(*open(test::makeLog({})), {.bytes = 0, .time = test::kNever}, {}).end,
            End::kTooLarge)
      << "before a block is looked at";
}

TEST_F(LogCheckTest, timeThatIsOverAndAStopAreToldApart) {
  const MeshPointer mesh = open(testing::logBytes(testing::soundMesh(6, 1)));
  EXPECT_EQ(checkLog(*mesh, {.time = std::chrono::milliseconds(0)}, {}).end, End::kTooLarge);
  std::stop_source stop;
  stop.request_stop();
  const auto stopped = checkLog(*mesh, {.time = std::chrono::milliseconds(0)}, stop.get_token());
  EXPECT_EQ(stopped.end, End::kBusy);
}

}  // namespace
}  // namespace qtet
