#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/level_jobs.h"

#include <boost/asio/post.hpp>
#include <new>

#include "codec/boundary_drc.h"
#include "codec/vtu_writer.h"
#include "server/mesh_store.h"

namespace qtet {

Result<Bytes> makeLevel(const LevelRequest& request) {
  try {
    const Result<LatticeMesh> mesh = meshAtLevel(request.mesh->log, request.level);
    if (!mesh) return std::unexpected(mesh.error());
    if (request.form == LevelRequest::Form::kDrc) return boundaryDrc(*mesh);
    return vtuBytes(*mesh);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::kIo, "there is not enough memory for this level; ask for a coarser one");
  }
}

LevelJobs::LevelJobs(std::size_t threads, std::size_t places, Maker maker) : maker_(std::move(maker)), places_(places), pool_(threads) {}

LevelJobs::~LevelJobs() {
  pool_.stop();
  pool_.join();
}

LevelJobs::Place LevelJobs::reserve() {
  std::size_t taken = taken_->load();
  do {
    if (taken >= places_) return nullptr;
  } while (!taken_->compare_exchange_weak(taken, taken + 1));
  // The counter outlives the jobs: a reply that is still being sent may hold the last place.
  return {static_cast<void*>(taken_.get()), [counter = taken_](void*) { --*counter; }};
}

void LevelJobs::submit(LevelRequest request, Done done) {
  boost::asio::post(pool_, [this, request, done = std::move(done)]() mutable { done(maker_(request)); });
}

}  // namespace qtet
