#include "simplify/read/steps/cell_labels.h"

#include <gtest/gtest.h>

#include <utility>

#include "proto/limits.h"
#include "simplify/read/steps/join_blocks.h"

namespace qtet {
namespace {

/// So many tetrahedra on the same four points.
CellMesh labelledCells(std::size_t cells) {
  CellMesh out;
  out.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t i = 0; i < cells; ++i)
    out.addCell(kTetrahedronCell, std::vector<VertexId>{0, 1, 2, 3});
  return out;
}

CellMesh block(const std::string& name, std::int32_t number, std::size_t cells) {
  CellMesh out = labelledCells(cells);
  nameBlock(name, number, out);
  return out;
}

CellMesh joinedOf(std::vector<CellMesh> blocks, const FieldNames& wanted = {}) {
  ReadReport report;
  CellMesh out = joinBlocks(std::move(blocks), {}, report);
  addLabelFields(wanted, out, report);
  return out;
}

TEST(CellLabels, cellsKnowTheirBlocksByNumberAndName) {
  const CellMesh mesh = joinedOf({block("fluid", 1, 2), block("solid", 2, 1)});
  ASSERT_EQ(mesh.fields.size(), 1u);
  const MeshField& field = mesh.fields[0];
  EXPECT_EQ(field.name, "BlockId");
  EXPECT_EQ(field.association, "cell");
  EXPECT_EQ(field.type, "int32");
  EXPECT_EQ(field.values, (std::vector<double>{1, 1, 2}));
  EXPECT_EQ(field.labelNames, (LabelNames{{1, "fluid"}, {2, "solid"}}));
}

TEST(CellLabels, piecesAndBlocksThatAreCalledAlikeAreNone) {
  EXPECT_TRUE(joinedOf({labelledCells(1), labelledCells(2)}).fields.empty());
  EXPECT_TRUE(joinedOf({block("a", 1, 1), block("a", 2, 1)}).fields.empty());
  EXPECT_TRUE(joinedOf({block("a", 1, 1), block("b", 2, 0)}).fields.empty());
}

TEST(CellLabels, aNameHasOneNumberInAllPieces) {
  CellMesh first = labelledCells(3), second = labelledCells(3);
  first.labels = {{"BlockId", {1, 2, 2}, {{1, "a"}, {2, "b"}}}};
  second.labels = {{"BlockId", {1, 2, 0}, {{1, "b"}, {2, "c"}}}};
  const CellMesh mesh = joinedOf({first, second, labelledCells(1)});
  ASSERT_EQ(mesh.fields.size(), 1u);
  EXPECT_EQ(mesh.fields[0].values, (std::vector<double>{1, 2, 2, 2, 3, 0, 0}));
  EXPECT_EQ(mesh.fields[0].labelNames, (LabelNames{{1, "a"}, {2, "b"}, {3, "c"}}));
}

TEST(CellLabels, blocksWithinABlockHaveBothNames) {
  CellMesh inner = labelledCells(2);
  inner.labels = {{"BlockId", {1, 2}, {{1, "a"}, {2, "b"}}}};
  nameBlock("wing", 5, inner);
  EXPECT_EQ(inner.labels[0].names, (LabelNames{{1, "wing/a"}, {2, "wing/b"}}));
  nameBlock("", 7, inner);
  EXPECT_EQ(inner.labels[0].values, (std::vector<std::int32_t>{1, 2}));
}

TEST(CellLabels, namesGoToTheFilesOwnNumbersOfBlocksWhereTheseFit) {
  const auto with = [](const std::string& name, std::vector<double> values) {
    std::vector<CellMesh> blocks{block("fluid", 1, 2), block("solid", 2, 1)};
    blocks[0].fields = {{name, 1, "int32", {values[0], values[1]}, "cell"}};
    blocks[1].fields = {{name, 1, "int32", {values[2]}, "cell"}};
    return joinedOf(std::move(blocks)).fields;
  };
  const std::vector<MeshField> fits = with("ObjectId", {12, 12, 94});
  ASSERT_EQ(fits.size(), 1u);
  EXPECT_EQ(fits[0].labelNames, (LabelNames{{12, "fluid"}, {94, "solid"}}));
  for (const std::vector<double>& values : {std::vector<double>{12, 13, 94}, {12, 12, 12}}) {
    const std::vector<MeshField> others = with("ObjectId", values);
    ASSERT_EQ(others.size(), 1u);
    EXPECT_TRUE(others[0].labelNames.empty());
  }
  EXPECT_EQ(with("mat", {12, 12, 94}).size(), 2u);
}

TEST(CellLabels, numbersOfBlocksThatNobodyAskedForAreNotMadeAgain) {
  std::vector<CellMesh> blocks{block("fluid", 1, 1), block("solid", 2, 1)};
  blocks[0].otherFields = {"ObjectId"};
  EXPECT_TRUE(joinedOf(blocks).fields.empty());
  EXPECT_TRUE(joinedOf(blocks, {{"T"}}).fields.empty());
  EXPECT_EQ(joinedOf(blocks, {{"T", "BlockId"}}).fields.size(), 1u) << "somebody asked for these";
}

TEST(CellLabels, valuesWithoutANameAreNoOtherBlocks) {
  CellMesh first = labelledCells(3), second = labelledCells(3), third = labelledCells(2);
  first.labels = {{"BlockId", {1, 2, 0}, {{1, "a"}}}};
  second.labels = {{"BlockId", {1, 2, 3}, {{2, "b"}, {3, "a"}}}};
  third.labels = {{"BlockId", {0, 2}, {{0, "c"}}}};
  const CellMesh mesh = joinedOf({first, second, third});
  ASSERT_EQ(mesh.fields.size(), 1u);
  // 1 is a, so the second block's own 1 is 4; 2 has no name, so b is 3; 0 is that of no label
  EXPECT_EQ(mesh.fields[0].values, (std::vector<double>{1, 2, 0, 4, 3, 1, 5, 2}));
  EXPECT_EQ(mesh.fields[0].labelNames, (LabelNames{{1, "a"}, {3, "b"}, {5, "c"}}));
}

TEST(CellLabels, numbersOfBlocksBeyondInt32GetNoNames) {
  for (const auto& [value, isNamed] :
       {std::pair{2147483647.0, true}, std::pair{2147483648.0, false}, std::pair{0x1p63, false},
        std::pair{-2147483648.0, true}, std::pair{-2147483649.0, false}}) {
    std::vector<CellMesh> blocks{block("fluid", 1, 1), block("solid", 2, 1)};
    blocks[0].fields = {{"ObjectId", 1, "uint64", {1}, "cell"}};
    blocks[1].fields = {{"ObjectId", 1, "uint64", {value}, "cell"}};
    EXPECT_EQ(joinedOf(std::move(blocks)).fields.at(0).labelNames.size(), isNamed ? 2u : 0u)
        << value;
  }
}

TEST(CellLabels, labelsWithAnotherNumberOfValuesThanCellsAreNone) {
  CellMesh mesh = labelledCells(2);
  mesh.labels = {{"BlockId", {1, 2, 3}, {{1, "a"}}}};
  EXPECT_TRUE(blocksOfPoints(mesh).empty());
  EXPECT_TRUE(joinedOf({mesh, labelledCells(1)}).fields.empty());
}

TEST(CellLabels, namesBeyondTheLimitAreLeftOut) {
  CellMesh mesh;
  mesh.points = labelledCells(0).points;
  const auto number = static_cast<std::int32_t>(kMaxLabelNames);
  for (std::int32_t i = 1; i <= number + 1; ++i) {
    mesh.addCell(kTetrahedronCell, std::vector<VertexId>{0, 1, 2, 3});
    nameNewCells("block" + std::to_string(i), i, mesh);
  }
  EXPECT_EQ(mesh.labels[0].names.size(), kMaxLabelNames);
  EXPECT_EQ(mesh.labels[0].values.back(), number + 1);
}

// A value with two names has none: either would be wrong in one of the blocks.
TEST(CellLabels, blocksThatCallAValueDifferentlyGiveItNoName) {
  std::vector<CellMesh> blocks{labelledCells(1), labelledCells(1)};
  blocks[0].fields = {{"mat", 1, "int32", {1}, "cell", {{1, "steel"}, {2, "ice"}}}};
  blocks[1].fields = {{"mat", 1, "int32", {1}, "cell", {{1, "air"}, {2, "ice"}}}};
  ReadReport report;
  const CellMesh mesh = joinBlocks(std::move(blocks), {}, report);
  EXPECT_EQ(mesh.fields.at(0).labelNames, (LabelNames{{2, "ice"}}));
}

}  // namespace
}  // namespace qtet
