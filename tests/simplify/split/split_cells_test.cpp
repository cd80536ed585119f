#include "simplify/split/split_cells.h"

#include <gtest/gtest.h>

#include <limits>

#include "simplify/clean/clean_mesh.h"
#include "simplify/clean/mend_faces.h"
#include "simplify/read/parts/weld_points.h"
#include "tests/simplify/split/cell_grids.h"
#include "tests/support/homology.h"

namespace qtet {
namespace {

using testing::asPolyhedra;
using testing::asWedges;
using testing::curved;
using testing::Filled;
using testing::filledBy;
using testing::hexGrid;
using testing::higher;
using testing::mixed;

TetMesh splitOf(CellMesh mesh, SplitReport& report, CurvedCells how = CurvedCells::kSplit) {
  EXPECT_TRUE(checkCellMesh(mesh, "mesh")) << checkCellMesh(mesh, "mesh").error().text();
  Result<TetMesh> out = splitCells(std::move(mesh), {how, true}, report);
  EXPECT_TRUE(out) << out.error().text();
  return out ? std::move(*out) : TetMesh{};
}

TetMesh splitOf(CellMesh mesh) {
  SplitReport report;
  return splitOf(std::move(mesh), report);
}

/// The tetrahedra fill the unit cube, each once, and meet face to face; `triangles` on its hull.
void expectACube(const TetMesh& mesh, std::size_t triangles) {
  const Filled filled = filledBy(mesh);
  EXPECT_NEAR(filled.volume, 1, 1e-12);
  EXPECT_EQ(filled.notPositive, 0u);
  EXPECT_EQ(filled.facesOfMore, 0u);
  EXPECT_NEAR(filled.boundaryArea, 6, 1e-12);
  EXPECT_EQ(filled.openEdges, 0u);
  EXPECT_EQ(filled.boundary, triangles);
}

TEST(SplitCells, hexahedraOfAnyNumberingMeetFaceToFace) {
  for (std::uint32_t seed = 0; seed < 20; ++seed)
    expectACube(splitOf(hexGrid(4, seed)), 6 * 16 * 2);
}

TEST(SplitCells, straightHexahedraNeedNoNewPoints) {
  SplitReport report;
  const CellMesh grid = hexGrid(5, 1, 0);
  const TetMesh mesh = splitOf(grid, report);
  EXPECT_EQ(report.centrePoints, 0u);
  EXPECT_EQ(mesh.points.size(), grid.points.size());
  EXPECT_EQ(mesh.tetrahedra.size(), 6u * 125);
  EXPECT_EQ(report.cells[kHexahedronCell], 125u);
}

TEST(SplitCells, wedgesPyramidsAndPolyhedraFillTheSameCube) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    expectACube(splitOf(asWedges(hexGrid(3, seed))), 6 * 9 * 2);
    expectACube(splitOf(mixed(hexGrid(3, seed))), 6 * 9 * 2);
    expectACube(splitOf(asPolyhedra(hexGrid(3, seed))), 6 * 9 * 2);
  }
}

TEST(SplitCells, hexahedraAndPolyhedraAgreeOnTheFacesBetweenThem) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const CellMesh hexes = hexGrid(3, seed), polyhedra = asPolyhedra(hexes);
    CellMesh both = testing::pointsOf(hexes);
    for (std::size_t i = 0; i < hexes.cells(); ++i)
      i % 2 ? both.addCell(kHexahedronCell, hexes.cell(i))
            : both.addCell(kPolyhedronCell, polyhedra.cell(i));
    expectACube(splitOf(both), 6 * 9 * 2);
  }
}

TEST(SplitCells, theShellsOfAPolyhedronWithAHoleAreTurnedEachByItself) {
  // A cube of side 4 with a hole of side 1: whatever senses the faces are stored in, what is left
  // is 64 - 1.
  for (std::uint32_t turned = 0; turned < 4096; turned += 273) {
    CellMesh mesh;
    mesh.pointType = "float64";
    std::vector<VertexId> stream{12};
    std::uint32_t face = 0;
    for (const double side : {1.0, 4.0}) {
      const auto first = static_cast<VertexId>(mesh.points.size());
      for (const Position& p : hexGrid(1, 1, 0).points)
        mesh.points.push_back({side * (p[0] - 0.5), side * (p[1] - 0.5), side * (p[2] - 0.5)});
      const CellMesh cube = hexGrid(1, 1, 0);
      for (const ShapeFace& shape : shapeOf(kHexahedronCell).faces) {
        std::vector<VertexId> loop;
        for (std::size_t k = 0; k < 4; ++k) loop.push_back(first + cube.cell(0)[shape.corner[k]]);
        if (turned >> face++ & 1) std::ranges::reverse(loop);
        stream.push_back(4);
        stream.insert(stream.end(), loop.begin(), loop.end());
      }
    }
    mesh.addCell(kPolyhedronCell, stream);
    EXPECT_NEAR(filledBy(splitOf(mesh)).volume, 63, 1e-9) << turned;
  }
}

TEST(SplitCells, voxelsAreHexahedraInAnotherOrder) {
  CellMesh voxels = testing::pointsOf(hexGrid(3, 3, 0));
  const CellMesh hexes = hexGrid(3, 3, 0);
  for (std::size_t i = 0; i < hexes.cells(); ++i) {
    const auto c = hexes.cell(i);
    voxels.addCell(kVoxelCell, std::array{c[0], c[1], c[3], c[2], c[4], c[5], c[7], c[6]});
  }
  expectACube(splitOf(voxels), 6 * 9 * 2);
}

TEST(SplitCells, prismsOfFiveAndSixSidesAreFilled) {
  for (const std::size_t sides : {5u, 6u}) {
    CellMesh prism;
    std::vector<VertexId> ids;
    for (std::size_t k = 0; k < 2 * sides; ++k) {
      const double angle =
          2 * 3.14159265358979 * static_cast<double>(k % sides) / static_cast<double>(sides);
      prism.points.push_back({std::cos(angle), std::sin(angle), k < sides ? 0.0 : 1.0});
      ids.push_back(static_cast<VertexId>(k));
    }
    prism.addCell(sides == 5 ? kPentagonalPrismCell : kHexagonalPrismCell, ids);
    const Filled filled = filledBy(splitOf(prism));
    const double area = static_cast<double>(sides) / 2 *
                        std::sin(2 * 3.14159265358979 / static_cast<double>(sides));
    EXPECT_NEAR(filled.volume, area, 1e-9);
    EXPECT_EQ(filled.notPositive, 0u);
    EXPECT_EQ(filled.openEdges, 0u);
    EXPECT_EQ(filled.boundary, 2 * (sides - 2) + 2 * sides);
  }
}

TEST(SplitCells, aPolyhedronWithANodeOnItsEdgeHasNoFlatTetrahedron) {
  CellMesh mesh;  // a cube whose edge 0-1 has a node in the middle, as beside two smaller cells
  mesh.points = {{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                 {0, 0, 1}, {1, 0, 1},   {1, 1, 1}, {0, 1, 1}};
  mesh.addCell(kPolyhedronCell,
               std::vector<VertexId>{6, 5, 0, 4, 3, 2, 1, 5, 0, 1, 2, 6, 5, 4, 5, 6, 7,
                                     8, 4, 2, 3, 7, 6, 4, 3, 4, 8, 7, 4, 4, 0, 5, 8});
  const Filled filled = filledBy(splitOf(mesh));
  EXPECT_NEAR(filled.volume, 1, 1e-12);
  EXPECT_EQ(filled.notPositive, 0u);
  EXPECT_EQ(filled.openEdges, 0u);
  EXPECT_EQ(filled.boundary, 14u);
}

TEST(SplitCells, curvedCellsAreSplitAtAllOfTheirNodes) {
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    const CellMesh hexes = hexGrid(2, seed), wedges = asWedges(hexes);
    expectACube(splitOf(curved(hexes, kQuadraticHexahedronCell)), 6 * 4 * 6);
    expectACube(splitOf(curved(hexes, kTriquadraticHexahedronCell)), 6 * 4 * 8);
    expectACube(splitOf(curved(hexes, kBiquadraticQuadraticHexahedronCell)), 4 * 4 * 8 + 2 * 4 * 6);
    expectACube(splitOf(curved(wedges, kQuadraticWedgeCell)), 4 * 4 * 6 + 2 * 4 * 8);
    expectACube(splitOf(curved(wedges, kBiquadraticQuadraticWedgeCell)), 4 * 4 * 8 + 2 * 4 * 8);
    expectACube(splitOf(curved(wedges, kQuadraticLinearWedgeCell)), 4 * 4 * 4 + 2 * 4 * 8);
    CellMesh tets = testing::pointsOf(hexes);
    for (const Tetrahedron& t : splitOf(hexGrid(2, seed, 0)).tetrahedra)
      tets.addCell(kTetrahedronCell, t);
    tets.points = hexGrid(2, seed, 0).points;
    expectACube(splitOf(curved(tets, kQuadraticTetrahedronCell)), 6 * 4 * 2 * 4);
  }
}

TEST(SplitCells, biquadraticHexahedraAndQuadraticPyramidsAreFilled) {
  const CellMesh one = hexGrid(1, 4);
  expectACube(splitOf(curved(one, kBiquadraticQuadraticHexahedronCell)), 4 * 8 + 2 * 6);
  CellMesh pyramids = testing::pointsOf(one);
  const VertexId apex = testing::addCentre(pyramids, one.cell(0));
  for (const ShapeFace& face : shapeOf(kHexahedronCell).faces) {
    const auto c = one.cell(0);
    pyramids.addCell(kPyramidCell, std::array{c[face.corner[3]], c[face.corner[2]],
                                              c[face.corner[1]], c[face.corner[0]], apex});
  }
  expectACube(splitOf(curved(pyramids, kQuadraticPyramidCell)), 6 * 6);
  expectACube(splitOf(curved(pyramids, kBiquadraticPyramidCell)), 6 * 8);
}

TEST(SplitCells, linearisedCurvedCellsKeepTheirCornersAlone) {
  SplitReport report;
  TetMesh mesh =
      splitOf(curved(hexGrid(3, 2), kQuadraticHexahedronCell), report, CurvedCells::kLinear);
  expectACube(mesh, 6 * 9 * 2);
  const Result<CleanReport> cleaned = cleanMesh(mesh);
  ASSERT_TRUE(cleaned);
  EXPECT_EQ(mesh.points.size(), 64 + report.centrePoints);
}

TEST(SplitCells, lagrangeAndBezierCellsAreSplitAtAllOfTheirNodes) {
  const CellMesh hexes = hexGrid(2, 3), wedges = asWedges(hexes), straight = hexGrid(2, 3, 0);
  CellMesh tets = testing::pointsOf(straight);
  for (const Tetrahedron& t : splitOf(straight).tetrahedra) tets.addCell(kTetrahedronCell, t);
  for (const int degree : {1, 2, 3, 4}) {
    const auto triangles = static_cast<std::size_t>(6 * 4 * 2 * degree * degree);
    for (const bool bezier : {false, true}) {
      SplitReport report;
      expectACube(
          splitOf(higher(hexes, degree, bezier ? kBezierHexahedronCell : kLagrangeHexahedronCell),
                  report),
          triangles);
      expectACube(
          splitOf(higher(wedges, degree, bezier ? kBezierWedgeCell : kLagrangeWedgeCell), report),
          triangles);
      const TetMesh split = splitOf(
          higher(tets, degree, bezier ? kBezierTetrahedronCell : kLagrangeTetrahedronCell), report);
      expectACube(split, triangles);
      EXPECT_EQ(split.tetrahedra.size(),
                tets.cells() * static_cast<std::size_t>(degree * degree * degree));
      EXPECT_EQ(report.insideOut, 0u);
    }
  }
}

TEST(SplitCells, lagrangePyramidsMeetHexahedraAndTetrahedraOfTheirDegree) {
  const CellMesh hexes = hexGrid(2, 3), both = mixed(hexes);
  // A cube of six pyramids, of which every second is two tetrahedra.
  const CellMesh one = hexGrid(1, 4);
  CellMesh halved = testing::pointsOf(one);
  const VertexId apex = testing::addCentre(halved, one.cell(0));
  for (const ShapeFace& face : shapeOf(kHexahedronCell).faces) {
    const std::array c{one.cell(0)[face.corner[3]], one.cell(0)[face.corner[2]],
                       one.cell(0)[face.corner[1]], one.cell(0)[face.corner[0]]};
    if (halved.cells() % 3 == 0) {
      halved.addCell(kPyramidCell, std::array{c[0], c[1], c[2], c[3], apex});
    } else {
      halved.addCell(kTetrahedronCell, std::array{c[0], c[1], c[2], apex});
      halved.addCell(kTetrahedronCell, std::array{c[0], c[2], c[3], apex});
    }
  }
  for (const int degree : {1, 2, 3, 4, 7}) {
    SplitReport report;
    expectACube(splitOf(higher(both, degree), report),
                static_cast<std::size_t>(6 * 4 * 2 * degree * degree));
    EXPECT_EQ(report.insideOut, 0u);
    EXPECT_GT(report.cells[kLagrangePyramidCell], 0u);
    expectACube(splitOf(higher(halved, degree)), static_cast<std::size_t>(6 * 2 * degree * degree));
    expectACube(splitOf(higher(both, degree), report, CurvedCells::kLinear), 6 * 4 * 2);
  }
}

TEST(SplitCells, triquadraticPyramidsMeetTriquadraticHexahedra) {
  const CellMesh linear = mixed(hexGrid(2, 5));
  const auto only = [&](std::uint8_t type) {
    CellMesh out = testing::pointsOf(linear);
    for (std::size_t i = 0; i < linear.cells(); ++i) {
      if (linear.types[i] == type) out.addCell(type, linear.cell(i));
    }
    return out;
  };
  TetMesh hexes = splitOf(curved(only(kHexahedronCell), kTriquadraticHexahedronCell)),
          pyramids = splitOf(curved(only(kPyramidCell), kTriquadraticPyramidCell));
  EXPECT_NEAR(filledBy(hexes).volume + filledBy(pyramids).volume, 1, 1e-12);
  EXPECT_EQ(filledBy(hexes).notPositive + filledBy(pyramids).notPositive, 0u);
  // The two have the hull of the cube and the faces between them, in the same triangles: each
  // other's points lie at one place.
  const auto trianglesOf = [](const TetMesh& mesh) {
    std::map<std::array<Position, 3>, int> out;
    for (const Tetrahedron& t : mesh.tetrahedra) {
      for (std::size_t k = 0; k < 4; ++k) {
        std::array<Position, 3> face{mesh.points[t[(k + 1) % 4]], mesh.points[t[(k + 2) % 4]],
                                     mesh.points[t[(k + 3) % 4]]};
        std::ranges::sort(face);
        ++out[face];
      }
    }
    std::erase_if(out, [](const auto& entry) { return entry.second != 1; });
    return out;
  };
  const auto a = trianglesOf(hexes), b = trianglesOf(pyramids);
  const auto shared =
      std::ranges::count_if(a, [&](const auto& entry) { return b.contains(entry.first); });
  EXPECT_EQ(static_cast<std::size_t>(shared), (a.size() + b.size() - 6 * 4 * 8) / 2);
  EXPECT_GT(shared, 0);
}

TEST(SplitCells, cellsOfSevenNodeTrianglesLeaveTheMiddlesOut) {
  const CellMesh straight = hexGrid(1, 3, 0), wedges = asWedges(straight);
  CellMesh tets = testing::pointsOf(straight);
  for (const Tetrahedron& t : splitOf(straight).tetrahedra) tets.addCell(kTetrahedronCell, t);
  // A 10-node tetrahedron and an 18-node wedge, with 5 and 3 nodes more among and behind theirs.
  CellMesh fifteen = testing::curved(tets, kQuadraticTetrahedronCell),
           twentyOne = testing::curved(wedges, kBiquadraticQuadraticWedgeCell);
  const auto withMiddles = [](const CellMesh& from, std::uint8_t type, std::size_t first,
                              std::size_t count) {
    CellMesh out = testing::pointsOf(from);
    for (std::size_t i = 0; i < from.cells(); ++i) {
      std::vector<VertexId> ids(from.cell(i).begin(), from.cell(i).end());
      const VertexId middle = testing::addCentre(out, from.cell(i).first(4));
      ids.insert(ids.begin() + static_cast<std::ptrdiff_t>(first), count, middle);
      while (ids.size() < (type == kLagrangeWedgeCell ? 21u : 15u)) ids.push_back(middle);
      out.addCell(type, ids);
    }
    return out;
  };
  expectACube(splitOf(withMiddles(fifteen, kLagrangeTetrahedronCell, 10, 5)), 6 * 2 * 4);
  expectACube(splitOf(withMiddles(twentyOne, kLagrangeWedgeCell, 15, 2)), 4 * 8 + 2 * 8);
}

TEST(SplitCells, aRationalBezierCellComesToLieOnItsCircles) {
  CellMesh mesh;
  mesh.pointType = "float64";
  // along a quarter of a ring, across, and up
  const HigherCell& shape = higherCell(kBezierHexahedronCell, {2, 1, 1});
  std::vector<VertexId> ids;
  MeshField degrees{kDegreesField, 3, "uint8", {2, 1, 1}, "cell"},
      weights{kWeightsField, 1, "float64", {}, "point"}, x{"x", 1, "float64", {}, "point"};
  for (const auto& [i, j, k] : shape.places) {
    const double radius = 2.0 - j;  // so that the cell is not inside out
    mesh.points.push_back({i < 2 ? radius : 0, i > 0 ? radius : 0, static_cast<double>(k)});
    weights.values.push_back(i == 1 ? std::sqrt(0.5) : 1);
    x.values.push_back(mesh.points.back()[0]);
    ids.push_back(static_cast<VertexId>(ids.size()));
  }
  mesh.addCell(kBezierHexahedronCell, ids);
  mesh.fields = {degrees, weights, x};
  SplitReport report;
  const TetMesh split = splitOf(mesh, report);
  ASSERT_EQ(split.points.size(), 12u);
  for (std::size_t v = 0; v < 12; ++v) {
    const double radius = std::hypot(split.points[v][0], split.points[v][1]);
    EXPECT_NEAR(radius, radius > 1.5 ? 2 : 1, 1e-12);
    EXPECT_NEAR(split.fields[0].values[v], split.points[v][0], 1e-12);
  }
  EXPECT_EQ(split.tetrahedra.size(), 12u);
  EXPECT_EQ(filledBy(split).notPositive, 0u);
  ASSERT_EQ(split.fields.size(), 2u)
      << "x and the cells' numbers; the shape's own fields mean nothing of tetrahedra";
  EXPECT_EQ(split.fields[0].name, "x");

  constexpr double kNone = std::numeric_limits<double>::quiet_NaN(),
                   kInfinity = std::numeric_limits<double>::infinity();
  for (const double weight : {0.0, -1.0, kNone, kInfinity}) {
    CellMesh bad = mesh;
    bad.fields[1].values[3] = weight;
    const Result<TetMesh> refused = splitCells(std::move(bad), {}, report);
    ASSERT_FALSE(refused) << weight;
    EXPECT_EQ(refused.error().code, ErrorCode::kBadInput);
    EXPECT_NE(refused.error().message.find("weight"), std::string::npos);
  }
  std::ranges::fill(mesh.fields[1].values, std::numeric_limits<double>::denorm_min());
  const Result<TetMesh> refused = splitCells(CellMesh(mesh), {}, report);
  ASSERT_FALSE(refused) << "half of each is 0";
  EXPECT_NE(refused.error().message.find("weights"), std::string::npos);
}

TEST(SplitCells, aNumberOfNodesThatNoDegreeHasIsLinearisedOnRequestAlone) {
  CellMesh mesh;
  mesh.points.assign(19, {0, 0, 0});
  mesh.points[1] = {1, 0, 0}, mesh.points[2] = {0, 1, 0}, mesh.points[3] = {0, 0, 1};
  std::vector<VertexId> ids(19);
  std::iota(ids.begin(), ids.end(), 0u);
  for (const std::uint8_t type : {kLagrangeTetrahedronCell, kBezierTetrahedronCell}) {
    CellMesh one = mesh;
    one.addCell(type, ids);
    SplitReport report;
    const Result<TetMesh> refused = splitCells(CellMesh(one), {}, report);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kBadInput);
    EXPECT_NE(refused.error().message.find("19 nodes"), std::string::npos);
    EXPECT_EQ(splitOf(one, report, CurvedCells::kLinear).tetrahedra,
              (std::vector<Tetrahedron>{{0, 1, 2, 3}}));
  }
}

TEST(SplitCells, cellFieldsAreInheritedAndTheCellsNumberIsKept) {
  CellMesh mesh = hexGrid(2, 7);
  MeshField field{"p", 2, "float64", {}, "cell"};
  for (std::size_t i = 0; i < mesh.cells(); ++i)
    field.values.push_back(static_cast<double>(i)),
        field.values.push_back(100.0 + static_cast<double>(i));
  mesh.fields.push_back(field);
  for (std::size_t i = 0; i < mesh.cells(); ++i) mesh.cellIds.push_back(10 * i);
  const TetMesh split = splitOf(mesh);
  ASSERT_EQ(split.fields.size(), 2u);
  EXPECT_EQ(split.fields[1].name, kOriginalCellField);
  EXPECT_EQ(split.fields[1].type, "int32");
  ASSERT_EQ(split.fields[0].values.size(), 2 * split.tetrahedra.size());
  std::vector<double> volumes(8);
  for (std::size_t i = 0; i < split.tetrahedra.size(); ++i) {
    const double id = split.fields[1].values[i];
    ASSERT_EQ(split.fields[0].values[2 * i], id / 10);
    ASSERT_EQ(split.fields[0].values[2 * i + 1], 100 + id / 10);
    for (const VertexId v : split.tetrahedra[i]) {
      const auto cell = mesh.cell(static_cast<std::size_t>(id / 10));
      ASSERT_TRUE(v >= mesh.points.size() || std::ranges::find(cell, v) != cell.end());
    }
  }
}

TEST(SplitCells, tetrahedraAloneStayAsTheyAreWithoutANewField) {
  CellMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.addCell(kTetrahedronCell, std::array<VertexId, 4>{0, 2, 1, 3});
  const TetMesh split = splitOf(mesh);
  EXPECT_EQ(split.tetrahedra, (std::vector<Tetrahedron>{{0, 2, 1, 3}}));
  EXPECT_TRUE(split.fields.empty());
}

TEST(SplitCells, aCellTooCrookedForItsVerticesGetsACentreWithMeanValues) {
  CellMesh mesh = hexGrid(1, 0, 0);
  std::vector<VertexId> corner(mesh.cell(0).begin(), mesh.cell(0).end());
  // the far corner pulled in past the middle: no fan from the near one stays positive
  mesh.points[corner[6]] = {0.45, 0.45, 0.45};
  mesh.fields.push_back({"f", 1, "float64", {1, 2, 3, 4, 5, 6, 7, 8}, "point"});
  mesh.fields.push_back({"i", 1, "int32", {1, 2, 3, 4, 5, 6, 7, 8}, "point"});
  mesh.vertices.assign({0, 1, 2, 3, 4, 5, 6, 7});
  std::vector<Position> ordered;
  for (const VertexId v : corner) ordered.push_back(mesh.points[v]);
  mesh.points = ordered;
  SplitReport report;
  const TetMesh split = splitOf(mesh, report);
  if (report.centrePoints == 0) {
    EXPECT_EQ(filledBy(split).notPositive, 0u);
    return;
  }
  EXPECT_EQ(split.fields[0].values.back(), 4.5);
  EXPECT_EQ(split.fields[1].values.back(), 1);
  EXPECT_EQ(split.points.size(), 9u);
}

TEST(SplitCells, cellsStoredInsideOutAreTurnedAndCounted) {
  CellMesh mesh = hexGrid(2, 3, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 4; ++k)
      std::swap(mesh.vertices[8 * i + k], mesh.vertices[8 * i + 4 + k]);
  }
  SplitReport report;
  expectACube(splitOf(mesh, report), 6 * 4 * 2);
  EXPECT_EQ(report.insideOut, 3u);
}

TEST(SplitCells, collapsedEdgesLeaveTheRestOfTheCell) {
  CellMesh mesh = hexGrid(1, 0, 0);
  const std::vector<VertexId> c(mesh.cell(0).begin(), mesh.cell(0).end());
  // the upper face folded to an edge: a wedge
  mesh.vertices = {c[0], c[1], c[2], c[3], c[4], c[5], c[5], c[4]};
  const Filled filled = filledBy(splitOf(mesh));
  EXPECT_NEAR(filled.volume, 0.5, 1e-12);
  EXPECT_EQ(filled.openEdges, 0u);
  EXPECT_EQ(filled.notPositive, 0u);
  mesh.vertices = {c[0], c[0], c[0], c[0], c[4], c[4], c[4], c[4]};
  SplitReport report;
  EXPECT_TRUE(splitOf(mesh, report).tetrahedra.empty());
  EXPECT_EQ(report.collapsed, 1u);
}

TEST(CheckCellMesh, whatIsWrongIsNamedWithItsCell) {
  CellMesh good = hexGrid(1, 0);
  const auto refused = [](const CellMesh& mesh, const char* word) {
    const Status checked = checkCellMesh(mesh, "file.msh");
    ASSERT_FALSE(checked);
    EXPECT_EQ(checked.error().code, ErrorCode::kBadInput);
    EXPECT_NE(checked.error().message.find(word), std::string::npos) << checked.error().message;
  };
  CellMesh mesh = good;
  mesh.vertices[3] = 8;
  refused(mesh, "cell 0 is a hexahedron without 8 vertices among the 8 points");
  mesh = good;
  mesh.types[0] = 41;
  refused(mesh, "VTK type 41");
  mesh = asPolyhedra(good);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    CellMesh broken = mesh;
    broken.vertices[i] = 200;
    refused(broken, "cell 0 is a polyhedron");
  }
  mesh = good;
  mesh.fields.push_back({"f", 1, "float32", {1, 2, 3}, "point"});
  refused(mesh, "point field f has 3 tuples for 8 points");
}

TEST(CheckCellMesh, polyhedraOfManyFacesAreRefusedBeforeTheyTakeHours) {
  for (const VertexId n : {VertexId{2047}, VertexId{2048}}) {  // corners of a double pyramid's base
    CellMesh mesh;
    std::vector<VertexId> stream{2 * n};
    for (VertexId i = 0; i < n; ++i) {
      const double angle = 2 * 3.14159265358979323846 * i / n;
      mesh.points.push_back({std::cos(angle), std::sin(angle), 0});
      const VertexId next = (i + 1) % n;
      stream.insert(stream.end(), {3, i, next, n, 3, next, i, n + 1});
    }
    mesh.points.push_back({0, 0, 1});
    mesh.points.push_back({0, 0, -1});
    mesh.addCell(kPolyhedronCell, stream);
    const Status checked = checkCellMesh(mesh, "file.vtu");
    if (stream.size() <= kMaxPolyhedronNumbers) {
      ASSERT_TRUE(checked) << checked.error().text();
      EXPECT_NEAR(filledBy(splitOf(mesh)).volume, 2 * 3.14159265358979323846 / 3, 1e-5);
    } else {
      ASSERT_FALSE(checked);
      EXPECT_EQ(checked.error().code, ErrorCode::kLimitExceeded);
      EXPECT_NE(
          checked.error().message.find("cell 0 is a polyhedron whose faces take 16385 numbers"),
          std::string::npos)
          << checked.error().message;
    }
  }
}

/// A ring of `n` hexahedra round an axis, two layers high and two thick, whose ends coincide but
/// have points of their own.
CellMesh openRing(std::size_t n) {
  CellMesh mesh;
  const auto at = [](std::size_t i, std::size_t j, std::size_t k) {
    return static_cast<VertexId>(9 * i + 3 * j + k);
  };
  for (std::size_t i = 0; i <= n; ++i) {
    const double angle =
        2 * 3.14159265358979323846 * static_cast<double>(i % n) / static_cast<double>(n);
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double r = 1 + 0.3 * static_cast<double>(j);
        mesh.points.push_back(
            {r * std::cos(angle), r * std::sin(angle), 0.3 * static_cast<double>(k)});
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      for (std::size_t k = 0; k < 2; ++k) {
        mesh.addCell(kHexahedronCell,
                     std::array{at(i, j, k), at(i, j + 1, k), at(i + 1, j + 1, k), at(i + 1, j, k),
                                at(i, j, k + 1), at(i, j + 1, k + 1), at(i + 1, j + 1, k + 1),
                                at(i + 1, j, k + 1)});
      }
    }
  }
  return mesh;
}

void expectARing(TetMesh mesh, std::uint64_t cells) {
  const Result<CleanReport> cleaned = cleanMesh(mesh);
  ASSERT_TRUE(cleaned) << cleaned.error().text();
  EXPECT_EQ(cleaned->nonManifoldEdges.count, 0u);
  EXPECT_EQ(cleaned->nonManifoldVertices.count, 0u);
  EXPECT_EQ(cleaned->invertedCells.count + cleaned->flatCells.count, 0u);
  EXPECT_EQ(cleaned->components, 1u);
  EXPECT_EQ(testing::bettiNumbers(mesh.tetrahedra), (std::array<std::int64_t, 4>{1, 1, 0, 0}));
  EXPECT_EQ(filledBy(mesh).boundary, 2 * 8 * cells);
}

TEST(Weld, ringsOfEvenAndOddNumbersOfHexahedraClose) {
  for (const std::size_t n : {7u, 8u}) {
    for (const double distance : {0.0, 1e-3}) {
      CellMesh ring = openRing(n);
      if (distance > 0) ring.points.back()[0] += 5e-4;
      EXPECT_EQ(weldPoints(ring, distance), 9u);
      expectARing(splitOf(ring), n);
    }
  }
}

TEST(Weld, pointsFurtherApartThanTheDistanceStay) {
  CellMesh ring = openRing(7);
  for (std::size_t v = 63; v < 72; ++v) ring.points[v][2] += 2e-3;
  CellMesh other = ring;
  EXPECT_EQ(weldPoints(ring, 1.99e-3), 0u);
  EXPECT_EQ(weldPoints(other, 2.01e-3), 9u);
}

TEST(Weld, distancesBelowTheSpacingOfNumbersJoinWhatLiesAtOnePlace) {
  for (const double distance : {1e-12, 1e-17, 1e-310, std::numeric_limits<double>::denorm_min()}) {
    CellMesh ring = openRing(7);
    for (Position& p : ring.points) p[0] += 1e6;  // where numbers are 1e-10 apart
    EXPECT_EQ(weldPoints(ring, distance), 9u) << distance;
  }
}

/// The ring with each hexahedron cut into five tetrahedra by parity, as one cuts structured grids:
/// an odd ring's ends do not fit.
TetMesh fiveSplit(const CellMesh& ring) {
  constexpr std::array<std::array<std::size_t, 4>, 5> kEven{
      {{0, 1, 3, 4}, {1, 2, 3, 6}, {1, 4, 5, 6}, {3, 4, 6, 7}, {1, 3, 4, 6}}};
  constexpr std::array<std::array<std::size_t, 4>, 5> kOdd{
      {{0, 1, 2, 5}, {0, 2, 3, 7}, {0, 4, 5, 7}, {2, 5, 6, 7}, {0, 2, 5, 7}}};
  TetMesh mesh{ring.points, {}, {{"cell", 1, "int32", {}, "cell"}}, "float64"};
  for (std::size_t i = 0; i < ring.cells(); ++i) {
    const bool even = (i / 4 + i / 2 % 2 + i % 2) % 2 == 0;
    for (const auto& t : even ? kEven : kOdd) {
      const auto c = ring.cell(i);
      mesh.tetrahedra.push_back({c[t[0]], c[t[1]], c[t[2]], c[t[3]]});
      mesh.fields[0].values.push_back(static_cast<double>(i));
    }
  }
  return mesh;
}

TEST(MendFaces, anOddRingCutByParityClosesWithoutACrossedFace) {
  for (const std::size_t n : {7u, 8u}) {
    CellMesh ring = openRing(n);
    weldPoints(ring, 0);
    TetMesh mesh = fiveSplit(ring);
    const double before = filledBy(mesh).absolute;
    const MendReport report = mendCrossedFaces(mesh);
    EXPECT_EQ(report.mended, n % 2 ? 4u : 0u);
    EXPECT_EQ(report.left, 0u);
    EXPECT_EQ(mesh.tetrahedra.size(), 20 * n + report.mended);
    EXPECT_NEAR(filledBy(mesh).absolute, before, 1e-12);
    ASSERT_EQ(mesh.fields[0].values.size(), mesh.tetrahedra.size());
    for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
      const auto cell = ring.cell(static_cast<std::size_t>(mesh.fields[0].values[i]));
      for (const VertexId v : mesh.tetrahedra[i]) ASSERT_NE(std::ranges::find(cell, v), cell.end());
    }
    expectARing(std::move(mesh), n);
  }
}

TEST(MendFaces, thousandsOfCellsRoundOneEdgeAreLookedThroughAtOnce) {
  constexpr VertexId kCells = 5000;
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {0, 0, 1}};
  for (VertexId i = 0; i < kCells; ++i) {
    for (const double turn : {0.0, 0.5})
      mesh.points.push_back({std::cos((i + turn) * 1e-4), std::sin((i + turn) * 1e-4), 0.5});
    mesh.tetrahedra.push_back({0, 1, 2 * i + 2, 2 * i + 3});
  }
  const std::vector<Tetrahedron> before = mesh.tetrahedra;
  EXPECT_EQ(mendCrossedFaces(mesh).mended, 0u);
  EXPECT_EQ(mesh.tetrahedra, before);
}

TEST(MendFaces, aCavityOfOneTetrahedronStays) {
  TetMesh mesh = splitOf(hexGrid(4, 5));
  mesh.tetrahedra.erase(std::ranges::find_if(mesh.tetrahedra, [&](const Tetrahedron& t) {
    return std::ranges::all_of(t, [&](VertexId v) {
      return std::ranges::all_of(mesh.points[v], [](double x) { return x > 0 && x < 1; });
    });
  }));
  mesh.fields.clear();
  const std::vector<Tetrahedron> before = mesh.tetrahedra;
  EXPECT_EQ(mendCrossedFaces(mesh).mended, 0u);
  EXPECT_EQ(mesh.tetrahedra, before);
}

}  // namespace
}  // namespace qtet
