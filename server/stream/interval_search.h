// Has the intervals of a log's packets found for one session whose view asks for them.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/any_io_executor.hpp>
#include <functional>
#include <memory>

#include "server/store/level_jobs.h"
#include "server/store/mesh_store.h"

namespace qtet {

/// One search at a time, which ends with the object. For its executor alone.
class IntervalSearch {
 public:
  /// Says of a mesh that its intervals are known, or never will be.
  using Found = std::function<void(const MeshPointer&)>;

  /// `jobs` makes what is not kept; nullptr: nothing is ever found. `from` is for whom, and
  /// outlives the object. `found` runs on `executor`, or within want().
  IntervalSearch(LevelJobs* jobs, LevelJobs::Address from, boost::asio::any_io_executor executor,
                 Found found)
      : jobs_(jobs),
        from_(from),
        executor_(std::move(executor)),
        found_(std::make_shared<const Found>(std::move(found))) {}

  /// The mesh whose intervals are wanted now; nullptr: none. A search for another one ends.
  void want(const MeshPointer& mesh);

 private:
  LevelJobs* jobs_;
  LevelJobs::Address from_;
  boost::asio::any_io_executor executor_;
  std::shared_ptr<const Found> found_;  ///< gone with the object, whatever is still on its way
  LevelJobs::Subscription subscription_;
  MeshPointer mesh_;  ///< the subscription's; nullptr: there is none
};

}  // namespace qtet
