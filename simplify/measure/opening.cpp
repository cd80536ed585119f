#include "simplify/measure/opening.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "proto/limits.h"
#include "proto/series.h"
#include "simplify/clean/quantise_field.h"
#include "simplify/mesh/vector3.h"

namespace qtet {
namespace {

constexpr std::size_t kColors = 256;
/// A boundary with fewer colours looks uniform.
constexpr double kUniform = 16;
/// A cut must show so many times as many, and so must another instant than the first.
constexpr double kBetter = 1.5;
/// Instants that are looked at: the two ends and others at equal distances.
constexpr std::size_t kLookedAt = 8;
/// The tails of the values, and when they hide the others.
constexpr double kTail = 0.02, kMinMiddle = 0.4;
/// The values' span has so many bins when the tails are looked for.
constexpr std::size_t kBins = 1 << 12;

/// By field: the values that the viewer's colours are of.
struct Extent {
  std::array<double, 2> range;
  bool isSeries = false;  ///< its own range is that of all instants, and spans all colours
};

/// Outlying instants have another scale, or more bits. They neither widen the extent nor open the
/// log.
std::vector<std::size_t> usualInstants(const LatticeMesh& mesh, const Series& series) {
  std::vector<std::size_t> out = series.fields;
  std::erase_if(out, [&](std::size_t f) {
    const FieldInfo &first = mesh.fields[series.fields.front()], &its = mesh.fields[f];
    return !haveOneScale(first, its) || its.bits > first.bits;
  });
  return out;
}

std::vector<Extent> shownExtents(const LatticeMesh& mesh) {
  std::vector<Extent> out;
  for (const FieldInfo& info : mesh.fields) out.push_back({info.range});
  for (const Series& series : seriesOf(mesh.fields)) {
    Extent all{mesh.fields[series.fields.front()].range, true};
    for (const std::size_t f : usualInstants(mesh, series)) {
      all.range[0] = std::min(all.range[0], mesh.fields[f].range[0]);
      all.range[1] = std::max(all.range[1], mesh.fields[f].range[1]);
    }
    for (const std::size_t f : series.fields) out[f] = all;
  }
  return out;
}

/// Values or magnitudes of one field, in [0, 1] over its extent; NaN where one is missing.
class Values {
 public:
  Values(const LatticeMesh& mesh, std::size_t field, const Extent& extent)
      : info_(mesh.fields[field]), integers_(mesh.values[field]), isSeries_(extent.isSeries) {
    const double low = extent.range[0], span = extent.range[1] - low;
    low_ = low, inverse_ = span > 0 ? 1 / span : 0;
  }

  [[nodiscard]] bool isSeries() const { return isSeries_; }
  [[nodiscard]] bool ofCells() const { return info_.association == "cell"; }
  [[nodiscard]] std::size_t size() const { return integers_.size() / info_.components; }
  [[nodiscard]] double operator[](std::size_t index) const {
    assert(index < size());
    const std::size_t n = info_.components;
    if (n == 1) return (info_.value(0, integers_[index]) - low_) * inverse_;
    double sum = 0;
    for (std::size_t c = 0; c < n; ++c) {
      const double value = info_.value(c, integers_[index * n + c]);
      sum += value * value;
    }
    return (std::sqrt(sum) - low_) * inverse_;
  }

 private:
  const FieldInfo& info_;
  const std::vector<std::int32_t>& integers_;
  bool isSeries_;
  double low_ = 0, inverse_ = 0;
};

struct Range {
  double low = 0, high = 1;
};

std::size_t binOf(double share, std::size_t bins) {
  assert(bins > 0 && !std::isnan(share));
  return static_cast<std::size_t>(
      std::clamp(share * static_cast<double>(bins), 0.0, static_cast<double>(bins - 1)));
}

/// The range that the viewer's colours span.
Range shownRange(const Values& values) {
  if (values.isSeries()) return {};
  std::array<std::uint64_t, kBins> counts{};
  std::uint64_t known = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (const double value = values[i]; !std::isnan(value)) ++counts[binOf(value, kBins)], ++known;
  const auto passing = [&](double share) {
    std::uint64_t passed = 0;
    std::size_t bin = 0;
    for (; bin + 1 < kBins; ++bin)
      if (static_cast<double>(passed += counts[bin]) > share * static_cast<double>(known)) break;
    return static_cast<double>(bin) / kBins;
  };
  const Range middle{passing(kTail), passing(1 - kTail)};
  const double width = middle.high - middle.low;
  return width > 0 && width < kMinMiddle ? middle : Range{};
}

/// Sums areas by colour.
class Palette {
 public:
  explicit Palette(Range range) : range_(range) {}

  void add(double value, double area) {
    assert(area >= 0 && range_.low < range_.high);
    if (std::isnan(value)) return;
    areas_[binOf((value - range_.low) / (range_.high - range_.low), kColors)] += area;
  }
  [[nodiscard]] double colors() const {
    double sum = 0, squares = 0;
    for (const double area : areas_) sum += area, squares += area * area;
    return squares > 0 ? sum * sum / squares : 0;
  }

 private:
  Range range_;
  std::array<double, kColors> areas_{};
};

/// Towards the eye of a viewer's first camera: front right, from above.
constexpr Vector3 kTowardsEye{0.62, -1, 0.55};

/// The sum of a triangle's edges crossed: as long as twice the area, normal to it.
Vector3 twiceTheArea(const std::array<Vector3, 3>& corners) {
  return cross(corners[1] - corners[0], corners[2] - corners[0]);
}

double twiceAreaOf(const std::array<Vector3, 3>& corners) {
  const Vector3 normal = twiceTheArea(corners);
  return std::sqrt(dot(normal, normal));
}

/// A triangle whose values are linear between its corners.
void addTriangle(Palette& palette, const std::array<double, 3>& values, double area) {
  const double middle = (values[0] + values[1] + values[2]) / 3;
  palette.add(middle, area);
  for (const double value : values) palette.add((value + middle) / 2, area);
}

constexpr double kEverywhere = std::numeric_limits<double>::infinity();

class Scene {
 public:
  Scene(const LatticeMesh& mesh, const std::optional<Focus>& focus)
      : mesh_(mesh),
        extents_(shownExtents(mesh)),
        onBoundary_(mesh.points.size()),
        isPart_(focus.has_value()) {
    if (focus) lookAt(*focus);
    for (const Triangle& t : mesh.boundary)
      for (const VertexId v : t) onBoundary_[v] = true;
  }

  struct Sight {
    Opening opening;
    double colors = 0;
  };

  /// The one of these fields, and the cut, that show most.
  [[nodiscard]] Sight bestOf(std::span<const std::size_t> fields) const {
    Sight best;
    for (const std::size_t f : fields)
      if (const double colors = colorsOnBoundary(f); colors > best.colors)
        best = {{static_cast<std::uint8_t>(f)}, colors};
    if (best.colors >= kUniform || isPart_) return best;
    double most = kBetter * best.colors;
    for (const std::size_t f : fields)
      for (std::uint8_t axis = 0; axis < 3; ++axis)
        if (const double colors = colorsOnCut(f, axis); colors > most)
          most = colors, best = {{static_cast<std::uint8_t>(f), axis}, colors};
    return best;
  }

 private:
  [[nodiscard]] double colorsOnBoundary(std::size_t field) const {
    assert(field < extents_.size());
    const Values values(mesh_, field, extents_[field]);
    Palette palette(shownRange(values));
    if (values.ofCells()) {
      addOuterFaces(palette, values);
    } else {
      for (const auto& [a, b, c] : mesh_.boundary)
        addTriangle(palette, {values[a], values[b], values[c]},
                    seenArea(at(a), twiceTheArea({at(a), at(b), at(c)})));
    }
    return palette.colors();
  }

  /// On the plane across the axis in the middle of the lattice's points.
  [[nodiscard]] double colorsOnCut(std::size_t field, std::size_t axis) const {
    assert(field < extents_.size() && axis < 3);
    const Values values(mesh_, field, extents_[field]);
    const auto [low, high] =
        std::ranges::minmax(mesh_.points, {}, [&](const LatticePoint& p) { return p[axis]; });
    // Between two lattice planes no vertex lies on the cut.
    const double height = std::floor((static_cast<double>(low[axis]) + high[axis]) / 2) + 0.5;
    Palette palette(shownRange(values));
    for (std::size_t cell = 0; cell < mesh_.tetrahedra.size(); ++cell)
      addSection(palette, values, cell, axis, height);
    return palette.colors();
  }

  [[nodiscard]] Vector3 at(VertexId v) const { return toVector(mesh_.points[v]); }

  /// Looks at the focus and as much round it, on each side.
  void lookAt(const Focus& focus) {
    const double unit =
        std::ldexp(1.0, mesh_.lattice.bits - std::numeric_limits<Focus::value_type>::digits);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double extent = focus[axis + 3] - focus[axis];
      seenLow_[axis] = unit * (focus[axis] - extent);
      seenHigh_[axis] = unit * (focus[axis + 3] + extent);
    }
  }

  /// The area of a triangle of the boundary that the first camera sees, in some unit.
  [[nodiscard]] double seenArea(const Vector3& corner, const Vector3& outward) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (corner[axis] < seenLow_[axis] || corner[axis] > seenHigh_[axis]) return 0;
    return std::max(0.0, dot(outward, kTowardsEye));
  }

  /// A face with all corners on the boundary counts: nearly all such faces are outer ones.
  void addOuterFaces(Palette& palette, const Values& values) const {
    for (std::size_t cell = 0; cell < mesh_.tetrahedra.size(); ++cell)
      for (std::size_t left = 0; left < 4; ++left) {
        std::array<Vector3, 3> corners{};
        std::size_t count = 0;
        for (std::size_t i = 0; i < 4; ++i)
          if (const VertexId v = mesh_.tetrahedra[cell][i]; i != left && onBoundary_[v])
            corners[count++] = at(v);
        if (count < 3) continue;
        const Vector3 normal = twiceTheArea(corners);
        const double side = dot(normal, at(mesh_.tetrahedra[cell][left]) - corners[0]);
        palette.add(values[cell], seenArea(corners[0], side < 0 ? normal : -1 * normal));
      }
  }

  void addSection(Palette& palette, const Values& values, std::size_t cell, std::size_t axis,
                  double height) const {
    std::array<VertexId, 4> above{}, below{};
    std::size_t ups = 0, downs = 0;
    for (const VertexId v : mesh_.tetrahedra[cell])
      (mesh_.points[v][axis] > height ? above[ups++] : below[downs++]) = v;
    if (ups == 0 || downs == 0) return;
    // In the order round the section: each edge shares a corner with the one before it.
    assert(ups + downs == 4);
    std::array<Vector3, 4> points{};
    std::array<double, 4> known{};
    std::size_t count = 0;
    for (std::size_t up = 0; up < ups; ++up)
      for (std::size_t i = 0; i < downs; ++i) {
        const VertexId a = above[up], b = below[up % 2 == 0 ? i : downs - 1 - i];
        const double t = (height - mesh_.points[b][axis]) /
                         (static_cast<double>(mesh_.points[a][axis]) - mesh_.points[b][axis]);
        points[count] = at(b) + t * (at(a) - at(b));
        known[count++] = values.ofCells() ? values[cell] : values[b] + t * (values[a] - values[b]);
      }
    for (std::size_t i = 2; i < count; ++i)
      addTriangle(palette, {known[0], known[i - 1], known[i]},
                  twiceAreaOf({points[0], points[i - 1], points[i]}));
  }

  const LatticeMesh& mesh_;
  const std::vector<Extent> extents_;
  std::vector<bool> onBoundary_;
  bool isPart_;  ///< only what lies near the focus counts
  Vector3 seenLow_{-kEverywhere, -kEverywhere, -kEverywhere};
  Vector3 seenHigh_{kEverywhere, kEverywhere, kEverywhere};
};

/// Those that an opening can name: of a series one instant alone.
std::vector<std::size_t> openingFields(const LatticeMesh& mesh) {
  const std::vector<bool> isLater = laterInstants(seriesOf(mesh.fields), mesh.fields.size());
  std::vector<std::size_t> out;
  for (std::size_t f = 0; f < mesh.fields.size() && f <= kMaxOpeningField; ++f)
    if (!isLater[f]) out.push_back(f);
  return out;
}

/// The times of all series, each once, ascending.
std::vector<double> timesOf(std::span<const Series> all) {
  std::vector<double> out;
  for (const Series& series : all) out.insert(out.end(), series.times.begin(), series.times.end());
  std::ranges::sort(out);
  const auto again = std::ranges::unique(out, isSameTime);
  out.erase(again.begin(), again.end());
  return out;
}

/// The instants of that time, but for outlying ones.
std::vector<std::size_t> fieldsAt(const LatticeMesh& mesh, std::span<const Series> all,
                                  double time) {
  std::vector<std::size_t> out;
  for (const Series& series : all)
    if (const auto place = placeOfTime(series.times, time);
        place &&
        haveOneScale(mesh.fields[series.fields.front()], mesh.fields[series.fields[*place]]))
      out.push_back(series.fields[*place]);
  return out;
}

}  // namespace

std::optional<Opening> openingOf(const LatticeMesh& mesh, const std::optional<Focus>& focus) {
  const Opening best = Scene(mesh, focus).bestOf(openingFields(mesh)).opening;
  if (best.field == 0 && !best.cut) return std::nullopt;
  return best;
}

std::optional<double> openingTime(const LatticeMesh& mesh, const std::optional<Focus>& focus) {
  const std::vector<Series> all = seriesOf(mesh.fields);
  if (all.empty()) return std::nullopt;
  const Scene scene(mesh, focus);
  const std::vector<double> times = timesOf(all);
  assert(!times.empty());
  const std::size_t last = times.size() - 1, steps = std::min(last, kLookedAt - 1);
  double most = kBetter * scene.bestOf(openingFields(mesh)).colors;
  std::optional<double> out;
  for (std::size_t i = 1; i <= steps; ++i) {
    const double time = times[i * last / steps];
    if (const double colors = scene.bestOf(fieldsAt(mesh, all, time)).colors; colors > most)
      most = colors, out = time;
  }
  return out;
}

}  // namespace qtet
