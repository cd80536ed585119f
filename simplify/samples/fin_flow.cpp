#include "simplify/samples/fin_flow.h"

#include <algorithm>
#include <cmath>

namespace qtet {
namespace {

constexpr double kGamma = 1.4;
constexpr double kMach = 2.95;
/// Bow shock (Billig's hyperbola): distance ahead of the nose, radius at its apex, squared
/// cotangent of its far angle.
constexpr double kStandOff = 0.26, kShockRadius = 0.5, kShockCotangent2 = 5.0;
/// Where the wake starts behind the nose, and how far apart its bends are.
constexpr double kWakeStart = 1.7, kWakeBends = 0.55;

double square(double x) { return x * x; }

/// max(0, x) with its corner rounded over `width`.
double ramp(double x, double width) { return 0.5 * (x + std::sqrt(x * x + width * width)); }

/// A bump of height 1 and half-width `width`, in place of a Gaussian.
double bump(double x, double width) { return 1 / square(1 + square(x / width)); }

/// Rises from 0 to 1 around x = 0 within about `width`.
double step(double x, double width) { return 0.5 * (1 + x / std::sqrt(width * width + x * x)); }

/// A sine of period 2, in parabolas.
double wave(double x) {
  const double v = x - 2 * std::floor(0.5 * x) - 1;
  return -4 * v * (1 - std::abs(v));
}

/// The place relative to the fin: `along` behind the leading edge at this height, `side` and
/// `above` away from it.
struct Place {
  Position p;
  double along;
  double side;
  double above;
  double wall;
  FlowPhase phase;
};

/// Where the wake bends, `behind` its start.
double bendAt(const Place& place, double behind) {
  return kWakeBends * behind - 2 * place.phase.wakeTurns;
}

struct Shock {
  double behind;    ///< 0 ahead of it, 1 behind it
  double depth;     ///< distance behind it, 0 ahead of it
  double sine2;     ///< of its angle to the stream
  double pressure;  ///< ratios across it (Rankine and Hugoniot)
  double density;
};

Shock shockAt(const Place& place) {
  const double radius2 = square(place.side) + square(place.above);
  const double root = std::sqrt(1 + radius2 / (square(kShockRadius) * kShockCotangent2));
  const double slope2 = radius2 / square(kShockRadius * root);
  const double sine2 = 1 / (1 + slope2);
  const double distance = (place.along + (kStandOff + place.phase.shockAhead) -
                           kShockRadius * kShockCotangent2 * (root - 1)) *
                          std::sqrt(sine2);
  const double normalMach2 = std::max(1.0, square(kMach) * sine2);
  return {step(distance, 0.03 + 0.015 * std::sqrt(radius2)), ramp(distance, 0.02), sine2,
          1 + 2 * kGamma / (kGamma + 1) * (normalMach2 - 1),
          (kGamma + 1) * normalMach2 / ((kGamma - 1) * normalMach2 + 2)};
}

/// 0 outside the wake, 1 in its core.
double wakeAt(const Place& place) {
  const double behind = ramp(place.along - kWakeStart, 0.1);
  const double centre = 0.35 * behind / (behind + 2) * wave(bendAt(place, behind));
  const double top = kFinHalfAxes[2] - 0.05;
  return square(behind) / (square(behind) + 0.15) *
         bump(place.side - centre, 0.22 + 0.2 * std::sqrt(behind)) *
         bump(ramp(place.p[2] - top, 0.05), 0.35) / (1 + 0.12 * behind);
}

/// A vortex that trails downstream: centre in the cross-plane, core radius and strength at this
/// place.
struct Vortex {
  double y, z, core, strength;
};

std::array<Vortex, 4> vorticesAt(const Place& place) {
  const double grown = ramp(place.along - 0.3, 0.2);
  const double tip = 0.75 * grown / (grown + 1), base = 0.45 * grown / (grown + 0.6);
  const double tipY = 0.16 + 0.05 * grown, tipZ = kFinHalfAxes[2] + 0.02 + 0.04 * grown,
               tipCore = 0.1 + 0.05 * grown;
  const double baseY = 0.34 + 0.3 * std::sqrt(grown), baseZ = 0.12 + 0.03 * grown,
               baseCore = 0.1 + 0.03 * grown;
  return {{{tipY, tipZ, tipCore, tip},
           {-tipY, tipZ, tipCore, -tip},
           {baseY, baseZ, baseCore, -base},
           {-baseY, baseZ, baseCore, base}}};
}

/// Outward normal of the fin's shell through the place.
Position shellNormal(const Place& place) {
  const double x = place.along - kFinHalfAxes[0];
  const auto cube = [](double value, double halfAxis) {
    return value * value * value / square(square(halfAxis));
  };
  Position n{cube(x, kFinHalfAxes[0]), cube(place.side, kFinHalfAxes[1]),
             cube(place.p[2], kFinHalfAxes[2])};
  n[2] -= kFinSweep * n[0];
  const double length = std::sqrt(square(n[0]) + square(n[1]) + square(n[2])) + 1e-12;
  return {n[0] / length, n[1] / length, n[2] / length};
}

Position velocityAt(const Place& place, const Shock& shock, double wake) {
  Position v{kMach, 0, 0};
  // Behind the shock the stream turns away from the axis and slows down.
  const double turned = 0.45 * kMach * shock.behind * std::sqrt(shock.sine2 * (1 - shock.sine2)) /
                        (1 + 0.5 * shock.depth);
  const double radius = std::sqrt(square(place.side) + square(place.above)) + 1e-12;
  v[0] *= 1 - shock.behind * shock.sine2 * (1 - 1 / shock.density) / (1 + 0.4 * shock.depth);
  v[1] += turned * place.side / radius;
  v[2] += turned * place.above / radius;

  // Along the fin's wall there is no flow through it, and on the wall and the plate there is none
  // at all.
  const Position n = shellNormal(place);
  const double through = (v[0] * n[0] + v[1] * n[1] + v[2] * n[2]) * bump(place.wall, 0.4);
  for (std::size_t k = 0; k < 3; ++k) v[k] -= through * n[k];

  v[0] *= 1 - 1.2 * wake;
  v[1] += 0.6 * wake * wave(bendAt(place, ramp(place.along - kWakeStart, 0.1)) + 0.5);
  for (const Vortex& vortex : vorticesAt(place)) {
    const double y = place.p[1] - vortex.y, z = place.p[2] - vortex.z;
    const double turn =
        vortex.strength * vortex.core / (square(y) + square(z) + square(vortex.core));
    v[1] -= turn * z;
    v[2] += turn * y;
  }
  const auto layer = [](double distance, double thickness) {
    return distance / std::sqrt(square(distance) + square(thickness));
  };
  const double grown = std::sqrt(ramp(place.along, 0.1));
  const double slip =
      layer(place.wall, 0.012 + 0.02 * grown) * layer(place.p[2], 0.04 + 0.03 * grown);
  for (double& component : v) component *= slip;
  return v;
}

}  // namespace

FlowState finFlowAt(const Position& p, double wallDistance, const FlowPhase& phase) {
  const double above = ramp(p[2] - 1.1, 0.3);
  const Place place{p, p[0] - kFinSweep * p[2] + kFinHalfAxes[0], p[1], above, wallDistance, phase};
  const Shock shock = shockAt(place);
  const double wake = wakeAt(place);

  const double expansion = 1 / (1 + square(shock.depth / 0.9));
  const double stagnation = 0.3 * bump(place.along, 0.25) * bump(place.wall, 0.3);
  const double suction = 0.3 * bump(place.along - 1.3, 0.9) * bump(place.wall, 0.35);
  double core = 0;
  for (const Vortex& vortex : vorticesAt(place)) {
    const double r2 = square(p[1] - vortex.y) + square(p[2] - vortex.z);
    core += std::abs(vortex.strength) / square(1 + r2 / square(vortex.core));
  }

  FlowState flow;
  flow.pressure = (1 + shock.behind * (shock.pressure - 1) * expansion * (1 + stagnation)) *
                  (1 - suction * shock.behind) * (1 - 0.35 * wake) / (1 + 0.4 * core) / kGamma;
  flow.density = (1 + shock.behind * (shock.density - 1) * (0.25 + 0.75 * expansion)) *
                 (1 - 0.5 * suction * shock.behind) * (1 - 0.55 * wake) / (1 + 0.5 * core);
  flow.velocity = velocityAt(place, shock, wake);
  return flow;
}

}  // namespace qtet
