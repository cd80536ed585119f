// A .vtu or .pvtu file that is read piece by piece. Its points wait in a spool, its cells are read
// by ranges.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "simplify/blocks/piece_store.h"
#include "simplify/pieces/input_pieces.h"
#include "simplify/read/options/read_options.h"
#include "simplify/read/pieces/point_records.h"
#include "simplify/read/vtu/vtu_document.h"

namespace qtet {

/// Pieces take most of their memory while they are read: some 300 bytes a cell.
class VtuPieces final : public InputPieces {
 public:
  /// Null: the file has another format, or the options ask for what takes the whole mesh. Then
  /// `why` says which. Errors: those of readVtuDocument and checkMeshFile.
  [[nodiscard]] static Result<std::unique_ptr<VtuPieces>> open(const std::filesystem::path& path,
                                                               const ReadOptions& options,
                                                               std::string& why);

  /// As the files' heads say; some may be no volume cells.
  [[nodiscard]] std::uint64_t cells() const { return cells_; }

  /// Reads all points. Has to be called once before next(). Errors: those of readVtu and
  /// selectFields; io.
  [[nodiscard]] Status begin(const MakeSpool& spool, std::size_t pieceCells = kPieceCells);
  [[nodiscard]] std::uint64_t points() const override { return points_; }
  [[nodiscard]] std::uint32_t parts() const override {
    return static_cast<std::uint32_t>(parts_.size());
  }
  /// Errors: those of readVtu; bad-input (several parts, and cells that are no tetrahedra).
  [[nodiscard]] Result<std::optional<InputPiece>> next() override;

  /// As readMesh's, as far as the pieces were read.
  [[nodiscard]] const ReadReport& report() const { return report_; }

 private:
  struct File {
    std::filesystem::path path;
    VtuDocument document;
  };
  /// A piece of a file's own.
  struct Part {
    const File* file = nullptr;
    const VtuPiece* piece = nullptr;
    std::uint64_t firstPoint = 0;  // in all parts
  };
  /// A field that is read.
  struct Chosen {
    std::string array;  // its name in the file
    MeshField shape;    // without values
  };

  VtuPieces(std::filesystem::path path, ReadOptions options)
      : path_(std::move(path)), options_(std::move(options)) {}

  Status addFile(const std::filesystem::path& path);
  /// Opens the part's file, unless it is open. Only one is at a time.
  Status open(const Part& part);
  Status choose();
  Status spoolPoints(const Part& part);
  [[nodiscard]] Result<CellMesh> cellsOf(const Part& part, std::uint64_t first,
                                         std::uint64_t count);
  [[nodiscard]] Status takePoints(const Part& part, CellMesh& cells);
  [[nodiscard]] Status takeValues(const Part& part, std::uint64_t first, std::uint64_t count,
                                  const std::vector<std::uint64_t>& rows, CellMesh& cells) const;
  [[nodiscard]] Result<const VtuArray*> arrayOf(const Part& part, const Chosen& field) const;
  [[nodiscard]] Result<InputPiece> pieceOf(CellMesh&& cells);

  std::filesystem::path path_;
  ReadOptions options_;
  ReadReport report_;
  std::vector<std::unique_ptr<File>> files_;
  std::optional<VtuFile> open_;
  const File* opened_ = nullptr;
  std::vector<Part> parts_;
  std::uint64_t points_ = 0, cells_ = 0;
  std::size_t pieceCells_ = kPieceCells;
  std::vector<Chosen> fields_;
  std::string pointType_;
  std::optional<PointRecords> records_;
  // where the next piece begins
  std::uint32_t part_ = 0;
  std::uint64_t nextCell_ = 0;
  std::vector<bool> hidden_;                  // cells of the part
  std::uint64_t tetrahedra_ = 0, added_ = 0;  // so far
  std::vector<std::uint64_t> names_;          // of the points of the piece in hand
};

}  // namespace qtet
