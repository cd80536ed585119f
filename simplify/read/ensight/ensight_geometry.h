// The geometry of EnSight: parts with their points and cells.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "simplify/read/ensight/ensight_numbers.h"
#include "simplify/read/options/read_options.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// The memory of a grid's point and of the hexahedron that begins there.
inline constexpr std::uint64_t kEnSightGridPointBytes =
    sizeof(Position) + 8 * sizeof(VertexId) + 2 * sizeof(std::uint64_t) + 1;

/// Which row of a block's cells the first element of a kind is, and how many there are.
struct EnSightElements {
  std::uint64_t firstRow = 0, count = 0;
};

struct EnSightPart {
  std::size_t block = 0;
  bool isGrid = false;                                           ///< i x j x k points
  std::map<std::string, EnSightElements, std::less<>> elements;  ///< by kind; of a grid: "block"
};

/// Points and the cells of one part; in EnSight 6 all parts that are no grids share one.
struct EnSightBlock {
  CellMesh mesh;                    ///< volumes that are no ghosts
  std::vector<std::uint64_t> rows;  ///< the place of each among all elements
  std::uint64_t elements = 0;       ///< of any dimension, ghosts included
};

struct EnSightGeometry {
  EnSightEncoding encoding;
  std::map<std::int64_t, EnSightPart> parts;  ///< by their numbers
  std::vector<EnSightBlock> blocks;
};

/// Reads one file or step. Counts elements of other dimensions in `report`. Ids of points are
/// unchecked (kGhost where there is none). Errors: bad-input, truncated (with the byte or line),
/// a grid beyond `bounds`.
[[nodiscard]] Result<EnSightGeometry> readEnSightGeometry(std::string_view bytes,
                                                          const std::filesystem::path& file,
                                                          const EnSightEncoding& encoding,
                                                          EnSightBounds& bounds,
                                                          ReadReport& report);

/// Gives the geometry the points of `moved`, which has the same parts. Errors: bad-input (it has
/// not).
[[nodiscard]] Status movePoints(EnSightGeometry& geometry, const EnSightGeometry& moved,
                                const std::filesystem::path& file);

}  // namespace qtet
