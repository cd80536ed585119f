// Cells as their faces say, in VTK's order: the expected vertices are those of vtkOpenFOAMReader.
#include "simplify/read/foam/cell_shaper.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "simplify/split/cell_shapes.h"

namespace qtet {
namespace {

using FaceIds = std::vector<std::vector<VertexId>>;

/// The faces of a cell with vertices 10, 11, 12 ...
FaceIds facesOfShape(CellType type) {
  FaceIds out;
  for (const ShapeFace& face : shapeOf(type).faces) {
    out.emplace_back();
    for (std::size_t k = 0; k < face.corners; ++k)
      out.back().push_back(static_cast<VertexId>(10 + face.corner[k]));
  }
  return out;
}

/// The cell of these faces; face `reversed` is stored the other way round.
CellMesh shaped(const FaceIds& faces, std::size_t reversed = 99) {
  CellShaper shaper;
  shaper.addFace(std::vector<VertexId>{7, 8, 9}, false);  // of a cell before
  shaper.clear();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    std::vector<VertexId> corners = faces[i];
    if (i == reversed) std::reverse(corners.begin() + 1, corners.end());
    shaper.addFace(corners, i == reversed);
  }
  CellMesh out;
  shaper.addTo(out);
  return out;
}

TEST(CellShaper, everyShapeIsFoundWhicheverFaceIsFirstOrReversed) {
  for (const CellType type : {kTetrahedronCell, kHexahedronCell, kWedgeCell, kPyramidCell}) {
    FaceIds faces = facesOfShape(type);
    for (std::size_t turns = 0; turns < faces.size(); ++turns) {
      for (std::size_t reversed = 0; reversed <= faces.size(); ++reversed) {
        const CellMesh mesh = shaped(faces, reversed);
        ASSERT_EQ(mesh.types, std::vector<std::uint8_t>{type});
        // each face of the cell, seen from outside, is one of those given
        for (const ShapeFace& face : shapeOf(type).faces) {
          std::vector<VertexId> corners;
          for (std::size_t k = 0; k < face.corners; ++k)
            corners.push_back(mesh.cell(0)[face.corner[k]]);
          std::ranges::rotate(corners, std::ranges::min_element(corners));
          EXPECT_TRUE(std::ranges::any_of(faces, [&](std::vector<VertexId> given) {
            std::ranges::rotate(given, std::ranges::min_element(given));
            return given == corners;
          }));
        }
      }
      std::ranges::rotate(faces, faces.begin() + 1);
    }
  }
}

TEST(CellShaper, verticesStandAsVtkOrdersThem) {
  const auto ids = [](const FaceIds& faces) {
    const CellMesh mesh = shaped(faces);
    return std::vector<VertexId>(mesh.cell(0).begin(), mesh.cell(0).end());
  };
  EXPECT_EQ(ids({{2, 65, 22}, {2, 22, 18}, {65, 2, 18}, {65, 18, 22}}),
            (std::vector<VertexId>{2, 22, 65, 18}));
  EXPECT_EQ(ids({{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}),
            (std::vector<VertexId>{0, 1, 2, 3, 4}));
  EXPECT_EQ(ids({{0, 3, 4, 1}, {0, 1, 2}, {3, 5, 4}, {1, 4, 5, 2}, {2, 5, 3, 0}}),
            (std::vector<VertexId>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(
      ids({{5, 1, 0, 4}, {1, 2, 3, 0}, {5, 6, 2, 1}, {6, 7, 3, 2}, {7, 4, 0, 3}, {4, 7, 6, 5}}),
      (std::vector<VertexId>{5, 4, 0, 1, 6, 7, 3, 2}));
}

TEST(CellShaper, otherCellsArePolyhedraWithTheirFacesSeenFromOutside) {
  FaceIds faces = facesOfShape(kPentagonalPrismCell);
  const CellMesh mesh = shaped(faces, 1);
  ASSERT_EQ(mesh.types, std::vector<std::uint8_t>{kPolyhedronCell});
  std::vector<VertexId> stream{7};
  for (const std::vector<VertexId>& face : faces) {
    stream.push_back(static_cast<VertexId>(face.size()));
    stream.insert(stream.end(), face.begin(), face.end());
  }
  EXPECT_EQ(std::vector<VertexId>(mesh.cell(0).begin(), mesh.cell(0).end()), stream);
}

/// Six quadrilaterals and eight vertices, two of which are corners of all faces.
TEST(CellShaper, sixQuadrilateralsThatAreNoHexahedronStayAPolyhedron) {
  FaceIds faces;
  for (VertexId i = 0; i < 6; ++i) faces.push_back({6, i, 7, (i + 1) % 6});
  EXPECT_EQ(shaped(faces).types, std::vector<std::uint8_t>{kPolyhedronCell});
  const FaceIds twice{{0, 1, 2, 3}, {0, 3, 2, 1}, {4, 5, 6, 7},
                      {4, 7, 6, 5}, {0, 1, 2, 3}, {0, 3, 2, 1}};
  EXPECT_EQ(shaped(twice).types, std::vector<std::uint8_t>{kPolyhedronCell});
}

TEST(CellShaper, aCellWithoutFacesIsRefusedLater) {
  const CellMesh mesh = shaped({});
  EXPECT_EQ(mesh.types, std::vector<std::uint8_t>{kPolyhedronCell});
  EXPECT_EQ(mesh.vertices, std::vector<VertexId>{0});
}

}  // namespace
}  // namespace qtet
