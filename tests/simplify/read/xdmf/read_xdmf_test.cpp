#include "simplify/read/xdmf/read_xdmf.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/simplify/mesh/tet_meshes.h"

namespace qtet {
namespace {

/// A grid of a series: one cell with the attribute T of one value.
std::string grid(const std::string& time, int value, const std::string& name = "T") {
  const std::string v = std::to_string(value);
  return "<Grid><Time Value='" + time +
         "'/><Topology TopologyType='Tetrahedron' NumberOfElements='1'>"
         "<DataItem Dimensions='1 4' NumberType='Int' Format='XML'>0 1 2 3</DataItem></Topology>"
         "<Geometry GeometryType='XYZ'><DataItem Dimensions='4 3' Format='XML'>0 0 0 1 0 0 0 1 0 "
         "0 0 1</DataItem></Geometry><Attribute Name='" +
         name + "' Center='Node'><DataItem Dimensions='4' Format='XML'>" + v + " " + v + " " + v +
         " " + v + "</DataItem></Attribute></Grid>";
}

Result<XdmfFile> opened(const std::string& grids) {
  return XdmfFile::open(testing::fileWith(
      "run.xdmf", "<Xdmf><Domain><Grid GridType='Collection' CollectionType='Temporal'>" + grids +
                      "</Grid></Domain></Xdmf>"));
}

TEST(ReadXdmf, ofOneTimeTheLastGridOfASeriesCounts) {
  Result<XdmfFile> file = opened(grid("0", 1) + grid("1", 2) + grid("1.0", 3));
  ASSERT_TRUE(file) << file.error().message;
  ASSERT_EQ(file->times(), (std::vector<double>{0, 1}));
  EXPECT_EQ(file->notes(),
            std::vector<std::string>{"grids left out, because later ones of their series have "
                                     "the same time: 1, at time 1"});
  ReadReport report;
  const Result<CellMesh> mesh = file->read(1, {}, report);
  ASSERT_TRUE(mesh) << mesh.error().message;
  ASSERT_EQ(mesh->fields.size(), 1u);
  EXPECT_EQ(mesh->fields[0].values, std::vector<double>(4, 3));
}

TEST(ReadXdmf, gridsOfOneTimeWithOtherAttributesAreOne) {
  Result<XdmfFile> file = opened(grid("0", 1) + grid("0", 2, "p"));
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_TRUE(file->notes().empty());
  ReadReport report;
  const Result<CellMesh> mesh = file->read(0, {}, report);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->fields.size(), 2u);
}

TEST(ReadXdmf, aTimeIsANumber) {
  EXPECT_EQ(opened(grid(" +1.5D0 ", 1))->times(), std::vector<double>{1.5});
  for (const std::string text : {"", "0,5", "0.1s", "nan"}) {
    const Result<XdmfFile> file = opened(grid("0", 1) + grid(text, 2));
    ASSERT_FALSE(file) << text;
    EXPECT_TRUE(file.error().message.ends_with(
        "run.xdmf: the <Time> of its <Grid> number 1 is \"" + text +
        "\", which is no number; give it its time, a number such as 0.5"))
        << file.error().message;
  }
}

/// A grid of one tetrahedron, by its parts.
std::string tetrahedron(const std::string& topology, const std::string& geometry,
                        const std::string& more = "") {
  return "<Grid Name='g'><Topology TopologyType='Tetrahedron' NumberOfElements='1'" + topology +
         "</Topology><Geometry " + geometry + "</Geometry>" + more + "</Grid>";
}
const std::string kIds = "><DataItem Dimensions='1 4' NumberType='Int'>0 1 2 3</DataItem>";
const std::string kXyz =
    "GeometryType='XYZ'><DataItem Dimensions='4 3'>0 0 0 1 0 0 0 1 0 0 0 1</DataItem>";
const std::vector<Position> kPlaces{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

Result<XdmfFile> openedDomain(const std::string& grids) {
  return XdmfFile::open(
      testing::fileWith("one.xdmf", "<Xdmf><Domain>" + grids + "</Domain></Xdmf>"));
}

CellMesh meshOf(const std::string& grids) {
  Result<XdmfFile> file = openedDomain(grids);
  EXPECT_TRUE(file) << file.error().message;
  if (!file) return {};
  EXPECT_TRUE(file->isUnderstood());
  ReadReport report;
  Result<CellMesh> mesh = file->read(0, {}, report);
  EXPECT_TRUE(mesh) << mesh.error().message;
  return mesh ? std::move(*mesh) : CellMesh{};
}

void expectRefused(const std::string& grids, const std::string& said) {
  Result<XdmfFile> file = openedDomain(grids);
  std::string message = file ? "" : file.error().message;
  if (file && file->isUnderstood()) {
    ReadReport report;
    const Result<CellMesh> mesh = file->read(0, {}, report);
    if (!mesh) message = mesh.error().message;
  }
  EXPECT_NE(message.find(said), std::string::npos) << message;
}

TEST(ReadXdmf, idsBeginAtTheBaseOffset) {
  const auto from = [](const std::string& base, const std::string& ids) {
    return tetrahedron(
        " BaseOffset='" + base + "'><DataItem Dimensions='1 4'>" + ids + "</DataItem>", kXyz);
  };
  EXPECT_EQ(meshOf(from("1", "1 2 3 4")).vertices, (std::vector<VertexId>{0, 1, 2, 3}));
  EXPECT_EQ(meshOf(from("0", "0 1 2 3")).vertices, (std::vector<VertexId>{0, 1, 2, 3}));
  EXPECT_EQ(meshOf(from("1", "0 1 2 5")).vertices, (std::vector<VertexId>{kGhost, 0, 1, kGhost}));
  expectRefused(from("one", "1 2 3 4"), "BaseOffset 'one', which is no number");
}

TEST(ReadXdmf, coordinatesMayStandInThreeItems) {
  const std::string apart =
      "GeometryType='X_Y_Z'><DataItem Dimensions='4'>0 1 0 0</DataItem>"
      "<DataItem Dimensions='4'>0 0 1 0</DataItem><DataItem Dimensions='";
  EXPECT_EQ(meshOf(tetrahedron(kIds, apart + "4'>0 0 0 1</DataItem>")).points, kPlaces);
  expectRefused(tetrahedron(kIds, apart + "3'>0 0 1</DataItem>"), "have 4 x, but 3 y or z");
}

TEST(ReadXdmf, aHyperslabIsAPartOfAnArray) {
  const auto slab = [](const std::string& which, const std::string& of) {
    return tetrahedron(kIds, kXyz,
                       "<Attribute Name='u' Center='Node'><DataItem ItemType='HyperSlab' "
                       "Dimensions='4'><DataItem Dimensions='3 2'>" +
                           which + "</DataItem><DataItem Dimensions='" + of +
                           "'>0 1 2 3 4 5 6 7 8 9 10 11</DataItem></DataItem></Attribute>");
  };
  EXPECT_EQ(meshOf(slab("1 0 1 1 1 4", "3 4")).fields[0].values, (std::vector<double>{4, 5, 6, 7}));
  EXPECT_EQ(meshOf(slab("0 1 2 2 2 2", "3 4")).fields[0].values,
            (std::vector<double>{1, 3, 9, 11}));
  expectRefused(slab("1 0 1 1 3 4", "3 4"), "beyond its array");
  expectRefused(slab("0 1 1 1 1 4", "3 4"), "beyond its array");
  expectRefused(slab("0 0 1 1 0 4", "3 4"), "takes nothing");
  expectRefused(slab("0 0 1 1 1 4", "4 4"), "other Dimensions than numbers");
  expectRefused(slab("0 0 1 1 1 4", "12"), "three for each of the 1 Dimensions");
  expectRefused(slab("0 -1 1 1 1 4", "3 4"), "hyperslab");
}

TEST(ReadXdmf, aNumberThatNoDoubleHoldsIsZeroOrMissing) {
  const CellMesh mesh = meshOf(tetrahedron(
      kIds, kXyz,
      "<Attribute Name='u'><DataItem Dimensions='4'>1e-400 6e-310 1e400 +1.5D0</DataItem>"
      "</Attribute>"));
  ASSERT_EQ(mesh.fields.size(), 1u);
  EXPECT_EQ(mesh.fields[0].values,
            (std::vector<double>{0, 6e-310, std::numeric_limits<double>::infinity(), 1.5}));
}

TEST(ReadXdmf, whatIsNotReadIsNamed) {
  expectRefused(tetrahedron(" Order='3 2 1 0'" + kIds, kXyz), "an Order of the nodes");
  expectRefused(tetrahedron(kIds,
                            "GeometryType='XY'><DataItem Dimensions='4 2'>0 0 1 0 0 1 1 "
                            "1</DataItem>"),
                "is of type xy");
  expectRefused(tetrahedron(kIds,
                            "GeometryType='XYZ'><DataItem ItemType='Function' Dimensions='4 "
                            "3'/>"),
                "a DataItem of type function");
  expectRefused("<Grid GridType='Subset'/>", "GridType 'Subset'");
  expectRefused(
      "<Grid><Topology TopologyType='3DCoRectMesh' Dimensions='2 2 2'/><Geometry "
      "GeometryType='XYZ'><DataItem Dimensions='1'>0</DataItem></Geometry></Grid>",
      "is a structured grid");
}

TEST(ReadXdmf, aCollectionStatesTheTimesOfItsGrids) {
  const auto times = [](const std::string& time) {
    const std::string one = tetrahedron(kIds, kXyz);
    Result<XdmfFile> file = opened(time + one + one + one);
    return file ? file->times() : std::vector<double>{-1};
  };
  const auto list = [](const std::string& type, const std::string& numbers) {
    return "<Time TimeType='" + type + "'><DataItem Dimensions='3'>" + numbers +
           "</DataItem></Time>";
  };
  EXPECT_EQ(times(list("List", "0.5 1 7")), (std::vector<double>{0.5, 1, 7}));
  EXPECT_EQ(times(list("HyperSlab", "0.5 0.25 3")), (std::vector<double>{0.5, 0.75, 1}));
  EXPECT_EQ(times(""), (std::vector<double>{0, 1, 2}));
  const auto refused = [](const std::string& time, const std::string& said) {
    const std::string one = tetrahedron(kIds, kXyz);
    const Result<XdmfFile> file = opened(time + one + one);
    ASSERT_FALSE(file) << time;
    EXPECT_NE(file.error().message.find(said), std::string::npos) << file.error().message;
  };
  refused(list("List", "0.5 1 7"), "has 3 times for 2 grids");
  refused(list("HyperSlab", "0.5 0.25 3"), "the number of 2 grids");
  refused(list("Range", "0.5 1.5 2"), "of type 'Range', which says no time of each grid");
}

TEST(ReadXdmf, gridsOfASpatialCollectionAreJoined) {
  const std::string other =
      tetrahedron(kIds,
                  "GeometryType='XYZ'><DataItem Dimensions='4 3'>1 1 1 1 0 0 0 1 0 0 0 "
                  "1</DataItem>");
  const std::string renamed = "<Grid Name='h'" + other.substr(other.find('>'));
  const std::string both = tetrahedron(kIds, kXyz) + renamed;
  for (const std::string& grids :
       {both, "<Grid GridType='Collection' CollectionType='Spatial'>" + both + "</Grid>",
        "<Grid GridType='Tree'>" + both + "</Grid>"}) {
    const CellMesh mesh = meshOf(grids);
    EXPECT_EQ(mesh.cells(), 2u);
    EXPECT_EQ(mesh.points.size(), 5u);
    ASSERT_EQ(mesh.labels.size(), 1u);
    EXPECT_EQ(mesh.labels[0].names, (LabelNames{{1, "g"}, {2, "h"}}));
  }
  const std::string step =
      "<Grid GridType='Collection' CollectionType='Spatial'><Time Value='0.5'/>" + both + "</Grid>";
  Result<XdmfFile> series = opened(step);
  ASSERT_TRUE(series) << series.error().message;
  EXPECT_EQ(series->times(), std::vector<double>{0.5});
}

}  // namespace
}  // namespace qtet
