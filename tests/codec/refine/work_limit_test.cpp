// The bytes received bound a reader's work, however much work decisions of almost no cost ask for.
#include <gtest/gtest.h>

#include "codec/log/log_writer.h"
#include "codec/log/work_meter.h"
#include "codec/refine/log_file.h"
#include "proto/limits.h"
#include "simplify/fuse/qtetfusion.h"
#include "tests/support/cheap_log.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

using testing::CheapLog;

constexpr std::uint32_t kVertices = CheapLog::kVertices;

TEST(WorkLimit, stepsThatTheBytesAllowAreTaken) {
  const CheapLog log(100);
  Refiner refiner(log.index);
  const Status status = log.decode(refiner);
  ASSERT_TRUE(status) << status.error().text();
  EXPECT_GT(refiner.steps(), 100u * (kVertices - 1000));
}

TEST(WorkLimit, aLogThatAsksForMinutesOfWorkIsRefused) {
  const CheapLog log(250);
  const std::size_t bytes = log.structure[0].size() + log.structure[1].size();
  EXPECT_LT(bytes, 4000u);
  Refiner refiner(log.index);
  const Status status = log.decode(refiner);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::kLimitExceeded) << status.error().text();
  EXPECT_NE(status.error().message.find("work"), std::string::npos);
  EXPECT_LE(refiner.steps(), kMaxStepsPerByte * (bytes + kFreeStepBytes) + kMaxLinkTriangles + 1);
}

TEST(WorkLimit, aBaseMeshOfTooManyCellsForItsBytesIsRefusedBeforeItsCellsAreRead) {
  const CheapLog log(1);
  LogIndex index = log.index;
  const auto allowed =
      static_cast<std::uint32_t>(kMaxStepsPerByte * (log.structure[0].size() + kFreeStepBytes));
  for (const auto& [cells, code] : {std::pair{allowed, ErrorCode::kBadValue},
                                    std::pair{allowed + 1, ErrorCode::kLimitExceeded}}) {
    index.chunks[0].newTetrahedra = cells;
    Refiner refiner(index);
    const Status status = refiner.apply(0, log.structure[0], log.positions[0]);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, code) << status.error().text();
  }
}

TEST(WorkLimit, theMeterAllowsWhatBytesGrant) {
  WorkMeter meter;
  meter.grant(10);
  meter.spend(kMaxStepsPerByte * (kFreeStepBytes + 10));
  EXPECT_FALSE(meter.isExceeded());
  meter.spend(1);
  EXPECT_TRUE(meter.isExceeded());
}

TEST(WorkLimit, writersCountTheStepsThatReadersTake) {
  FusionOptions options;
  options.targetRatio = 0;
  const auto log = encodeLog(simplify(testing::gridMesh(9, 3), options).value(), {});
  ASSERT_TRUE(log) << log.error().text();
  const LogFile file = LogFile::fromBytes(log->bytes).value();
  Refiner refiner(file.index());
  for (std::uint32_t chunk = 0; chunk < file.index().chunks.size(); ++chunk)
    ASSERT_TRUE(applyChunk(file, refiner, chunk, {}));
  EXPECT_GE(file.index().chunks.size(), 3u);
  EXPECT_EQ(refiner.steps(), log->statistics.steps);
  EXPECT_LT(refiner.steps(), kMaxStepsPerByte / 16 * log->bytes.size());
}

}  // namespace
}  // namespace qtet
