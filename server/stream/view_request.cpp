#include "server/stream/view_request.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "codec/log/log_index.h"
#include "proto/manifest.h"
#include "server/store/packet_intervals.h"

namespace qtet {
namespace {

/// Within this part of the lattice's size a place counts as at the point: nearer than that a packet
/// fills the picture anyhow.
constexpr double kNear = 1.0 / 32;

}  // namespace

ViewRequest::ViewRequest(const View& view, const LogFront& log)
    : view_(view),
      log_(log),
      origin_(log.manifest.latticeOrigin),
      size_(std::ldexp(log.manifest.latticeStep, log.manifest.latticeBits)) {
  if (view_.isovalue && log_.intervals != nullptr)
    column_ = log_.intervals->columnOf(log_.manifest, *view_.isovalue);
}

ViewRequest::Box ViewRequest::inSpace(const PacketBox& box) const {
  Box out{};
  for (std::size_t a = 0; a < 3; ++a) {
    out.least[a] = origin_[a] + size_ * box.least[a] / 256;
    out.most[a] = origin_[a] + size_ * (box.most[a] + 1) / 256;
  }
  return out;
}

namespace {

/// The least and the greatest value of a x + b y + c z + d in the box.
std::pair<double, double> valuesOf(const Plane& plane, const std::array<double, 3>& least,
                                   const std::array<double, 3>& most) {
  double low = plane[3], high = plane[3];
  for (std::size_t a = 0; a < 3; ++a) {
    low += std::min(plane[a] * least[a], plane[a] * most[a]);
    high += std::max(plane[a] * least[a], plane[a] * most[a]);
  }
  return {low, high};
}

}  // namespace

bool ViewRequest::isSeen(const Box& box) const {
  return std::ranges::all_of(view_.frustum, [&](const Plane& plane) {
    return valuesOf(plane, box.least, box.most).second >= 0;
  });
}

bool ViewRequest::isAtAPlace(const Box& box) const {
  const auto cuts = [&](const Plane& plane) {
    const auto [low, high] = valuesOf(plane, box.least, box.most);
    return low <= 0 && high >= 0;
  };
  if (std::ranges::any_of(view_.planes, cuts)) return true;
  if (!view_.box) return false;
  for (std::size_t a = 0; a < 3; ++a)
    if (box.most[a] < (*view_.box)[a] || (*view_.box)[a + 3] < box.least[a]) return false;
  return true;
}

bool ViewRequest::isMet(std::uint32_t packet) const {
  if (!column_) return false;
  const ValueInterval& interval = log_.intervals->of(packet, *column_);
  return std::ranges::any_of(view_.isovalue->values,
                             [&](double value) { return interval.holds(value); });
}

Tier ViewRequest::tierOf(std::uint32_t packet) const {
  assert(packet < log_.index.chunks.size());
  const Box box = inSpace(log_.index.chunks[packet].box);
  if (!isSeen(box)) return Tier::kRest;
  const bool anywhere = view_.planes.empty() && !view_.box && !column_;
  return anywhere || isAtAPlace(box) || isMet(packet) ? Tier::kWanted : Tier::kSeen;
}

double ViewRequest::weightOf(const PacketBox& packet) const {
  if (!view_.point) return 1;
  const Box box = inSpace(packet);
  double square = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double gap =
        std::max({box.least[a] - (*view_.point)[a], (*view_.point)[a] - box.most[a], 0.0});
    square += gap * gap;
  }
  const double near = kNear * size_;
  return near * near / (near * near + square);
}

}  // namespace qtet
