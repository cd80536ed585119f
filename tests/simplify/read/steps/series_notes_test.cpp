// Fields of a series that change their types, or that some steps miss; windows of steps.
#include "simplify/read/steps/series_notes.h"

#include <gtest/gtest.h>

#include "simplify/read/read_mesh.h"
#include "simplify/read/read_times.h"
#include "tests/simplify/mesh/tet_meshes.h"
#include "tests/simplify/read/steps/step_files.h"

namespace qtet {
namespace {

using testing::oneCell;
using testing::seriesOf;

using Notes = std::vector<std::string>;

TetMesh stepWith(std::vector<MeshField> fields) {
  TetMesh mesh = oneCell();
  mesh.fields = std::move(fields);
  mesh.pointType = "float32";
  return mesh;
}

MeshField fieldOf(const std::string& name, const std::string& type, std::uint32_t components = 1) {
  return {name, components, type, std::vector<double>(4 * std::size_t{components}, 7)};
}

Result<ReadMesh> readAllSteps(const std::filesystem::path& path) {
  ReadOptions options;
  options.time = "all";
  return readMesh(path, options);
}

TEST(SeriesNotes, theInstantsOfAFieldHaveOneType) {
  const auto path = seriesOf({stepWith({fieldOf("T", "float32"), fieldOf("n", "uint8")}),
                              stepWith({fieldOf("T", "float64"), fieldOf("n", "int32")}),
                              stepWith({fieldOf("T", "float32"), fieldOf("n", "uint8")})});
  const Result<ReadMesh> read = readAllSteps(path);
  ASSERT_TRUE(read) << read.error().message;
  for (const MeshField& field : read->mesh.fields)
    EXPECT_EQ(field.type, field.name.text().starts_with("T") ? "float64" : "int32") << field.name;
  EXPECT_EQ(read->report.notes,
            (Notes{"point field T changes its type over the steps; float64 holds all its values",
                   "point field n changes its type over the steps; int32 holds all its values"}));
}

TEST(SeriesNotes, aFieldOfOtherComponentsIsRefusedWithTheTimes) {
  const Result<ReadMesh> read = readAllSteps(
      seriesOf({stepWith({fieldOf("U", "float32", 3)}), stepWith({fieldOf("U", "float32")}),
                stepWith({fieldOf("U", "float32", 3)})}));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::kBadInput);
  EXPECT_TRUE(read.error().message.ends_with(
      "run.pvd: point field U has 1 component at time 1, and 3 components at time 0, 2; write it "
      "alike at all steps, or name other fields with `fields`"))
      << read.error().message;
}

TEST(SeriesNotes, fieldsThatSomeStepsMissAreNamedWithTheTimes) {
  std::vector<TetMesh> steps(9, stepWith({fieldOf("T", "float32")}));
  steps[2].fields.push_back(fieldOf("p", "float32"));
  steps[0].fields.clear();
  const Result<ReadMesh> read = readAllSteps(seriesOf(steps));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->report.notes,
            (Notes{"point field T is missing at time 0",
                   "point field p is missing at time 0, 1, 3, 4, 5, 6 and 2 more"}));
}

TEST(SeriesNotes, sixFieldsAreNamedAndTheOthersCounted) {
  std::vector<TetMesh> steps(2, stepWith({}));
  for (const char* name : {"a", "b", "c", "d", "e", "f", "g", "h"})
    steps[1].fields.push_back(fieldOf(name, "float32"));
  const Result<ReadMesh> read = readAllSteps(seriesOf(steps));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->report.notes.size(), 7u);
  EXPECT_EQ(read->report.notes[5], "point field f is missing at time 0");
  EXPECT_EQ(read->report.notes[6], "2 fields more miss some steps");
}

TEST(SeriesNotes, aFewStepsAtATimeGiveTheTypesAndNotesOfAllAtOnce) {
  std::vector<TetMesh> steps;
  for (int s = 0; s < 7; ++s) {
    TetMesh step = stepWith({fieldOf("T", s == 4 ? "float64" : "float32")});
    if (s != 3) step.fields.push_back(fieldOf("p", "int16"));
    step.points[3][2] += 0.25 * s;
    steps.push_back(std::move(step));
  }
  const auto path = seriesOf(steps);
  const ReadMesh all = readAllSteps(path).value();
  ReadOptions options;
  options.time = "all";
  const std::vector<double> times = chosenTimesOf(path, options).value().times;
  ASSERT_EQ(times.size(), 7u);
  for (std::size_t atOnce = 2; atOnce <= 7; ++atOnce) {
    const ReadMesh some = readTimesInParts(path, options, times, atOnce).value();
    EXPECT_EQ(some.report.notes, all.report.notes) << atOnce;
    ASSERT_EQ(some.mesh.fields.size(), all.mesh.fields.size()) << atOnce;
    for (std::size_t f = 0; f < all.mesh.fields.size(); ++f) {
      EXPECT_EQ(some.mesh.fields[f].name, all.mesh.fields[f].name) << atOnce;
      EXPECT_EQ(some.mesh.fields[f].type, all.mesh.fields[f].type) << atOnce;
    }
  }
}

/// The report on the steps of these times of the file.
SeriesReport reportOn(const std::filesystem::path& path, const std::vector<double>& times) {
  return readTimes(path, {}, times, 0.0).value().report.series;
}

TEST(SeriesNotes, aWindowOfWiderValuesThanThoseThatAreCodedIsRefused) {
  const auto path =
      seriesOf({stepWith({fieldOf("T", "float32")}), stepWith({fieldOf("T", "float64")}),
                stepWith({fieldOf("T", "int16")}), stepWith({fieldOf("p", "float64")})});
  const SeriesReport known = reportOn(path, {0});
  EXPECT_TRUE(checkWindow(reportOn(path, {0, 2, 3}), "run.pvd", known));
  const Status wider = checkWindow(reportOn(path, {0, 1, 2}), "run.pvd", known);
  ASSERT_FALSE(wider);
  EXPECT_EQ(wider.error().message,
            "run.pvd: point field T is float64 at time 1, which the float32 of earlier steps does "
            "not hold; write it in one type at all steps, or choose fewer steps with `time`");
  EXPECT_TRUE(checkWindow(reportOn(path, {0, 2}), "run.pvd", reportOn(path, {0, 1})));
}

TEST(SeriesNotes, windowsHaveTheTypesOfTheSampleAndOneReport) {
  std::vector<TetMesh> steps(5, stepWith({fieldOf("T", "float32"), fieldOf("p", "int16")}));
  steps[0].fields[0].type = "float64";
  for (std::size_t s = 0; s < 5; ++s) steps[s].points[3][2] += 0.25 * static_cast<double>(s);
  steps[2].fields.pop_back();
  steps[3].fields.pop_back();
  const auto path = seriesOf(steps);
  ReadReport report;
  ReadOptions options;
  for (const std::vector<double>& times : {std::vector<double>{0, 2}, {1, 2}, {3, 4}}) {
    const Result<TetMesh> window = readWindow(path, options, times, 0, report);
    ASSERT_TRUE(window) << window.error().message;
    for (const MeshField& field : window->fields) {
      if (field.name.text().starts_with("T@")) EXPECT_EQ(field.type, "float64") << field.name;
    }
    options.moves = !report.motion.empty();
  }
  EXPECT_EQ(report.notes,
            (Notes{"point field p is missing at time 2, 3",
                   "point field T changes its type over the steps; float64 holds all its values",
                   "the points move over its 5 steps; the mesh is that of time 0, and the point "
                   "field Displacement has how far they are from there, at most 1"}));
}

TEST(SeriesNotes, aWindowWhosePointsAreTheFirstToMoveIsRefused) {
  TetMesh moved = oneCell();
  moved.points[1] = {2, 0, 0};
  const auto path = seriesOf({oneCell(), oneCell(), moved});
  const SeriesReport known = reportOn(path, {0, 1});
  const Status moves = checkWindow(reportOn(path, {0, 2}), "run.pvd", known);
  ASSERT_FALSE(moves);
  EXPECT_EQ(moves.error().message,
            "run.pvd: its points move at time 2, but rest at the times that choose the fusions, 0, "
            "1; choose fewer steps with `time`, so that all are simplified at once");
}

TEST(SeriesNotes, otherComponentsInALaterWindowAreRefused) {
  const auto path =
      seriesOf({stepWith({fieldOf("U", "float32", 3)}), stepWith({fieldOf("U", "float32", 3)}),
                stepWith({fieldOf("U", "float32")})});
  ReadOptions options;
  options.time = "all";
  const Result<ReadMesh> read = readTimesInParts(path, options, std::vector<double>{0, 1, 2}, 2);
  ASSERT_FALSE(read);
  EXPECT_TRUE(
      read.error().message.ends_with("point field U has 3 components at time 0, 1, and 1 "
                                     "component at time 2; write it alike at all steps, "
                                     "or name other fields with `fields`"))
      << read.error().message;
}

}  // namespace
}  // namespace qtet
