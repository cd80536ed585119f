// Numbered files as the steps of a series that no file lists.
#include "simplify/read/listed_files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "proto/number_text.h"
#include "simplify/log/write_mesh.h"
#include "simplify/read/parts/file_family.h"
#include "simplify/read/read_mesh.h"
#include "simplify/read/read_times.h"
#include "tests/simplify/mesh/tet_meshes.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// A folder with meshes, whose field T is `value` at all points.
class ListedFilesTest : public ::testing::Test {
 protected:
  void put(const std::string& name, double value, std::optional<double> time = std::nullopt) {
    TetMesh mesh = testing::oneCell();
    mesh.fields = {{"T", 1, "float64", std::vector<double>(mesh.points.size(), value)}};
    const Bytes bytes = vtuBytes(mesh);
    std::string text(bytes.begin(), bytes.end());
    const std::string grid = "<UnstructuredGrid>";
    if (time)
      text.insert(text.find(grid) + grid.size(),
                  "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
                  "format=\"ascii\">" +
                      shortestText(*time) + "</DataArray></FieldData>");
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  [[nodiscard]] ReadOptions words(const std::vector<std::string>& names,
                                  const std::vector<double>& times = {}) const {
    ReadOptions out;
    out.time = "all";
    for (const std::string& name : names) out.listed.files.push_back(folder_ / name);
    out.listed.times = times;
    return out;
  }
  /// The times and the values of T, "0:5 1:6".
  [[nodiscard]] static std::string seriesOf(const fs::path& path, ReadOptions options = {}) {
    options.time = "all";
    options.namesTime = true;
    const Result<ReadMesh> read = readMesh(path, options);
    if (!read) return read.error().message;
    std::string out;
    for (const MeshField& field : read->mesh.fields)
      out += (out.empty() ? "" : " ") + field.name.text().substr(2) + ":" +
             shortestText(field.values.front());
    return out;
  }
  /// The refusal, in which the folder is called F.
  [[nodiscard]] std::string refusal(const fs::path& path, const ReadOptions& options = {}) const {
    const auto listed = withListedFiles(path, options);
    if (listed) return "taken";
    std::string text = listed.error().message;
    for (std::size_t at = 0; (at = text.find(folder_.string())) != std::string::npos;)
      text.replace(at, folder_.string().size(), "F");
    return text;
  }

  const fs::path folder_ = testing::freshFolder("listed-files");
};

TEST_F(ListedFilesTest, aFileIsItself) {
  put("a_1.vtu", 1);
  put("b[1].vtu", 1);
  EXPECT_FALSE(namesFiles(folder_ / "a_1.vtu"));
  EXPECT_FALSE(namesFiles(folder_ / "b[1].vtu")) << "it is there";
  EXPECT_FALSE(namesFiles(folder_ / "none.vtu"));
  EXPECT_TRUE(withListedFiles(folder_ / "a_1.vtu", {})->listed.files.empty());
  EXPECT_TRUE(readMesh(folder_ / "b[1].vtu"));
}

TEST_F(ListedFilesTest, numbersInNamesAreTimesInTheirOwnOrder) {
  for (const int step : {9, 10, 100}) put("run2_" + std::to_string(step) + ".vtu", step + 0.5);
  EXPECT_EQ(seriesOf(folder_ / "run2_*.vtu"), "9:9.5 10:10.5 100:100.5");
  EXPECT_EQ(seriesOf(folder_ / "run2_?.vtu"), "9:9.5") << "a series of one step";
  EXPECT_EQ(seriesOf(folder_ / "run2_[19]*.vtu"), "9:9.5 10:10.5 100:100.5");
  EXPECT_EQ(seriesOf(folder_), "9:9.5 10:10.5 100:100.5");
  EXPECT_EQ(seriesOf(folder_ / ""), "9:9.5 10:10.5 100:100.5");
  EXPECT_EQ(seriesOf("x", words({"run2_10.vtu", "run2_100.vtu", "run2_9.vtu"})),
            "9:9.5 10:10.5 100:100.5");
  const Result<ReadMesh> last = readMesh(folder_ / "run2_*.vtu");
  ASSERT_TRUE(last);
  EXPECT_EQ(last->mesh.fields.at(0).values.at(0), 100.5);
  EXPECT_EQ(last->report.times, (std::vector<double>{9, 10, 100}));
  EXPECT_EQ(last->report.notes,
            (std::vector<std::string>{
                "times are the numbers in the files' names, since run2_9.vtu has no TimeValue; "
                "`times` gives others",
                "of its 3 time steps the last is read, 100; `time` names another, or all"}));
}

TEST_F(ListedFilesTest, theFilesTimeValueCountsWhereAllHaveOne) {
  put("s0.vtu", 5, 0.25);
  put("s1.vtu", 6, 0.5);
  put("s2.vtu", 7, 0.125);
  EXPECT_EQ(seriesOf(folder_ / "s*.vtu"), "0.125:7 0.25:5 0.5:6");
  put("s3.vtu", 8);
  EXPECT_EQ(seriesOf(folder_ / "s*.vtu"), "0:5 1:6 2:7 3:8");
  EXPECT_EQ(seriesOf("x", words({"s0.vtu", "s1.vtu"}, {7, 8})), "7:5 8:6") << "given times win";
}

TEST_F(ListedFilesTest, windowsReadTheFilesTimesOnce) {
  for (const int step : {0, 1, 2, 3}) put("s" + std::to_string(step) + ".vtu", step, step / 2.0);
  ReadOptions options;
  options.time = "0.5:";
  const Result<ReadOptions> listed = withListedFiles(folder_ / "s*.vtu", options);
  ASSERT_TRUE(listed);
  EXPECT_EQ(chosenTimesOf("x", *listed)->times, (std::vector<double>{0.5, 1, 1.5}));
  const Result<ReadMesh> some = readTimes("x", *listed, std::vector<double>{1, 1.5});
  ASSERT_TRUE(some);
  EXPECT_EQ(some->mesh.fields.at(1).name, "T@1.5");
}

TEST_F(ListedFilesTest, whatIsNoSeriesIsRefusedByName) {
  put("s1.vtu", 1);
  put("s01.vtu", 2);
  put("plain.vtu", 3);
  put("late.vtu", 3, 4);
  put("later.vtu", 3, 4);
  put("p0.5.vtu", 3);
  put("p0.25.vtu", 3);
  fs::copy_file(folder_ / "s1.vtu", folder_ / "s2.vtk");
  fs::copy_file(folder_ / "s1.vtu", folder_ / "s1.msh");
  EXPECT_EQ(refusal("S", words({"s1.vtu", "s01.vtu"})),
            "S: F/s1.vtu and F/s01.vtu both have time 1; leave one out, or give `times`, one a "
            "file");
  EXPECT_EQ(refusal("S", words({"late.vtu", "later.vtu"})),
            "S: F/late.vtu and F/later.vtu both have time 4; leave one out, or give `times`, one "
            "a file");
  EXPECT_EQ(refusal("S", words({"s1.vtu", "plain.vtu"})),
            "S: F/plain.vtu has neither a TimeValue nor a number in its name; give `times`, one a "
            "file");
  EXPECT_EQ(refusal("S", words({"p0.5.vtu", "p0.25.vtu"})),
            "S: F/p0.25.vtu may mean the number 25 or a fraction; give `times`, one a file");
  EXPECT_EQ(refusal("S", words({"s1.vtu", "s2.vtk"})),
            "S: F/s1.vtu and F/s2.vtk are of different kinds; give files of one kind");
  EXPECT_EQ(refusal("S", words({"s1.msh", "s1.vtu"})),
            "S: F/s1.msh cannot be a step: files of VTK alone can; convert each to .vtu with qtet "
            "convert");
  EXPECT_EQ(refusal("S", words({"run.e.2.0", "run.e.2.1"})),
            "S: F/run.e.2.0 is a piece of a parallel result; give it alone, and all others are "
            "read with it");
  EXPECT_EQ(refusal("S", words({"s1.vtu", "s7.vtu"})), "there is no file F/s7.vtu; check the name");
  EXPECT_EQ(refusal(folder_ / "q*.vtu"),
            "there is no file F/q*.vtu; check the pattern and the folder");
  EXPECT_EQ(refusal("S", words({"s1.vtu", "s01.vtu"}, {1})),
            "S: `times` gives 1 times for 2 files; give one a file");
  EXPECT_EQ(refusal("S", words({"s1.vtu", "s01.vtu"}, {2, 2})),
            "S: F/s1.vtu and F/s01.vtu both have time 2; leave one out, or give `times`, one a "
            "file");
  put("s10.vtu", 1);
  put("s2.vtu", 1);
  EXPECT_EQ(refusal("S", words({"s10.vtu", "s2.vtu"}, {0.1, 0.2})),
            "S: F/s10.vtu stands before F/s2.vtu, and `times` gives it the earlier time; give the "
            "files' pattern in quotes, which takes them by number");
  EXPECT_EQ(refusal("S", words({"s10.vtu", "s2.vtu"}, {0.2, 0.1})), "taken");
}

TEST_F(ListedFilesTest, aFolderHoldsOneSeries) {
  EXPECT_EQ(refusal(folder_),
            "F: this folder holds neither numbered files of VTK nor a case of OpenFOAM; it has "
            "no files; give a mesh file");
  std::ofstream(folder_ / "notes.txt") << "text";
  EXPECT_EQ(refusal(folder_),
            "F: this folder holds neither numbered files of VTK nor a case of OpenFOAM, but "
            "notes.txt; give a mesh file");
  put("run_1.vtu", 1);
  put("run_2.vtu", 2);
  fs::create_directory(folder_ / "more_3.vtu");
  EXPECT_EQ(seriesOf(folder_), "1:1 2:2");
  put("other_1.vtu", 2);
  EXPECT_EQ(refusal(folder_),
            "F: its files have several names: other_*.vtu, run_*.vtu (2); give those of one, in "
            "quotes: 'F/other_*.vtu'");
  std::ofstream(folder_ / "run.pvd") << "<VTKFile/>";
  EXPECT_EQ(refusal(folder_), "F: it has run.pvd, which lists files with their times; give that");
}

TEST_F(ListedFilesTest, aCaseOfOpenFoamIsNoSeries) {
  put("run_1.vtu", 1);
  for (const char* inside : {"processor0", "constant/polyMesh"}) {
    fs::create_directories(folder_ / inside);
    EXPECT_TRUE(withListedFiles(folder_, {})->listed.files.empty()) << inside;
    fs::remove_all(folder_ / inside);
    EXPECT_EQ(withListedFiles(folder_, {})->listed.files.size(), 1u);
  }
}

TEST(FileFamily, namesAroundTheirNumbers) {
  EXPECT_EQ(numberedName("a/r2_007.vtu")->number, 7);
  EXPECT_EQ(numberedName("a/r2_007.vtu")->before, "r2_");
  EXPECT_EQ(numberedName("12b.vtu")->behind, "b.vtu");
  EXPECT_FALSE(numberedName("2/run.e2"));
  const std::vector<fs::path> files{"r/s_10.vtu", "r/s_11.vtu"}, far{"a1/x.vtu", "a2/x.vtu"};
  EXPECT_EQ(familyOf(files), "r/s_*.vtu");
  EXPECT_EQ(familyOf(far), "a*/x.vtu");
  EXPECT_EQ(familyOf(std::vector<fs::path>{"a.vtu", "a.vtu"}), "a.vtu*");
  EXPECT_EQ(familyOf(std::vector<fs::path>{"s_1.vtu"}), "s_1.vtu");
}

}  // namespace
}  // namespace qtet
