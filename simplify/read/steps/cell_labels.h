// The labels that a file's structure gives to cells: blocks, parts, regions and zones with names.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "simplify/read/options/read_options.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// The label, and the field, of the block that a cell is of.
inline constexpr std::string_view kBlockLabel = "BlockId";

/// Says that the cells behind those that have a block are of this one; without a name of none.
void nameNewCells(std::string_view name, std::int32_t number, CellMesh& mesh);

/// Says that all cells are of one block. The cells of blocks that have names within it are of
/// OUTER/INNER. Does nothing without a name. REQUIRES: number > 0.
void nameBlock(std::string_view name, std::int32_t number, CellMesh& mesh);

/// The labels of all blocks, whose cells stand one after the other. A name has one value: that of
/// the first block that has it, or the next free one where that is taken. Values without a name
/// give way likewise, and are the same in all blocks. Cells without the label have 0, and no name
/// does. Labels with another number of values than cells count as none.
[[nodiscard]] std::vector<CellLabel> joinedLabels(const std::vector<CellMesh>& blocks);

/// The block of each point by its first cell; 0: none. Empty: no two blocks have names that differ.
[[nodiscard]] std::vector<std::int32_t> blocksOfPoints(const CellMesh& mesh);

/// Makes cell fields of the labels that have two values at least. The names of blocks go to a field
/// of the file instead that has a number for each block: BlockId, ObjectId and the like. Those that
/// `wanted` names are made even then. A label gives way to a field of its name. `report.labels`
/// says which were made.
void addLabelFields(const FieldNames& wanted, CellMesh& mesh, ReadReport& report);

/// Leaves out the fields that addLabelFields made.
void eraseLabelFields(const ReadReport& report, std::vector<MeshField>& fields);

}  // namespace qtet
