#include "simplify/mesh/measure_geometry.h"

namespace qtet {
namespace {

NearestPoint at(const Vector3& p, const std::array<Vector3, 3>& triangle,
                const std::array<double, 3>& weights) {
  const Vector3 apart = p - blend(triangle, weights);
  return {dot(apart, apart), weights};
}

}  // namespace

NearestPoint nearestOnTriangle(const Vector3& p, const std::array<Vector3, 3>& triangle) {
  const Vector3 ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0];
  const Vector3 ap = p - triangle[0], bp = p - triangle[1], cp = p - triangle[2];
  const double abAp = dot(ab, ap), acAp = dot(ac, ap);
  if (abAp <= 0 && acAp <= 0) return at(p, triangle, {1, 0, 0});
  const double abBp = dot(ab, bp), acBp = dot(ac, bp);
  if (abBp >= 0 && acBp <= abBp) return at(p, triangle, {0, 1, 0});
  // of the area, what lies opposite c; below 0 where p is beyond ab
  const double overC = abAp * acBp - abBp * acAp;
  if (overC <= 0 && abAp >= 0 && abBp <= 0 && abAp > abBp) {
    const double v = abAp / (abAp - abBp);
    return at(p, triangle, {1 - v, v, 0});
  }
  const double abCp = dot(ab, cp), acCp = dot(ac, cp);
  if (acCp >= 0 && abCp <= acCp) return at(p, triangle, {0, 0, 1});
  const double overB = abCp * acAp - abAp * acCp;
  if (overB <= 0 && acAp >= 0 && acCp <= 0 && acAp > acCp) {
    const double w = acAp / (acAp - acCp);
    return at(p, triangle, {1 - w, 0, w});
  }
  const double overA = abBp * acCp - abCp * acBp, towardsC = acBp - abBp, towardsB = abCp - acCp;
  if (overA <= 0 && towardsC >= 0 && towardsB >= 0 && towardsC + towardsB > 0) {
    const double w = towardsC / (towardsC + towardsB);
    return at(p, triangle, {0, 1 - w, w});
  }
  const double area = overA + overB + overC;
  if (!(area > 0)) return at(p, triangle, {1, 0, 0});  // three corners in one place
  return at(p, triangle, {overA / area, overB / area, overC / area});
}

}  // namespace qtet
