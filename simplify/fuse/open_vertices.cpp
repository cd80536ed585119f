#include "simplify/fuse/open_vertices.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace qtet {
namespace {

// Vertices whose candidates are found at once, and how many of them a thread takes at a time.
constexpr std::size_t kCollected = 4096;
constexpr std::size_t kGrain = 8;
// Vertices of the queue that a thread takes at a time.
constexpr std::size_t kFilled = 1024;
// How many fused vertices ahead the memory is asked for what their candidates are found from.
constexpr std::size_t kFusedAhead = 2;
// The same of vertices for the queue.
constexpr std::size_t kListsAhead = 8;
// Candidates a vertex, most of the time: 7 in a large mesh, and gaps of as many.
constexpr std::size_t kMaxCandidates = 16;

/// Where the remaining part of a run of vertices ends.
struct Filled {
  std::size_t vertices = 0, entries = 0;
};

// Moves the remaining part of each run of kFilled up to the one before.
template <class T>
void joinRuns(std::vector<T>& all, std::span<const Filled> filled, std::size_t Filled::* end) {
  const auto place = [&](std::size_t i) { return all.begin() + static_cast<std::ptrdiff_t>(i); };
  auto to = filled.empty() ? all.begin() : place(filled[0].*end);
  for (std::size_t run = 1; run < filled.size(); ++run)
    to = std::copy(place(run * kFilled), place(filled[run].*end), to);
  all.erase(to, all.end());
}

}  // namespace

void OpenVertices::findAll() {
  const FusionMesh& mesh = state_.mesh();
  state_.candidates().clear();
  vertices_.clear();
  for (VertexId v = 0; v < mesh.vertexSlots(); ++v)
    if (mesh.alive(v) && !mesh.singular(v)) vertices_.push_back(v);
  state_.candidates().reserve(kMaxCandidates * vertices_.size());
  collect(vertices_, [&](FusionProposer& proposer, std::size_t i, std::vector<Candidate>& found) {
    proposer.candidatesOf(vertices_[i], found);
  });
}

void OpenVertices::add(const LevelFusions& level) {
  const std::span<const VertexId> fused = level.fused();
  assert(fused.empty() || vertices_.empty() || vertices_.back() < fused.front());
  vertices_.insert(vertices_.end(), fused.begin(), fused.end());
  collect(fused, [&](FusionProposer& proposer, std::size_t i, std::vector<Candidate>& found) {
    if (i + kFusedAhead < fused.size()) prefetchFused(level, i + kFusedAhead);
    proposer.candidatesOf(fused[i], level.linkOf(i), found);
  });
  state_.candidates().compact();
}

// Asks the memory for what the candidates of a fused vertex are found from.
void OpenVertices::prefetchFused(const LevelFusions& level, std::size_t i) const {
  const FusionMesh& mesh = state_.mesh();
  const FusionCost& cost = state_.cost();
  mesh.prefetchStar(level.fused()[i]), cost.prefetch(level.fused()[i]);
  for (const VertexId v : level.linkOf(i))
    if (v != kGhost) cost.prefetch(v), mesh.prefetchPoint(v);
}

// The candidates of these vertices, found in parallel, kept in order: find(proposer, index, found).
template <class Find>
void OpenVertices::collect(std::span<const VertexId> vertices, const Find& find) {
  assert(proposers_.size() == workers_.count());
  found_.resize(std::max(found_.size(), std::min(vertices.size(), kCollected)));
  for (std::size_t first = 0; first < vertices.size(); first += kCollected) {
    const auto part = vertices.subspan(first, std::min(kCollected, vertices.size() - first));
    workers_.forEach(part.size(), kGrain, [&](std::size_t worker, std::size_t i) {
      find(*proposers_[worker], first + i, found_[i]);
    });
    state_.candidates().set(part, found_, workers_);
  }
}

void OpenVertices::fill(std::vector<QueueEntry>& entries) {
  Candidates& candidates = state_.candidates();
  entries.resize(vertices_.size());
  std::vector<Filled> filled((vertices_.size() + kFilled - 1) / kFilled);
  workers_.forRuns(vertices_.size(), kFilled, [&](std::size_t begin, std::size_t end) {
    Filled left{begin, begin};
    for (std::size_t i = begin; i < end; ++i) {
      if (i + 2 * kListsAhead < end) candidates.prefetch(vertices_[i + 2 * kListsAhead]);
      if (i + kListsAhead < end) candidates.prefetchBest(vertices_[i + kListsAhead]);
      const VertexId v = vertices_[i];
      // what its old neighbours forbade the new ones may allow
      if (candidates.hasFailed(v) && state_.changes().isLocked(v)) candidates.restart(v);
      const Candidate* best = state_.bestAlive(v);
      assert(left.vertices <= i && left.entries <= left.vertices);
      vertices_[left.vertices] = v;
      left.vertices += !candidates.isEmpty(v);
      entries[left.entries] = {best ? best->key : 0, v};
      left.entries += best != nullptr && best->key <= std::numeric_limits<float>::max();
    }
    filled[begin / kFilled] = left;
  });
  joinRuns(vertices_, filled, &Filled::vertices);
  joinRuns(entries, filled, &Filled::entries);
  assert(entries.size() <= vertices_.size());
}

}  // namespace qtet
