#include "codec/record/label_coder.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/star_mesh.h"

namespace qtet {
namespace {

using testing::labelsOf;
using testing::StarMesh;

constexpr LatticePoint kCentre{30000, 30000, 30000};

StarMesh someStar(std::mt19937& random) {
  const auto length = [&] { return 50 + static_cast<std::int32_t>(random() % 5000); };
  return testing::starMesh(kCentre, {length(), length(), length()}, 16, random() % 2 == 0);
}

/// Labels in order of first appearance along the traversal, all alike likely.
std::vector<std::uint8_t> randomLabels(std::mt19937& random, const Link& link, std::size_t k) {
  std::vector<std::uint8_t> out(link.triangles().size());
  std::size_t seen = 0;
  for (const std::uint32_t f : link.traversal()) {
    const std::size_t label = random() % std::min(seen + 1, k);
    out[f] = static_cast<std::uint8_t>(label);
    seen = std::max(seen, label + 1);
  }
  return out;
}

TEST(LabelCoder, anyLabelsComeBack) {
  std::mt19937 random(1);
  std::vector<StarMesh> stars;
  std::vector<std::vector<std::uint8_t>> truth;
  std::vector<int> k;
  RangeEncoder encoder;
  LabelModels models;
  for (int i = 0; i < 300; ++i) {
    stars.push_back(someStar(random));
    k.push_back(2 + i % 3);
    truth.push_back(randomLabels(random, stars.back().link, static_cast<std::size_t>(k.back())));
    LabelCoder<RangeEncoder>(encoder, models, stars.back().link).code(k.back(), truth.back());
    ASSERT_EQ(labelsOf(stars.back().link), truth.back());
  }
  const Bytes bytes = encoder.finish();
  RangeDecoder decoder(bytes);
  LabelModels again;
  for (std::size_t i = 0; i < stars.size(); ++i) {
    testing::labelAs(stars[i], {});
    LabelCoder<RangeDecoder>(decoder, again, stars[i].link).code(k[i], {});
    ASSERT_EQ(labelsOf(stars[i].link), truth[i]) << i;
  }
  EXPECT_TRUE(decoder.atEnd());
}

TEST(LabelCoder, labelsThatLieWithTheirPreyTakeAFewBitsARecord) {
  std::mt19937 random(2);
  RangeEncoder encoder;
  LabelModels models;
  std::size_t triangles = 0;
  const auto code = [&](int records) {
    for (int i = 0; i < records; ++i) {
      StarMesh star = someStar(random);
      std::vector<LatticePoint> prey(2, kCentre);
      for (std::int32_t& x : prey[1]) x += static_cast<std::int32_t>(random() % 2001) - 1000;
      if (testing::labelByNearest(star, prey) < 2) continue;
      const std::vector<std::uint8_t> truth = labelsOf(star.link);
      testing::labelAs(star, {});
      LabelCoder<RangeEncoder>(encoder, models, star.link).code(2, truth);
      triangles += truth.size();
    }
  };
  code(500);  // to learn
  (void)encoder.finish();
  triangles = 0;
  code(500);
  EXPECT_LT(static_cast<double>(encoder.size()) * 8, 0.6 * static_cast<double>(triangles));
}

TEST(LabelCoder, anyBytesGiveLabelsBelowKInOrderOfAppearance) {
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    StarMesh star = someStar(random);
    Bytes noise(24);
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
    RangeDecoder decoder(noise);
    LabelModels models;
    const int k = 2 + i % 3;
    LabelCoder<RangeDecoder>(decoder, models, star.link).code(k, {});
    std::uint8_t seen = 0;
    for (const std::uint32_t f : star.link.traversal()) {
      const std::uint8_t label = star.link.triangles()[f].label;
      ASSERT_LT(label, k);
      ASSERT_LE(label, seen) << "a label that skips one";
      seen = std::max<std::uint8_t>(seen, static_cast<std::uint8_t>(label + 1));
    }
  }
}

TEST(LabelCoder, theLargestLatticeIsNoneTooLarge) {
  std::mt19937 random(4);
  StarMesh star = testing::starMesh({1 << 27, 1 << 27, 1 << 27}, {1 << 26, (1 << 26) - 5, 1}, 28);
  const std::vector<std::uint8_t> truth = randomLabels(random, star.link, 4);
  RangeEncoder encoder;
  LabelModels models, again;
  LabelCoder<RangeEncoder>(encoder, models, star.link).code(4, truth);
  const Bytes bytes = encoder.finish();
  RangeDecoder decoder(bytes);
  testing::labelAs(star, {});
  LabelCoder<RangeDecoder>(decoder, again, star.link).code(4, {});
  EXPECT_EQ(labelsOf(star.link), truth);
}

}  // namespace
}  // namespace qtet
