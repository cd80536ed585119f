// The wishes of a decoder's caller while it decodes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "codec/mesh/mesh.h"
#include "proto/error.h"
#include "proto/limits.h"

namespace qtet {

class GrowingMesh;
class Link;
struct Split;

/// Notified of every split just before it is applied. The link is labelled, and ids are those of
/// `mesh`.
class SplitObserver {
 public:
  virtual void beforeSplit(VertexId v, const GrowingMesh& mesh, const Link& link,
                           const Split& split) = 0;

 protected:
  ~SplitObserver() = default;
};

/// Asked whether decoding goes on. So a check of a stranger's log can stop inside a chunk, which
/// may be the whole log.
class LevelGate {
 public:
  virtual bool goOn() = 0;

 protected:
  ~LevelGate() = default;
};

/// Where to stop, whom to notify, whom to ask.
struct PatchRequests {
  std::uint32_t stopLevel = kMaxLevels + 1;
  SplitObserver* observer = nullptr;
  LevelGate* gate = nullptr;

  [[nodiscard]] Status mayGoOn() const {
    return gate == nullptr || gate->goOn() ? Status{}
                                           : fail(ErrorCode::kIo, "stopped, as was asked for");
  }
};

/// The size of the mesh when a level was complete.
struct LevelCounts {
  std::size_t vertices = 0, tetrahedra = 0, boundaryTriangles = 0;
};

}  // namespace qtet
