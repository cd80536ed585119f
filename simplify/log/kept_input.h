// The input itself behind its log: its numbering (--keep-order) and its own numbers (--lossless),
// in both directions (FORMAT.md, "Closing blocks").
#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

#include "codec/log/log_writer.h"
#include "codec/mesh/input_order.h"
#include "proto/error.h"
#include "simplify/clean/clean_mesh.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

class LogFile;

struct KeepOptions {
  bool order = false;
  bool exact = false;
  /// The cell field kOriginalCellField (split_cells.h) in a closing block instead of a stream, and
  /// with it the order, which it rests on.
  bool originalCells = false;

  [[nodiscard]] bool keepsOrder() const { return order || originalCells; }
  [[nodiscard]] bool any() const { return keepsOrder() || exact; }
};

/// The data of the input that are kept until its log is encoded.
struct KeptInput {
  KeepOptions options;
  TetMesh mesh;  ///< cleaned, but the cells' vertices in the order of the file
  std::optional<std::vector<std::uint32_t>> originalCells{};  ///< takeOriginalCells'
};

/// Takes the field kOriginalCellField out of a mesh: one number a cell. Empty where there is none,
/// or where it is no int32 of one component without negative values: then the field stays.
[[nodiscard]] std::optional<std::vector<std::uint32_t>> takeOriginalCells(TetMesh& mesh);

/// `cleaned` with the order of vertices that its cells had before (`before`: the mesh as it was
/// read). Where cleaning dropped points or cells, turned cells stay turned.
[[nodiscard]] TetMesh asRead(const TetMesh& cleaned, const std::vector<Tetrahedron>& before,
                             const CleanReport& report);

/// Gives what is kept as closing blocks (LogWriterOptions::closing). `history` is the one that is
/// encoded. Errors: cancelled, the sink's.
Status giveInput(const FusionHistory& history, const FinestMesh& finest, const KeptInput& input,
                 const std::stop_token& stop, const ClosingSink& give);

/// The data that a log has of its input, in the input's numbering where it has that, else in slot
/// order.
struct RestoredInput {
  std::optional<InputOrder> order;
  std::vector<VertexId> points;  ///< slot of point i
  std::vector<CellId> cells;     ///< slot of cell i
  bool exactPositions = false;
  std::vector<bool> exactFields;  ///< one a field; true also of integers that lose nothing
  LatticeMesh lattice;            ///< renumbered
  TetMesh mesh;                   ///< the same in floats, exact where known
  /// One a cell, in the input's order. Both meshes have it as their last field, too.
  std::optional<std::vector<std::uint32_t>> originalCells;
};

/// `finest` is the mesh of the last level with all fields, in slot order. Errors: bad-checksum,
/// bad-value.
[[nodiscard]] Result<RestoredInput> restoreInput(const LogFile& log, const LatticeMesh& finest);

}  // namespace qtet
