// The parts of VTK's grids as every reader takes them over, whether VTK reads the file or we do.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simplify/read/options/read_options.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// Names of the arrays that mark cells of another piece: bits, or in files of VTK before version 7
/// how many layers away they lie.
inline constexpr const char* kGhostTypes = "vtkGhostType";
inline constexpr const char* kGhostLevels = "vtkGhostLevels";
/// Bits of kGhostTypes of cells that another piece has, that finer cells stand for, or that are
/// blanked out.
inline constexpr unsigned kElsewhere = 1u | 8u | 32u;
/// Names of the point fields that hold for all pieces; the first that there is counts.
inline constexpr const char* kGlobalIdNames[] = {"GlobalPointIds", "GlobalNodeIds", "GlobalNodeId"};

/// The dimension of VTK's type of cells. Unknown types count as volumes, so that checkCellMesh
/// refuses them by name.
[[nodiscard]] int dimensionOf(std::uint8_t type);

/// The id, or kGhost where no vertex can have it.
[[nodiscard]] VertexId narrowedId(std::int64_t id);

/// "cell 12 has vertices outside the list of vertices; ..."
[[nodiscard]] std::string verticesOutside(std::uint64_t cell);
/// "cell 12 is a polyhedron without its faces; ..."
[[nodiscard]] std::string withoutFaces(std::uint64_t cell);

/// Appends to `out.vertices` a polyhedron's faces, which begin at faces[at]: their number, then of
/// each its number of corners and these. Moves `at` behind them. False where they go beyond the
/// end.
[[nodiscard]] bool appendFaces(std::span<const std::int64_t> faces, std::size_t& at, CellMesh& out);

/// Takes the tuples of `rows` alone, which ascend.
void keepRows(MeshField& field, std::span<const std::uint64_t> rows);

/// An array of point or cell data.
struct GridArray {
  std::string name;  ///< as the file has it
  int number = 0;    ///< among those of its association
  std::uint64_t components = 1;
  bool hasNumbers = true;
  bool isOfTheShape = false;  ///< cells of higher degree are not understood without it
};

/// Decides which arrays become fields.
class FieldChoice {
 public:
  FieldChoice(const FieldNames& wanted, ReadReport& report) : wanted_(wanted), report_(report) {}

  /// The name under which the array is read as a field; nullopt: it is not, which the report or
  /// `out.otherFields` says unless it marks ghosts.
  [[nodiscard]] std::optional<std::string> nameOf(const GridArray& array,
                                                  const std::string& association, CellMesh& out);

 private:
  const FieldNames& wanted_;
  ReadReport& report_;
};

}  // namespace qtet
