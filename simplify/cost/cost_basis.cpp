#include "simplify/cost/cost_basis.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>

namespace qtet {
namespace {

// More takes time and leaves errors as they are.
constexpr double kVarianceKept = 0.99;
// Steps of the subspace iteration that follow the elimination. Each turns the directions towards
// the principal ones; the variance that these hold no longer changes in its third digit.
constexpr int kTurns = 4;
// Products of two components that are summed at most, a tenth of a second of work. Beyond it, a
// part of the vertices stands for all.
constexpr std::uint64_t kMaxProducts = 100'000'000;
// Relative to the largest variance: what is below it is rounding.
constexpr double kNothing = 1e-12;

// Row-major and square.
class Matrix {
 public:
  explicit Matrix(std::size_t size) : size_(size), entries_(size * size, 0) {}
  [[nodiscard]] std::span<double> row(std::size_t i) {
    return std::span(entries_).subspan(i * size_, size_);
  }
  [[nodiscard]] std::span<const double> row(std::size_t i) const {
    return std::span(entries_).subspan(i * size_, size_);
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] double trace() const {
    double sum = 0;
    for (std::size_t i = 0; i < size_; ++i) sum += row(i)[i];
    return sum;
  }

 private:
  std::size_t size_;
  std::vector<double> entries_;
};

using Direction = std::vector<double>;

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

void addScaled(std::span<double> to, double factor, std::span<const double> what) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * what[i];
}

// The scaled components of a vertex, part by part.
void takeValues(const LatticeMesh& mesh, std::span<const CostPart> parts, std::size_t vertex,
                std::vector<double>& values) {
  values.clear();
  for (const CostPart& part : parts) {
    const std::size_t n = mesh.fields[part.field].components;
    for (std::size_t c = 0; c < n; ++c)
      values.push_back(part.scale * mesh.values[part.field][vertex * n + c]);
  }
}

// Over vertices at equal distances in their order.
Matrix covarianceOf(const LatticeMesh& mesh, std::span<const CostPart> parts, std::size_t size) {
  const std::size_t most = std::max<std::size_t>(2 * size, kMaxProducts / (size * size));
  const std::size_t step = (mesh.points.size() + most - 1) / most;
  Direction mean(size, 0);
  std::vector<double> values;
  std::size_t count = 0;
  for (std::size_t v = 0; v < mesh.points.size(); v += step, ++count)
    takeValues(mesh, parts, v, values), addScaled(mean, 1, values);
  for (double& m : mean) m /= static_cast<double>(count);
  Matrix out(size);
  for (std::size_t v = 0; v < mesh.points.size(); v += step) {
    takeValues(mesh, parts, v, values);
    addScaled(values, -1, mean);
    for (std::size_t i = 0; i < size; ++i)
      addScaled(out.row(i), values[i] / static_cast<double>(count), values);
  }
  return out;
}

// Takes out of `d` what `before` hold; nothing is left of what they hold all of.
bool makeOrthonormal(Direction& d, std::span<const Direction> before) {
  const double whole = dot(d, d);
  for (int twice = 0; twice < 2; ++twice)  // the second time takes what rounding left
    for (const Direction& b : before) addScaled(d, -dot(d, b), b);
  const double left = dot(d, d);
  if (!(left > kNothing * whole)) return false;
  for (double& x : d) x /= std::sqrt(left);
  return true;
}

// The component of largest variance, taken out of all, and again: Gauss's elimination with pivots.
std::vector<Direction> eliminate(Matrix rest, std::size_t most) {
  std::vector<Direction> out;
  const double nothing = kNothing * rest.trace();
  while (out.size() < most) {
    std::size_t pivot = 0;
    for (std::size_t i = 1; i < rest.size(); ++i)
      if (rest.row(i)[i] > rest.row(pivot)[pivot]) pivot = i;
    const double variance = rest.row(pivot)[pivot];
    if (!(variance > nothing)) break;
    const auto row = rest.row(pivot);
    const Direction column(row.begin(), row.end());
    for (std::size_t i = 0; i < rest.size(); ++i)
      addScaled(rest.row(i), -column[i] / variance, column);
    Direction direction = column;
    if (!makeOrthonormal(direction, out)) break;
    out.push_back(std::move(direction));
  }
  return out;
}

Direction times(const Matrix& m, const Direction& d) {
  Direction out(d.size());
  for (std::size_t i = 0; i < d.size(); ++i) out[i] = dot(m.row(i), d);
  return out;
}

// One step of the subspace iteration.
void turn(std::vector<Direction>& directions, const Matrix& covariance) {
  std::vector<Direction> out;
  for (const Direction& d : directions) {
    Direction next = times(covariance, d);
    if (makeOrthonormal(next, out)) out.push_back(std::move(next));
  }
  directions = std::move(out);
}

}  // namespace

CostBasis::CostBasis(const LatticeMesh& mesh, std::span<const CostPart> parts) {
  std::size_t size = 0;
  for (const CostPart& part : parts) size += mesh.fields[part.field].components;
  components_ = size;
  if (size <= kMaxCostComponents) return;
  const Matrix covariance = covarianceOf(mesh, parts, size);
  std::vector<Direction> directions = eliminate(covariance, kMaxCostComponents);
  for (int i = 0; i < kTurns; ++i) turn(directions, covariance);
  double held = 0;
  const double whole = covariance.trace();
  components_ = 0;
  while (components_ < directions.size() && held < kVarianceKept * whole) {
    const Direction& d = directions[components_++];
    held += dot(d, times(covariance, d));
  }
  varianceKept_ = held / whole;
  directions_.resize(size * components_);
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < components_; ++j)
      directions_[i * components_ + j] = directions[j][i];
}

void CostBasis::add(std::size_t i, double value, std::span<double> values) const {
  assert(isDirect() ? i < values.size() : (i + 1) * components_ <= directions_.size());
  if (isDirect())
    values[i] += value;
  else
    addScaled(values, value, std::span(directions_).subspan(i * components_, components_));
}

double CostBasis::changeOf(std::size_t i, std::span<const double> values) const {
  assert((i + 1) * components_ <= directions_.size() && values.size() == components_);
  assert(!isDirect());
  return dot(std::span(directions_).subspan(i * components_, components_), values);
}

}  // namespace qtet
