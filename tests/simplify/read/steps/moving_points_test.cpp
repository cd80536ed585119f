// Points that move over the steps of a file, which become a point field of displacements.
#include "simplify/read/steps/moving_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "simplify/read/read_mesh.h"
#include "simplify/read/read_times.h"
#include "tests/simplify/mesh/tet_meshes.h"
#include "tests/simplify/read/steps/step_files.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using testing::oneCell;
using testing::seriesOf;
using testing::twoCells;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The two cells with their last point moved, and a field of the step's number.
TetMesh stepOf(int number, const Position& by) {
  TetMesh mesh = twoCells();
  for (std::size_t c = 0; c < 3; ++c) mesh.points[4][c] += by[c];
  mesh.fields.push_back({"T", 1, "float32", std::vector<double>(5, number)});
  mesh.pointType = "float32";
  return mesh;
}

std::vector<TetMesh> movingSteps() {
  return {stepOf(0, {}), stepOf(1, {0.5, 0, 0}), stepOf(2, {0, -0.25, 2})};
}

Result<ReadMesh> readAll(const fs::path& path, const FieldNames& fields = std::nullopt,
                         std::optional<double> weld = std::nullopt) {
  ReadOptions options;
  options.time = "all", options.fields = fields, options.weld = weld;
  return readMesh(path, options);
}

std::vector<std::string> namesOf(const TetMesh& mesh) {
  std::vector<std::string> out;
  for (const MeshField& field : mesh.fields) out.push_back(field.name);
  return out;
}

bool hasNote(const ReadMesh& read, const std::string& part) {
  return std::ranges::any_of(read.report.notes, [&](const std::string& note) {
    return note.find(part) != std::string::npos;
  });
}

CellMesh asCells(const TetMesh& mesh) {
  CellMesh out;
  out.points = mesh.points;
  for (const Tetrahedron& t : mesh.tetrahedra) out.addCell(kTetrahedronCell, t);
  return out;
}

TEST(MovingPoints, aDisplacementIsRoundedOnceToItsType) {
  const CellMesh rest = asCells(oneCell());
  std::vector<Position> points = rest.points;
  points[1] = {1.1, 0, 0};
  const Result<MeshField> wide = displacementOf(rest, points, "float64");
  ASSERT_TRUE(wide);
  EXPECT_EQ(wide->values, (std::vector<double>{0, 0, 0, 1.1 - 1, 0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(wide->components, 3u);
  EXPECT_EQ(largestDisplacement(*wide), 1.1 - 1);
  const Result<MeshField> narrow = displacementOf(rest, points, "float32");
  ASSERT_TRUE(narrow);
  EXPECT_EQ(narrow->type, "float32");
  EXPECT_EQ(narrow->values[3], static_cast<float>(1.1 - 1));
  points.pop_back();
  EXPECT_EQ(displacementOf(rest, points, "float64").error().code, ErrorCode::kBadInput);
}

TEST(MovingPoints, onlyAPointThatNoCellUsesMayLieNowhere) {
  CellMesh rest = asCells(oneCell());
  rest.points.push_back({kNone, 0, 0});
  std::vector<Position> points = rest.points;
  EXPECT_TRUE(areSamePoints(rest.points, points));
  Result<MeshField> field = displacementOf(rest, points, "float64");
  ASSERT_TRUE(field);
  EXPECT_EQ(field->values, std::vector<double>(15, 0));
  points[2][1] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(areSamePoints(rest.points, points));
  field = displacementOf(rest, points, "float64");
  ASSERT_FALSE(field);
  EXPECT_NE(field.error().message.find("point 2 has a coordinate"), std::string::npos);
  points[2][1] = std::numeric_limits<float>::max() * 2.0;
  EXPECT_TRUE(displacementOf(rest, points, "float64"));
  EXPECT_FALSE(displacementOf(rest, points, "float32")) << "no float32 holds it";
}

TEST(MovingPoints, theNameIsOneThatTheFileDoesNotHave) {
  CellMesh step;
  EXPECT_EQ(displacementName(step), "Displacement");
  step.fields.push_back({"Displacement@0.5", 3, "float64", {}});
  EXPECT_EQ(displacementName(step), "Motion");
  step.otherFields.emplace_back("Motion");
  EXPECT_EQ(displacementName(step), "Motion-2");
}

TEST(MovingPoints, theFirstStepIsTheMeshAndEveryStepADisplacement) {
  const Result<ReadMesh> read = readAll(seriesOf(movingSteps()));
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->mesh.points, twoCells().points);
  EXPECT_EQ(namesOf(read->mesh),
            (std::vector<std::string>{"T@0", "Displacement@0", "T@1", "Displacement@1", "T@2",
                                      "Displacement@2"}));
  for (const std::size_t f : {1, 3, 5}) {
    EXPECT_EQ(read->mesh.fields[f].type, "float32");
    EXPECT_EQ(read->mesh.fields[f].components, 3u);
  }
  EXPECT_EQ(read->mesh.fields[1].values, std::vector<double>(15, 0));
  std::vector<double> last(15, 0);
  last[13] = -0.25, last[14] = 2;
  EXPECT_EQ(read->mesh.fields[5].values, last);
  EXPECT_EQ(read->report.motion, "Displacement");
  EXPECT_TRUE(hasNote(*read,
                      "the points move over its 3 steps; the mesh is that of time 0, and "
                      "the point field Displacement has how far they are from there, at "
                      "most 2.016"));
}

TEST(MovingPoints, theFirstStepThatIsChosenRests) {
  ReadOptions options;
  options.time = "1:";
  const Result<ReadMesh> read = readMesh(seriesOf(movingSteps()), options);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->mesh.points[4], (Position{1.5, 1, 1}));
  EXPECT_EQ(namesOf(read->mesh),
            (std::vector<std::string>{"T@1", "Displacement@1", "T@2", "Displacement@2"}));
  EXPECT_EQ(read->mesh.fields[3].values[12], -0.5);
}

TEST(MovingPoints, pointsThatRestMakeNoField) {
  const Result<ReadMesh> read = readAll(seriesOf({stepOf(0, {}), stepOf(1, {})}));
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(namesOf(read->mesh), (std::vector<std::string>{"T@0", "T@1"}));
  EXPECT_EQ(read->report.motion, "");
}

TEST(MovingPoints, pointsOfFloat64AnywhereMakeFieldsOfFloat64) {
  std::vector<TetMesh> steps = movingSteps();
  steps[1].pointType = "float64";
  const Result<ReadMesh> read = readAll(seriesOf(steps));
  ASSERT_TRUE(read) << read.error().text();
  for (const std::size_t f : {1, 3, 5}) EXPECT_EQ(read->mesh.fields[f].type, "float64");
}

TEST(MovingPoints, theListOfFieldsDecides) {
  const fs::path path = seriesOf(movingSteps());
  Result<ReadMesh> read = readAll(path, std::vector<std::string>{"T"});
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(namesOf(read->mesh), (std::vector<std::string>{"T@0", "T@1", "T@2"}));
  EXPECT_TRUE(hasNote(*read, "`fields` Displacement would say how far they move"));
  read = readAll(path, std::vector<std::string>{"Displacement"});
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->mesh.fields.size(), 3u);
  read = readAll(path, std::vector<std::string>{"point:Displacement@1"});
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(namesOf(read->mesh), std::vector<std::string>{"Displacement@1"});
}

TEST(MovingPoints, aFieldOfTheFileKeepsItsName) {
  std::vector<TetMesh> steps = movingSteps();
  for (TetMesh& step : steps)
    step.fields.push_back({"Displacement", 3, "float32", std::vector<double>(15, 7)});
  const fs::path path = seriesOf(steps);
  Result<ReadMesh> read = readAll(path);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->mesh.fields[1].name, "Displacement@0");
  EXPECT_EQ(read->mesh.fields[1].values, std::vector<double>(15, 7));
  EXPECT_EQ(read->mesh.fields[2].name, "Motion@0");
  EXPECT_TRUE(hasNote(*read, "the file has a field Displacement of its own"));
  read = readAll(path, std::vector<std::string>{"Motion"});
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->mesh.fields.size(), 3u);
}

TEST(MovingPoints, stepsOfOtherCellsAreRefused) {
  std::vector<TetMesh> steps = movingSteps();
  steps[2] = oneCell();
  Result<ReadMesh> read = readAll(seriesOf(steps));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::kBadInput);
  EXPECT_NE(read.error().message.find("the mesh at time 2 is not that of time 0: it has 4 points "
                                      "and 1 cells, not 5 points and 2 cells"),
            std::string::npos)
      << read.error().message;
  steps = movingSteps();
  steps[1].tetrahedra[1] = {0, 2, 3, 4};
  read = readAll(seriesOf(steps));
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("its cells have other points"), std::string::npos);
}

// Two cells whose common face is stored twice, and which part at the last step.
TEST(MovingPoints, pointsThatPartAreNotWelded) {
  TetMesh apart = oneCell();
  for (const std::size_t v : {1, 2, 3}) apart.points.push_back(apart.points[v]);
  apart.points.push_back({1, 1, 1});
  apart.tetrahedra.push_back({4, 5, 6, 7});
  TetMesh turned = apart, open = apart;
  for (Position& p : turned.points) p = {p[0], -p[2], p[1]};
  Result<ReadMesh> read = readAll(seriesOf({apart, turned}), std::nullopt, 0);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->report.weldedPoints, 3u);
  for (std::size_t v = 5; v < 8; ++v) open.points[v][0] += 0.5;
  read = readAll(seriesOf({apart, turned, open}), std::nullopt, 0);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->report.weldedPoints, 1u) << "the others open like a book";
  EXPECT_EQ(read->mesh.tetrahedra[1][0], 1u);
  EXPECT_EQ(readAll(seriesOf({apart, turned, open}), std::nullopt, 0.5)->report.weldedPoints, 3u);
}

TEST(MovingPoints, aFewStepsAtATimeAreAsAllAtOnce) {
  const std::vector<TetMesh> resting{stepOf(0, {}), stepOf(1, {}), stepOf(2, {0, 0, 1})};
  const std::vector<TetMesh> returning{stepOf(0, {}), stepOf(1, {0, 0, 1}), stepOf(2, {}),
                                       stepOf(3, {})};
  for (const std::vector<TetMesh>& steps :
       {movingSteps(), resting, returning, std::vector<TetMesh>{resting[0], resting[1]}}) {
    const fs::path path = seriesOf(steps);
    const ReadMesh all = readAll(path).value();
    ReadOptions options;
    options.time = "all";
    const ChosenTimes chosen = chosenTimesOf(path, options).value();
    ASSERT_EQ(chosen.times.size(), steps.size());
    EXPECT_EQ(chosen.valuesOfAStep, 5u);
    for (std::size_t atOnce = 1; atOnce <= steps.size(); ++atOnce) {
      const ReadMesh some = readTimesInParts(path, options, chosen.times, atOnce).value();
      EXPECT_EQ(some.mesh.points, all.mesh.points);
      EXPECT_EQ(namesOf(some.mesh), namesOf(all.mesh)) << atOnce;
      for (std::size_t f = 0; f < all.mesh.fields.size(); ++f)
        EXPECT_EQ(some.mesh.fields[f].values, all.mesh.fields[f].values) << atOnce << " " << f;
    }
  }
}

}  // namespace
}  // namespace qtet
