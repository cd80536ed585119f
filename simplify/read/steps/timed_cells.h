// One time step of a result.
#pragma once

#include <string>

#include "simplify/split/cell_mesh.h"

namespace qtet {

/// The step's name ("0.5"; empty: the file knows no time), and its mesh in one piece.
struct TimedCells {
  std::string time;
  CellMesh cells;
};

}  // namespace qtet
