// Steps whose points or cells stand in another order than those of the first step.
#include "simplify/read/steps/step_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "simplify/read/read_mesh.h"
#include "simplify/read/read_segments.h"
#include "simplify/read/steps/join_blocks.h"
#include "tests/simplify/mesh/tet_meshes.h"
#include "tests/simplify/read/steps/step_files.h"

namespace qtet {
namespace {

using testing::seriesOf;
using testing::twoCells;

/// Two cells with a field of the points and one of the cells.
TetMesh restMesh() {
  TetMesh mesh = twoCells();
  mesh.fields.push_back({"T", 1, "float32", {10, 11, 12, 13, 14}});
  mesh.fields.push_back({"v", 2, "float32", {20, 0, 21, 1}, "cell"});
  return mesh;
}

/// The same mesh with the point v called names[v].
TetMesh renumbered(const TetMesh& mesh, const std::vector<VertexId>& names) {
  TetMesh out = mesh;
  for (std::size_t v = 0; v < names.size(); ++v) {
    out.points[names[v]] = mesh.points[v];
    out.fields[0].values[names[v]] = mesh.fields[0].values[v];
  }
  for (Tetrahedron& t : out.tetrahedra)
    for (VertexId& v : t) v = names[v];
  return out;
}

void swapCells(TetMesh& mesh) {
  std::swap(mesh.tetrahedra[0], mesh.tetrahedra[1]);
  for (std::size_t c = 0; c < 2; ++c)
    std::swap(mesh.fields[1].values[c], mesh.fields[1].values[2 + c]);
}

Result<ReadMesh> readSeries(const std::vector<TetMesh>& steps) {
  ReadOptions options;
  options.time = "all";
  return readMesh(seriesOf(steps), options);
}

void expectUndone(const TetMesh& step, const char* what) {
  const Result<ReadMesh> read = readSeries({restMesh(), step});
  ASSERT_TRUE(read) << what << ": " << read.error().message;
  EXPECT_EQ(read->mesh.points, restMesh().points) << what;
  EXPECT_EQ(read->mesh.tetrahedra, restMesh().tetrahedra) << what;
  ASSERT_EQ(read->mesh.fields.size(), 4u) << what;
  for (const MeshField& field : read->mesh.fields)
    EXPECT_EQ(field.values, restMesh().fields[isCellField(field) ? 1 : 0].values)
        << what << " " << field.name;
  EXPECT_EQ(read->report.motion, "") << what;
  EXPECT_EQ(read->report.notes,
            std::vector<std::string>{"its points or cells stand in another order at time 1, and "
                                     "were put into that of time 0"})
      << what;
}

TEST(StepOrder, pointsAndCellsInAnotherOrderArePutIntoTheFirstStepsOne) {
  TetMesh step = renumbered(restMesh(), {3, 0, 4, 1, 2});
  expectUndone(step, "points");
  swapCells(step);
  expectUndone(step, "points and cells");
  step = restMesh();
  swapCells(step);
  expectUndone(step, "cells");
  step = restMesh();
  std::swap(step.tetrahedra[0][0], step.tetrahedra[0][1]);
  std::swap(step.tetrahedra[0][2], step.tetrahedra[0][3]);
  expectUndone(step, "corners");
}

TEST(StepOrder, cellsInAnotherOrderMayMove) {
  TetMesh step = restMesh();
  swapCells(step);
  step.points[4] = {2, 2, 2};
  const Result<ReadMesh> read = readSeries({restMesh(), step});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->report.motion, "Displacement");
  const auto cells = std::ranges::find(read->mesh.fields, "v@1", &MeshField::name);
  ASSERT_NE(cells, read->mesh.fields.end());
  EXPECT_EQ(cells->values, restMesh().fields[1].values);
}

TEST(StepOrder, pointsInAnotherOrderThanTheirCellsAreRefused) {
  TetMesh step = restMesh();
  std::swap(step.points[0], step.points[4]);
  const Result<ReadMesh> read = readSeries({restMesh(), step});
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::kBadInput);
  EXPECT_TRUE(read.error().message.ends_with(
      "run.pvd: the points at time 1 are those of time 0 in another order, but its cells name the "
      "same numbers, so they would be torn; write points and cells of all steps in one order"))
      << read.error().message;
}

/// Eight cells round an axis, so that a quarter turn is an order of its points.
TetMesh wheel(int quarters) {
  TetMesh mesh;
  constexpr std::array<Position, 4> kRound{{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}};
  mesh.points = {{0, 0, -1}, {0, 0, 1}};
  for (std::size_t i = 0; i < 4; ++i)
    mesh.points.push_back(kRound[(i + static_cast<std::size_t>(quarters)) % 4]);
  for (VertexId i = 0; i < 4; ++i) mesh.tetrahedra.push_back({0, 2 + i, 2 + (i + 1) % 4, 1});
  return mesh;
}

TEST(StepOrder, aBodyThatTurnsIntoItselfMoves) {
  const Result<ReadMesh> read = readSeries({wheel(0), wheel(1)});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->report.motion, "Displacement");
}

TEST(StepOrder, anotherOrderBeginsNoOtherRunOfSteps) {
  TetMesh other = restMesh();
  other.tetrahedra[1] = {0, 2, 3, 4};
  ReadOptions options;
  options.time = "all";
  std::vector<std::string> notes;
  const auto runs = segmentTimes(
      seriesOf({restMesh(), renumbered(restMesh(), {3, 0, 4, 1, 2}), restMesh(), other, other}),
      options, [](double) {}, notes);
  ASSERT_TRUE(runs) << runs.error().message;
  EXPECT_EQ(*runs, (std::vector<std::vector<double>>{{0, 1, 2}, {3, 4}}));
}

TEST(StepOrder, pointsThatShareAPlaceKeepTheirNumbers) {
  CellMesh rest;
  rest.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 1}, {1, 1, 1}};
  for (const auto& ids : {std::array<VertexId, 4>{0, 1, 2, 3}, {1, 2, 4, 5}})
    rest.addCell(kTetrahedronCell, ids);
  CellMesh swapped = rest;
  swapped.vertices = {1, 2, 4, 5, 0, 1, 2, 3};
  StepOrder order(rest);
  EXPECT_TRUE(order.restore(swapped));
  EXPECT_TRUE(haveSameCells(rest, swapped));
  CellMesh other = rest;
  std::swap(other.points[0], other.points[5]);
  for (VertexId& v : other.vertices) v = v == 0 ? 5 : v == 5 ? 0 : v;
  EXPECT_FALSE(order.restore(other)) << "3 and 4 cannot be told from one another";
}

TEST(StepOrder, otherCellsStayAsTheyAre) {
  CellMesh rest;
  rest.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  rest.addCell(kTetrahedronCell, std::array<VertexId, 4>{0, 1, 2, 3});
  StepOrder order(rest);
  for (const VertexId other : {VertexId{4}, VertexId{5}, kGhost}) {
    CellMesh step = rest;
    step.vertices[3] = other;
    EXPECT_FALSE(order.restore(step)) << other;
    EXPECT_EQ(step.vertices[3], other);
  }
  CellMesh step = rest;
  step.addCell(kTetrahedronCell, std::array<VertexId, 4>{0, 1, 2, 4});
  EXPECT_FALSE(order.restore(step));
  step = rest;
  step.types[0] = kPyramidCell;
  EXPECT_FALSE(order.restore(step));
}

}  // namespace
}  // namespace qtet
