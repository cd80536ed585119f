// Which faces of the pieces' cells are boundary, and how their cells are turned, found across all
// pieces (INPUT.md, "Cleaning").
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

#include "simplify/pieces/gathered_pieces.h"
#include "simplify/pieces/record_buckets.h"

namespace qtet {

/// A cell's mark: bit i is set if the face opposite corner i is boundary, with the corners as the
/// input has them.
enum CellMark : std::uint8_t { kBoundaryFaces = 0xF, kTurnedCell = 0x10, kDroppedCell = 0x20 };

class PieceFaces {
 public:
  /// Errors: io; bad-input as cleanMesh's for crowded faces and rings without an inside.
  [[nodiscard]] static Result<PieceFaces> of(const GatheredPieces& pieces, const MakeSpool& make,
                                             const std::stop_token& stop);

  /// One mark a cell.
  [[nodiscard]] Result<std::vector<std::uint8_t>> marksOf(std::size_t piece) const;
  /// Sets of cells that hang together by faces.
  [[nodiscard]] std::uint64_t components() const { return components_; }

 private:
  /// A face whose vertices are all in several pieces, so that its other cell may be in another one.
  struct Face {
    std::array<WholeVertex, 3> vertices{};  // ascending
    std::uint32_t piece = 0;
    CellId cell = 0;
    WholeVertex opposite = 0;
    std::uint32_t component = 0;
    std::uint16_t corner = 0;  // opposite the face
    std::uint16_t isOdd = 0;   // how the face turns, once the cell agrees with its component

    friend auto operator<=>(const Face&, const Face&) = default;
  };
  /// A face or a cell, found across pieces.
  struct Found {
    std::uint32_t piece = 0;
    CellId cell = 0;
    std::uint8_t mark = 0;

    friend auto operator<=>(const Found&, const Found&) = default;
  };
  /// Cells of a piece that hang together in it.
  struct Component {
    std::uint32_t parent = 0;  // another one that it hangs together with, or itself
    bool isFlipped = false;    // against the parent
    double volume = 0;
  };
  class Matching;

  PieceFaces(PieceSpool spool, RecordBuckets<Face> faces)
      : spool_(std::move(spool)), faces_(std::move(faces)) {}

  Status matchAcross(const GatheredPieces& pieces);
  Status matchGroup(const GatheredPieces& pieces, std::span<const Face> group);
  bool join(std::uint32_t a, std::uint32_t b, bool disagree);
  /// The set that a component is in, and whether it is flipped against that.
  std::pair<std::uint32_t, bool> setOf(std::uint32_t component);
  void turnComponents();

  PieceSpool spool_;  // by piece: marks, and the component of each cell
  std::optional<RecordBuckets<Face>> faces_;
  std::vector<Component> component_;
  std::vector<std::uint32_t> firstComponent_;  // by piece
  std::vector<std::uint8_t> isTurned_;         // by component
  std::vector<Found> found_;                   // ascending
  std::uint64_t components_ = 0;
};

}  // namespace qtet
