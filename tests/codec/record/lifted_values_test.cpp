// Lifted point values there and back, with any rule and missing values, and what a hostile block
// may hold.
#include "codec/record/lifted_values.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "proto/limits.h"
#include "tests/support/star_mesh.h"

namespace qtet {
namespace {

using testing::StarMesh;

constexpr LatticePoint kMiddleOfStar{30000, 30000, 30000};

/// A record on a star, and the values round it.
struct Scene {
  StarMesh star;
  PointAncestry ancestry{true};
  std::uint32_t components;
  std::vector<std::int32_t> values;  // by slot, the fused vertex's first
  std::vector<std::uint8_t> sizes;
  std::vector<std::int32_t> prey;

  Scene(std::mt19937& random, std::uint32_t componentsOf, int k, bool onBoundary,
        Placement placement, std::int32_t most)
      : star(testing::starMesh(kMiddleOfStar, {512, 256, 128}, 16, onBoundary)),
        components(componentsOf) {
    Split split;
    split.k = k;
    split.placement = placement;
    for (LatticePoint& p : split.points)
      for (std::size_t a = 0; a < 3; ++a)
        p[a] = kMiddleOfStar[a] + static_cast<std::int32_t>(random() % 301) - 150;
    if (placement == Placement::kAtPrey) split.points[0] = kMiddleOfStar;
    ancestry.add(0, star.mesh, star.link, split);
    const auto any = [&] {
      return static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(most));
    };
    values.resize((star.mesh.points.size() + 3) * components);
    for (std::int32_t& value : values) value = any();
    sizes.resize(values.size());
    prey.resize(static_cast<std::size_t>(k) * components);
    for (std::int32_t& value : prey) value = any();
  }
  [[nodiscard]] const Birth& birth() const { return ancestry.births()[0]; }
  [[nodiscard]] std::span<const Slope> slopes() const { return ancestry.slopesAt(birth()); }

  /// Moves the fused values to where the rule can have them.
  void fit(const LiftingRule& rule) {
    const LiftedRecord record(birth(), slopes());
    for (std::uint32_t c = 0; c < components; ++c) {
      std::array<std::int64_t, LiftedRecord::kMaxPrey> p{};
      bool isWhole = true;
      for (std::size_t i = birth().k; i-- > 0;) {
        p[i] = prey[i * components + c];
        if (p[i] == kMissing) isWhole = false;
        // without a correction the first one's
        else if (!rule.isCorrected())
          values[c] = prey[i * components + c];
      }
      if (!isWhole) continue;
      const auto at = [&](VertexId v) -> std::int64_t { return values[v * components + c]; };
      const std::int64_t follows = record.follows(
          rule, p, at, record.isWhole([&](VertexId v) { return at(v) != kMissing; }));
      const std::int64_t off =
          rule.isCorrected() ? (values[c] - follows) >> rule.shift << rule.shift : 0;
      values[c] = static_cast<std::int32_t>(follows + off);
    }
  }
  /// Codes the record, and leaves the prey's values.
  template <class Coder>
  bool code(Coder& coder, const LiftingRule& rule, bool hasMissing) {
    LiftedBlock<Coder> block(coder, {values, sizes}, components, hasMissing);
    block.record(block.rule(rule), birth(), slopes(), prey);
    return !block.bad();
  }
  [[nodiscard]] std::vector<std::int32_t> preyNow() const {
    std::vector<std::int32_t> out(values.begin(), values.begin() + components);
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(birth().firstNew) * components;
    out.insert(out.end(), first, first + static_cast<std::ptrdiff_t>(birth().k - 1) * components);
    return out;
  }
};

constexpr std::array kPlacements{Placement::kAtPrey, Placement::kMiddle, Placement::kQuarter,
                                 Placement::kFree};

/// Codes the scene's record, and decodes it again.
void expectBack(Scene& scene, const LiftingRule& rule, bool hasMissing) {
  Scene again = scene;
  std::ranges::fill(again.prey, 0);
  RangeEncoder encoder;
  ASSERT_TRUE(scene.code(encoder, rule, hasMissing));
  ASSERT_EQ(scene.preyNow(), scene.prey);
  const Bytes bytes = encoder.finish();
  RangeDecoder decoder(bytes);
  ASSERT_TRUE(again.code(decoder, {}, hasMissing));
  ASSERT_TRUE(decoder.atEnd());
  ASSERT_EQ(again.values, scene.values);
  ASSERT_EQ(again.sizes, scene.sizes);
}

TEST(LiftedValues, comeBackByAnyRule) {
  std::mt19937 random(7);
  for (int round = 0; round < 120; ++round) {
    Scene scene(random, 1 + random() % 6, 2 + static_cast<int>(random() % 3), round % 2 == 0,
                kPlacements[random() % 4], round % 3 == 0 ? 1 << kMaxFieldBits : 4096);
    const LiftingRule rule{static_cast<int>(random() % 8) - 1, static_cast<int>(random() % 128)};
    scene.fit(rule);
    ASSERT_NO_FATAL_FAILURE(expectBack(scene, rule, false)) << round;
  }
}

TEST(LiftedValues, comeBackBesideMissingOnes) {
  std::mt19937 random(8);
  int rims = 0;
  for (int round = 0; round < 120; ++round) {
    Scene scene(random, 2, 2 + static_cast<int>(random() % 3), round % 2 == 0,
                kPlacements[random() % 4], 4096);
    for (std::size_t i = 2; i < scene.values.size(); ++i)
      if (random() % 5 == 0) scene.values[i] = kMissing;
    for (std::uint32_t c = 0; c < 2; ++c) {
      std::size_t missing = 0;
      for (std::size_t i = 0; i < scene.birth().k; ++i)
        if (random() % 3 == 0) scene.prey[i * 2 + c] = kMissing, ++missing;
      if (missing == scene.birth().k) scene.values[c] = kMissing;
      rims += missing > 0 && missing < scene.birth().k;
    }
    const LiftingRule rule{static_cast<int>(random() % 4) - 1, static_cast<int>(random() % 128)};
    scene.fit(rule);
    ASSERT_NO_FATAL_FAILURE(expectBack(scene, rule, true)) << round;
  }
  EXPECT_GT(rims, 20);
}

TEST(LiftedValues, aFusedValueThatNoRuleGivesIsNotCoded) {
  std::mt19937 random(9);
  Scene scene(random, 1, 2, false, Placement::kMiddle, 4096);
  const LiftingRule rule{LiftingRule::kNoCorrection, 30};
  scene.fit(rule);
  ++scene.values[0];
  RangeEncoder encoder;
  EXPECT_FALSE(scene.code(encoder, rule, false));
}

// The largest correction by the largest shift is 2^61: what it leaves is refused, at once.
TEST(LiftedValues, aCorrectionBeyondAnyValueIsRefused) {
  for (const std::int32_t correction : {8, 9, (1 << 30) + ((1 << 30) - 1)}) {
    std::mt19937 random(10);
    Scene scene(random, 1, 2, false, Placement::kMiddle, 1);
    ASSERT_TRUE(scene.slopes()[0].hasBoth());
    RangeEncoder encoder;
    BitModel sameShift, sameCurve;
    encoder.bit(0, sameShift), encoder.raw(LiftingRule::kMaxShift + 1, 5);
    encoder.bit(0, sameCurve), encoder.raw(LiftingRule::kMaxCurve, 7);
    SizeHints hints;
    hints.place = static_cast<std::uint8_t>(Placement::kMiddle);
    std::int32_t difference = 0, told = correction;
    GuessedIntegers differences, corrections;
    ASSERT_TRUE(differences.code(encoder, hints, difference));
    hints.shift = LiftingRule::kMaxShift;
    ASSERT_TRUE(corrections.code(encoder, hints, told));
    const Bytes bytes = encoder.finish();
    RangeDecoder decoder(bytes);
    EXPECT_FALSE(scene.code(decoder, {}, false)) << correction;
    EXPECT_TRUE(decoder.atEnd()) << correction;
    EXPECT_EQ(scene.values[0], 0);
  }
}

TEST(LiftedValues, noiseLeavesNoValueBeyondTheLimit) {
  std::mt19937 random(11);
  for (int round = 0; round < 250; ++round) {
    Scene scene(random, 3, 2 + static_cast<int>(random() % 3), round % 2 == 0,
                kPlacements[random() % 4], 1 << kMaxFieldBits);
    Bytes noise(40);
    for (std::uint8_t& byte : noise)
      byte = static_cast<std::uint8_t>(round % 4 == 0 ? random() % 3 : random());
    RangeDecoder decoder(noise);
    (void)scene.code(decoder, {}, round % 3 == 0);
    for (const std::int32_t value : scene.values)
      ASSERT_TRUE(value == kMissing || std::abs(value) <= 1 << 30);
  }
}

}  // namespace
}  // namespace qtet
