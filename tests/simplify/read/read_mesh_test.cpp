#include "simplify/read/read_mesh.h"
#include "simplify/read/unused_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "simplify/log/write_mesh.h"
#include "tests/simplify/mesh/tet_meshes.h"

// VTK's XML reader leaks a few small objects when it gives up on a damaged file; the leak sanitizer
// reads this, other builds do not.
// NOLINTBEGIN(readability-identifier-naming): the sanitizer's name
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libvtk"; }
// NOLINTEND(readability-identifier-naming)

namespace qtet {
namespace {

using testing::fileWith;

std::string asText(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

std::string boxFile() { return asText(vtuBytes(boxSample())); }

/// A .vtu of text arrays; the arguments are what stands in them.
std::string asciiVtu(const std::string& points, const std::string& connectivity,
                     const std::string& offsets, const std::string& types, int pointCount,
                     int cellCount, const std::string& pointData = "",
                     const std::string& cellData = "") {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
         "byte_order=\"LittleEndian\">\n<UnstructuredGrid><Piece NumberOfPoints=\"" +
         std::to_string(pointCount) + "\" NumberOfCells=\"" + std::to_string(cellCount) +
         "\">\n<PointData>" + pointData + "</PointData><CellData>" + cellData +
         "</CellData>\n<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
         "format=\"ascii\">" +
         points +
         "</DataArray></Points>\n<Cells><DataArray type=\"Int64\" Name=\"connectivity\" "
         "format=\"ascii\">" +
         connectivity + "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">" +
         offsets + "</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">" +
         types + "</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>\n";
}

const std::string kLegacy =
    "# vtk DataFile Version 3.0\ntest\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 "
    "0 0 1 0 0 0 1\nCELLS 2 9\n4 0 1 2 3\n3 "
    "0 1 2\nCELL_TYPES 2\n10\n5\n"
    "POINT_DATA 4\nSCALARS s float 1\nLOOKUP_TABLE default\n1 2 3 4\nVECTORS v double\n1 2 3 4 5 6 "
    "7 8 9 10 11 12\nFIELD f 1\nid 1 4 "
    "int\n7 8 9 10\n";

const std::string kFourPoints = "0 0 0 1 0 0 0 1 0 0 0 1";

std::string oneCellVtu(const std::string& pointData, const std::string& cellData = "") {
  return asciiVtu(kFourPoints, "0 1 2 3", "4", "10", 4, 1, pointData, cellData);
}

/// The error of reading `text` as `name`; its message must hold the file's name and `word`.
ErrorCode refused(const std::string& name, const std::string& text, const std::string& word,
                  const FieldNames& fields = std::nullopt) {
  const Result<ReadMesh> read = readMesh(fileWith(name, text), fields);
  EXPECT_FALSE(read) << "was read";
  if (read) return ErrorCode::kIo;
  EXPECT_NE(read.error().message.find(name), std::string::npos) << read.error().message;
  EXPECT_NE(read.error().message.find(word), std::string::npos) << read.error().message;
  EXPECT_EQ(read.error().message.find('\n'), std::string::npos) << read.error().message;
  return read.error().code;
}

TEST(ReadMesh, aVtuComesBackAsItWasWritten) {
  const TetMesh mesh = boxSample();
  const Result<ReadMesh> read = readMesh(fileWith("box.vtu", boxFile()));
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->mesh.points, mesh.points);
  EXPECT_EQ(read->mesh.tetrahedra, mesh.tetrahedra);
  ASSERT_EQ(read->mesh.fields.size(), 1u);
  EXPECT_EQ(read->mesh.fields[0].values, mesh.fields[0].values);
  EXPECT_EQ(read->mesh.fields[0].type, "float32");
  EXPECT_TRUE(read->report.notes.empty());
}

TEST(ReadMesh, legacyFilesAreRead) {
  const Result<ReadMesh> read = readMesh(fileWith("one.vtk", kLegacy));
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->mesh.tetrahedra, (std::vector<Tetrahedron>{{0, 1, 2, 3}}));
  EXPECT_EQ(read->report.ignoredCells, 1u);
  ASSERT_EQ(read->mesh.fields.size(), 3u);
  for (const MeshField& field : read->mesh.fields) {
    EXPECT_EQ(field.components, field.name == "v" ? 3u : 1u);
    EXPECT_EQ(field.type, field.name == "id" ? "int32" : field.name == "v" ? "float64" : "float32");
  }
}

TEST(ReadMesh, lowerDimensionsAreIgnoredWithACount) {
  const std::string text =
      asciiVtu(kFourPoints, "0 1 2 0 1 2 3 0 1 0", "3 7 9 10", "5 10 3 1", 4, 4);
  const Result<ReadMesh> read = readMesh(fileWith("mixed.vtu", text));
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->mesh.tetrahedra.size(), 1u);
  EXPECT_EQ(read->report.ignoredCells, 3u);
  ASSERT_EQ(read->report.notes.size(), 1u);
}

TEST(ReadMesh, fieldsOfTooManyComponentsAreIgnoredWithANote) {
  const auto wide = [](const std::string& name, int tuples) {
    std::string values;
    for (int i = 0; i < 17 * tuples; ++i) values += "1 ";
    return "<DataArray type=\"Float32\" Name=\"" + name +
           "\" NumberOfComponents=\"17\" format=\"ascii\">" + values + "</DataArray>";
  };
  const Result<ReadMesh> read =
      readMesh(fileWith("wide.vtu", oneCellVtu(wide("big", 4), wide("bigger", 1))));
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_TRUE(read->mesh.fields.empty());
  EXPECT_EQ(read->report.ignoredFields, (std::vector<std::string>{"big", "bigger"}));
  ASSERT_EQ(read->report.notes.size(), 2u);
  EXPECT_NE(read->report.notes[1].find("cell field bigger"), std::string::npos);
}

/// Three tetrahedra with a line and a triangle between them, and the given cell fields.
std::string mixedVtu(const std::string& cellData) {
  return asciiVtu(
      "0 0 0 1 0 0 0 1 0 0 0 1 1 1 1 2 2 2", "0 1 2 3 0 1 1 2 3 4 0 1 2 2 4 3 5", "4 6 10 13 17",
      "10 3 10 5 10", 6, 5,
      "<DataArray type=\"Float32\" Name=\"both\" format=\"ascii\">0 1 2 3 4 5</DataArray>",
      cellData);
}

const std::string kCellData =
    "<DataArray type=\"Int32\" Name=\"material\" format=\"ascii\">10 11 12 13 14</DataArray>"
    "<DataArray type=\"Float64\" Name=\"both\" NumberOfComponents=\"2\" format=\"ascii\">0 1 10 11 "
    "20 21 30 31 40 41</DataArray>";

TEST(ReadMesh, cellFieldsAreThoseOfTheTetrahedra) {
  const Result<ReadMesh> read = readMesh(fileWith("mixed.vtu", mixedVtu(kCellData)));
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->mesh.tetrahedra.size(), 3u);
  ASSERT_EQ(read->mesh.fields.size(), 3u);
  EXPECT_FALSE(isCellField(read->mesh.fields[0]));
  EXPECT_TRUE(isCellField(read->mesh.fields[1]));
  EXPECT_EQ(read->mesh.fields[1].type, "int32");
  EXPECT_EQ(read->mesh.fields[1].values, (std::vector<double>{10, 12, 14}));
  EXPECT_TRUE(isCellField(read->mesh.fields[2]));
  EXPECT_EQ(read->mesh.fields[2].values, (std::vector<double>{0, 1, 20, 21, 40, 41}));
}

TEST(ReadMesh, aNameMeansEveryFieldThatHasItUnlessItSaysWhich) {
  const auto path = fileWith("names.vtu", mixedVtu(kCellData));
  const auto associations = [&](const std::vector<std::string>& names) {
    const Result<ReadMesh> read = readMesh(path, names);
    EXPECT_TRUE(read) << read.error().text();
    std::string out;
    for (const MeshField& field : read->mesh.fields)
      out += field.association + " " + field.name + ", ";
    return out;
  };
  EXPECT_EQ(associations({"both"}), "point both, cell both, ");
  EXPECT_EQ(associations({"cell:both"}), "cell both, ");
  EXPECT_EQ(associations({"point:both", "material"}), "point both, cell material, ");
  EXPECT_EQ(associations({"cell:both", "both"}), "cell both, point both, ");
  EXPECT_EQ(readMesh(path, std::vector<std::string>{"point:material"}).error().code,
            ErrorCode::kNotFound);
}

TEST(ReadMesh, cellIntegersThatADoubleCannotHoldAreRefusedByName) {
  const std::string ids =
      "<DataArray type=\"Int64\" Name=\"id\" format=\"ascii\">1 9007199254740993 2 3 "
      "9007199254740992</DataArray>";
  EXPECT_EQ(refused("wide-cells.vtu", mixedVtu(ids), "cell 2", {{"id"}}),
            ErrorCode::kBadInput);  // the third tetrahedron; the line's value does not matter
}

TEST(ReadMesh, fieldsAreChosenByNameInTheOrderAsked) {
  const std::string text = oneCellVtu(
      "<DataArray type=\"Float32\" Name=\"a\" format=\"ascii\">1 2 3 4</DataArray><DataArray "
      "type=\"Int16\" Name=\"b\" format=\"ascii\">5 "
      "6 7 8</DataArray>");
  const auto path = fileWith("fields.vtu", text);
  const Result<ReadMesh> read = readMesh(path, std::vector<std::string>{"b", "a"});
  ASSERT_TRUE(read);
  ASSERT_EQ(read->mesh.fields.size(), 2u);
  EXPECT_EQ(read->mesh.fields[0].name, "b");
  EXPECT_EQ(read->mesh.fields[0].type, "int16");
  EXPECT_TRUE(readMesh(path, std::vector<std::string>{})->mesh.fields.empty());
  const Result<ReadMesh> none = readMesh(path, std::vector<std::string>{"c"});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kNotFound);
  EXPECT_NE(none.error().message.find("a, b"), std::string::npos);
}

TEST(ReadMesh, aFieldKeepsWhatIsNotFinite) {
  TetMesh mesh = testing::oneCell();
  mesh.fields = {{"f", 1, "float32", {std::nan(""), INFINITY, 1, 2}}};
  const Result<ReadMesh> read = readMesh(fileWith("nanfield.vtu", asText(vtuBytes(mesh))));
  ASSERT_TRUE(read);
  EXPECT_TRUE(std::isnan(read->mesh.fields[0].values[0]));
}

TEST(ReadMesh, integersThatADoubleCannotHoldAreLeftOutAndRefusedByName) {
  const auto text = [](const char* value) {
    return oneCellVtu("<DataArray type=\"Int64\" Name=\"id\" format=\"ascii\">1 2 " +
                      std::string(value) + " 4</DataArray>");
  };
  EXPECT_TRUE(readMesh(fileWith("fits.vtu", text("9007199254740991"))));
  EXPECT_EQ(refused("wide.vtu", text("9007199254740993"), "point 2", {{"id"}}),
            ErrorCode::kBadInput);
  const Result<ReadMesh> rest = readMesh(fileWith("left-out.vtu", text("9007199254740993")));
  ASSERT_TRUE(rest) << rest.error().text();
  EXPECT_TRUE(rest->mesh.fields.empty());
  ASSERT_EQ(rest->report.notes.size(), 1u);
  EXPECT_NE(rest->report.notes[0].find("left out"), std::string::npos) << rest->report.notes[0];
}

TEST(ReadMesh, coordinatesThatAreNotFiniteAreCounted) {
  TetMesh mesh = boxSample();
  mesh.points[5][1] = std::nan("");
  mesh.points[9][2] = INFINITY;
  EXPECT_EQ(refused("nan.vtu", asText(vtuBytes(mesh)), "2 points"), ErrorCode::kBadInput);
  EXPECT_EQ(refused("nan2.vtu", asText(vtuBytes(mesh)), "point 5"), ErrorCode::kBadInput);
}

TEST(ReadMesh, aPointThatIsNotFiniteAndThatNoCellUsesIsDropped) {
  TetMesh mesh = testing::twoCells();
  mesh.points.insert(mesh.points.begin() + 1, Position{0, std::nan(""), 0});
  mesh.points.push_back({INFINITY, 0, 0});
  for (Tetrahedron& cell : mesh.tetrahedra)
    for (VertexId& v : cell) v += v > 0 ? 1 : 0;
  mesh.fields = {{"T", 1, "float64", {0, 9, 1, 2, 3, 4, 9}, "point"}};
  const Result<ReadMesh> read = readMesh(fileWith("unused.vtu", asText(vtuBytes(mesh))));
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->mesh.points, testing::twoCells().points);
  EXPECT_EQ(read->mesh.tetrahedra, testing::twoCells().tetrahedra);
  EXPECT_EQ(read->mesh.fields[0].values, (std::vector<double>{0, 1, 2, 3, 4}));
  ASSERT_EQ(read->report.notes.size(), 1u);
  EXPECT_TRUE(read->report.notes[0].starts_with("2 points that no cell uses"));
  mesh.points[3][0] = INFINITY;
  EXPECT_EQ(refused("used.vtu", asText(vtuBytes(mesh)), "NaN or infinite"), ErrorCode::kBadInput);
}

TEST(ReadMesh, aPolyhedronUsesThePointsOfItsFacesAndNotTheirNumbers) {
  // A tetrahedron as a polyhedron of four triangles on points 0, 1, 2 and 5.
  CellMesh mesh;
  const double nan = std::nan("");
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {nan, 0, 0}, {nan, 0, 0}, {0, 0, 1}};
  mesh.addCell(kPolyhedronCell,
               std::vector<VertexId>{4, 3, 0, 2, 1, 3, 0, 1, 5, 3, 1, 2, 5, 3, 0, 5, 2});
  std::vector<std::string> notes;
  dropUnusedPoints(mesh, notes);
  EXPECT_EQ(mesh.points.size(), 4u);
  EXPECT_EQ(mesh.vertices,
            (std::vector<VertexId>{4, 3, 0, 2, 1, 3, 0, 1, 3, 3, 1, 2, 3, 3, 0, 3, 2}));
  EXPECT_EQ(notes.size(), 1u);
}

TEST(ReadMesh, asciiArraysOfOtherLengthsThanToldAreRefused) {
  const auto text = [](std::array<std::string, 6> arrays) {
    const auto field = [](const char* name, const std::string& values) {
      return std::string("<DataArray type=\"Float32\" Name=\"") + name + "\" format=\"ascii\">" +
             values + "</DataArray>";
    };
    return asciiVtu(arrays[0], arrays[1], arrays[2], arrays[3], 4, 1, field("T", arrays[4]),
                    field("c", arrays[5]));
  };
  const std::array<std::string, 6> good{kFourPoints, "0 1 2 3", "4", "10", "1 2 3 4", "5"};
  const std::array<std::array<const char*, 4>, 6> told{{{"Points", "11", "13", "12"},
                                                        {"connectivity", "3", "5", "4"},
                                                        {"offsets", "0", "2", "1"},
                                                        {"types", "0", "2", "1"},
                                                        {"T", "3", "5", "4"},
                                                        {"c", "0", "2", "1"}}};
  ASSERT_TRUE(readMesh(fileWith("counted.vtu", text(good))));
  for (std::size_t i = 0; i < good.size(); ++i) {
    const auto [name, fewer, more, right] = told[i];
    const auto says = [&](const std::string& values, const std::string& what) {
      std::array<std::string, 6> arrays = good;
      arrays[i] = values;
      EXPECT_EQ(refused("counted.vtu", text(arrays), std::string("the ascii array ") + name + what),
                ErrorCode::kBadInput);
    };
    const std::size_t last = good[i].find_last_of(' ');
    const std::string less = last == std::string::npos ? "" : good[i].substr(0, last);
    const std::string counts = std::string(" numbers, but the file's counts say ") + right;
    says(less, " has " + std::string(fewer) + counts);
    says(good[i] + " 7", " has " + std::string(more) + counts);
    says(good[i] + " x", " has 'x' behind its first " + std::string(right));
  }
}

TEST(ReadMesh, hexahedraAreSplitAndTheirNumberKept) {
  const std::string text =
      asciiVtu("0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1 0.5 0.5 -1",
               "0 1 2 0 2 1 8 0 1 2 3 4 5 6 7", "3 7 15", "5 10 12", 9, 3, "",
               "<DataArray type=\"Float32\" Name=\"s\" format=\"ascii\">5 6 7</DataArray>");
  ReadOptions options;
  options.originalIds = true;
  const Result<ReadMesh> read = readMesh(fileWith("hex.vtu", text), options);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->mesh.tetrahedra.size(), 7u);
  EXPECT_EQ(readMesh(fileWith("hex.vtu", text))->mesh.fields.size(), 1u);
  ASSERT_EQ(read->mesh.fields.size(), 2u);
  EXPECT_EQ(read->mesh.fields[0].values, (std::vector<double>{6, 7, 7, 7, 7, 7, 7}));
  EXPECT_EQ(read->mesh.fields[1].name, kOriginalCellField);
  EXPECT_EQ(read->mesh.fields[1].values, (std::vector<double>{1, 2, 2, 2, 2, 2, 2}));
  EXPECT_EQ(read->report.split.cells[kHexahedronCell], 1u);
  EXPECT_EQ(readMesh(fileWith("hex.vtu", text), std::vector<std::string>{"s"})->mesh.fields.size(),
            1u);
  EXPECT_TRUE(readMesh(fileWith("hex.vtu", text), std::vector<std::string>{kOriginalCellField}));
  options.fields = std::vector<std::string>{};
  EXPECT_EQ(readMesh(fileWith("hex.vtu", text), options)->mesh.fields.size(), 1u);
}

TEST(ReadMesh, cellsWithTooFewVerticesAreRefused) {
  EXPECT_EQ(refused("hex.vtu", asciiVtu(kFourPoints, "0 1 2 3", "4", "12", 4, 1),
                    "cell 0 is a hexahedron without 8 vertices"),
            ErrorCode::kBadInput);
  EXPECT_EQ(refused("quadratic.vtu", asciiVtu(kFourPoints, "0 1 2 3", "4", "24", 4, 1),
                    "quadratic tetrahedron"),
            ErrorCode::kBadInput);
}

TEST(ReadMesh, unknownCellTypesAreRefused) {
  EXPECT_EQ(refused("type.vtu", asciiVtu(kFourPoints, "0 1 2 3", "4", "200", 4, 1), "type 200"),
            ErrorCode::kBadInput);
  EXPECT_EQ(refused("pyramid.vtu", asciiVtu(kFourPoints, "0 1 2 3", "4", "74", 4, 1),
                    "VTK defines no order"),
            ErrorCode::kBadInput);
}

TEST(ReadMesh, aMeshWithoutTetrahedraIsRefused) {
  EXPECT_EQ(
      refused("surface.vtu", asciiVtu(kFourPoints, "0 1 2", "3", "5", 4, 1), "no volume cells"),
      ErrorCode::kBadInput);
  EXPECT_EQ(refused("points.vtu", asciiVtu(kFourPoints, "", "", "", 4, 0), "no volume cells"),
            ErrorCode::kBadInput);
  EXPECT_EQ(refused("nothing.vtu", asciiVtu("", "", "", "", 0, 0), "no points"),
            ErrorCode::kBadInput);
}

TEST(ReadMesh, vertexIdsOutsideThePointsAreRefused) {
  EXPECT_EQ(refused("high.vtu", asciiVtu(kFourPoints, "0 1 2 4", "4", "10", 4, 1), "cell 0"),
            ErrorCode::kBadInput);
  EXPECT_EQ(refused("negative.vtu", asciiVtu(kFourPoints, "0 1 2 -1", "4", "10", 4, 1), "cell 0"),
            ErrorCode::kBadInput);
}

TEST(ReadMesh, offsetsThatContradictTheTypeAreRefused) {
  EXPECT_EQ(refused("offsets.vtu", asciiVtu(kFourPoints, "0 1 2 3", "3", "10", 4, 1), "counts"),
            ErrorCode::kBadInput);
}

TEST(ReadMesh, arraysOfAWrongLengthAreRefused) {
  EXPECT_EQ(
      refused(
          "short.vtu",
          oneCellVtu("<DataArray type=\"Float32\" Name=\"s\" format=\"ascii\">1 2 3</DataArray>"),
          "counts"),
      ErrorCode::kBadInput);
  EXPECT_EQ(refused("few.vtu", asciiVtu("0 0 0 1 0 0", "0 1 2 3", "4", "10", 4, 1), "counts"),
            ErrorCode::kBadInput);
}

TEST(ReadMesh, aMissingFileIsNotFound) {
  const Result<ReadMesh> read = readMesh(testing::freshFolder("missing") / "no.vtu");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::kNotFound);
}

TEST(ReadMesh, aFolderIsRefused) {
  const auto folder = testing::freshFolder("folder") / "f.vtu";
  std::filesystem::create_directory(folder);
  ASSERT_FALSE(readMesh(folder));
  EXPECT_EQ(readMesh(folder).error().code, ErrorCode::kBadInput);
}

TEST(ReadMesh, anEmptyFileIsTruncated) {
  EXPECT_EQ(refused("empty.vtu", "", "0 bytes"), ErrorCode::kTruncated);
  EXPECT_EQ(refused("empty.vtk", "", "0 bytes"), ErrorCode::kTruncated);
}

TEST(ReadMesh, whatIsNoVtkFileIsRefused) {
  EXPECT_EQ(refused("text.vtu", "this is no XML", "no <VTKFile>"), ErrorCode::kBadInput);
  EXPECT_EQ(refused("text.vtk", "this is no VTK", "first line"), ErrorCode::kBadInput);
  EXPECT_EQ(refused("other.msh", "$MeshFormat", "ends"), ErrorCode::kTruncated);
  EXPECT_EQ(refused("image.vtu", "<VTKFile type=\"ImageData\"></VTKFile>", "'ImageData'"),
            ErrorCode::kBadInput);
  EXPECT_EQ(refused("image.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\n",
                    "UNSTRUCTURED_GRID"),
            ErrorCode::kBadInput);
}

TEST(ReadMesh, theRootsTypeIsFoundWhereverItStands) {
  const std::string whole = oneCellVtu("");
  const std::string before =
      "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">";
  const std::size_t at = whole.find(before);
  ASSERT_NE(at, std::string::npos);
  for (const char* root :
       {"<VTKFile byte_order=\"LittleEndian\" header_type=\"UInt32\" type=\"UnstructuredGrid\" "
        "version=\"0.1\">",
        "<VTKFile type = \"UnstructuredGrid\" version='0.1' byte_order=\"LittleEndian\">",
        "<VTKFile\n  version='0.1'\n  type='UnstructuredGrid'\tbyte_order=\"LittleEndian\" >"}) {
    const auto read =
        readMesh(fileWith("root.vtu", std::string(whole).replace(at, before.size(), root)));
    EXPECT_TRUE(read) << root << read.error().message;
  }
  for (const char* root : {"<VTKFile header_type=\"UnstructuredGrid\">", "<VTKFile",
                           "<VTKFile type", "<VTKFile type=", "<VTKFile type=\"UnstructuredGrid",
                           "<VTKFile comment=\" type='UnstructuredGrid'\">"})
    EXPECT_EQ(refused("root.vtu", std::string(root) + "</VTKFile>", "type ''"),
              ErrorCode::kBadInput)
        << root;
}

TEST(ReadMesh, aVtuCutAnywhereIsRefused) {
  const std::string whole = boxFile();
  for (std::size_t length = 0; length + 12 < whole.size(); length += length < 1500 ? 97 : 5003) {
    const Result<ReadMesh> read = readMesh(fileWith("cut.vtu", whole.substr(0, length)));
    ASSERT_FALSE(read) << "cut at " << length;
    ASSERT_TRUE(read.error().code == ErrorCode::kTruncated ||
                read.error().code == ErrorCode::kBadInput);
  }
}

TEST(ReadMesh, aVtuWithAPieceMissingIsRefused) {
  const std::string whole = boxFile();
  // The closing tags are there, but raw bytes before them are not.
  const std::string text = whole.substr(0, 20000) + whole.substr(whole.size() - 40);
  EXPECT_EQ(refused("hole.vtu", text, "line 14: the array types"), ErrorCode::kBadInput);
}

/// Reads `rounds` damaged copies of `whole`: bits flipped, bytes that became digits. Whatever
/// happens must be a mesh or an error.
void readDamagedCopies(const std::string& name, const std::string& whole, int rounds) {
  std::mt19937 random(5);
  for (int round = 0; round < rounds; ++round) {
    std::string text = whole;
    for (int changes = 0; changes < 3; ++changes) {
      char& c = text[random() % text.size()];
      c = random() % 2 ? static_cast<char>('0' + random() % 10)
                       : static_cast<char>(c ^ (1 << (random() % 8)));
    }
    const Result<ReadMesh> read = readMesh(fileWith(name, text));
    ASSERT_TRUE(read || !read.error().message.empty());
  }
}

TEST(ReadMesh, aDamagedVtuNeverCrashes) {
  TetMesh mesh = testing::twoCells();
  mesh.fields = {{"f", 1, "float32", {1, 2, 3, 4, 5}}};
  readDamagedCopies("damaged.vtu", asText(vtuBytes(mesh)), 300);
}

TEST(ReadMesh, aDamagedLegacyFileNeverCrashes) { readDamagedCopies("damaged.vtk", kLegacy, 300); }

TEST(ReadMesh, aLegacyFileThatCrashesVtkIsRefused) {
  // VTK alone reads texture coordinates
  std::string text = kLegacy + "TEXTURE_COORDINATES t 2 float\n0 0 0 0 0 0 0 0\n";
  text.replace(text.find("4 0 1 2 3"), 1, "400000");
  EXPECT_EQ(refused("crash.vtk", text, "VTK"), ErrorCode::kBadInput);
}

}  // namespace
}  // namespace qtet
