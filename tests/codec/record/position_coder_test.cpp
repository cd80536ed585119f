// Positions of a record's prey: every placement there and back, what aligned meshes save, and what
// a damaged block may do.
#include "codec/record/position_coder.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/support/star_mesh.h"

namespace qtet {
namespace {

using testing::StarMesh;

struct Record {
  Split split;
  LatticePoint fused{};
  int bits = 16;
  LatticePoint scale{};
  bool half = false;
};

StarMesh starOf(const Record& r) {
  StarMesh star = testing::starMesh(r.fused, r.scale, r.bits, r.half);
  std::vector<LatticePoint> prey(r.split.points.begin(), r.split.points.begin() + r.split.k);
  (void)testing::labelByNearest(star, prey);
  std::vector<std::uint8_t> labels = testing::labelsOf(star.link);
  // the record's own numbers: the coder asks for labels below k, not for their order
  for (std::uint8_t& label : labels)
    label = static_cast<std::uint8_t>(std::ranges::find(r.split.points, prey[label]) -
                                      r.split.points.begin());
  testing::labelAs(star, labels);
  return star;
}

/// Prey vertices up to `reach` from a centre, and the fused vertex where `placement` puts it.
Record randomRecord(std::mt19937& random, int bits, std::int32_t scale, std::int32_t reach) {
  Record r;
  r.bits = bits;
  r.scale = {scale, scale, std::max(scale / 3, 1)};
  r.half = random() % 3 == 0;
  r.split.k = 2 + static_cast<int>(random() % 3);
  r.split.placement = static_cast<Placement>(random() % 4);
  if (r.split.k > 2 && r.split.placement == Placement::kQuarter)
    r.split.placement = Placement::kMiddle;
  const auto n = static_cast<std::size_t>(r.split.k);
  const std::int32_t centre = 1 << (bits - 1);
  for (std::size_t i = 0; i < n; ++i)
    for (std::int32_t& x : r.split.points[i])
      x = centre +
          static_cast<std::int32_t>(random() % (2u * static_cast<std::uint32_t>(reach) + 1)) -
          reach;
  const std::size_t near = random() % n;
  switch (r.split.placement) {
    case Placement::kAtPrey: r.fused = r.split.points[near]; break;
    case Placement::kQuarter:
      r.fused = quarter(r.split.points[near], r.split.points[1 - near]);
      break;
    case Placement::kMiddle: r.fused = middle(std::span(r.split.points).first(n)); break;
    case Placement::kFree:
      r.fused = {centre + 7, centre - 3, centre + static_cast<std::int32_t>(random() % 50)};
      break;
  }
  if (r.split.placement == Placement::kAtPrey || r.split.placement == Placement::kQuarter)
    r.split.near = static_cast<int>(near);
  return r;
}

struct Coded {
  Bytes structure;
  std::vector<std::int32_t> values;
};

Coded encoded(std::span<const Record> records) {
  RangeEncoder encoder;
  PositionModels models;
  Values values;
  for (const Record& r : records) {
    const StarMesh star = starOf(r);
    Split split = r.split;
    PositionCoder<RangeEncoder>(encoder, models, values, star.mesh, star.link).code(0, split);
  }
  EXPECT_FALSE(values.bad());
  return {encoder.finish(), values.written()};
}

void expectRoundTrip(std::span<const Record> records) {
  const Coded coded = encoded(records);
  RangeDecoder decoder(coded.structure);
  PositionModels models;
  Values values(coded.values);
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Record& r = records[i];
    const StarMesh star = starOf(r);
    Split split;
    split.k = r.split.k;
    PositionCoder<RangeDecoder>(decoder, models, values, star.mesh, star.link).code(0, split);
    ASSERT_EQ(split.placement, r.split.placement) << i;
    ASSERT_EQ(split.near, r.split.near) << i;
    for (std::size_t p = 0; p < static_cast<std::size_t>(r.split.k); ++p)
      ASSERT_EQ(split.points[p], r.split.points[p]) << i << ", prey " << p;
  }
  EXPECT_TRUE(values.atEnd());
  EXPECT_FALSE(values.bad());
  EXPECT_TRUE(decoder.atEnd());
}

TEST(PositionCoder, everyPlacementComesBack) {
  std::mt19937 random(1);
  for (const auto& [bits, scale, reach] :
       {std::array{16, 2000, 1500}, std::array{16, 300, 2}, std::array{8, 1, 60},
        std::array{28, 1 << 25, 1 << 26}}) {
    std::vector<Record> records;
    for (int i = 0; i < 400; ++i) records.push_back(randomRecord(random, bits, scale, reach));
    expectRoundTrip(records);
  }
}

TEST(PositionCoder, preyThatCoincideComeBack) {
  for (const Placement placement :
       {Placement::kAtPrey, Placement::kMiddle, Placement::kQuarter, Placement::kFree}) {
    Record r;
    r.scale = {100, 100, 100};
    r.split.placement = placement;
    r.split.points[0] = r.split.points[1] = r.fused = {9000, 9001, 9002};
    expectRoundTrip(std::vector(3, r));
  }
}

TEST(PositionCoder, aRecordTakesOneTupleANewVertex) {
  std::mt19937 random(2);
  for (int i = 0; i < 100; ++i) {
    const std::vector<Record> one{randomRecord(random, 16, 500, 800)};
    EXPECT_EQ(encoded(one).values.size(), 3u * static_cast<std::size_t>(one[0].split.k - 1));
  }
}

/// The same record, all distances from the middle of a lattice of 20 bits times `factor`.
Record enlarged(Record r, std::int32_t factor) {
  constexpr std::int32_t kMiddle = 1 << 19;
  const auto enlarge = [&](LatticePoint& p) {
    for (std::int32_t& x : p) x = kMiddle + factor * (x - kMiddle);
  };
  enlarge(r.fused);
  for (LatticePoint& p : r.split.points) enlarge(p);
  for (std::int32_t& x : r.scale) x *= factor;
  return r;
}

TEST(PositionCoder, valuesAreThoseOfAStarOfAnySize) {
  std::mt19937 random(3);
  std::vector<Record> records;
  while (records.size() < 300)
    if (const Record r = randomRecord(random, 20, 256, 256);
        r.split.placement == Placement::kAtPrey)
      records.push_back(r);
  std::vector<std::vector<std::int32_t>> values;
  for (const std::int32_t factor : {1, 8, 64}) {
    std::vector<Record> larger;
    for (const Record& r : records) larger.push_back(enlarged(r, factor));
    values.push_back(encoded(larger).values);
  }
  for (std::size_t i = 0; i < values[0].size(); ++i) {
    EXPECT_NEAR(values[0][i], values[1][i], 1) << i;
    EXPECT_NEAR(values[0][i], values[2][i], 1) << i;
  }
  EXPECT_LT(std::ranges::max(values[2]), 256);
}

TEST(PositionCoder, preyOnTheFusedVertexsPlanesTakeFewerDigits) {
  std::mt19937 random(4);
  std::vector<Record> aligned, oblique;
  for (int i = 0; i < 500; ++i) {
    Record r;
    r.scale = {4000, 4000, 4000};
    r.fused = r.split.points[0] = {30000, 30000, 30000};
    r.split.points[1] = r.fused;
    r.split.points[1][static_cast<std::size_t>(random() % 3)] +=
        static_cast<std::int32_t>(random() % 4000);
    aligned.push_back(r);
    for (std::int32_t& x : r.split.points[1])
      x = 30000 + static_cast<std::int32_t>(random() % 4000);
    oblique.push_back(r);
  }
  expectRoundTrip(aligned);
  EXPECT_LT(encoded(aligned).structure.size() * 3, encoded(oblique).structure.size() * 2);
}

TEST(PositionCoder, whatEverTheBytesSayPointsStayInRange) {
  constexpr std::int32_t kLargest = 1 << 30;
  std::mt19937 random(5);
  std::size_t refused = 0;
  for (int i = 0; i < 2000; ++i) {
    Record r = randomRecord(random, 28, 1 << 25, 1 << 26);
    const StarMesh star = starOf(r);
    Bytes noise(40);
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
    std::vector<std::int32_t> given(9);
    for (std::int32_t& value : given) {
      const std::int32_t edges[] = {std::numeric_limits<std::int32_t>::max(),
                                    std::numeric_limits<std::int32_t>::min(),
                                    static_cast<std::int32_t>(random() % 64)};
      value = edges[random() % 3];
    }
    RangeDecoder decoder(noise);
    PositionModels models;
    Values values(given);
    Split split;
    split.k = r.split.k;
    PositionCoder<RangeDecoder>(decoder, models, values, star.mesh, star.link).code(0, split);
    refused += values.bad();
    for (const LatticePoint& p : split.points)
      for (const std::int32_t x : p) {
        ASSERT_LE(x, kLargest);
        ASSERT_GE(x, -kLargest);
      }
  }
  EXPECT_GT(refused, 1500u);
}

TEST(PositionCoder, aDifferenceBeyondTheRangeIsRefusedOnBothSides) {
  std::mt19937 random(7);
  for (const std::int32_t wild :
       {std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::min()}) {
    const Record r = randomRecord(random, 8, 1, 60);
    const Coded coded = encoded(std::span(&r, 1));
    const std::vector<std::int32_t> given(coded.values.size(), wild);
    const StarMesh star = starOf(r);
    RangeDecoder decoder(coded.structure);
    PositionModels models;
    Values values(given);
    Split split;
    split.k = r.split.k;
    PositionCoder<RangeDecoder>(decoder, models, values, star.mesh, star.link).code(0, split);
    EXPECT_TRUE(values.bad()) << wild;
  }
}

TEST(PositionCoder, aBlockThatEndsTooEarlyIsNoticed) {
  std::mt19937 random(6);
  for (int i = 0; i < 50; ++i) {
    const Record r = randomRecord(random, 16, 500, 800);
    Coded coded = encoded(std::span(&r, 1));
    coded.values.pop_back();
    const StarMesh star = starOf(r);
    RangeDecoder decoder(coded.structure);
    PositionModels models;
    Values values(coded.values);
    Split split;
    split.k = r.split.k;
    PositionCoder<RangeDecoder>(decoder, models, values, star.mesh, star.link).code(0, split);
    EXPECT_TRUE(values.bad());
  }
}

}  // namespace
}  // namespace qtet
