// A level that is written field after field is the file of the whole level.
#include "codec/refine/write_level.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "codec/files/mesh_file.h"
#include "codec/mesh/mesh.h"
#include "codec/refine/level_fields.h"
#include "codec/refine/refiner.h"
#include "tests/support/series_mesh.h"
#include "tests/support/written_log.h"

namespace qtet {
namespace {

class WriteLevel : public ::testing::Test {
 protected:
  static std::vector<std::uint32_t> upTo(std::uint32_t end) {
    std::vector<std::uint32_t> out(end);
    std::iota(out.begin(), out.end(), 0u);
    return out;
  }

  // 9 instants of points, predicted from each other; 3 of cells
  const LogFile log_ = LogFile::fromBytes(testing::logBytes(testing::seriesMesh(4, 3, 9))).value();
  const std::uint32_t last_ = log_.index().chunks.back().lastLevel;
};

TEST_F(WriteLevel, isTheFileOfTheWholeLevel) {
  for (const std::string ending : {".vtu", ".vtk", ".msh", ".obj", ".usda"})
    for (const std::uint32_t level : {0u, last_ / 2, last_})
      for (const std::vector<std::uint32_t>& fields :
           {upTo(12), {}, std::vector<std::uint32_t>{3, 8, 10}}) {
        LatticeMesh whole = meshAtLevel(log_, level, fields).value();
        std::vector<std::string> names;
        for (std::size_t i = 0; i < fields.size(); ++i) names.push_back("n" + std::to_string(i));
        for (const bool renamed : {false, true}) {
          for (std::size_t i = 0; renamed && i < names.size(); ++i) whole.fields[i].name = names[i];
          Bytes pieces;
          ASSERT_TRUE(writeLevel(
              log_, level, fields,
              renamed ? std::span<const std::string>(names) : std::span<const std::string>(),
              ending, appendTo(pieces)));
          EXPECT_EQ(pieces, meshFileBytes(whole, ending).value()) << ending << level;
        }
      }
}

TEST_F(WriteLevel, theSinksErrorAndAStopEndIt) {
  for (int most = 0; most < 5; ++most) {
    int left = most;
    const Status failed = writeLevel(log_, last_, upTo(12), {}, ".vtu", [&](ByteView) -> Status {
      return left-- > 0 ? Status() : fail(ErrorCode::kIo, "full");
    });
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().message, "full");
    EXPECT_EQ(left, -1) << "nothing is written behind it";
  }
  std::stop_source stop;
  const Status stopped = writeLevel(
      log_, last_, upTo(12), {}, ".vtu",
      [&](ByteView) -> Status {
        stop.request_stop();  // between two fields
        return {};
      },
      stop.get_token());
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::kIo);
}

TEST_F(WriteLevel, fieldsAreTheSameInAnyOrder) {
  const LatticeMesh whole = meshAtLevel(log_, last_, upTo(9)).value();
  Refiner refiner(log_.index());
  ASSERT_TRUE(refineToLevel(log_, refiner, last_, {}, {}));
  LevelFields fields(log_, refiner, upTo(9), {});
  for (const std::uint32_t f : {0u, 4u, 4u, 8u, 2u, 3u, 0u, 7u})
    EXPECT_TRUE(std::ranges::equal(fields.integers(f), whole.values[f])) << f;
  EXPECT_TRUE(fields.status());
}

}  // namespace
}  // namespace qtet
