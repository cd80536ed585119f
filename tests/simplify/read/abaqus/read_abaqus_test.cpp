// Our own reader of Abaqus' and CalculiX' input files.
#include "simplify/read/abaqus/read_abaqus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "simplify/read/abaqus/abaqus_lines.h"
#include "simplify/read/abaqus/element_numbers.h"
#include "simplify/read/abaqus/placement.h"
#include "simplify/read/read_mesh.h"
#include "tests/simplify/mesh/tet_meshes.h"
#include "tests/simplify/read/text_reader.h"
#include "tests/simplify/split/cell_grids.h"

namespace qtet {
namespace {

using testing::fileWith;
using testing::filledBy;
namespace fs = std::filesystem;

const std::string kCorners = "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n";
const std::string kTetrahedron = kCorners + "*ELEMENT, TYPE=C3D4, ELSET=E\n1, 1, 2, 3, 4\n";

const testing::TextReader kAbaqus{
    "model.inp", [](const fs::path& path, ReadReport& report) { return readAbaqus(path, report); }};

double volumeOf(const std::string& text) {
  const Result<ReadMesh> read = readMesh(fileWith("model.inp", text));
  EXPECT_TRUE(read) << read.error().text();
  return read ? filledBy(read->mesh).volume : 0;
}

const MeshField* fieldOf(const CellMesh& mesh, const std::string& name) {
  const auto at = std::ranges::find(mesh.fields, FieldName(name), &MeshField::name);
  return at == mesh.fields.end() ? nullptr : &*at;
}

std::string elementOf(const std::string& type, const std::vector<Position>& points) {
  std::string nodes = "*Node\n", element = "*Element, type=" + type + "\n7";
  for (std::size_t i = 0; i < points.size(); ++i) {
    nodes += std::to_string(i + 1);
    for (const double x : points[i]) nodes += ", " + std::to_string(x);
    nodes += "\n";
    element += (i == 14 ? ",\n" : ", ") + std::to_string(i + 1);
  }
  return nodes + element + "\n";
}

/// With the middles of these edges behind them.
std::vector<Position> withMiddles(std::vector<Position> points,
                                  const std::vector<std::array<std::size_t, 2>>& edges) {
  for (const auto& [a, b] : edges) {
    Position middle{};
    for (std::size_t k = 0; k < 3; ++k) middle[k] = (points[a][k] + points[b][k]) / 2;
    points.push_back(middle);
  }
  return points;
}

const std::vector<Position> kCube{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                  {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
const std::vector<Position> kPrism{{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
const std::vector<std::array<std::size_t, 2>> kEdgesOfCube{
    {0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

TEST(ReadAbaqus, everyShapeFillsItsVolume) {
  const std::vector<Position> tet{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_NEAR(volumeOf(elementOf("C3D8R", kCube)), 1, 1e-12);
  EXPECT_NEAR(volumeOf(elementOf("SC6R", kPrism)), 0.5, 1e-12);
  EXPECT_NEAR(volumeOf(elementOf("c3d5", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}})),
              1.0 / 3, 1e-12);
  EXPECT_NEAR(volumeOf(elementOf(
                  "DC3D10", withMiddles(tet, {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}))),
              1.0 / 6, 1e-12);
  EXPECT_NEAR(
      volumeOf(elementOf(
          "C3D15",
          withMiddles(kPrism,
                      {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}))),
      0.5, 1e-12);
  const std::vector<Position> quadratic = withMiddles(kCube, kEdgesOfCube);
  EXPECT_NEAR(volumeOf(elementOf("C3D20RH", quadratic)), 1, 1e-12);
  std::vector<Position> whole = quadratic;
  for (const Position& p : std::vector<Position>{{0.5, 0.5, 0.5},
                                                 {0.5, 0.5, 0},
                                                 {0.5, 0.5, 1},
                                                 {0.5, 0, 0.5},
                                                 {1, 0.5, 0.5},
                                                 {0.5, 1, 0.5},
                                                 {0, 0.5, 0.5}})
    whole.push_back(p);
  EXPECT_NEAR(volumeOf(elementOf("C3D27", whole)), 1, 1e-12);
}

/// A wrong order of the nodes on edges would fold the cell.
TEST(ReadAbaqus, nodesOnEdgesStandWhereVtkHasThem) {
  const auto read = kAbaqus.read(elementOf("C3D20", withMiddles(kCube, kEdgesOfCube)));
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->cell(0).size(), 20u);
  for (std::size_t e = 0; e < kEdgesOfCube.size(); ++e)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(2 * read->points[read->cell(0)[8 + e]][k],
                kCube[kEdgesOfCube[e][0]][k] + kCube[kEdgesOfCube[e][1]][k]);
}

TEST(ReadAbaqus, keywordsCommentsAndNumbersAreAsFreeAsAbaqusHasThem) {
  EXPECT_NEAR(
      volumeOf("\xEF\xBB\xBF*Heading\n a title, *NODE\n** a comment\n * node ,\n nset = \"All"
               " nodes\"\n1, 0.D0, 0, 0\r\n2, +1.0, 0,\n\n** within\n3,\t0, 1.d0\n"
               "4, , , 10E-1\n*ELEMENT,\nTYPE=c3d4,\nELSET=e\n1, 1, 2,\n** within\n3, 4\n"
               "*STEP\n*NODE\nnothing\n"),
      1.0 / 6, 1e-12);
}

TEST(ReadAbaqus, otherElementsAreCountedAndUnknownOnesRefused) {
  ReadReport report;
  const auto read =
      kAbaqus.read(kTetrahedron +
                       "*ELEMENT, TYPE=S4R\n2, 1, 2, 3, 4\n*ELEMENT, TYPE=SPRINGA\n3, 1, "
                       "2\n*ELEMENT, TYPE=CONN3D2\n4, 1, 99\n*ELEMENT, TYPE=T3D2\n5, 1, 2\n",
                   report);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->cells(), 1u);
  EXPECT_EQ(report.ignoredCells, 4u);
  for (const char* type : {"U1", "C3D7", "NOVEL8", "C3D8X2", ""}) {
    const std::string said =
        kAbaqus.refusalOf(kCorners + "*ELEMENT, TYPE=" + type + "\n1, 1, 2, 3, 4\n");
    EXPECT_NE(said.find("line 6: elements of type " + std::string(type)), std::string::npos)
        << said;
  }
}

TEST(ReadAbaqus, lineGasketsAreNoVolumesAndF3D4IsRefused) {
  for (const char* type : {"GK3D4L", "GK3D4LN", "GK3D6L", "GK3D6LN"}) {
    ReadReport report;
    const auto read =
        kAbaqus.read(kTetrahedron + "*ELEMENT, TYPE=" + type + "\n2, 1, 2, 3, 4\n", report);
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(read->cells(), 1u) << type;
    EXPECT_EQ(report.ignoredCells, 1u) << type;
  }
  EXPECT_NEAR(volumeOf(elementOf("GK3D6N", kPrism)), 0.5, 1e-12);
  EXPECT_NE(
      kAbaqus.refusalOf(kCorners + "*ELEMENT, TYPE=f3d4\n1, 1, 2, 3, 4\n").find("flat in Abaqus"),
      std::string::npos);
}

TEST(ReadAbaqus, nodesForThePressureInPoresAreLeftOut) {
  std::vector<Position> prism = kPrism, cube = kCube;
  for (int i = 0; i < 3; ++i) prism.push_back(kPrism[i]);
  for (int i = 0; i < 4; ++i) cube.push_back(kCube[i]);
  EXPECT_NEAR(volumeOf(elementOf("COH3D6P", prism)), 0.5, 1e-12);
  EXPECT_NEAR(volumeOf(elementOf("COH3D8P", cube)), 1, 1e-12);
  EXPECT_NEAR(volumeOf(elementOf("COD3D8P", cube)), 1, 1e-12);
  EXPECT_NE(kAbaqus.refusalOf(elementOf("COH3D8", cube)).find("has 12 nodes"), std::string::npos);
}

TEST(ReadAbaqus, whatMakesNodesAndIsNotUnderstoodIsRefusedByName) {
  for (const std::string keyword : {"NFILL", "NCOPY, CHANGE NUMBER=1", "ELCOPY", "N MAP"}) {
    const std::string said = kAbaqus.refusalOf(kTetrahedron + "*" + keyword + "\n1, 2\n"),
                      name = abaqusName(keyword.substr(0, keyword.find(',')));
    EXPECT_NE(said.find("line 8: *" + name), std::string::npos) << said;
  }
  EXPECT_NE(kAbaqus.refusalOf(kCorners + "*NGEN, LINE=C\n1, 2\n").find("LINE=C"),
            std::string::npos);
}

TEST(ReadAbaqus, numbersThatContradictAreRefusedWithBoth) {
  EXPECT_NE(kAbaqus.refusalOf(kCorners + "*ELEMENT, TYPE=C3D4\n5, 1, 2, 3, 9\n")
                .find("element 5 names node 9"),
            std::string::npos);
  EXPECT_TRUE(kAbaqus.read(kTetrahedron + "*NODE\n2, 1, 0, 0\n"));
  EXPECT_NE(kAbaqus.refusalOf(kTetrahedron + "*NODE\n2, 1, 0, 0.5\n").find("line 9: node 2"),
            std::string::npos);
  EXPECT_NE(kAbaqus.refusalOf(kTetrahedron + "*ELEMENT, TYPE=C3D4\n1, 1, 2, 4, 3\n")
                .find("line 9: element 1 is there already"),
            std::string::npos);
  EXPECT_NE(kAbaqus.refusalOf(kCorners + "*ELEMENT, TYPE=C3D4\n5, 1, 2, 3,\n*STEP\n")
                .find("ends after 3 nodes"),
            std::string::npos);
  EXPECT_NE(
      kAbaqus.refusalOf(kCorners + "*ELEMENT, TYPE=C3D4\n5, 1, 2, 3, 4, 1\n").find("has 5 nodes"),
      std::string::npos);
}

TEST(ReadAbaqus, everyTruncationIsAnErrorOrAMesh) {
  const std::string text = "*PART, NAME=P\n" + kTetrahedron +
                           "*ELSET, ELSET=S, GENERATE\n1, 1, 1\n*END PART\n*ASSEMBLY\n*INSTANCE, "
                           "NAME=I, PART=P\n1, 2, 3\n0, 0, 0, 0, 0, 1, 90\n*END INSTANCE\n";
  for (std::size_t length = 0; length < text.size(); ++length) {
    const auto read = kAbaqus.read(text.substr(0, length));
    if (read) continue;
    EXPECT_FALSE(read.error().message.empty());
  }
}

TEST(ReadAbaqus, includedFilesAreReadBesideTheFileThatNamesThem) {
  const fs::path path = fileWith("model.inp",
                                 "*INCLUDE, INPUT=sub/nodes.inc\n*ELEMENT, TYPE=C3D4, "
                                 "INPUT='elements.inc'\n");
  fs::create_directories(path.parent_path() / "sub");
  const auto put = [&](const char* name, const std::string& text) {
    std::ofstream(path.parent_path() / name) << text;
  };
  put("sub/nodes.inc", "*NODE\n*INCLUDE, INPUT=rest.inc\n4, 0, 0, 1\n");
  put("sub/rest.inc", "1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n");
  put("elements.inc", "1, 1, 2, 3, 4\n");
  ReadReport report;
  const auto read = readAbaqus(path, report);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->cells(), 1u);
  put("sub/rest.inc", "1, 0, 0, zero\n");
  const auto damaged = readAbaqus(path, report);
  ASSERT_FALSE(damaged);
  EXPECT_NE(damaged.error().message.find("rest.inc, line 1"), std::string::npos)
      << damaged.error().text();
  put("sub/rest.inc", "*INCLUDE, INPUT=nodes.inc\n");
  const auto circle = readAbaqus(path, report);
  ASSERT_FALSE(circle);
  EXPECT_NE(circle.error().message.find("within itself"), std::string::npos);
  fs::remove(path.parent_path() / "sub/rest.inc");
  const auto missing = readAbaqus(path, report);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::kNotFound) << missing.error().text();
}

/// A model of a tetrahedron whose nodes but the last are in the included file.
Result<CellMesh> readWithIncluded(const std::string& included, const std::string& behind,
                                  int times = 1) {
  std::string text;
  for (int i = 0; i < times; ++i) text += "*INCLUDE, INPUT=part.inc\n";
  const fs::path path = fileWith("model.inp", text + behind);
  std::ofstream(path.parent_path() / "part.inc") << included;
  ReadReport report;
  return readAbaqus(path, report);
}

TEST(ReadAbaqus, anIncludedFileMayEndBehindAKeywordsComma) {
  const std::string behind = kCorners.substr(6) + "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n";
  for (const char* end : {"*NODE,", "*NODE,\n", "*NODE,\n\n", "*NODE,\n** more\n \n** end"}) {
    const auto read = readWithIncluded(end, behind);
    ASSERT_TRUE(read) << end << read.error().text();
    EXPECT_EQ(read->points.size(), 4u) << end;
  }
}

TEST(ReadAbaqus, whatIsIncludedTwiceIsThereOnce) {
  const auto read = readWithIncluded(kTetrahedron, "*ELGEN\n1, 1\n", 3);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->cells(), 1u);
  EXPECT_EQ(read->points.size(), 4u);
}

TEST(ReadAbaqus, filesThatAreIncludedAgainAreBounded) {
  constexpr std::uint64_t kBytes = std::uint64_t{1} << 20;
  constexpr int kMostTimes = 1 + AbaqusLines::kMaxBytesAgain / kBytes + AbaqusLines::kMaxTimesAgain;
  const std::string included = "**" + std::string(kBytes - 2, 'x');
  const auto most = readWithIncluded(included, kTetrahedron, kMostTimes);
  EXPECT_TRUE(most) << most.error().text();
  const auto more = readWithIncluded(included, kTetrahedron, kMostTimes + 1);
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().code, ErrorCode::kLimitExceeded) << more.error().text();
}

TEST(ReadAbaqus, elementsInAnyOrderAreFoundByNumber) {
  ElementNumbers numbers;
  const std::vector<std::uint32_t> order{3, 7, 9, 5, 10, 1, 0, 8};
  for (std::uint32_t cell = 0; cell < order.size(); ++cell) {
    EXPECT_FALSE(numbers.cellOf(order[cell]));
    numbers.add(order[cell]);
    for (std::uint32_t earlier = 0; earlier <= cell; ++earlier)
      EXPECT_EQ(numbers.cellOf(order[earlier]), earlier);
  }
  EXPECT_EQ(numbers.all(), order);
  EXPECT_FALSE(numbers.cellOf(4));
  EXPECT_FALSE(numbers.cellOf(11));
}

TEST(ReadAbaqus, instancesAreMovedAndThenTurned) {
  const auto read = kAbaqus.read(
      "*PART, NAME=P\n" + kTetrahedron +
      "*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=First, PART=p\n*END INSTANCE\n*INSTANCE, "
      "NAME=Second, PART=P\n2., 0., 0.\n0., 0., 0., 0., 0., 1., 90.\n*END INSTANCE\n*INSTANCE, "
      "NAME=Own\n0, 0, 5\n" +
      kTetrahedron + "*END INSTANCE\n*END ASSEMBLY\n");
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->cells(), 3u);
  EXPECT_EQ(read->points[4], (Position{0, 2, 0}));
  EXPECT_EQ(read->points[5], (Position{0, 3, 0}));
  EXPECT_EQ(read->points[11], (Position{0, 0, 6}));
  const MeshField* instance = fieldOf(*read, "Instance");
  ASSERT_TRUE(instance);
  EXPECT_EQ(instance->values, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(instance->labelNames, (LabelNames{{1, "First"}, {2, "Second"}, {3, "Own"}}));
}

TEST(ReadAbaqus, instancesOfAHugePartAreBounded) {
  std::string text = "*PART, NAME=P\n" + kCorners +
                     "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n"
                     "*NGEN\n1, 2\n*ELGEN\n1, 1000000, 0, 1\n*END PART\n";
  for (int i = 0; i < 200; ++i)
    text += "*INSTANCE, NAME=I" + std::to_string(i) + ", PART=P\n*END INSTANCE\n";
  const auto read = kAbaqus.read(text);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::kLimitExceeded) << read.error().text();
  EXPECT_NE(kAbaqus.refusalOf(kCorners + "*NODE\n2000000000, 1, 1, 1\n*NGEN\n1, 2000000000, 1\n")
                .find("too many nodes"),
            std::string::npos);
  EXPECT_NE(kAbaqus.refusalOf(kTetrahedron + "*ELGEN\n1, 2000000000, 0, 1, 2000000000, 0, 1\n")
                .find("too many elements"),
            std::string::npos);
}

/// Two blocks of cells at distance 1.
std::string twoBlocks() {
  return kCorners +
         "11, 2, 0, 0\n12, 3, 0, 0\n13, 2, 1, 0\n14, 2, 0, 1\n*ELEMENT, TYPE=C3D4, ELSET=left\n1, "
         "1, 2, 3, 4\n*ELEMENT, TYPE=C3D4, ELSET=right\n2, 11, 12, 13, 14\n";
}

TEST(ReadAbaqus, sectionsGiveMaterialsByName) {
  const auto read =
      kAbaqus.read(twoBlocks() +
                   "*MATERIAL, NAME=steel\n*ELSET, ELSET=odd, GENERATE\n1, 9, 2\n*ELSET, "
                   "ELSET=alsoOdd\nodd,\n*SOLID SECTION, ELSET=ALSOODD, MATERIAL=Steel\n,\n"
                   "*SOLID SECTION, ELSET=right, MATERIAL=Water\n");
  ASSERT_TRUE(read) << read.error().text();
  const MeshField *material = fieldOf(*read, "Material"), *set = fieldOf(*read, "ElementSet");
  ASSERT_TRUE(material && set);
  EXPECT_EQ(material->values, (std::vector<double>{1, 2}));
  EXPECT_EQ(material->type, "int32");
  EXPECT_EQ(material->labelNames, (LabelNames{{1, "Steel"}, {2, "Water"}}));
  EXPECT_EQ(set->labelNames, (LabelNames{{1, "right"}, {2, "alsoOdd"}}));
}

TEST(ReadAbaqus, fieldsThatAreTheSameEverywhereAreLeftOut) {
  const auto read =
      kAbaqus.read(kTetrahedron + "*SOLID SECTION, ELSET=E, MATERIAL=Steel\n*ELSET, ELSET=F\n1\n");
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_TRUE(read->fields.empty());
}

TEST(ReadAbaqus, setsOfTheAssemblyNameInstances) {
  const std::string instances =
      "*PART, NAME=P\n" + kTetrahedron +
      "*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=P-1, PART=P\n*END INSTANCE\n*INSTANCE, "
      "NAME=P-2, PART=P\n2, 0, 0\n*END INSTANCE\n";
  for (const char* set :
       {"*ELSET, ELSET=S, INSTANCE=P-2\n1\n", "*ELSET, ELSET=S\nP-2.1\n",
        "*ELSET, ELSET=S, INSTANCE=P-2\nE\n", "*ELSET, ELSET=S\nP-2.E, P-2.1\n"}) {
    const auto read = kAbaqus.read(instances + set + "*END ASSEMBLY\n");
    ASSERT_TRUE(read) << read.error().text();
    const MeshField* field = fieldOf(*read, "ElementSet");
    ASSERT_TRUE(field) << set;
    EXPECT_EQ(field->values, (std::vector<double>{0, 1})) << set;
  }
}

TEST(ReadAbaqus, namesInQuotesHaveBlanksCommasAndDots) {
  const std::string instances = "*PART, NAME=\"A, b\"\n" + kTetrahedron +
                                "*ELSET, ELSET=\"Set 1\"\n1\n*END PART\n*ASSEMBLY\n"
                                "*INSTANCE, NAME='P 1', PART='a, B'\n*END INSTANCE\n*INSTANCE, "
                                "NAME=\"P, 2\", PART=\"A, b\"\n2, 0, 0\n*END INSTANCE\n";
  for (const char* set :
       {"*ELSET, ELSET=S, INSTANCE=\"P, 2\"\n1\n", "*ELSET, ELSET=S, INSTANCE='P, 2'\n\"Set 1\"\n",
        "*ELSET, ELSET=S\nnone, \"P, 2\".\"Set 1\", \"no, ne\"\n",
        "*ELSET, ELSET=S\n\"P, 2.Set 1\"\n", "*ELSET, ELSET=S\n\"P, 2\".1, o'ne\n"}) {
    const auto read = kAbaqus.read(instances + set + "*END ASSEMBLY\n");
    ASSERT_TRUE(read) << read.error().text();
    const MeshField* field = fieldOf(*read, "ElementSet");
    ASSERT_TRUE(field) << set;
    EXPECT_EQ(field->values, (std::vector<double>{0, 1})) << set;
    EXPECT_EQ(fieldOf(*read, "Instance")->labelNames, (LabelNames{{1, "P 1"}, {2, "P, 2"}}));
  }
}

TEST(ReadAbaqus, setsThatNameEachOtherEnd) {
  const auto read =
      kAbaqus.read(twoBlocks() + "*ELSET, ELSET=a\nb, 1\n*ELSET, ELSET=b\na, a, nothing\n");
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_TRUE(fieldOf(*read, "ElementSet"));
}

TEST(ReadAbaqus, generatedNodesAndElementsMakeABar) {
  std::string text = "*NODE\n";
  const std::array<std::array<int, 2>, 4> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (int c = 0; c < 4; ++c)
    for (const int z : {0, 4})
      text += std::to_string(100 * c + z) + ", " + std::to_string(corners[c][0]) + ", " +
              std::to_string(corners[c][1]) + ", " + std::to_string(z) + "\n";
  text +=
      "*NGEN\n0, 4\n100, 104, 1\n204, 200, 1\n300, 304,\n*ELEMENT, TYPE=C3D8, ELSET=bar\n"
      "1, 0, 100, 200, 300, 1, 101, 201, 301\n*ELGEN, ELSET=bar\n1, 4, 1, 1\n";
  EXPECT_NEAR(volumeOf(text), 4, 1e-12);
}

TEST(ReadAbaqus, incrementsThatAreLeftOutAreOne) {
  const std::string points = kCorners + "5, 1, 1, 1\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n";
  for (const char* line :
       {"1, 2", "1, 2,,", "1, 2, , 1", "1, , , , 2, ,\n", "1, 2, 1, 1, 1, , ,"}) {
    const auto read = kAbaqus.read(points + "*ELGEN\n" + line + "\n");
    ASSERT_TRUE(read) << line << read.error().text();
    ASSERT_EQ(read->cells(), 2u) << line;
    EXPECT_TRUE(std::ranges::equal(read->cell(1), std::array{1, 2, 3, 4})) << line;
  }
  EXPECT_NE(kAbaqus.refusalOf(points + "*ELGEN\n1, 2, 1, 0\n").find("element 1 is there already"),
            std::string::npos);
}

TEST(ReadAbaqus, anIncrementThatPassesTheLastNodeIsRefused) {
  const std::string ends = kTetrahedron + "*NODE\n10, 0, 0, 0\n20, 1, 0, 0\n*NGEN\n";
  EXPECT_TRUE(kAbaqus.read(ends + "10, 20, 5\n20, 10, 5\n10, 10, 3\n"));
  for (const char* line : {"10, 20, 3", "20, 10, 11"})
    EXPECT_NE(kAbaqus.refusalOf(ends + line + "\n").find("line 12: *NGEN from node"),
              std::string::npos);
}

TEST(ReadAbaqus, cylindersAndLocalSystemsPlaceNodes) {
  const auto read = kAbaqus.read(
      "*NODE, SYSTEM=C\n1, 2, 90, 3\n*NODE, SYSTEM=S\n2, 2, 90, 0\n3, 2, 0, 90\n*SYSTEM\n1, 0, 0, "
      "1, "
      "5, 9\n*NODE\n4, 1, 0, 0\n*SYSTEM\n0, 0, 0, 0, 0, 1\n0, 1, 0\n*NODE\n5, 1, 2, 3\n*SYSTEM\n"
      "*NODE\n6, 1, 2, 3\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n");
  ASSERT_TRUE(read) << read.error().text();
  const std::vector<Position> wanted{{0, 2, 3}, {0, 2, 0},  {0, 0, 2},
                                     {1, 1, 0}, {-3, 2, 1}, {1, 2, 3}};
  EXPECT_EQ(read->points, wanted);
  EXPECT_NE(kAbaqus.refusalOf("*SYSTEM\n0, 0, 0, 0, 0, 0\n").find("no axes"), std::string::npos);
  EXPECT_NE(kAbaqus.refusalOf("*NODE, SYSTEM=Q\n1, 0\n").find("SYSTEM=Q"), std::string::npos);
}

TEST(ReadAbaqus, aTurnIsTheSineAndCosineOfDegrees) {
  for (int degrees = -720; degrees <= 720; ++degrees) {
    const Turn turn = turnOf(degrees);
    EXPECT_NEAR(turn.sine, std::sin(degrees * std::numbers::pi / 180), 4e-15) << degrees;
    EXPECT_NEAR(turn.cosine, std::cos(degrees * std::numbers::pi / 180), 4e-15) << degrees;
    if (degrees % 90 == 0) EXPECT_EQ(turn.sine * turn.cosine, 0) << degrees;
  }
}

}  // namespace
}  // namespace qtet
