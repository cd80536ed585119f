// The pieces of the input in a spool, in the order in which they came. Once all of them were read,
// more is known of the whole.
#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "simplify/clean/clean_mesh.h"
#include "simplify/clean/field_extremes.h"
#include "simplify/clean/place_points.h"
#include "simplify/pieces/input_pieces.h"
#include "simplify/pieces/piece_spool.h"
#include "simplify/pieces/vertex_marks.h"

namespace qtet {

/// A piece after joining. It has cells of four different vertices, and no other points.
struct GatheredPiece {
  TetMesh mesh;
  std::vector<WholeVertex> vertices;  ///< ascending, one a point
  /// Each cell's number in the input; empty: they count up from firstCell.
  std::vector<std::uint64_t> cells;
  std::uint64_t firstCell = 0;

  [[nodiscard]] std::uint64_t numberOf(CellId cell) const {
    return cells.empty() ? firstCell + cell : cells[cell];
  }
};

class GatheredPieces {
 public:
  /// Reads all pieces, drops cells that repeat a vertex, and joins the points of parts. Errors:
  /// those of the input and of the spool; bad-input (no cell is left; points of several parts lie
  /// where a part has several).
  [[nodiscard]] static Result<GatheredPieces> of(InputPieces& input, const MakeSpool& make,
                                                 const std::stop_token& stop);

  [[nodiscard]] std::size_t count() const { return spool_.count(); }
  [[nodiscard]] Result<GatheredPiece> get(std::size_t number) const;

  [[nodiscard]] const PointBox& box() const { return box_; }
  [[nodiscard]] const std::vector<FieldExtremes>& extremes() const { return extremes_; }
  [[nodiscard]] const VertexMarks& marks() const { return *marks_; }
  [[nodiscard]] std::uint64_t points() const { return points_; }  ///< of the input
  [[nodiscard]] std::uint64_t cells() const { return cells_; }    ///< of the input
  [[nodiscard]] std::uint64_t joinedPoints() const { return joined_.size(); }
  /// Cells that repeated a vertex.
  [[nodiscard]] const Occurrences& repeating() const { return repeating_; }

 private:
  /// A point that may lie in several parts.
  struct Seam {
    Position at{};
    WholeVertex vertex = 0;
    std::uint32_t part = 0;
  };
  /// A vertex, and the earliest one at its place.
  struct Joined {
    WholeVertex vertex = 0, owner = 0;
  };

  explicit GatheredPieces(PieceSpool spool) : spool_(std::move(spool)) {}

  Status take(InputPiece&& piece);
  void takeShape(const TetMesh& mesh);
  [[nodiscard]] Result<GatheredPiece> stored(std::size_t number) const;
  void addSeams(const InputPiece& piece);
  Status joinSeams();
  Status takeOwnersValues();
  void rename(GatheredPiece& piece) const;
  [[nodiscard]] WholeVertex ownerOf(WholeVertex v) const;
  /// Where the values of an owner begin in ownersValues_; nothing: it is none.
  [[nodiscard]] std::optional<std::size_t> valuesOf(WholeVertex owner) const;

  PieceSpool spool_;
  PointBox box_;
  std::vector<FieldExtremes> extremes_;
  std::vector<MeshField> shapes_;  // without values
  std::string pointType_;
  std::optional<VertexMarks> marks_;
  std::uint64_t points_ = 0, cells_ = 0;
  Occurrences repeating_;
  std::vector<Seam> seams_;           // while pieces come
  std::vector<Joined> joined_;        // ascending
  std::vector<WholeVertex> owners_;   // ascending
  std::vector<double> ownersValues_;  // of all point fields, one after the other
  std::size_t valuesOfPoint_ = 0;
};

}  // namespace qtet
