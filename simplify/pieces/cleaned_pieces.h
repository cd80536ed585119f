// A mesh that comes in pieces, cleaned and on the lattice: what cleanMesh and quantise do for a
// mesh at hand.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "simplify/blocks/lattice_pieces.h"
#include "simplify/clean/clean_mesh.h"
#include "simplify/clean/place_fields.h"
#include "simplify/clean/quantise.h"
#include "simplify/pieces/gathered_pieces.h"
#include "simplify/pieces/piece_faces.h"

namespace qtet {

/// Boundary triangles of a mesh whose edges and vertices are looked at at most. They take 100 bytes
/// each while they are.
inline constexpr std::uint64_t kMostCheckedTriangles = 20'000'000;

struct CleaningOptions {
  QuantiseOptions quantise{};
  Units units{};  ///< of fields by name, for bounds of errors
  MakeSpool spool{};
  std::stop_token stop{};
};

class CleanedPieces final : public LatticePieces {
 public:
  /// Errors: those of cleanMesh, checkValueBounds, quantise, the input and the spool; cancelled.
  [[nodiscard]] static Result<CleanedPieces> of(InputPieces& input, const CleaningOptions& options);

  [[nodiscard]] const Lattice& lattice() const override { return lattice_; }
  [[nodiscard]] const std::vector<FieldInfo>& fields() const override { return fields_; }
  [[nodiscard]] std::uint64_t tetrahedra() const override { return cells_; }
  [[nodiscard]] std::uint64_t vertices() const override { return pieces_.marks().count(); }
  [[nodiscard]] std::uint64_t triangles() const override { return triangles_; }
  [[nodiscard]] Status forEach(const TakePiece& take) override;

  /// The report has no boundary.
  [[nodiscard]] const CleanReport& cleanReport() const { return clean_; }
  [[nodiscard]] const QuantiseReport& quantiseReport() const { return quantise_; }
  [[nodiscard]] std::uint64_t cellsOfInput() const { return pieces_.cells(); }
  /// On what was done, and what was not looked for.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  /// A piece after cleaning.
  struct Clean {
    GatheredPiece piece;
    std::vector<std::uint64_t> numbers{};  // of its cells in the input
    std::vector<PieceTriangle> boundary{};
    std::vector<std::uint64_t> turned{}, dropped{};  // numbers of such cells
  };
  class Inspection;

  CleanedPieces(GatheredPieces pieces, PieceFaces faces, std::stop_token stop)
      : pieces_(std::move(pieces)), faces_(std::move(faces)), stop_(std::move(stop)) {}

  Status inspect(const MakeSpool& make);
  Status chooseFields(const CleaningOptions& options);
  Status chooseLattice(const QuantiseOptions& options);
  void fillShared(const GivenPiece& given, std::size_t field);
  [[nodiscard]] Result<Clean> cleaned(std::size_t number) const;
  [[nodiscard]] Result<Occurrences> worseAt(const Lattice& lattice) const;
  void placeValues(const Clean& from, MeshPiece& to) const;
  void fill(std::size_t field, const MeshPiece& piece, std::vector<std::uint8_t> missing,
            std::vector<std::int32_t>& values) const;

  GatheredPieces pieces_;
  PieceFaces faces_;
  std::stop_token stop_;
  CleanReport clean_;
  QuantiseReport quantise_;
  std::vector<std::string> notes_;
  Lattice lattice_;
  std::vector<FieldInfo> fields_;
  std::uint64_t cells_ = 0, triangles_ = 0;
  /// By field: what vertices of several pieces have in place of missing values.
  std::vector<std::map<WholeVertex, std::vector<std::int32_t>>> filled_;
};

}  // namespace qtet
