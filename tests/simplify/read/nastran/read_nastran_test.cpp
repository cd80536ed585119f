// Our own reader of Nastran's bulk data.
#include "simplify/read/nastran/read_nastran.h"

#include <gtest/gtest.h>

#include <fstream>

#include "simplify/read/nastran/bulk_cards.h"
#include "simplify/read/nastran/coordinate_systems.h"
#include "simplify/read/read_mesh.h"
#include "simplify/read/text/plain_numbers.h"
#include "tests/simplify/mesh/tet_meshes.h"
#include "tests/simplify/read/text_reader.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

const std::string kCorners =
    "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nGRID,4,,0.,0.,1.\n";
const std::string kTetrahedron = kCorners + "CTETRA,1,1,1,2,3,4\n";

const testing::TextReader kNastran{"model.bdf", [](const fs::path& path, ReadReport& report) {
                                     return readNastran(path, report);
                                   }};

void expectRefused(const std::string& text, const std::string& said) {
  const std::string message = kNastran.refusalOf(text);
  EXPECT_NE(message.find(said), std::string::npos) << message;
}

/// The mesh's points as its four corners should be.
void expectCorners(const std::string& text) {
  const Result<CellMesh> read = kNastran.read(text);
  ASSERT_TRUE(read) << text << read.error().message;
  EXPECT_EQ(read->points, (std::vector<Position>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}))
      << text;
  EXPECT_EQ(read->vertices, (std::vector<VertexId>{0, 1, 2, 3})) << text;
}

TEST(ReadNastran, linesOfEachFormMakeTheSameCards) {
  expectCorners(kTetrahedron);
  expectCorners("\xEF\xBB\xBF" + kTetrahedron);
  expectCorners("SOL 101\nCEND\n$ GRID,9\nBegin  bulk\n" + kTetrahedron +
                "ENDDATA\nnonsense 1,2\n");
  expectCorners(kTetrahedron + "END BULK\nnonsense\n");
  expectCorners(
      "grid           1              0.      0.      0.\n"
      "grid           2              1.      0.      0.  $ here\n"
      "grid\t3\t\t0.\t1.\t0.\n"
      "GRID*                  4                              0.              0.*G4\n"
      "*G4                   1.\n"
      "ctetra         1       1       1       2       3       4\n");
  // lines that continue a card need no mark, and commas may end before the last field
  expectCorners(
      "GRID*,1,,0.,0.\n*,0.\nGRID*,2,,1.,0.\n,0.\nGRID,3,,0.,1.\nGRID,4,,,,1.\n"
      "CTETRA,1,1,1,2,3,4\n");
}

TEST(ReadNastran, exponentsMayHaveNoLetter) {
  EXPECT_EQ(fortranReal("10.0000-1"), 1);
  EXPECT_EQ(fortranReal("-1.5+2"), -150);
  EXPECT_EQ(fortranReal("1.5D-1"), 0.15);
  EXPECT_EQ(fortranReal("1.5d+1"), 15);
  EXPECT_EQ(fortranReal("+1.e-1"), 0.1);
  EXPECT_EQ(fortranReal(".5"), 0.5);
  EXPECT_EQ(fortranReal("-.5-1"), -0.05);
  EXPECT_EQ(fortranReal("7"), 7);
  for (const char* no : {"", "-", "1.-", "1.5-3-3", "1.5E", "a", "1-+3"})
    EXPECT_FALSE(fortranReal(no)) << no;
}

TEST(ReadNastran, anExponentMayStandBehindItsField) {
  const auto place = [](const std::string& line) {
    const Result<CellMesh> read = kNastran.read(line + "\n");
    return read ? read->points.front() : Position{-1, -1, -1};
  };
  //                 name    number  system  x       y       z
  EXPECT_EQ(place("GRID           1        10.0000-1      2.      3."), (Position{1, 2, 3}));
  EXPECT_EQ(place("GRID           1              2.10.0000-130.0000-1"), (Position{2, 1, 3}));
  EXPECT_EQ(place("GRID           1        3.3333-110.0000-1 5.000+1  "),
            (Position{0.33333, 1, 50}));
  // with two digits more no field ends where the line does
  expectRefused("GRID           1        10.0000-12      2.      3.\n", "'10.0000-' is where");
}

TEST(ReadNastran, hexahedraGoOnOverLinesWithoutAMark) {
  std::string cube;
  int number = 0;
  for (const char* corner : {"0.,0.,0.", "1.,0.,0.", "1.,1.,0.", "0.,1.,0.", "0.,0.,1.", "1.,0.,1.",
                             "1.,1.,1.", "0.,1.,1."})
    cube += "GRID," + std::to_string(++number) + ",," + corner + "\n";
  for (const char* element :
       {"CHEXA          1       1       1       2       3       4       5       6\n"
        "               7       8\n",
        "CHEXA          1       1       1       2       3       4       5       6+H1\n"
        "+H1            7       8\n",
        "CHEXA,1,1,1,2,3,4,5,6,+\n+,7,8\n", "CHEXA,1,1,1,2,3,4,5,6\n,7,8\n"}) {
    const Result<CellMesh> read = kNastran.read(cube + element);
    ASSERT_TRUE(read) << element << read.error().message;
    EXPECT_EQ(read->types, std::vector<std::uint8_t>{kHexahedronCell});
    EXPECT_EQ(read->vertices, (std::vector<VertexId>{0, 1, 2, 3, 4, 5, 6, 7}));
  }
}

TEST(ReadNastran, nodesOnUprightEdgesComeLast) {
  std::string text;
  for (int i = 1; i <= 20; ++i)
    text += "GRID," + std::to_string(i) + ",," + std::to_string(i) + ".,0.,0.\n";
  const auto hex =
      kNastran.read(text + "CHEXA,1,1,1,2,3,4,5,6\n,7,8,9,10,11,12,13,14\n,15,16,17,18,19,20\n");
  ASSERT_TRUE(hex) << hex.error().message;
  EXPECT_EQ(hex->types, std::vector<std::uint8_t>{kQuadraticHexahedronCell});
  EXPECT_EQ(hex->vertices, (std::vector<VertexId>{0,  1,  2,  3,  4,  5,  6,  7,  8,  9,
                                                  10, 11, 16, 17, 18, 19, 12, 13, 14, 15}));
  const auto wedge = kNastran.read(text + "CPENTA,1,1,1,2,3,4,5,6\n,7,8,9,10,11,12,13,14\n,15\n");
  ASSERT_TRUE(wedge) << wedge.error().message;
  EXPECT_EQ(wedge->vertices,
            (std::vector<VertexId>{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11}));
  const auto pyramid = kNastran.read(text + "CPYRAM,1,1,1,2,3,4,5,CORDM\n");
  ASSERT_TRUE(pyramid) << pyramid.error().message;
  EXPECT_EQ(pyramid->types, std::vector<std::uint8_t>{kPyramidCell});
  expectRefused(text + "CTETRA,5,1,1,2,3,4,5,6\n", "CTETRA 5 has nodes on 2 of its 6 edges");
  expectRefused(text + "CTETRA,5,1,1,2,3\n", "CTETRA 5 has 3 corners, not 4");
}

Position placeOf(const std::string& cards) {
  const Result<CellMesh> read = kNastran.read(cards);
  EXPECT_TRUE(read) << read.error().message;
  return read ? read->points.back() : Position{};
}

void expectNear(const Position& a, const Position& b) {
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 1e-12);
}

TEST(ReadNastran, pointsAreGivenInCoordinateSystems) {
  const std::string ends = ",0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n";
  expectNear(placeOf("CORD2C,7,0" + ends + "GRID,1,7,2.,90.,3.\n"), {0, 2, 3});
  expectNear(placeOf("CORD2S,7,0" + ends + "GRID,1,7,2.,90.,90.\n"), {0, 2, 0});
  expectNear(placeOf("CORD2S,7,0" + ends + "GRID,1,7,2.,0.,30.\n"), {0, 0, 2});
  // z along x, x along y, so y along z
  expectNear(placeOf("CORD2R,7,,1.,2.,3.,2.,2.,3.\n,1.,3.,3.\nGRID,1,7,10.,20.,30.\n"),
             {31, 12, 23});
  // in a system within a cylindrical one: its points are radius, degrees and height
  expectNear(placeOf("CORD2C,7,0" + ends +
                     "CORD2R,8,7,1.,90.,0.,1.,90.,1.\n,2.,90.,0.\nGRID,1,8,1.,0.,5.\n"),
             {0, 2, 5});
  // by points of the mesh; two on a card
  expectNear(placeOf(kCorners + "CORD1R,5,1,2,3,6,1,3,4\nGRID,9,5,10.,20.,30.\n"), {30, 10, 20});
  expectNear(placeOf(kCorners + "CORD1R,5,1,2,3,6,1,3,4\nGRID,9,6,10.,20.,30.\n"), {20, 30, 10});
  // the default, which a 0 sets aside
  expectNear(placeOf("GRDSET,,7\nCORD2C,7,0" + ends + "GRID,1,,2.,90.,3.\n"), {0, 2, 3});
  expectNear(placeOf("GRDSET,,7\nCORD2C,7,0" + ends + "GRID,1,0,2.,90.,3.\n"), {2, 90, 3});
}

TEST(ReadNastran, systemsThatSayNoPlaceAreRefused) {
  expectRefused("GRID,3,7,1.,0.,0.\n", "point 3: coordinate system 7 is not there");
  expectRefused("CORD2R,7,,0.,0.,0.,1.,0.,0.\n,2.,0.,0.\nGRID,3,7,1.,0.,0.\n", "one line");
  expectRefused("CORD2R,7,7,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\nGRID,3,7,1.,0.,0.\n", "in a circle");
  expectRefused("CORD1R,7,1,2,4\nGRID,3,7,1.,0.,0.\n", "the point 1, which is not there");
  const std::string system = "CORD2R,7,,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\n";
  expectRefused(system + system, "coordinate system 7 is there already");
  const auto chain = [](int systems) {
    std::string text;
    for (int i = 1; i <= systems; ++i)
      text += "CORD2R," + std::to_string(i) + "," + std::to_string(i - 1) +
              ",0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n";
    return text + "GRID,1," + std::to_string(systems) + ",1.,2.,3.\n";
  };
  EXPECT_TRUE(kNastran.read(chain(PlacedGrids::kMaxDepth - 1)));
  EXPECT_TRUE(kNastran.read(chain(PlacedGrids::kMaxDepth)));
  expectRefused(chain(PlacedGrids::kMaxDepth + 1), "more than 64 deep");
}

TEST(ReadNastran, otherElementsAreCountedAndOtherVolumesRefused) {
  ReadReport report;
  const auto read =
      kNastran.read(kTetrahedron +
                        "PSOLID,1,1\nCQUAD4,7,1,1,2,3,4\nCBAR,8,1,1,2\nRBE2,9,1,123,2,3,4\n"
                        "FORCE,1,1,,1.\nMAT1,1,2.1+5,,.3\n",
                    report);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(report.ignoredCells, 3u);
  EXPECT_TRUE(read->fields.empty());
  expectRefused(kTetrahedron + "CHEXA1,2,1,1,2,3,4\n", "line 6: elements CHEXA1 are not read");
  expectRefused(kTetrahedron + "BEGIN SUPER=2\n" + kTetrahedron,
                "begins the bulk data of one part among several");
}

TEST(ReadNastran, propertiesAreALabel) {
  const auto read =
      kNastran.read(kCorners + "GRID,5,,1.,1.,1.\nCTETRA,1,3,1,2,3,4\nCTETRA,2,9,2,3,4,5\n");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->fields.size(), 1u);
  EXPECT_EQ(read->fields[0].name, "nastran:ref");
  EXPECT_EQ(read->fields[0].values, (std::vector<double>{3, 9}));
}

TEST(ReadNastran, numbersThatAreGivenTwiceAreRefused) {
  expectCorners(kTetrahedron + kTetrahedron);
  expectRefused(kTetrahedron + "GRID,4,,0.,0.,2.\n", "point 4 is there already");
  expectRefused(kTetrahedron + "CTETRA,1,1,1,2,4,3\n", "element 1 is there already");
  expectRefused(kTetrahedron + "CTETRA,2,1,1,2,4,30\n", "element 2 has the point 30");
  expectRefused("GRID,1,,a,0.,0.\n", "line 1: 'a' is where a coordinate should be");
  expectRefused("GRID,x,,1.,0.,0.\n", "a point's number");
  expectRefused(",1,,1.,0.,0.\n", "continues no card");
  expectRefused("GRID,1,,0.,0.,0.,,,,,7\n", "more than 10 fields");
}

TEST(ReadNastran, includedFilesAreRead) {
  const fs::path folder = testing::freshFolder("nastran");
  const auto write = [&](const std::string& name, const std::string& text) {
    fs::create_directories((folder / name).parent_path());
    std::ofstream(folder / name) << text;
  };
  ReadReport report;
  const auto read = [&](const std::string& text) {
    write("all.bdf", text);
    return readNastran(folder / "all.bdf", report);
  };
  write("nodes.bdf", kCorners);
  write("more/cells.bdf", "CTETRA,1,1,1,2,3,4\n");
  for (const char* end : {"include 'more/cells.bdf'\n", "INCLUDE more/cells.bdf\n",
                          "INCLUDE 'more/\n  cells.bdf'\n"}) {
    const auto mesh = read("BEGIN BULK\nINCLUDE \"nodes.bdf\"\n" + std::string(end) + "ENDDATA\n");
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->vertices, (std::vector<VertexId>{0, 1, 2, 3}));
  }
  const auto refused = [&](const std::string& text, const std::string& said) {
    const auto mesh = read(text);
    ASSERT_FALSE(mesh);
    EXPECT_NE(mesh.error().message.find(said), std::string::npos) << mesh.error().message;
  };
  refused("INCLUDE 'none.bdf'\n", "line 1: the included file 'none.bdf' is not there");
  refused("INCLUDE 'all.bdf'\n", "is included twice");
  refused("INCLUDE 'nodes.bdf'\nINCLUDE './nodes.bdf'\n", "is included twice");
  refused("INCLUDE 'nodes.bdf\n", "names no file between quotes");
  const auto deep = [&](std::size_t depth) {
    for (std::size_t i = 1; i < depth; ++i)
      write(std::to_string(i) + ".bdf", "INCLUDE '" + std::to_string(i + 1) + ".bdf'\n");
    write(std::to_string(depth) + ".bdf", kTetrahedron);
    return read("INCLUDE '1.bdf'\n");
  };
  EXPECT_TRUE(deep(BulkCards::kMaxDepth - 1));
  EXPECT_TRUE(deep(BulkCards::kMaxDepth));
  const auto tooDeep = deep(BulkCards::kMaxDepth + 1);
  ASSERT_FALSE(tooDeep);
  EXPECT_EQ(tooDeep.error().code, ErrorCode::kLimitExceeded);
}

TEST(ReadNastran, anyTruncationIsAnErrorOrAMesh) {
  const std::string whole = "CORD2C,7,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n" + kTetrahedron;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const auto read = kNastran.read(whole.substr(0, length));
    if (read) {
      for (const VertexId v : read->vertices) EXPECT_LT(v, read->points.size());
    } else {
      EXPECT_FALSE(read.error().message.empty());
    }
  }
}

}  // namespace
}  // namespace qtet
