// The files that VTK's XML lists of files name: series, summaries of pieces, blocks.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "simplify/read/options/mesh_format.h"
#include "simplify/read/parts/file_series.h"

namespace qtet {

/// Those of a .pvd file, in its order. Its attributes part, group and name tell parts of one time
/// from one another. Errors: those of readXml; bad-input (no list; an entry without a file, or
/// whose time is none). A time may be left out where no entry has one, and each is another part.
[[nodiscard]] Result<std::vector<SeriesEntry>> entriesOfPvd(const std::filesystem::path& path);

/// A file that is a part of a mesh. The name is that of its block, or empty: it is a piece.
struct BlockFile {
  std::filesystem::path path;
  std::string name;
};

/// The Source of each Piece that a summary names. Errors: those of readXml; bad-input (no piece, or
/// one without a file). REQUIRES: traitsOf(format).namesPieces.
[[nodiscard]] Result<std::vector<BlockFile>> piecesOf(const std::filesystem::path& path,
                                                      MeshFormat format);

/// The names of the arrays of points and cells that a summary states, but for those that mark
/// ghosts. Errors: those of readXml; bad-input. REQUIRES: traitsOf(format).namesPieces.
[[nodiscard]] Result<std::vector<std::string>> statedArrays(const std::filesystem::path& path,
                                                            MeshFormat format);

/// The files of a .vtm file's blocks, depth first. Those that can hold no volume cells (surfaces,
/// tables) are noted instead. A block is called by its own name, or that of the block around it.
/// Names that come again are led by those of all blocks around: "wing/solid". Errors: those of
/// readXml; bad-input (no such file).
[[nodiscard]] Result<std::vector<BlockFile>> blocksOf(const std::filesystem::path& path,
                                                      std::vector<std::string>& notes);

}  // namespace qtet
