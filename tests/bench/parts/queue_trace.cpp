#include "tests/bench/parts/queue_trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>

namespace qtet::bench {
namespace {

constexpr double kQuantile = 0.35;
constexpr double kLeft = 0.01;          // of the vertices, at the end
constexpr std::uint32_t kIllegal = 20;  // one candidate in so many
// steps over locations that a vertex swallowed, before it has no neighbour in a direction
constexpr int kReach = 8;

/// A stray number from 0 to 1 that depends on nothing but its arguments.
double noise(std::uint32_t a, std::uint32_t b) {
  std::uint64_t x = (std::uint64_t{a} << 32 | b) * 0x9E3779B97F4A7C15u;
  x ^= x >> 29, x *= 0xBF58476D1CE4E5B9u, x ^= x >> 32;
  return static_cast<double>(x >> 11) * 0x1p-53;
}

struct Candidate {
  float key = 0;
  std::uint32_t partner = 0;
};

class Model {
 public:
  explicit Model(std::uint32_t vertices) : side_(static_cast<std::int64_t>(std::cbrt(vertices))) {
    const auto locations = static_cast<std::size_t>(side_ * side_ * side_);
    occupant_.resize(locations);
    std::iota(occupant_.begin(), occupant_.end(), 0u);
    live_ = occupant_.size();
    error_.reserve(2 * locations);
    std::mt19937 random(1);
    // Errors spread over a few decades, as in a graded mesh.
    for (std::size_t i = 0; i < locations; ++i)
      error_.push_back(static_cast<float>(
          std::exp(4 * std::sin(9.0 * static_cast<double>(i) / static_cast<double>(locations)) +
                   static_cast<double>(random() % 1024) / 512)));
    location_ = occupant_;
    vertexAt_ = occupant_;
    alive_.assign(locations, 1);
    current_.resize(locations);
    locked_.assign(locations, 0);
    target_ = static_cast<std::size_t>(kLeft * static_cast<double>(locations));
  }

  QueueTrace run() {
    for (std::uint32_t v = 0; v < error_.size(); ++v) offerNext(v, 0);
    while (!queue_.empty() && live_ > target_) runLevel();
    return std::move(trace_);
  }

 private:
  void push(const QueueEntry& entry) {
    queue_.push_back(entry);
    std::ranges::push_heap(queue_, after);
    trace_.operations.push_back(entry);
  }
  QueueEntry pop() {
    std::ranges::pop_heap(queue_, after);
    const QueueEntry top = queue_.back();
    queue_.pop_back();
    trace_.operations.push_back({QueueTrace::kPop, 0});
    trace_.checksum = withPopped(trace_.checksum, top.owner);
    ++trace_.pops;
    return top;
  }
  static bool after(const QueueEntry& a, const QueueEntry& b) { return b.isBefore(a); }

  std::uint32_t rootOf(std::uint32_t location) {
    while (occupant_[location] != location)
      location = occupant_[location] = occupant_[occupant_[location]];
    return location;
  }

  /// The vertices next to v in the fourteen directions of a grid of tetrahedra; some twice.
  std::vector<std::uint32_t>& neighbours(std::uint32_t v) {
    static constexpr std::array<std::array<int, 3>, 7> kDirections{
        {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}, {1, 1, 1}}};
    neighbours_.clear();
    const std::int64_t at = location_[v];
    const std::array<std::int64_t, 3> place{at / (side_ * side_), at / side_ % side_, at % side_};
    for (const auto& direction : kDirections)
      for (const int sign : {1, -1})
        if (const auto found = neighbour(v, place, direction, sign)) neighbours_.push_back(*found);
    return neighbours_;
  }

  std::optional<std::uint32_t> neighbour(std::uint32_t v, std::array<std::int64_t, 3> place,
                                         const std::array<int, 3>& direction, int sign) {
    for (int step = 0; step < kReach; ++step) {
      for (std::size_t k = 0; k < 3; ++k) {
        place[k] += sign * direction[k];
        if (place[k] < 0 || place[k] >= side_) return std::nullopt;
      }
      const std::uint32_t other = vertexAt_[rootOf(
          static_cast<std::uint32_t>((place[0] * side_ + place[1]) * side_ + place[2]))];
      if (other != v) return other;
    }
    return std::nullopt;
  }

  /// The vertex's cheapest candidate above `floor`, of those with an older partner.
  bool next(std::uint32_t v, float floor) {
    std::optional<Candidate> best;
    for (const std::uint32_t partner : neighbours(v)) {
      if (partner > v) continue;
      const auto key =
          static_cast<float>((error_[v] + error_[partner]) * (0.2 + noise(v, partner)));
      if (key > floor && (!best || key < best->key)) best = {key, partner};
    }
    if (best) current_[v] = *best;
    return best.has_value();
  }

  void offerNext(std::uint32_t v, float floor) {
    if (next(v, floor)) push({current_[v].key, v});
  }

  void runLevel() {
    std::vector<float> keys;
    for (const QueueEntry& entry : queue_) keys.push_back(entry.key);
    const auto quantile =
        keys.begin() + static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(keys.size()));
    std::ranges::nth_element(keys, quantile);
    const float limit = *quantile;
    const std::uint64_t fused = trace_.fused;
    ++trace_.levels;
    while (!queue_.empty() && live_ > target_ &&
           (queue_.front().key <= limit || trace_.fused == fused))
      process(pop());
    for (const QueueEntry& entry : deferred_) push(entry);
    deferred_.clear();
  }

  void process(const QueueEntry& top) {
    const std::uint32_t v = top.owner;
    const Candidate candidate = current_[v];
    if (!alive_[v]) {
      ++trace_.dead;
    } else if (!alive_[candidate.partner]) {
      ++trace_.gone;
      offerNext(v, candidate.key);
    } else if (locked_[v] == trace_.levels || locked_[candidate.partner] == trace_.levels) {
      ++trace_.locked;
      deferred_.push_back(top);
    } else if (static_cast<std::uint32_t>(noise(candidate.partner, v) * kIllegal) == 0) {
      ++trace_.illegal;
      offerNext(v, candidate.key);
    } else {
      fuse(v, candidate.partner);
    }
  }

  void fuse(std::uint32_t v, std::uint32_t partner) {
    ++trace_.fused;
    --live_;
    const auto fused = static_cast<std::uint32_t>(error_.size());
    error_.push_back(error_[v] + error_[partner]);
    alive_[v] = alive_[partner] = 0;
    alive_.push_back(1);
    const std::uint32_t place = rootOf(location_[v]);
    occupant_[rootOf(location_[partner])] = place;
    vertexAt_[place] = fused;
    location_.push_back(location_[v]);
    current_.emplace_back();
    locked_.push_back(trace_.levels);
    for (const std::uint32_t other : neighbours(fused)) locked_[other] = trace_.levels;
    if (next(fused, 0)) deferred_.push_back({current_[fused].key, fused});
  }

  std::int64_t side_;
  std::size_t live_ = 0, target_ = 0;
  // by location: towards the location whose vertex swallowed it
  std::vector<std::uint32_t> occupant_;
  std::vector<std::uint32_t> vertexAt_;  // by location that is its own occupant
  std::vector<std::uint32_t> location_;  // by vertex
  std::vector<float> error_;             // by vertex
  std::vector<std::uint8_t> alive_;
  std::vector<Candidate> current_;
  std::vector<std::uint64_t> locked_;  // by vertex: the level that locked it last
  std::vector<std::uint32_t> neighbours_;
  std::vector<QueueEntry> queue_, deferred_;
  QueueTrace trace_;
};

}  // namespace

QueueTrace recordQueueTrace(std::uint32_t vertices) { return Model(vertices).run(); }

}  // namespace qtet::bench
