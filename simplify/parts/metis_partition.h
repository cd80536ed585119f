// Parts by METIS, whose cuts are short (Debian's libmetis-dev).
#pragma once

#include "simplify/parts/cell_graph.h"

namespace qtet {

/// About equal numbers of cells, and few faces cut. Null in a build without METIS.
[[nodiscard]] Partitioner metisPartitioner();

}  // namespace qtet
