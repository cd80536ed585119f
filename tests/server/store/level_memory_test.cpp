// The prediction of a level's memory holds, and is not far away.
#include "server/store/level_memory.h"

#include <gtest/gtest.h>

#include "server/store/level_maker.h"
#include "server/store/series_maker.h"
#include "tests/server/store/synthetic_log.h"
#include "tests/support/allocation_meter.h"
#include "tests/support/series_mesh.h"
#include "tests/support/written_log.h"

namespace qtet {
namespace {

class LevelMemory : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.write("run.qtet", testing::logBytes(testing::seriesMesh(9, 3, 30)));
    mesh_ = openMesh(folder_.path() / "run.qtet", "run").value();
  }
  /// All instants, as a server asks for them.
  [[nodiscard]] LevelRequest request(LevelForm form, std::uint32_t level) const {
    LevelRequest out{mesh_, level, form};
    for (std::uint32_t f = 0; f < mesh_->manifest.fields.size(); ++f) out.fields.push_back(f);
    return out;
  }
  /// Bytes of memory while it is written into a file, as the processes do.
  static std::size_t taken(const LevelRequest& request) {
    return testing::peakBytesOf([&] {
      SeriesMaker series;
      EXPECT_TRUE(writeLevel(request, [](ByteView) { return Status(); }, {}, series));
    });
  }

  test::TempFolder folder_;
  MeshPointer mesh_;
};

TEST_F(LevelMemory, isAtLeastWhatMakingItTakes) {
  const std::uint32_t last = mesh_->manifest.levels.back().level;
  for (const LevelForm form : {LevelForm::kVtu, LevelForm::kVtk, LevelForm::kMsh, LevelForm::kObj,
                               LevelForm::kGlb, LevelForm::kDrc, LevelForm::kUsda})
    for (const std::uint32_t level : {0u, last})
      for (const ContentCoding coding : {ContentCoding::kIdentity, ContentCoding::kGzip}) {
        LevelRequest wanted = request(form, level);
        wanted.coding = coding;
        const std::size_t peak = taken(wanted);
        EXPECT_GE(memoryOf(wanted), peak) << formName(form) << level << codingName(coding);
        if (level == last) EXPECT_LE(memoryOf(wanted), 6 * peak) << formName(form);
      }
}

TEST_F(LevelMemory, ofASeriesHoldsAllInstantsOrOne) {
  LevelRequest wanted{mesh_, mesh_->manifest.levels.back().level, LevelForm::kJson};
  for (std::uint32_t f = 0; f < 30; ++f) wanted.fields.push_back(f);
  wanted.point = {0, 0, 0};
  EXPECT_GE(memoryOf(wanted), taken(wanted));
}

TEST_F(LevelMemory, aFileOfAllInstantsTakesThatOfAFew) {
  const std::uint32_t last = mesh_->manifest.levels.back().level;
  LevelRequest all = request(LevelForm::kVtu, last), one = all;
  one.fields = {0};
  const std::uint64_t values = fileBytesOf(all) - fileBytesOf(one);
  EXPECT_LT(taken(all), taken(one) + values / 2) << "33 fields against one";
  EXPECT_LT(memoryOf(all), memoryOf(one) + 2 * values) << "of values alone there are as many";
}

TEST_F(LevelMemory, theFilesSizeIsForetold) {
  for (const LevelForm form :
       {LevelForm::kVtu, LevelForm::kVtk, LevelForm::kMsh, LevelForm::kUsda}) {
    const LevelRequest wanted = request(form, mesh_->manifest.levels.back().level);
    const auto bytes = static_cast<double>(makeLevel(wanted, {}).value().size());
    EXPECT_GE(1.25 * static_cast<double>(fileBytesOf(wanted)), bytes) << formName(form);
    EXPECT_LE(static_cast<double>(fileBytesOf(wanted)), 3 * bytes) << formName(form);
  }
}

TEST(OwnMemory, isThatOfTheMachineOrLess) {
  EXPECT_GT(ownMemory(), 1u << 26);
  EXPECT_LT(ownMemory(), std::uint64_t{1} << 50);
}

}  // namespace
}  // namespace qtet
