// How much a view wants a packet, judged by its box and its values (STREAM.md, "View").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "codec/log/log_index.h"
#include "proto/stream_request.h"
#include "server/stream/log_front.h"

namespace qtet {

/// How near to what the view wants, in the order of sending.
enum class Tier : std::uint8_t {
  kWanted,  ///< seen, and on a clip plane, in the box or met by an isosurface where there are any
  kSeen,    ///< in the frustum, but on no plane, not in the box and met by none
  kRest,    ///< behind the camera
};

/// Monotone: a packet is in the same tier as its parent or in a later one, so that what is wanted
/// is closed under dependencies.
class ViewRequest {
 public:
  /// A box's 256ths become lengths by the manifest's lattice. An isovalue whose intervals are
  /// unknown counts for nothing. The log outlives the object.
  ViewRequest(const View& view, const LogFront& log);

  /// REQUIRES: a chunk of the log.
  [[nodiscard]] Tier tierOf(std::uint32_t packet) const;
  /// The weight of an error in the box. It is 1 at the view's point and without a point. It falls
  /// with the square of the distance, like the visible size.
  [[nodiscard]] double weightOf(const PacketBox& box) const;

 private:
  struct Box {
    std::array<double, 3> least, most;
  };
  [[nodiscard]] Box inSpace(const PacketBox& box) const;
  [[nodiscard]] bool isSeen(const Box& box) const;
  [[nodiscard]] bool isAtAPlace(const Box& box) const;
  [[nodiscard]] bool isMet(std::uint32_t packet) const;

  View view_;
  LogFront log_;
  std::optional<std::size_t> column_;  ///< of the isovalue's intervals
  std::array<double, 3> origin_;
  double size_;  ///< of the lattice along each axis
};

}  // namespace qtet
