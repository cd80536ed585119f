#include "simplify/read/nastran/coordinate_systems.h"

#include <array>

namespace qtet {
namespace {

struct PlacedSystem {
  SystemKind kind = SystemKind::kRectangular;
  AbaqusPlacement placement;
};

Position inRectangular(SystemKind kind, const Position& p) {
  switch (kind) {
    case SystemKind::kCylindrical: return fromCylindrical(p);
    case SystemKind::kSpherical: {
      // radius, degrees from the axis z, degrees round it
      const Turn down = turnOf(p[1]);
      return fromCylindrical({p[0] * down.sine, p[2], p[0] * down.cosine});
    }
    default: return p;
  }
}

class Placing {
 public:
  explicit Placing(const PlacedGrids& file) : file_(file) {}

  Result<Position> placeOf(const GridCard& grid, int depth) {
    if (grid.system == 0) return grid.place;
    const Result<PlacedSystem> system = systemOf(grid.system, depth);
    if (!system) return std::unexpected(system.error());
    return system->placement(inRectangular(system->kind, grid.place));
  }

 private:
  static std::unexpected<Error> refuse(std::uint32_t number, const std::string& what) {
    return fail(ErrorCode::kBadInput, "coordinate system " + std::to_string(number) + " " + what);
  }

  Result<PlacedSystem> systemOf(std::uint32_t number, int depth) {
    if (const auto known = known_.find(number); known != known_.end()) return known->second;
    if (depth == PlacedGrids::kMaxDepth)
      return fail(ErrorCode::kLimitExceeded,
                  "coordinate systems refer to one another more than " +
                      std::to_string(PlacedGrids::kMaxDepth) +
                      " deep, or in a circle; give them in the basic system");
    const auto card = file_.systems.find(number);
    if (card == file_.systems.end())
      return refuse(number,
                    "is not there, or is none of CORD1R, CORD1C, CORD1S, CORD2R, CORD2C and "
                    "CORD2S; give the points in the basic system");
    std::array<Position, 3> points = card->second.points;
    for (std::size_t k = 0; k < 3; ++k) {
      const Result<Position> point = pointOf(number, card->second, k, depth + 1);
      if (!point) return std::unexpected(point.error());
      points[k] = *point;
    }
    const std::optional<AbaqusPlacement> placement = axesOf(points);
    if (!placement)
      return refuse(number, "is defined by three points of one line; correct its card");
    return known_.emplace(number, PlacedSystem{card->second.kind, *placement}).first->second;
  }

  Result<Position> pointOf(std::uint32_t number, const SystemCard& card, std::size_t k, int depth) {
    if (!card.isByGrids) return placeOf({0, card.reference, card.points[k]}, depth);
    const auto row = file_.rows.find(card.grids[k]);
    if (row == file_.rows.end())
      return refuse(number, "is defined by the point " + std::to_string(card.grids[k]) +
                                ", which is not there; export the file again");
    return placeOf(file_.grids[row->second], depth);
  }

  /// From the origin, a point on z and one in the plane x-z. Abaqus' systems have the former on x,
  /// and the latter in the plane x-y.
  static std::optional<AbaqusPlacement> axesOf(const std::array<Position, 3>& points) {
    std::array<double, 9> numbers{};
    for (std::size_t i = 0; i < 9; ++i) numbers[i] = points[i / 3][i % 3];
    std::optional<AbaqusPlacement> out = qtet::systemOf(numbers);
    if (out) out->axes = {out->axes[1], out->axes[2], out->axes[0]};
    return out;
  }

  const PlacedGrids& file_;
  std::map<std::uint32_t, PlacedSystem> known_;
};

}  // namespace

Result<std::vector<Position>> PlacedGrids::places() const {
  Placing placing(*this);
  std::vector<Position> out;
  out.reserve(grids.size());
  for (const GridCard& grid : grids) {
    const Result<Position> place = placing.placeOf(grid, 0);
    if (!place)
      return fail(place.error().code,
                  "point " + std::to_string(grid.number) + ": " + place.error().message);
    out.push_back(*place);
  }
  return out;
}

}  // namespace qtet
