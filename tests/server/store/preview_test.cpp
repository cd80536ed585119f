#include "server/store/preview.h"

#include <gtest/gtest.h>
#include <png.h>

#include <array>

namespace qtet {
namespace {

/// A lattice cube of two triangles a side, its lower half at value 0 and its upper half at 100.
LatticeMesh cube() {
  LatticeMesh out;
  for (int i = 0; i < 8; ++i)
    out.points.push_back({(i & 1) * 1000, (i >> 1 & 1) * 1000, (i >> 2) * 1000});
  out.boundary = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                  {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  FieldInfo field;
  field.name = "height";
  field.minimum = {0};
  field.range = {0, 100};
  out.fields = {field};
  out.values = {{0, 0, 0, 0, 100, 100, 100, 100}};
  return out;
}

struct Picture {
  Bytes pixels = Bytes(std::size_t{4} * kPreviewWidth * kPreviewHeight);
  [[nodiscard]] std::array<int, 4> at(int column, int row) const {
    std::array<int, 4> out{};
    for (std::size_t c = 0; c < 4; ++c)
      out[c] = pixels[4 * (static_cast<std::size_t>(row) * kPreviewWidth +
                           static_cast<std::size_t>(column)) +
                      c];
    return out;
  }
  [[nodiscard]] double covered() const {
    double out = 0;
    for (std::size_t i = 3; i < pixels.size(); i += 4) out += pixels[i] / 255.0;
    return out;
  }
};

Picture pictureOf(const LatticeMesh& mesh) {
  const Result<Bytes> png = previewPng(mesh);
  EXPECT_TRUE(png);
  Picture out;
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, png->data(), png->size()), 0);
  EXPECT_EQ(image.width, static_cast<png_uint_32>(kPreviewWidth));
  EXPECT_EQ(image.height, static_cast<png_uint_32>(kPreviewHeight));
  image.format = PNG_FORMAT_RGBA;
  EXPECT_NE(png_image_finish_read(&image, nullptr, out.pixels.data(), 0, nullptr), 0);
  return out;
}

TEST(Preview, theMeshFillsThePictureAndTheRestIsTransparent) {
  const Picture picture = pictureOf(cube());
  EXPECT_EQ(picture.at(0, 0)[3], 0);
  EXPECT_EQ(picture.at(kPreviewWidth / 2, kPreviewHeight / 2)[3], 255);
  EXPECT_EQ(picture.at(kPreviewWidth / 2, 5)[3], 0);
  int rows = 0;
  for (int row = 0; row < kPreviewHeight; ++row)
    rows += picture.at(kPreviewWidth / 2, row)[3] == 255;
  EXPECT_GT(rows, kPreviewHeight * 7 / 10);
}

TEST(Preview, theFieldsRangeRunsFromVioletToYellow) {
  const Picture picture = pictureOf(cube());
  int top = 0, bottom = kPreviewHeight - 1;
  while (picture.at(kPreviewWidth / 2, top)[3] < 255) ++top;
  while (picture.at(kPreviewWidth / 2, bottom)[3] < 255) --bottom;
  const auto high = picture.at(kPreviewWidth / 2, top + 10),
             low = picture.at(kPreviewWidth / 2, bottom - 10);
  EXPECT_GT(high[0], 2 * high[2]) << "yellow";
  EXPECT_GT(low[2], low[1]) << "violet";
}

TEST(Preview, withoutAFieldAndInGapsItIsGrey) {
  LatticeMesh bare = cube();
  bare.fields.clear();
  bare.values.clear();
  LatticeMesh hasMissing = cube();
  hasMissing.fields[0].hasMissing = true;
  hasMissing.values[0].assign(8, kMissing);
  for (const LatticeMesh& mesh : {bare, hasMissing}) {
    const auto pixel = pictureOf(mesh).at(kPreviewWidth / 2, kPreviewHeight / 2);
    EXPECT_EQ(pixel[0], pixel[1]);
    EXPECT_EQ(pixel[1], pixel[2]);
  }
}

TEST(Preview, facesThatLookAwayAreNotDrawn) {
  LatticeMesh one = cube();
  one.boundary = {{0, 2, 1}, {1, 2, 3}};  // the cube's floor, seen from above
  EXPECT_EQ(pictureOf(one).covered(), 0);
  one.boundary = {{0, 1, 2}, {1, 3, 2}};
  EXPECT_GT(pictureOf(one).covered(), 1000);
}

TEST(Preview, withoutABoundaryThereIsNoPicture) {
  EXPECT_EQ(previewPng(LatticeMesh()).error().code, ErrorCode::kBadInput);
}

}  // namespace
}  // namespace qtet
