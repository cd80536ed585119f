#include "codec/picture/poster.h"

#include <gtest/gtest.h>
#include <webp/decode.h>

#include <array>
#include <cmath>
#include <random>

#include "tests/support/meshes.h"

namespace qtet {
namespace {

struct Picture {
  int width = 0, height = 0;
  Bytes pixels{};
  [[nodiscard]] std::array<int, 4> at(int column, int row) const {
    std::array<int, 4> out{};
    for (std::size_t c = 0; c < 4; ++c)
      out[c] = pixels[4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                           static_cast<std::size_t>(column)) +
                      c];
    return out;
  }
  [[nodiscard]] std::array<int, 4> middle() const { return at(width / 2, height / 2); }
  [[nodiscard]] double covered() const {
    double out = 0;
    for (std::size_t i = 3; i < pixels.size(); i += 4) out += pixels[i] / 255.0;
    return out / (width * height);
  }
};

Picture decoded(const Bytes& webp) {
  Picture out;
  std::uint8_t* pixels = WebPDecodeRGBA(webp.data(), webp.size(), &out.width, &out.height);
  EXPECT_NE(pixels, nullptr);
  if (pixels != nullptr)
    out.pixels.assign(pixels, pixels + std::size_t{4} * static_cast<std::size_t>(out.width) *
                                           static_cast<std::size_t>(out.height));
  WebPFree(pixels);
  return out;
}

/// A cube of 2 x 2 x 2 boxes; each vertex has the value `valueAt` of its lattice point.
template <class Value>
LatticeMesh cube(Value valueAt) {
  LatticeMesh out = testing::gridMesh(2, 1);
  FieldInfo field;
  field.name = "f";
  field.minimum = {0};
  field.range = {0, 100};
  out.fields = {field};
  out.values = {{}};
  for (const LatticePoint& p : out.points) out.values[0].push_back(valueAt(p));
  return out;
}

Manifest manifestOf(const LatticeMesh& mesh) {
  Manifest out;
  out.latticeBits = mesh.lattice.bits;
  for (const FieldInfo& field : mesh.fields) {
    ManifestField named;
    named.name = field.name;
    out.fields.push_back(named);
  }
  out.levels.push_back({});
  return out;
}

Picture posterOf(const LatticeMesh& mesh, const Manifest& manifest) {
  const Result<Bytes> webp = posterWebp(mesh, manifest);
  EXPECT_TRUE(webp);
  EXPECT_LE(webp->size(), kMaxPosterBytes);
  return decoded(*webp);
}
Picture posterOf(const LatticeMesh& mesh) { return posterOf(mesh, manifestOf(mesh)); }

int low(const LatticeMesh& mesh, std::size_t axis) {
  int out = mesh.points[0][axis];
  for (const LatticePoint& p : mesh.points) out = std::min(out, p[axis]);
  return out;
}
int high(const LatticeMesh& mesh, std::size_t axis) {
  int out = mesh.points[0][axis];
  for (const LatticePoint& p : mesh.points) out = std::max(out, p[axis]);
  return out;
}

TEST(Poster, theMeshReachesEveryEdgeAndTheRestIsTransparent) {
  const Picture picture = posterOf(cube([](const LatticePoint&) { return 50; }));
  EXPECT_EQ(std::max(picture.width, picture.height), kMaxPosterPixels);
  const auto reaches = [&](auto pixelAt, int count) {
    for (int i = 0; i < count; ++i)
      if (pixelAt(i)[3] > 100) return true;
    return false;
  };
  constexpr int kGap = 3;  // pixels
  const auto row = [&](int y) { return [&, y](int x) { return picture.at(x, y); }; };
  const auto column = [&](int x) { return [&, x](int y) { return picture.at(x, y); }; };
  EXPECT_TRUE(reaches(row(kGap), picture.width));
  EXPECT_TRUE(reaches(row(picture.height - 1 - kGap), picture.width));
  EXPECT_TRUE(reaches(column(kGap), picture.height) ||
              reaches(column(picture.width - 1 - kGap), picture.height))
      << "the middle is the camera's target, so one side may be a little wider";
  for (const int x : {0, picture.width - 1})
    for (const int y : {0, picture.height - 1}) EXPECT_EQ(picture.at(x, y)[3], 0);
  EXPECT_EQ(picture.middle()[3], 255);
}

TEST(Poster, coloursRunFromVioletBelowToYellowAbove) {
  LatticeMesh mesh = cube([](const LatticePoint&) { return 0; });
  const int from = low(mesh, 2), to = high(mesh, 2);
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    mesh.values[0][v] = 100 * (mesh.points[v][2] - from) / (to - from);
  const Picture picture = posterOf(mesh);
  const auto above = picture.at(picture.width / 2, picture.height / 10),
             below = picture.at(picture.width / 2, picture.height * 9 / 10);
  EXPECT_GT(above[0], 2 * above[2]) << "yellow";
  EXPECT_GT(below[2], below[1]) << "violet";
}

TEST(Poster, aFewValuesFarOffDoNotTakeTheColours) {
  LatticeMesh mesh = testing::gridMesh(6, 3);
  mesh.fields = cube([](const LatticePoint&) { return 0; }).fields;
  mesh.values = {std::vector<std::int32_t>(mesh.points.size())};
  const int from = low(mesh, 2), to = high(mesh, 2);
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    mesh.values[0][v] = 20 * (mesh.points[v][2] - from) / (to - from);
  const auto brightest = [](const Picture& picture) {
    int out = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); i += 4)
      if (picture.pixels[i + 3] == 255) out = std::max<int>(out, picture.pixels[i]);
    return out;
  };
  EXPECT_GT(brightest(posterOf(mesh)), 180) << "yellow, though the values end at a fifth";
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    mesh.values[0][v] = 80 * (mesh.points[v][2] - from) / (to - from);
  EXPECT_LT(brightest(posterOf(mesh)), 160) << "a fifth of the range is no tail";
}

TEST(Poster, withoutAFieldAndWhereAValueIsMissingItIsPlain) {
  LatticeMesh bare = cube([](const LatticePoint&) { return 50; });
  bare.fields.clear();
  bare.values.clear();
  LatticeMesh missing = cube([](const LatticePoint&) { return kMissing; });
  missing.fields[0].hasMissing = true;
  for (const LatticeMesh& mesh : {bare, missing}) {
    const auto pixel = posterOf(mesh).middle();
    EXPECT_NEAR(pixel[0], pixel[1], 12);
    EXPECT_NEAR(pixel[1], pixel[2], 16);
  }
}

TEST(Poster, theOpeningsCutShowsTheInside) {
  LatticeMesh mesh = cube([](const LatticePoint&) { return 0; });
  const int middle = (low(mesh, 1) + high(mesh, 1)) / 2;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    bool isInner = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
      isInner &= mesh.points[v][axis] > low(mesh, axis) && mesh.points[v][axis] < high(mesh, axis);
    mesh.values[0][v] = isInner ? 100 : 0;
  }
  EXPECT_LT(middle, high(mesh, 1));
  Manifest manifest = manifestOf(mesh);
  const auto yellow = [](const Picture& picture) {
    int out = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); i += 4)
      out += picture.pixels[i + 3] == 255 && picture.pixels[i] > 140 && picture.pixels[i + 2] < 90;
    return out;
  };
  const Picture whole = posterOf(mesh, manifest);
  EXPECT_EQ(yellow(whole), 0);
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    manifest.opening = Opening{0, axis};
    const Picture cut = posterOf(mesh, manifest);
    EXPECT_GT(yellow(cut), 100) << int{axis};
    EXPECT_LT(cut.covered(), whole.covered()) << int{axis};
    EXPECT_EQ(cut.width, whole.width) << "the whole mesh is fitted";
  }
}

TEST(Poster, cellsHaveTheirOwnColoursAndLabelsTheirs) {
  LatticeMesh mesh = testing::gridMesh(2, 1);
  FieldInfo field;
  field.name = "part";
  field.association = "cell";
  field.type = "int32";
  field.minimum = {0};
  field.range = {1, 2};
  mesh.fields = {field};
  mesh.values = {std::vector<std::int32_t>(mesh.tetrahedra.size(), 2)};
  const auto pixel = posterOf(mesh).middle();
  EXPECT_GT(pixel[0], 150) << "orange, the second label";
  EXPECT_LT(pixel[2], 90);
}

TEST(Poster, aLabelOfTheLogHasAsManyNumbersAsItLikes) {
  LatticeMesh mesh = testing::gridMesh(2, 1);
  FieldInfo field;
  field.name = "part";
  field.association = "cell";
  field.type = "int32";
  field.minimum = {-5000};
  field.range = {-5000, 5000};
  mesh.fields = {field};
  mesh.values = {std::vector<std::int32_t>(mesh.tetrahedra.size(), 5000 + 1 - 37 * 100)};
  Manifest manifest = manifestOf(mesh);
  manifest.fields[0].association = "cell";
  manifest.fields[0].type = "int32";
  manifest.labels = {{"part", {}}};
  const auto pixel = posterOf(mesh, manifest).middle();
  EXPECT_GT(pixel[0], 150) << "orange, as label 1";
  EXPECT_LT(pixel[2], 90);
}

TEST(Poster, aFocusFillsThePictureAndFadesOut) {
  const LatticeMesh mesh = cube([](const LatticePoint&) { return 50; });
  Manifest manifest = manifestOf(mesh);
  const auto share = [&](double at, std::size_t axis) {
    const double lattice = low(mesh, axis) + at * (high(mesh, axis) - low(mesh, axis));
    return static_cast<std::uint16_t>(std::ldexp(lattice, 16 - mesh.lattice.bits));
  };
  manifest.focus = Focus{share(0.4, 0), share(0.4, 1), share(0.7, 2),
                         share(0.6, 0), share(0.6, 1), share(0.9, 2)};
  const Picture picture = posterOf(mesh, manifest);
  EXPECT_EQ(picture.middle()[3], 255);
  EXPECT_LT(picture.at(0, picture.height / 2)[3], 20);
  EXPECT_LT(picture.at(picture.width / 2, picture.height - 1)[3], 20);
}

TEST(Poster, aPictureWithManyDetailsFitsIntoTheBytes) {
  LatticeMesh mesh = testing::gridMesh(12, 1);
  mesh.fields = cube([](const LatticePoint&) { return 0; }).fields;
  mesh.values = {{}};
  std::mt19937 random(1);
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    mesh.values[0].push_back(static_cast<std::int32_t>(random() % 101));
  const Manifest manifest = manifestOf(mesh);
  const Result<Bytes> one = posterWebp(mesh, manifest), two = posterWebp(mesh, manifest);
  ASSERT_TRUE(one && two);
  EXPECT_LE(one->size(), kMaxPosterBytes);
  EXPECT_EQ(*one, *two);
}

TEST(Poster, theLevelIsTheLastOneOfTheFirstChunkAndTheFieldTheOpenings) {
  Manifest manifest;
  manifest.levels.resize(3);
  manifest.levels[2].chunk = 1;
  EXPECT_EQ(posterLevel(manifest), 1u);
  EXPECT_TRUE(posterFields(manifest).empty());
  manifest.fields.resize(2);
  EXPECT_EQ(posterFields(manifest), std::vector<std::uint32_t>{0});
  manifest.opening = Opening{1, std::nullopt};
  EXPECT_EQ(posterFields(manifest), std::vector<std::uint32_t>{1});
}

/// A cube, and a manifest of `cells` cells, whose displacement along z is `share` of its side on
/// top.
Picture bentPoster(double share, std::uint32_t cells) {
  LatticeMesh mesh = cube([](const LatticePoint&) { return 50; });
  const double side = high(mesh, 0) - low(mesh, 0);
  FieldInfo& field = mesh.fields.emplace_back();
  field.name = "DISP", field.components = 3, field.minimum = {0, 0, 0},
  field.step = mesh.lattice.step;
  const double largest = std::floor(share * side);
  field.range = {0, largest * mesh.lattice.step};
  std::vector<std::int32_t>& values = mesh.values.emplace_back();
  const int top = high(mesh, 2);
  for (const LatticePoint& p : mesh.points)
    for (int axis = 0; axis < 3; ++axis)
      values.push_back(axis == 2 && p[2] == top ? static_cast<std::int32_t>(largest) : 0);
  Manifest manifest = manifestOf(mesh);
  manifest.fields[1].components = 3, manifest.fields[1].range = field.range;
  manifest.levels[0].tetrahedra = cells;
  EXPECT_EQ(posterFields(manifest), (std::vector<std::uint32_t>{0, 1}));
  return posterOf(mesh, manifest);
}

TEST(Poster, displacementsThatPassAnEdgeMoveTheMesh) {
  const auto shape = [](const Picture& picture) {
    return static_cast<double>(picture.height) / picture.width;
  };
  const double rest = shape(posterOf(cube([](const LatticePoint&) { return 50; })));
  EXPECT_GT(shape(bentPoster(1, 60)), 1.2 * rest);
  EXPECT_EQ(shape(bentPoster(0.45, 60)), rest) << "an edge is 0.52 of the side";
  EXPECT_GT(shape(bentPoster(0.45, 120)), 1.1 * rest) << "here 0.41";
  EXPECT_EQ(shape(bentPoster(1.8, 60)), rest) << "longer than the diagonal";
}

TEST(Poster, withoutABoundaryThereIsNone) {
  const Result<Bytes> none = posterWebp(LatticeMesh(), Manifest());
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kBadInput);
}

}  // namespace
}  // namespace qtet
