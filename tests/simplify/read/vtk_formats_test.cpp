// VTK's formats, and those that it reads for us: files that its own writers made (meshes/), and
// text files made here.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <tuple>

#include "simplify/clean/clean_mesh.h"
#include "simplify/log/write_mesh.h"
#include "simplify/read/options/mesh_format.h"
#include "simplify/read/read_mesh.h"
#include "simplify/read/read_times.h"
#include "tests/simplify/mesh/tet_meshes.h"
#include "tests/simplify/split/cell_grids.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using testing::fileWith;
using testing::filledBy;

fs::path given(const std::string& name) {
  return fs::path(testing::kSourceFolder) / "tests/simplify/read/meshes" / name;
}

const MeshField* field(const ReadMesh& read, const std::string& name) {
  const auto at = std::ranges::find(read.mesh.fields, FieldName(name), &MeshField::name);
  return at == read.mesh.fields.end() ? nullptr : &*at;
}

/// Reads the file, which must fill a volume of `volume` with a closed hull and a point field that
/// is x plus `more`.
ReadMesh expectABar(const fs::path& path, double volume, const std::string& name = "T",
                    double more = 0, const ReadOptions& options = {}) {
  const Result<ReadMesh> read = readMesh(path, options);
  EXPECT_TRUE(read) << read.error().text();
  if (!read) return {};
  EXPECT_NEAR(filledBy(read->mesh).volume, volume, 1e-9) << path;
  EXPECT_EQ(filledBy(read->mesh).openEdges, 0u) << path;
  const MeshField* x = field(*read, name);
  EXPECT_TRUE(x) << path;
  for (std::size_t i = 0; x && i < read->mesh.points.size(); ++i)
    EXPECT_NEAR(x->values[i], read->mesh.points[i][0] + more, 1e-5) << path;
  return *read;
}

TEST(VtkFormats, structuredRectilinearAndImageDataAreRead) {
  for (const char* name : {"s.vts", "r.vtr", "i.vti"}) expectABar(given(name), 2);
}

TEST(VtkFormats, extentsOfStructuredDataThatNoFileHoldsAreRefused) {
  for (const char* name : {"s.vts", "r.vtr", "i.vti"}) {
    std::ifstream file(given(name), std::ios::binary);
    const std::string sound{std::istreambuf_iterator<char>(file), {}};
    for (const char* end : {"-1", "2147483646", "2147483647", "4294967296", "NaN"}) {
      std::string text = sound;
      for (std::size_t at = 0; (at = text.find("Extent=\"0 2", at)) != std::string::npos; ++at)
        text.replace(at + 10, 1, end);
      ASSERT_NE(text, sound) << name;
      const Result<ReadMesh> read = readMesh(fileWith(name, text));
      ASSERT_FALSE(read) << name << ' ' << end;
      EXPECT_EQ(read.error().code, ErrorCode::kBadInput) << read.error().text();
    }
  }
}

// VTK leaves the rest of the field as the memory was, and reports nothing.
TEST(VtkFormats, aFieldWhoseBase64EndsTooEarlyIsRefused) {
  const auto grid = [](const std::string& base64) {
    return "<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\" "
           "header_type=\"UInt32\"><ImageData WholeExtent=\"0 1 0 1 0 1\" Origin=\"0 0 0\" "
           "Spacing=\"1 1 1\"><Piece Extent=\"0 1 0 1 0 1\"><PointData><DataArray "
           "type=\"UInt8\" Name=\"T\" format=\"appended\" offset=\"0\"/></PointData></Piece>"
           "</ImageData><AppendedData encoding=\"base64\">_" +
           base64 + "</AppendedData></VTKFile>\n";
  };
  // the count 8, then the bytes 1 to 8
  const Result<ReadMesh> sound = readMesh(fileWith("sound.vti", grid("CAAAAAECAwQFBgcI")));
  ASSERT_TRUE(sound) << sound.error().text();
  ASSERT_TRUE(field(*sound, "T"));
  EXPECT_EQ(field(*sound, "T")->values, (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8}));
  const Result<ReadMesh> cut = readMesh(fileWith("cut.vti", grid("CAAAAAECAw==BgcI")));
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().code, ErrorCode::kTruncated) << cut.error().text();
}

// Two pieces with a common cell, which the second one marks as a ghost.
TEST(VtkFormats, piecesOfStructuredDataAreJoined) {
  for (const char* name : {"ps.pvts", "pr.pvtr", "pi.pvti"}) {
    ReadMesh joined = expectABar(given(name), 2);
    EXPECT_EQ(joined.mesh.points.size(), 20u) << name;
    EXPECT_EQ(cleanMesh(joined.mesh)->components, 1u) << name;
  }
  const fs::path wrong = fileWith("wrong.pvts", "<VTKFile type=\"PImageData\"></VTKFile>\n");
  const Result<ReadMesh> read = readMesh(wrong);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("PStructuredGrid"), std::string::npos)
      << read.error().message;
}

TEST(VtkFormats, cellsWithinAThresholdAreKept) {
  for (const char* name : {"s.vts", "r.vtr", "i.vti", "p.pvtu"}) {
    ReadOptions options;
    options.threshold = Threshold{"T", 1, 2};
    options.fields = std::vector<std::string>{kOriginalCellField};
    const Result<ReadMesh> read = readMesh(given(name), options);
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_NEAR(filledBy(read->mesh).volume, 1, 1e-9);
    ASSERT_EQ(read->mesh.fields.size(), 1u);
    EXPECT_EQ(read->mesh.fields[0].values, std::vector<double>(6, 1.0));
    options.threshold->low = 5;
    EXPECT_EQ(readMesh(given(name), options).error().code, ErrorCode::kBadInput);
    options.threshold->field = "nothing";
    EXPECT_EQ(readMesh(given(name), options).error().code, ErrorCode::kNotFound);
  }
}

TEST(VtkFormats, piecesAndBlocksBecomeOneMesh) {
  expectABar(given("p.pvtu"), 2);
  ReadOptions none;
  none.joinPieces = false;
  Result<ReadMesh> apart = readMesh(given("m.vtm"), none);
  ASSERT_TRUE(apart) << apart.error().text();
  EXPECT_EQ(cleanMesh(apart->mesh)->components, 2u);
  EXPECT_EQ(apart->report.pieces, 2u);
  EXPECT_EQ(apart->report.joinedPoints, 0u);
  const auto says = [](const ReadReport& report, const std::string& what) {
    return std::ranges::any_of(report.notes, [&](const std::string& note) {
      return note.find(what) != std::string::npos;
    });
  };
  EXPECT_TRUE(says(apart->report, "its 2 pieces stay apart (`weld` none)"));
  ReadOptions withIds;
  withIds.originalIds = true;
  ReadMesh joined = expectABar(given("m.vtm"), 4, "T", 0, withIds);
  EXPECT_EQ(joined.report.joinedPoints, 4u);
  EXPECT_TRUE(says(joined.report, "its 2 pieces were joined at 4 points"));
  EXPECT_EQ(cleanMesh(joined.mesh)->components, 1u);
  ASSERT_TRUE(field(joined, "mat"));
  EXPECT_EQ(field(joined, "mat")->values.back(), 13);
  EXPECT_EQ(field(joined, kOriginalCellField)->values.back(), 3);
}

TEST(VtkFormats, ofASeriesTheLastStepTheOneAskedForOrAllAreRead) {
  expectABar(given("run.pvd"), 2, "T", 100);
  ReadOptions options;
  options.time = "0";
  expectABar(given("run.pvd"), 2, "T", 0, options);
  options.time = "first";
  expectABar(given("two.e"), 4, "T", 50, options);
  options.time = "1.5";
  expectABar(given("two.e"), 4, "T", 150, options);
  options.time = "all";
  const ReadMesh all = expectABar(given("run.pvd"), 2, "T@0", 0, options);
  EXPECT_TRUE(field(all, "T@0.25"));
  EXPECT_TRUE(field(all, "mat@0.25"));
  options.time = "0.3";
  const Result<ReadMesh> none = readMesh(given("run.pvd"), options);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kNotFound);
  EXPECT_NE(none.error().message.find("it has 0, 0.25"), std::string::npos);
}

TEST(VtkFormats, ofASeriesANameMeansEveryStepAndAStepsNameOne) {
  ReadOptions options;
  options.time = "all";
  const auto namesOf = [&](std::vector<std::string> asked) {
    options.fields = std::move(asked);
    const Result<ReadMesh> read = readMesh(given("run.pvd"), options);
    EXPECT_TRUE(read) << read.error().text();
    std::vector<std::string> out;
    for (const MeshField& field : read ? read->mesh.fields : std::vector<MeshField>{})
      out.push_back(field.association + ":" + field.name);
    return out;
  };
  const std::vector<std::string> both = namesOf({"T"});
  ASSERT_EQ(both.size(), 2u);
  EXPECT_TRUE(both[0].starts_with("point:T@") && both[1].starts_with("point:T@"));
  EXPECT_EQ(namesOf({"point:T"}), both);
  EXPECT_EQ(namesOf({both[1].substr(6)}), (std::vector<std::string>{both[1]}));
  EXPECT_EQ(namesOf({both[1], "T"}), (std::vector<std::string>{both[1], both[0]}));
  options.fields = std::vector<std::string>{"cell:T"};
  EXPECT_EQ(readMesh(given("run.pvd"), options).error().code, ErrorCode::kNotFound);
  options.fields = std::vector<std::string>{"T@7"};
  EXPECT_EQ(readMesh(given("run.pvd"), options).error().code, ErrorCode::kNotFound);
}

TEST(VtkFormats, aFileThatAnotherNamesInVainIsToldWithBoth) {
  const std::string pieces =
                        "<VTKFile type=\"PUnstructuredGrid\" "
                        "version=\"0.1\"><PUnstructuredGrid><PPoints><PDataArray type=\"Float64\" "
                        "NumberOfComponents=\"3\"/></PPoints><Piece "
                        "Source=\"gone.vtu\"/></PUnstructuredGrid></VTKFile>\n",
                    series =
                        "<VTKFile type=\"Collection\" version=\"0.1\"><Collection><DataSet "
                        "timestep=\"0\" file=\"gone.vtu\"/></Collection></VTKFile>\n";
  for (const auto& [name, text] :
       {std::pair{"in-vain.pvtu", pieces}, std::pair{"in-vain.pvd", series}}) {
    const Result<ReadMesh> read = readMesh(fileWith(name, text));
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::kNotFound) << read.error().text();
    EXPECT_NE(read.error().message.find(name), std::string::npos) << read.error().text();
    EXPECT_NE(read.error().message.find("there is no file"), std::string::npos)
        << read.error().text();
    EXPECT_NE(read.error().message.find("gone.vtu"), std::string::npos) << read.error().text();
  }
}

/// A tetrahedron as a .vtu of its own, its points from x on; `fields` are its <PointData>.
std::string pieceAt(int x, const std::string& pointType, const std::string& fields) {
  const std::string low = std::to_string(x), high = std::to_string(x + 1);
  const auto array = [](const std::string& type, const std::string& name,
                        const std::string& values) {
    return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" format=\"ascii\">" + values +
           "</DataArray>";
  };
  // Two neighbours share the triangle at x + 1; each has its fourth corner on its own side.
  const std::string seam = std::to_string(x < 0 ? x + 1 : x), apex = x < 0 ? low : high;
  return "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">"
         "<UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><PointData>" +
         fields + "</PointData><Points><DataArray type=\"" + pointType +
         "\" NumberOfComponents=\"3\" format=\"ascii\">" + seam + " 0 0 " + seam + " 1 0 " + seam +
         " 0 1 " + apex + " 0 0</DataArray></Points><Cells>" +
         array("Int64", "connectivity", x < 0 ? "0 2 1 3" : "0 1 2 3") +
         array("Int64", "offsets", "4") + array("UInt8", "types", "10") +
         "</Cells></Piece></UnstructuredGrid></VTKFile>\n";
}

std::string fieldOf(const std::string& type, const std::string& name, int components) {
  std::string values;
  for (int i = 0; i < 4 * components; ++i) values += std::to_string(i) + " ";
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"ascii\">" + values + "</DataArray>";
}

/// The summary says Float32 and one component of everything, whatever the pieces hold.
fs::path summaryOf(const std::vector<std::string>& pieces, const std::string& name) {
  std::string text =
      "<VTKFile type=\"PUnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">"
      "<PUnstructuredGrid><PPointData><PDataArray type=\"Float32\" Name=\"T\"/><PDataArray "
      "type=\"Float32\" Name=\"U\"/></PPointData><PPoints><PDataArray type=\"Float32\" "
      "NumberOfComponents=\"3\"/></PPoints>";
  for (std::size_t i = 0; i < pieces.size(); ++i)
    text += "<Piece Source=\"" + std::to_string(i) + ".vtu\"/>";
  const fs::path path = fileWith(name + ".pvtu", text + "</PUnstructuredGrid></VTKFile>\n");
  for (std::size_t i = 0; i < pieces.size(); ++i)
    std::ofstream(path.parent_path() / (std::to_string(i) + ".vtu")) << pieces[i];
  return path;
}

TEST(VtkFormats, anArrayOfTheSummaryThatNoPieceHasIsNoted) {
  const Result<ReadMesh> read = readMesh(summaryOf(
      {pieceAt(-1, "Float32", fieldOf("Float32", "T", 1)), pieceAt(0, "Float32", "")}, "stated"));
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_TRUE(
      std::ranges::find(read->report.notes, "its summary names arrays that no piece has: U") !=
      read->report.notes.end());
}

// VTK's own reader of such files writes beyond its arrays here.
TEST(VtkFormats, piecesThatDisagreeWithTheirSummaryAndOneAnotherAreReadOneByOne) {
  const fs::path path =
      summaryOf({pieceAt(-1, "Float32", fieldOf("Float32", "T", 1) + fieldOf("Float32", "U", 3)),
                 pieceAt(0, "Float64", fieldOf("Float64", "T", 1) + fieldOf("Float64", "U", 4))},
                "disagree");
  Result<ReadMesh> read = readMesh(path);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->mesh.points.size(), 5u);
  EXPECT_EQ(read->report.joinedPoints, 3u);
  EXPECT_EQ(cleanMesh(read->mesh)->components, 1u);
  ASSERT_TRUE(field(*read, "T"));
  EXPECT_EQ(field(*read, "T")->type, "float64") << "where nothing is lost the wider type is taken";
  EXPECT_FALSE(field(*read, "U"));
  EXPECT_TRUE(std::ranges::any_of(read->report.notes, [](const std::string& note) {
    return note.find("point field U was left out") != std::string::npos;
  }));
}

TEST(VtkFormats, aFieldTakesTheNarrowestTypeThatHoldsTheValuesOfAllPieces) {
  struct Case {
    std::string left, right, both;
  };
  for (const auto& [left, right, both] : {Case{"UInt8", "Int32", "int32"},
                                          {"UInt8", "Int8", "int16"},
                                          {"UInt16", "UInt8", "uint16"},
                                          {"Int32", "UInt32", "int64"},
                                          {"Int64", "UInt64", "int64"},
                                          {"UInt8", "Float32", "float32"},
                                          {"Float32", "Int32", "float64"}}) {
    const fs::path path = summaryOf({pieceAt(-1, "Float32", fieldOf(left, "T", 1)),
                                     pieceAt(0, "Float32", fieldOf(right, "T", 1))},
                                    "types");
    Result<ReadMesh> read = readMesh(path);
    ASSERT_TRUE(read) << read.error().text();
    ASSERT_TRUE(field(*read, "T")) << left << " beside " << right;
    EXPECT_EQ(field(*read, "T")->type, both) << left << " beside " << right;
  }
}

TEST(VtkFormats, anArrayThatOnlySomePiecesHaveIsMissingInTheOthers) {
  const fs::path path = summaryOf({pieceAt(-1, "Float32", fieldOf("Float32", "T", 1)),
                                   pieceAt(0, "Float32", fieldOf("Float32", "U", 1))},
                                  "some");
  const Result<ReadMesh> read = readMesh(path);
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_TRUE(field(*read, "T") && field(*read, "U"));
  EXPECT_TRUE(std::isnan(field(*read, "T")->values[4]));
  const std::vector<double>& u = field(*read, "U")->values;
  EXPECT_TRUE(std::isnan(u[3])) << "the corner that is the first piece's alone";
  EXPECT_EQ((std::vector<double>{u[0], u[1], u[2], u[4]}), (std::vector<double>{0, 1, 2, 3}))
      << "on the seam the value that is there";
}

TEST(VtkFormats, aFileThatNamesItselfIsRefused) {
  const fs::path path = fileWith(
      "self.vtm",
      "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" byte_order=\"LittleEndian\">"
      "<vtkMultiBlockDataSet><DataSet index=\"0\" file=\"self.vtm\"/></vtkMultiBlockDataSet>"
      "</VTKFile>\n");
  const Result<ReadMesh> read = readMesh(path);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("does one name itself?"), std::string::npos)
      << read.error().text();
}

TEST(VtkFormats, ghostCellsOfPiecesAreLeftOutAndTheirMarksAreNoField) {
  const auto array = [](const std::string& type, const std::string& name,
                        const std::string& values) {
    return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" format=\"ascii\">" + values +
           "</DataArray>";
  };
  const fs::path piece = fileWith(
      "ghosts.vtu",
      "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
      "byte_order=\"LittleEndian\"><UnstructuredGrid><Piece NumberOfPoints=\"5\" "
      "NumberOfCells=\"2\"><PointData>" +
          array("UInt8", "vtkGhostType", "0 0 0 0 1") + "</PointData><CellData>" +
          array("UInt8", "vtkGhostType", "0 1") + array("Int32", "part", "7 8") +
          "</CellData><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
          "format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1 1 1 1</DataArray></Points><Cells>" +
          array("Int64", "connectivity", "0 1 2 3 1 2 3 4") + array("Int64", "offsets", "4 8") +
          array("UInt8", "types", "10 10") + "</Cells></Piece></UnstructuredGrid></VTKFile>\n");
  const fs::path whole = piece.parent_path() / "ghosts.pvtu";
  std::ofstream(whole) << "<VTKFile type=\"PUnstructuredGrid\" version=\"0.1\" "
                          "byte_order=\"LittleEndian\"><PUnstructuredGrid "
                          "GhostLevel=\"1\"><PPointData><PDataArray type=\"UInt8\" "
                          "Name=\"vtkGhostType\"/></PPointData><PCellData><PDataArray "
                          "type=\"UInt8\" Name=\"vtkGhostType\"/><PDataArray type=\"Int32\" "
                          "Name=\"part\"/></PCellData><PPoints><PDataArray "
                          "type=\"Float64\" NumberOfComponents=\"3\"/></PPoints><Piece "
                          "Source=\"ghosts.vtu\"/></PUnstructuredGrid></VTKFile>\n";
  for (const fs::path& path : {piece, whole}) {
    const Result<ReadMesh> read = readMesh(path);
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(read->mesh.tetrahedra, (std::vector<Tetrahedron>{{0, 1, 2, 3}})) << path;
    ASSERT_EQ(read->mesh.fields.size(), 1u);
    EXPECT_EQ(read->mesh.fields[0].name, "part");
    EXPECT_EQ(read->mesh.fields[0].values, std::vector<double>{7});
  }
}

TEST(VtkFormats, aTimeThatAFileWithoutStepsDoesNotHaveIsRefused) {
  ReadOptions options;
  const std::string medit =
      "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 "
      "0\nTetrahedra\n1\n1 2 3 4 0\nEnd\n";
  for (const fs::path& path : {given("step0.vtu"), fileWith("timeless.mesh", medit)}) {
    for (const char* word : {"first", "last", "all"}) {
      options.time = word;
      EXPECT_TRUE(readMesh(path, options)) << path << word;
    }
    for (const char* word : {"foo", "0", ""}) {
      options.time = word;
      const Result<ReadMesh> read = readMesh(path, options);
      ASSERT_FALSE(read) << path << word;
      EXPECT_EQ(read.error().code, ErrorCode::kNotFound);
      EXPECT_NE(read.error().message.find("`time`"), std::string::npos) << read.error().message;
    }
  }
}

TEST(VtkFormats, whatEveryStepHasIsCountedAndToldOnce) {
  const fs::path path = fileWith("surfaced.pvd",
                                 "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"1\" "
                                 "file=\"a.vtk\"/><DataSet timestep=\"2\" file=\"b.vtk\"/>"
                                 "<DataSet timestep=\"3\" file=\"c.vtk\"/></Collection></VTKFile>");
  for (const char* step : {"a.vtk", "b.vtk", "c.vtk"})
    std::ofstream(path.parent_path() / step)
        << "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 "
           "0 1 0 0 0 1 0 0 0 1\nCELLS 2 9\n"
           "4 0 1 2 3\n3 0 1 2\nCELL_TYPES 2\n10\n5\nPOINT_DATA 4\nFIELD f 2\nbig 20 4 double\n"
        <<
        [] {
          std::string zeros;
          for (int i = 0; i < 80; ++i) zeros += "0 ";
          return zeros;
        }()
        << "\ns 1 4 double\n1 2 3 4\n";
  ReadOptions options;
  options.time = "all";
  const Result<ReadMesh> read = readMesh(path, options);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->mesh.fields.size(), 3u);
  EXPECT_EQ(read->report.ignoredCells, 1u);
  EXPECT_EQ(read->report.ignoredFields, std::vector<std::string>{"big"});
  EXPECT_EQ(std::ranges::count_if(read->report.notes,
                                  [](const std::string& note) {
                                    return note.find("big was ignored") != std::string::npos;
                                  }),
            1);
}

TEST(VtkFormats, aSeriesWhoseCellsChangeCannotBeOneLog) {
  const fs::path path =
      fileWith("changing.pvd",
               "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"1\" "
               "file=\"a.vtu\"/><DataSet timestep=\"2\" file=\"b.vtu\"/></Collection></VTKFile>");
  fs::copy_file(given("step0.vtu"), path.parent_path() / "a.vtu");
  const Bytes other = vtuBytes(testing::oneCell());
  std::ofstream(path.parent_path() / "b.vtu", std::ios::binary)
      << std::string(other.begin(), other.end());
  ReadOptions options;
  EXPECT_TRUE(readMesh(path, options));
  options.time = "all";
  const Result<ReadMesh> all = readMesh(path, options);
  ASSERT_FALSE(all);
  EXPECT_NE(all.error().message.find("the mesh at time 2 is not that of time 1"), std::string::npos)
      << all.error().text();
  fs::remove(path.parent_path() / "a.vtu");
  EXPECT_EQ(readMesh(path, options).error().code, ErrorCode::kNotFound);
}

TEST(VtkFormats, exodusBlocksHaveTheirFieldsAndNumbers) {
  const ReadMesh read = expectABar(given("two.e"), 4, "T", 150);
  ASSERT_TRUE(field(read, "ObjectId"));
  EXPECT_EQ(read.report.split.cells[kHexahedronCell], 4u);
}

TEST(VtkFormats, exodusBlocksKeepTheirNames) {
  std::ifstream file(given("two.e"), std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  constexpr std::size_t kBlockNames = 2120, kNameBytes = 256;  // where the file has them, empty
  for (const auto& [place, name] : {std::pair{0u, "fluid"}, std::pair{1u, "solid"}})
    bytes.replace(kBlockNames + place * kNameBytes, 5, name);
  const fs::path path = fileWith("named.e", bytes);
  ReadOptions options;
  for (const char* time : {"last", "all"}) {
    options.time = time;
    const Result<ReadMesh> read = readMesh(path, options);
    ASSERT_TRUE(read) << read.error().text();
    const MeshField* label = field(*read, time == std::string("all") ? "ObjectId@0.5" : "ObjectId");
    ASSERT_TRUE(label);
    EXPECT_EQ(label->labelNames, (LabelNames{{12, "fluid"}, {94, "solid"}}));
    EXPECT_FALSE(field(*read, "BlockId"));
  }
}

/// Two blocks with names and one point field T, at 1 and at `second`, in a folder of their own.
fs::path namedBlocks(double second) {
  const fs::path path =
      fileWith("named.vtm",
               "<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet>"
               "<DataSet name=\"fluid\" file=\"a.vtu\"/><DataSet name=\"solid\" file=\"b.vtu\"/>"
               "</vtkMultiBlockDataSet></VTKFile>");
  for (const auto& [name, x, value] :
       {std::tuple{"a.vtu", 0.0, 1.0}, std::tuple{"b.vtu", 1.0, second}}) {
    TetMesh mesh = testing::oneCell();
    if (x > 0) mesh.points = {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
    mesh.fields = {{"T", 1, "float64", std::vector<double>(4, value), "point"}};
    const Bytes bytes = vtuBytes(mesh);
    std::ofstream(path.parent_path() / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
  }
  return path;
}

TEST(VtkFormats, blocksKeepTheirNamesAndTheirValuesWhereTheyMeet) {
  for (const auto& [second, points] : {std::pair{1.0, 5u}, std::pair{8000.0, 8u}}) {
    const Result<ReadMesh> read = readMesh(namedBlocks(second));
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(read->mesh.points.size(), points);
    const MeshField* label = field(*read, "BlockId");
    ASSERT_TRUE(label);
    EXPECT_EQ(label->values, (std::vector<double>{1, 2}));
    EXPECT_EQ(label->labelNames, (LabelNames{{1, "fluid"}, {2, "solid"}}));
  }
}

TEST(VtkFormats, blocksOfASeriesAreOneFieldInAllParts) {
  const fs::path path = namedBlocks(8000).parent_path() / "run.pvd";
  std::string sets;
  for (int time = 0; time < 3; ++time)
    sets += "<DataSet timestep=\"" + std::to_string(time) + "\" file=\"named.vtm\"/>";
  std::ofstream(path) << "<VTKFile type=\"Collection\"><Collection>" + sets +
                             "</Collection></VTKFile>";
  ReadOptions options;
  options.time = "all";
  const std::vector<double> times{0, 1, 2};
  for (const std::size_t atOnce : {3u, 1u}) {
    const Result<ReadMesh> read = readTimesInParts(path, options, times, atOnce);
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(read->mesh.fields.size(), 4u);
    EXPECT_EQ(std::ranges::count(read->mesh.fields, "BlockId", &MeshField::name), 1);
    EXPECT_EQ(read->mesh.points.size(), 8u) << "the first step decides for all of them";
  }
  options.fields = std::vector<std::string>{"T"};
  EXPECT_EQ(readMesh(path, options)->mesh.fields.size(), 3u);
  options.fields = std::vector<std::string>{"BlockId"};
  EXPECT_EQ(readMesh(path, options)->mesh.fields.size(), 1u);
}

TEST(VtkFormats, cgnsZonesAreReadWithTheirSolution) {  // two files that the CGNS library wrote
  const ReadMesh mixed = expectABar(given("unstructured.cgns"), 1);
  EXPECT_EQ(mixed.report.split.cells[kHexahedronCell], 4u);
  EXPECT_EQ(mixed.report.split.cells[kWedgeCell], 8u);
  EXPECT_EQ(expectABar(given("structured.cgns"), 1).mesh.points.size(), 27u);
}

TEST(VtkFormats, avsUcdIsRead) {
  const std::string text =
      "12 2 1 0 0\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n7 0 0 1\n8 1 0 1\n9 2 0 "
      "1\n10 0 1 1\n11 1 1 1\n12 2 1 1\n"
      "1 1 hex 7 8 11 10 1 2 5 4\n2 1 hex 8 9 12 11 2 3 6 5\n1 1\nT, none\n1 0\n2 1\n3 2\n4 0\n5 "
      "1\n6 2\n7 0\n8 1\n9 2\n10 0\n11 1\n12 2\n";
  expectABar(fileWith("bar.inp", text), 2);
  for (std::size_t length = 0; length < 200; length += 40)
    EXPECT_FALSE(readMesh(fileWith("cut.inp", text.substr(0, length)))) << length;
}

TEST(VtkFormats, countsOfAvsUcdThatItsLinesContradictAreRefused) {
  const std::string points = "1 0 0 0\n2 nan 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n",
                    cells = "1 1 TET 1 2 3 4\n2 1 tet 2 3 4 5\n",
                    data = "1 1\nT, none\n1 0\n2 1\n3 2\n4 nan\n5 0\n";
  const auto errorOf = [&](const std::string& header, const std::string& body) {
    const Status status =
        checkMeshFile(fileWith("c.inp", header + "\n" + body), MeshFormat::kAvsUcd);
    return status ? std::string() : status.error().message;
  };
  const std::string whole = points + cells + data;
  EXPECT_EQ(errorOf("# made by hand\n5 2 1 0 0", whole + "\n \n"), "");
  EXPECT_EQ(errorOf("5 2 1 0 0", points + cells + "1 1\n,\n1 0\n2 1\n3 2\n4 0\n5 0\n"), "")
      << "a name may be empty";
  const auto names = [](const std::string& error, const std::string& part) {
    EXPECT_NE(error.find(part), std::string::npos) << error;
  };
  names(errorOf("4 2 1 0 0", whole), "line 6 is not cell 1 of 2");
  names(errorOf("6 2 1 0 0", whole), "line 7 is not point 6 of 6");
  names(errorOf("5 1 1 0 0", whole), "line 8 is not the sizes of point data whose sum is 1");
  names(errorOf("5 3 1 0 0", whole), "line 9 is not cell 3 of 3");
  names(errorOf("5 2 2 0 0", whole), "line 9 is not the sizes of point data whose sum is 2");
  names(errorOf("5 2 0 0 0", whole), "line 9 stands behind the last value");
  names(errorOf("5 2 1 0 0", points + cells + data.substr(0, data.size() - 4)),
        "ends before point tuple 5 of 5");
  names(errorOf("5 2 1 0 0", points + cells + "1 1\nT, none\n1\n2 1\n3 2\n4 0\n5 0\n"),
        "line 11 is not point tuple 1 of 5");
}

/// PLOT3D's numbers: C order of bytes, no record marks; `blank` marks the points of the second
/// grid's last plane.
std::string plot3d(bool solution, bool blank) {
  std::string out;
  const auto put = [&out](auto x) {
    const auto raw = std::bit_cast<std::array<char, sizeof(x)>>(x);
    out.append(raw.data(), raw.size());
  };
  put(std::int32_t{2});
  for (int g = 0; g < 2; ++g) put(std::int32_t{3}), put(std::int32_t{2}), put(std::int32_t{2});
  for (int g = 0; g < 2; ++g) {
    const auto each = [&](auto&& f) {
      for (int k = 0; k < 2; ++k) {
        for (int j = 0; j < 2; ++j) {
          for (int i = 0; i < 3; ++i)
            f(static_cast<float>(i + 2 * g), static_cast<float>(j), static_cast<float>(k));
        }
      }
    };
    if (solution) {
      for (int q = 0; q < 4; ++q) put(1.0F);
      each([&](float x, float, float) { put(x + 1); });
      for (int c = 0; c < 3; ++c) each([&](float, float, float) { put(0.5F); });
      each([&](float, float, float) { put(2.0F); });
      continue;
    }
    each([&](float x, float, float) { put(x); });
    each([&](float, float y, float) { put(y); });
    each([&](float, float, float z) { put(z); });
    if (blank) each([&](float x, float, float) { put(std::int32_t{x < 4 ? 1 : 0}); });
  }
  return out;
}

TEST(VtkFormats, plot3dGridsAreReadWithTheirSolutionAndWithoutBlankedCells) {
  for (const bool blank : {false, true}) {
    const fs::path path = fileWith("grid.xyz", plot3d(false, blank));
    std::ofstream(path.parent_path() / "grid.q", std::ios::binary) << plot3d(true, false);
    ReadOptions options;
    options.plot3d = true;
    options.plot3dSolution = (path.parent_path() / "grid.q").string();
    options.weld = 0;
    const ReadMesh read = expectABar(path, blank ? 3 : 4, "Density", 1, options);
    EXPECT_TRUE(field(read, "Pressure"));
    EXPECT_EQ(read.report.joinedPoints, 4u);
    options.plot3dSolution.clear();
    const Result<ReadMesh> alone = readMesh(path, options);
    ASSERT_TRUE(alone) << alone.error().text();
    EXPECT_NEAR(filledBy(alone->mesh).volume, blank ? 3 : 4, 1e-9);
  }
}

TEST(VtkFormats, aDamagedExodusFileIsAnErrorOrAMesh) {
  std::ifstream file(given("two.e"), std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(file), {}};
  for (std::size_t length = 0; length < whole.size(); length += 500) {
    const Result<ReadMesh> read = readMesh(fileWith("cut.e", whole.substr(0, length)));
    EXPECT_TRUE(read || !read.error().message.empty());
  }
}

/// A mesh often comes in an archive with other files, and qtet is called where they lie.
TEST(VtkFormats, aModuleInTheWorkingFolderIsNotTakenForMeshio) {
  const fs::path mesh = fs::absolute(fileWith("any.med", "nothing")), before = fs::current_path();
  std::ofstream(mesh.parent_path() / "meshio.py") << "open('ran', 'w')\n";
  fs::current_path(mesh.parent_path());
  EXPECT_FALSE(readMesh(mesh));
  EXPECT_FALSE(fs::exists("ran"));
  fs::remove("meshio.py");
  fs::current_path(before);
}

TEST(VtkFormats, aTemporaryFolderThatIsNotThereIsAnError) {
  const fs::path mesh = fileWith("any.med", "nothing");
  const char* before = std::getenv("TMPDIR");
  const std::string kept = before ? before : "";
  ::setenv("TMPDIR", "/nonexistent", 1);
  const Result<ReadMesh> read = readMesh(mesh);
  before ? ::setenv("TMPDIR", kept.c_str(), 1) : ::unsetenv("TMPDIR");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::kIo) << read.error().text();
  EXPECT_NE(read.error().message.find("TMPDIR"), std::string::npos) << read.error().text();
}

}  // namespace
}  // namespace qtet
