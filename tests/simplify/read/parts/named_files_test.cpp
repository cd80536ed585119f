#include "simplify/read/parts/named_files.h"

#include <gtest/gtest.h>

#include "tests/simplify/mesh/tet_meshes.h"

namespace qtet {
namespace {

std::vector<std::string> blockNames(const std::string& blocks) {
  const auto path = testing::fileWith(
      "blocks.vtm", "<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet>" + blocks +
                        "</vtkMultiBlockDataSet></VTKFile>");
  std::vector<std::string> notes, out;
  const auto files = blocksOf(path, notes);
  EXPECT_TRUE(files) << files.error().text();
  for (const BlockFile& file : files.value_or(std::vector<BlockFile>{})) out.push_back(file.name);
  return out;
}

using BlockNames = std::vector<std::string>;

TEST(NamedFiles, aBlockIsCalledByItsOwnNameOrThatAroundIt) {
  EXPECT_EQ(blockNames(R"(<DataSet name="a" file="a.vtu"/><DataSet file="b.vtu"/>)"),
            (BlockNames{"a", ""}));
  EXPECT_EQ(blockNames(R"(<Block name="fluid"><DataSet name="fluid" file="a.vtu"/></Block>)"
                       R"(<Block name="solid"><DataSet file="b.vtu"/><DataSet file="c.vtu"/>)"
                       R"(<DataSet name="skin" file="d.vtp"/></Block>)"),
            (BlockNames{"fluid", "solid", "solid"}));
}

TEST(NamedFiles, namesThatComeAgainHaveThoseAroundThem) {
  EXPECT_EQ(blockNames(R"(<Block name="fluid"><DataSet name="internal" file="a.vtu"/></Block>)"
                       R"(<Block name="solid"><DataSet name="internal" file="b.vtu"/>)"
                       R"(<DataSet name="core" file="c.vtu"/></Block>)"),
            (BlockNames{"fluid/internal", "solid/internal", "core"}));
}

TEST(NamedFiles, aSummaryStatesArrays) {
  const auto path = testing::fileWith(
      "summary.pvtu",
      "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><PPointData><PDataArray Name=\"u\"/>"
      "<PDataArray Name=\"vtkGhostType\"/></PPointData><PCellData><PDataArray Name=\"u\"/>"
      "<PDataArray Name=\"k\"/></PCellData><Piece "
      "Source=\"a.vtu\"/></PUnstructuredGrid></VTKFile>");
  const auto names = statedArrays(path, MeshFormat::kPvtu);
  ASSERT_TRUE(names) << names.error().text();
  EXPECT_EQ(*names, (std::vector<std::string>{"u", "k"}));
}

}  // namespace
}  // namespace qtet
