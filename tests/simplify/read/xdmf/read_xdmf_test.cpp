#include "simplify/read/xdmf/read_xdmf.h"

#include <gtest/gtest.h>

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
  const Result<CellMesh> mesh = file->read(1, std::nullopt, report);
  ASSERT_TRUE(mesh) << mesh.error().message;
  ASSERT_EQ(mesh->fields.size(), 1u);
  EXPECT_EQ(mesh->fields[0].values, std::vector<double>(4, 3));
}

TEST(ReadXdmf, gridsOfOneTimeWithOtherAttributesAreOne) {
  Result<XdmfFile> file = opened(grid("0", 1) + grid("0", 2, "p"));
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_TRUE(file->notes().empty());
  ReadReport report;
  const Result<CellMesh> mesh = file->read(0, std::nullopt, report);
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

}  // namespace
}  // namespace qtet
