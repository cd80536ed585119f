// What a refiner needs beyond the mesh that it makes, which on a phone decides how large that may be.
#include <gtest/gtest.h>

#include "codec/log_file.h"
#include "codec/log_writer.h"
#include "codec/value_block.h"
#include "simplify/qtetfusion.h"
#include "tests/support/allocation_meter.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

constexpr double kMostBytesATetrahedron = 60;

TEST(Refiner, holdsLittleBesideTheMesh) {
  FusionOptions options;
  options.targetRatio = 0;
  const auto history = simplify(testing::gridMesh(20, 1), options);
  ASSERT_TRUE(history) << history.error().text();
  auto log = encodeLog(*history, {});
  ASSERT_TRUE(log) << log.error().text();
  const auto file = LogFile::fromBytes(std::move(log->bytes));
  ASSERT_TRUE(file) << file.error().text();
  std::vector<std::vector<std::int32_t>> positions;
  for (std::uint32_t chunk = 0; chunk < file->index().chunks.size(); ++chunk)
    positions.push_back(*decodeValueBlock(file->block(chunk, kPositionsPart), 3, file->index().tuples(chunk, kPositionsPart)));
  double mesh = 0, tetrahedra = 0;
  const std::size_t peak = testing::peakBytesOf([&] {
    Refiner refiner(file->index());
    for (std::uint32_t chunk = 0; chunk < file->index().chunks.size(); ++chunk)
      ASSERT_TRUE(refiner.apply(chunk, file->block(chunk, kStructurePart), positions[chunk]));
    tetrahedra = static_cast<double>(refiner.tetrahedra().size());
    mesh = static_cast<double>(refiner.points().size_bytes() + refiner.tetrahedra().size_bytes() + refiner.boundary().size_bytes());
  });
  // Models of probabilities have one size however large the mesh is.
  constexpr double kModels = 2 * 400e3;
  EXPECT_LE(static_cast<double>(peak) - mesh - kModels, kMostBytesATetrahedron * tetrahedra);
  EXPECT_EQ(tetrahedra, 6.0 * 20 * 20 * 20);
}

}  // namespace
}  // namespace qtet
