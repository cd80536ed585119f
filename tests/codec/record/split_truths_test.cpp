#include "codec/record/split_describer.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "codec/log/log_writer.h"
#include "simplify/fuse/qtetfusion.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

/// Changes a deleted cell of the coarsest fusion, which the log undoes first. One of its vertices
/// becomes one that the finest fusions took, and that the log restores last.
TEST(SplitDescriber, aCellWithAVertexThatHasNotComeIsNoneOfTheStar) {
  FusionHistory history = simplify(testing::gridMesh(3, 1), {}).value();
  ASSERT_TRUE(encodeLog(history, {}));
  const Fusion& coarsest = history.fusions.back();
  const auto prey = std::span(coarsest.prey).first(coarsest.k);
  auto& cell = history.cells[history.deletedCells[coarsest.firstDeleted]];
  const auto other = std::ranges::find_if(
      cell, [&](VertexId v) { return v != kGhost && std::ranges::find(prey, v) == prey.end(); });
  ASSERT_NE(other, cell.end());
  *other = history.fusions.front().prey[0];
  const auto log = encodeLog(history, {});
  ASSERT_FALSE(log);
  EXPECT_EQ(log.error().code, ErrorCode::kBadValue);
  EXPECT_NE(log.error().message.find("not those of its star"), std::string::npos);
}

}  // namespace
}  // namespace qtet
