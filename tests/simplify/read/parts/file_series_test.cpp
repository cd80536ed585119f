// Lists of files: which data sets of one time count, and which texts are times.
#include "simplify/read/parts/file_series.h"

#include <gtest/gtest.h>

#include <fstream>

#include "simplify/log/write_mesh.h"
#include "simplify/read/parts/named_files.h"
#include "simplify/read/read_mesh.h"
#include "tests/simplify/mesh/tet_meshes.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using testing::fileWith;

fs::path pvd(const std::string& sets) {
  return fileWith("run.pvd",
                  "<VTKFile type=\"Collection\"><Collection>" + sets + "</Collection></VTKFile>");
}

struct Steps {
  std::vector<double> times;
  std::vector<std::string> files;  ///< of each time, with blanks between them
  std::vector<std::string> notes;
};

Steps stepsOf(std::vector<SeriesEntry> entries) {
  Steps out;
  const auto steps = stepsOfSeries(std::move(entries), "run.pvd", out.notes);
  EXPECT_TRUE(steps) << steps.error().message;
  for (const SeriesStep& step : steps.value_or(std::vector<SeriesStep>{})) {
    out.times.push_back(step.time);
    out.files.emplace_back();
    for (const fs::path& file : step.files) out.files.back() += file.string();
  }
  return out;
}

std::string errorOf(const std::string& sets) {
  const auto entries = entriesOfPvd(pvd(sets));
  EXPECT_FALSE(entries);
  if (entries) return {};
  EXPECT_EQ(entries.error().code, ErrorCode::kBadInput);
  const std::string& text = entries.error().message;
  const std::size_t name = text.find("run.pvd: ");
  return name == std::string::npos ? text : text.substr(name);
}

std::vector<double> timesOf(const std::string& sets) {
  const auto entries = entriesOfPvd(pvd(sets));
  EXPECT_TRUE(entries) << entries.error().message;
  std::vector<double> out;
  for (const SeriesEntry& entry : entries.value_or(std::vector<SeriesEntry>{}))
    out.push_back(entry.time);
  return out;
}

TEST(FileSeries, ofOneTimeTheLastDataSetCounts) {
  const Steps steps =
      stepsOf({{0, 0, "a"}, {1, 1, "b"}, {2, 2, "c"}, {1, 3, "d"}, {2, 4, "e"}, {3, 5, "f"}});
  EXPECT_EQ(steps.times, (std::vector<double>{0, 1, 2, 3}));
  EXPECT_EQ(steps.files, (std::vector<std::string>{"a", "d", "e", "f"}));
  EXPECT_EQ(steps.notes,
            std::vector<std::string>{"data sets left out, because later ones in the list have "
                                     "the same time: 2, at time 1, 2"});
}

TEST(FileSeries, partsOfOneTimeAreOneMesh) {
  const Steps steps = stepsOf(
      {{0, 0, "a", "0"}, {0, 1, "b", "1"}, {1, 2, "c", "1"}, {1, 3, "d", "0"}, {1, 4, "e", "2"}});
  EXPECT_EQ(steps.files, (std::vector<std::string>{"ab", "cde"}));
  EXPECT_TRUE(steps.notes.empty());
}

TEST(FileSeries, ofARunInPartsTheLastOfEachPartCounts) {
  const Steps steps =
      stepsOf({{0, 0, "a", "0"}, {0, 1, "b", "1"}, {0, 2, "c", "0"}, {0, 3, "d", "1"}});
  EXPECT_EQ(steps.files, std::vector<std::string>{"cd"});
  EXPECT_EQ(steps.notes.size(), 1u);
}

TEST(FileSeries, partsThatAreListedUnequallyOftenAreRefused) {
  std::vector<std::string> notes;
  const auto steps =
      stepsOfSeries({{0.5, 0, "a", "0"}, {0.5, 1, "b", "1"}, {0.5, 2, "c", "0"}}, "run.pvd", notes);
  ASSERT_FALSE(steps);
  EXPECT_EQ(steps.error().message,
            "run.pvd: its parts of time 0.5 are listed unequally often, so it is unknown which "
            "belong together; take those of older runs out of the list");
}

TEST(FileSeries, timesOfOtherLastDigitsAreOne) {
  const double long3 = 0.1 + 0.2;  // 0.30000000000000004
  Steps steps = stepsOf({{0.1, 0, "a"}, {0.2, 1, "b"}, {long3, 2, "c"}, {0.3, 3, "d"}});
  EXPECT_EQ(steps.times, (std::vector<double>{0.1, 0.2, 0.3}));
  EXPECT_EQ(steps.files[2], "d");
  steps = stepsOf({{0.3, 0, "a"}, {long3, 1, "b"}});
  EXPECT_EQ(steps.files, std::vector<std::string>{"b"});
  EXPECT_EQ(steps.times, std::vector<double>{long3});
  steps = stepsOf({{1, 0, "a"}, {2, 1, "b"}, {2 + 1e-10, 2, "c"}, {3, 3, "d"}});
  EXPECT_EQ(steps.files, (std::vector<std::string>{"a", "c", "d"}));
}

TEST(FileSeries, shortStepsAtLargeTimesStayApart) {
  const Steps steps = stepsOf({{1.7e9, 0, "a"}, {1.7e9 + 1, 1, "b"}, {1.7e9 + 2, 2, "c"}});
  EXPECT_EQ(steps.times.size(), 3u);
  EXPECT_TRUE(steps.notes.empty());
}

TEST(FileSeries, timesThatProgramsWriteAreRead) {
  EXPECT_EQ(timesOf("<DataSet timestep=' 1.5 ' file='a'/><DataSet timestep='+2' file='b'/>"
                    "<DataSet timestep='3D-1' file='c'/>"),
            (std::vector<double>{1.5, 2, 0.3}));
}

TEST(FileSeries, aTimeThatIsNoNumberIsRefused) {
  for (const char* text : {"", "0,5", "0.1s", "nan", "inf"})
    EXPECT_EQ(errorOf("<DataSet timestep='0' file='a'/><DataSet timestep='" + std::string(text) +
                      "' file='b'/>"),
              "run.pvd: its <DataSet> number 1 has the timestep \"" + std::string(text) +
                  "\", which is no number; give it its time, a number such as 0.5");
}

TEST(FileSeries, onlyTheFilesOfOneTimeNeedNone) {
  EXPECT_EQ(timesOf("<DataSet file='a'/>"), std::vector<double>{0});
  EXPECT_EQ(timesOf("<DataSet part='0' file='a'/><DataSet part='1' file='b'/>"),
            (std::vector<double>{0, 0}));
  const std::string none =
      "run.pvd: its <DataSet> number 1 has no timestep; give each one its time, a number such as "
      "0.5";
  EXPECT_EQ(errorOf("<DataSet timestep='0' file='a'/><DataSet file='b'/>"), none);
  EXPECT_EQ(errorOf("<DataSet timestep='0' file='a'/><DataSet part='1' file='b'/>"), none);
  EXPECT_EQ(errorOf("<DataSet part='0' file='a'/><DataSet part='0' file='b'/>"),
            "run.pvd: its <DataSet> number 0 has no timestep; give each one its time, a number "
            "such as 0.5");
}

/// A file beside the list: one cell with a field of one value.
void writeStep(const fs::path& folder, const std::string& name, double value) {
  TetMesh mesh = testing::oneCell();
  mesh.fields.push_back({"T", 1, "float32", std::vector<double>(4, value)});
  const Bytes bytes = vtuBytes(mesh);
  std::ofstream(folder / name, std::ios::binary) << std::string(bytes.begin(), bytes.end());
}

TEST(FileSeries, aRestartedRunIsReadOnce) {
  const fs::path xml = pvd(
      "<DataSet timestep='0' part='0' file='a.vtu'/><DataSet timestep='1' part='0' file='b.vtu'/>"
      "<DataSet timestep='1.0' part='0' file='c.vtu'/>");
  const fs::path json =
      fileWith("run.vtu.series",
               R"({"file-series-version": "1.0", "files": [{"name": "a.vtu", "time": 0},
          {"name": "b.vtu", "time": 1}, {"name": "c.vtu", "time": 1}]})");
  for (const fs::path& path : {xml, json}) {
    writeStep(path.parent_path(), "a.vtu", 1);
    writeStep(path.parent_path(), "b.vtu", 2);
    writeStep(path.parent_path(), "c.vtu", 3);
    ReadOptions options;
    options.time = "all";
    const Result<ReadMesh> read = readMesh(path, options);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->mesh.tetrahedra.size(), 1u);
    ASSERT_EQ(read->mesh.fields.size(), 2u);
    EXPECT_EQ(read->mesh.fields[1].name, "T@1");
    EXPECT_EQ(read->mesh.fields[1].values.front(), 3);
    EXPECT_EQ(read->report.notes,
              std::vector<std::string>{"data sets left out, because later ones in the list "
                                       "have the same time: 1, at time 1"});
  }
}

}  // namespace
}  // namespace qtet
