// Coordinates of a map, in metres: 500,000 and 4,600,000, as float32 and as float64.
#include "simplify/clean/float_spacing.h"

#include <gtest/gtest.h>

#include "simplify/clean/quantise.h"
#include "simplify/samples/samples.h"

namespace qtet {
namespace {

/// The box `size` wide at a place of a map; rounded as the type rounds.
TetMesh boxAt(const Position& place, double size, const std::string& type) {
  TetMesh mesh = boxSample();
  mesh.pointType = type;
  for (Position& p : mesh.points)
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = place[k] + size * p[k];
      if (type == "float32") p[k] = static_cast<double>(static_cast<float>(p[k]));
    }
  return mesh;
}

constexpr Position kMap{500'000, 4'600'000, 100};

TEST(FloatSpacing, whatFloat32HasLostIsTold) {
  // edges of 25 m and coordinates of half metres
  const auto lost = lostToFloats(boxAt(kMap, 200, "float32"));
  ASSERT_TRUE(lost);
  for (const char* words : {"near 4.6e+06 are a multiple of 0.5", "float64"})
    EXPECT_NE(lost->find(words), std::string::npos) << *lost;
  const auto worse = lostToFloats(boxAt(kMap, 10, "float32"));
  ASSERT_TRUE(worse);
  EXPECT_NE(worse->find("; 100 % of the edges"), std::string::npos) << *worse;
}

TEST(FloatSpacing, nothingIsToldOfFinerCoordinates) {
  EXPECT_FALSE(lostToFloats(boxAt(kMap, 200, "float64")));
  EXPECT_FALSE(lostToFloats(boxAt({0, 0, 0}, 200, "float32")));
  EXPECT_FALSE(lostToFloats(boxAt({-1, -1, -1}, 2e-9, "float64")));
  EXPECT_FALSE(lostToFloats(boxAt(kMap, 500'000, "float32")));
  EXPECT_FALSE(lostToFloats({}));
}

TEST(FloatSpacing, aFewShortEdgesAreUsual) {
  TetMesh mesh = boxAt({0, 0, 0}, 1, "float32");
  mesh.points[1] = mesh.points[0];
  mesh.points[1][0] += 1e-7;
  EXPECT_FALSE(lostToFloats(mesh));
}

TEST(FloatSpacing, theNoteOfQuantisingSaysIt) {
  const Result<QuantisedMesh> coarse = quantise(boxAt(kMap, 200, "float32")),
                              fine = quantise(boxAt(kMap, 200, "float64"));
  ASSERT_TRUE(coarse && fine);
  ASSERT_EQ(coarse->report.notes.size(), 1u);
  EXPECT_TRUE(coarse->report.notes[0].starts_with("the file's coordinates are float32"));
  EXPECT_TRUE(fine->report.notes.empty());
}

}  // namespace
}  // namespace qtet
