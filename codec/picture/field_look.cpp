#include "codec/picture/field_look.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "codec/mesh/predicates.h"
#include "proto/limits.h"

namespace qtet {
namespace {

/// Without a field, and where a value is missing.
constexpr Colour kPlain = {0.72, 0.74, 0.78};
/// The shares of the volume with values below and above the middle ones. If these take less than
/// kMinMiddle of the range, the colours span them alone, as in web-client/core/picture/spread.ts.
constexpr double kTail = 0.02, kMinMiddle = 0.7;
/// So many whole numbers count as labels without a word of the log.
constexpr double kMaxLabels = 20;
/// So many labels have a colour of their own: those of kLabels, then darker ones.
constexpr int kLabelColours = 37;
constexpr double kDarker = 0.65;
/// Two of each of ten hues.
constexpr std::array<std::uint32_t, 20> kLabels = {
    0x1f77b4, 0xff7f0e, 0x2ca02c, 0xd62728, 0x9467bd, 0x8c564b, 0xe377c2,
    0x17becf, 0xbcbd22, 0x7f7f7f, 0xaec7e8, 0xffbb78, 0x98df8a, 0xff9896,
    0xc5b0d5, 0xc49c94, 0xf7b6d2, 0x9edae5, 0xdbdb8d, 0xc7c7c7};

bool holdsLabels(const FieldInfo& field) {
  const bool isWhole = field.type.starts_with("int") || field.type.starts_with("uint");
  const double count = field.range[1] - field.range[0] + 1;
  return isWhole && field.components == 1 && count >= 2 && count <= kMaxLabels &&
         field.range[0] == std::floor(field.range[0]);
}

Colour labelColour(std::int64_t label) {
  const std::int64_t rest = label % kLabelColours;
  const auto at = static_cast<std::size_t>(rest < 0 ? rest + kLabelColours : rest);
  const bool isDark = at >= kLabels.size();
  const std::uint32_t rgb = kLabels[at % kLabels.size()];
  Colour out{};
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = (rgb >> (16 - 8 * c) & 255) / 255.0 * (isDark ? kDarker : 1);
  return out;
}

/// Six times the volume.
double volumeOf(const LatticeMesh& mesh, std::size_t cell) {
  const Tetrahedron& t = mesh.tetrahedra[cell];
  const auto at = [&](std::size_t corner) { return mesh.points[t[corner]]; };
  return std::abs(static_cast<double>(volume6(at(0), at(1), at(2), at(3))));
}

}  // namespace

FieldLook::FieldLook(const LatticeMesh& mesh, std::size_t field, bool isLabel) {
  if (field >= mesh.fields.size()) return;
  field_ = &mesh.fields[field];
  values_ = &mesh.values[field];
  isLabels_ = isLabel || holdsLabels(*field_);
  // A label of the log has the same colour in every log.
  if (!isLabel) firstLabel_ = field_->range[0];
  if (!isLabels_) range_ = automaticRange(mesh);
}

double FieldLook::at(std::size_t index) const {
  if (field_ == nullptr) return std::numeric_limits<double>::quiet_NaN();
  const std::uint32_t components = field_->components;
  double value = 0;
  for (std::uint32_t c = 0; c < components; ++c) {
    const double x = field_->value(c, (*values_)[index * components + c]);
    value = components == 1 ? x : value + x * x;
  }
  if (components > 1) value = std::sqrt(value);
  const double span = field_->range[1] - field_->range[0];
  if (std::isnan(value)) return value;
  return span > 0 ? (value - field_->range[0]) / span : 0;
}

std::array<double, 2> FieldLook::automaticRange(const LatticeMesh& mesh) const {
  std::vector<double> volumes(values_->size() / field_->components);
  for (std::size_t cell = 0; cell < mesh.tetrahedra.size(); ++cell) {
    const double volume = volumeOf(mesh, cell);
    if (ofCells()) volumes[cell] = volume;
    if (ofCells()) continue;
    for (const VertexId v : mesh.tetrahedra[cell]) volumes[v] += volume / 4;
  }
  /// Value and volume.
  std::vector<std::array<double, 2>> values;
  double total = 0;
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    if (volumes[i] == 0 || std::isnan(at(i))) continue;
    values.push_back({at(i), volumes[i]});
    total += volumes[i];
  }
  if (values.empty()) return {0, 1};
  std::ranges::sort(values);
  const auto quantile = [&](double share) {
    double rest = share * total;
    std::size_t i = 0;
    while (i + 1 < values.size() && values[i][1] <= rest) rest -= values[i++][1];
    return values[i][0];
  };
  const double low = quantile(kTail), high = quantile(1 - kTail);
  if (low < high && high - low < kMinMiddle) return {low, high};
  return {0, 1};
}

Colour FieldLook::colour(double share) const {
  if (field_ == nullptr || std::isnan(share)) return kPlain;
  if (!isLabels_) return viridis((share - range_[0]) / (range_[1] - range_[0]));
  const double label = field_->range[0] + share * (field_->range[1] - field_->range[0]);
  return labelColour(std::llround(label - firstLabel_));
}

}  // namespace qtet
