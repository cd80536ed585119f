// What a view wants of a packet, from its box alone (PROTOCOL.md, "View").
#pragma once

#include <array>
#include <cstdint>

#include "codec/log_index.h"
#include "proto/manifest.h"
#include "proto/stream_wishes.h"

namespace qtet {

/// How near to what the view wants, in the order of sending.
enum class Tier : std::uint8_t {
  kWanted,  ///< seen, and on a clip plane or in the box where there are any
  kSeen,    ///< in the frustum, but on no plane and not in the box
  kRest,    ///< behind the camera
};

/// Monotone: a box within another one is in the same tier or a later one, so that what is wanted is closed under dependencies.
class ViewWishes {
 public:
  /// The box's 256ths become lengths by the manifest's lattice. Values of packets are not in the file, so an isovalue chooses nothing.
  ViewWishes(const View& view, const Manifest& manifest);

  [[nodiscard]] Tier tierOf(const PacketBox& box) const;
  /// What error in the box counts: 1 at the view's point and without one, falling with the square of the distance like what is seen of it.
  [[nodiscard]] double weightOf(const PacketBox& box) const;

 private:
  struct Box {
    std::array<double, 3> least, most;
  };
  [[nodiscard]] Box inSpace(const PacketBox& box) const;
  [[nodiscard]] bool isSeen(const Box& box) const;
  [[nodiscard]] bool isAtAPlace(const Box& box) const;

  View view_;
  std::array<double, 3> origin_;
  double size_;  ///< of the lattice along each axis
};

}  // namespace qtet
