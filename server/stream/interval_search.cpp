#include "server/stream/interval_search.h"

#include <spdlog/spdlog.h>

#include <boost/asio/post.hpp>
#include <optional>

#include "server/store/packet_intervals.h"

namespace qtet {

void IntervalSearch::want(const MeshPointer& mesh) {
  if (jobs_ == nullptr || mesh == mesh_) return;
  subscription_ = {};
  mesh_ = nullptr;
  if (!mesh) return;
  const LevelRequest request{mesh, 0, LevelForm::kIntervals};
  const auto keep = [mesh](const LevelFile& table) {
    mesh->intervals->put(PacketIntervals::decode(table.bytes, mesh->log.index(), mesh->manifest));
  };
  if (const std::optional<LevelFile> kept = jobs_->find(request)) {
    keep(*kept);
    return (*found_)(mesh);
  }
  auto done = [keep, mesh, weak = std::weak_ptr(found_),
               executor = executor_](Result<LevelFile> table) {
    if (table)
      keep(*table);
    else
      spdlog::error("{}: the values of its packets cannot be found: {}", mesh->id,
                    table.error().text());
    // nor by trying again
    if (!table && table.error().code != ErrorCode::kIo) mesh->intervals->put({});
    boost::asio::post(executor, [mesh, weak] {
      if (const auto found = weak.lock()) (*found)(mesh);
    });
  };
  auto subscription = jobs_->submit(request, std::move(done), from_);
  if (!subscription) return;  // too many jobs; the next view tries again
  subscription_ = std::move(*subscription);
  mesh_ = mesh;
}

}  // namespace qtet
