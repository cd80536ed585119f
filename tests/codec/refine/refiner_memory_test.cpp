// Measures a refiner's memory beyond the mesh that it makes. On a phone this limits the mesh's
// size.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "codec/log/log_index.h"
#include "codec/log/log_writer.h"
#include "codec/log/value_block.h"
#include "codec/refine/log_file.h"
#include "codec/refine/refiner.h"
#include "proto/limits.h"
#include "simplify/fuse/qtetfusion.h"
#include "tests/support/allocation_meter.h"
#include "tests/support/meshes.h"
#include "tests/support/sanitizer.h"

/// The address sanitizer asks for its options: an allocation that fails is a test here, no fault.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "allocator_may_return_null=1"; }

namespace qtet {
namespace {

constexpr double kMaxBytesATetrahedron = 60;

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
    positions.push_back(*decodeValueBlock(file->block(chunk, kPositionsPart), 3,
                                          file->index().tuples(chunk, kPositionsPart),
                                          CodecId::kDraco));
  double mesh = 0, tetrahedra = 0;
  const std::size_t peak = testing::peakBytesOf([&] {
    Refiner refiner(file->index());
    for (std::uint32_t chunk = 0; chunk < file->index().chunks.size(); ++chunk)
      ASSERT_TRUE(refiner.apply(chunk, file->block(chunk, kStructurePart), positions[chunk]));
    tetrahedra = static_cast<double>(refiner.tetrahedra().size());
    mesh = static_cast<double>(refiner.points().size_bytes() + refiner.tetrahedra().size_bytes() +
                               refiner.boundary().size_bytes());
  });
  // Models of probabilities have one size however large the mesh is.
  constexpr double kModels = 2 * 400e3;
  EXPECT_LE(static_cast<double>(peak) - mesh - kModels, kMaxBytesATetrahedron * tetrahedra);
  EXPECT_EQ(tetrahedra, 6.0 * 20 * 20 * 20);
}

/// Limits the address space to `bytes` while this object lives. Does nothing under a sanitizer,
/// which needs more for itself.
class AddressLimit {
 public:
  explicit AddressLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_AS, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    if (!testing::kSanitized) ::setrlimit(RLIMIT_AS, &limit);
  }
  AddressLimit(const AddressLimit&) = delete;
  AddressLimit& operator=(const AddressLimit&) = delete;
  ~AddressLimit() { ::setrlimit(RLIMIT_AS, &before_); }

 private:
  rlimit before_{};
};

// The whole may be more than there is memory for, and the beginning still be worth a look.
TEST(Refiner, takesInTheBeginningOfALogThatNoMemoryHolds) {
  const auto history = simplify(testing::gridMesh(3, 1), {});
  ASSERT_TRUE(history) << history.error().text();
  auto log = encodeLog(*history, {});
  ASSERT_TRUE(log) << log.error().text();
  const auto file = LogFile::fromBytes(std::move(log->bytes));
  ASSERT_TRUE(file) << file.error().text();
  LogIndex index = file->index();
  ChunkEntry& last = index.chunks.back();
  last.newVertices = last.newTetrahedra = last.newBoundaryTriangles = kMaxElements / 2;
  ASSERT_GT(index.chunks.size(), 1u);
  Refiner refiner(index);
  const auto positions = decodeValueBlock(file->block(0, kPositionsPart), 3,
                                          file->index().tuples(0, kPositionsPart), CodecId::kDraco);
  // enough bytes to make such a log credible, though they contain nothing
  const Bytes credible(kMaxElements / kMaxElementsPerByte + 1);
  const AddressLimit limit(rlim_t{4} << 30);
  EXPECT_NO_THROW(EXPECT_FALSE(refiner.apply(0, credible, *positions)));
}

}  // namespace
}  // namespace qtet
