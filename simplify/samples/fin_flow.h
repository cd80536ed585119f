// An algebraic model of supersonic flow round the fin sample: what a shock-capturing solver's
// result looks like, in + - * / sqrt.
#pragma once

#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// The fin: a superellipsoid (|x / a|^4 + |y / b|^4 + |z / c|^4 = 1) on the plate z = 0, sheared
/// downstream by kFinSweep * z.
inline constexpr Position kFinHalfAxes{1.0, 0.2, 1.5};
inline constexpr double kFinSweep = 0.55;

struct FlowState {
  double density = 1;
  double pressure = 1 / 1.4;
  Position velocity{};
};

/// How far the flow is from the steady one. The bow shock lies `shockAhead` further upstream. The
/// wake's bends have moved by `wakeTurns` of their wave's length.
struct FlowPhase {
  double shockAhead = 0;
  double wakeTurns = 0;
};

/// The flow at `p`, `wallDistance` away from the fin.
[[nodiscard]] FlowState finFlowAt(const Position& p, double wallDistance,
                                  const FlowPhase& phase = {});

}  // namespace qtet
