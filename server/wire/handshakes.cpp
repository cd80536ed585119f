#include "server/wire/handshakes.h"

#include <boost/asio/post.hpp>

namespace qtet {

Handshakes::Counts Handshakes::counts() const {
  const std::scoped_lock lock(mutex_);
  return {open_.size(), waiting_.size(), displaced_};
}

/// Wakes the entry later, and only if its state has not changed meanwhile. If it took a place by
/// itself, the call to take one must not interrupt it.
void Handshakes::wake(const EntryPointer& entry) {
  boost::asio::post(entry->executor, [entry, as = entry->state.load()] {
    if (entry->wake && entry->state == as) entry->wake();
  });
}

void Handshakes::wakeFirst() {
  if (!waiting_.empty()) wake(waiting_.front());
}

std::optional<Handshakes::Clock::time_point> Handshakes::enter(const EntryPointer& entry) {
  const std::scoped_lock lock(mutex_);
  if (entry->state == State::kNew) {
    entry->state = State::kWaits;
    entry->at = waiting_.insert(waiting_.end(), entry);
  }
  // Those behind the first are woken when they are the first.
  if (waiting_.front() != entry) return Clock::time_point::max();
  const auto now = Clock::now();
  if (open_.size() >= most_) {
    const EntryPointer oldest = open_.front();
    if (oldest->since + patience_ > now) return oldest->since + patience_;
    open_.pop_front();
    oldest->state = State::kDisplaced;
    ++displaced_;
    wake(oldest);
  }
  entry->state = State::kHolds;
  entry->since = now;
  open_.splice(open_.end(), waiting_, entry->at);
  wakeFirst();
  return std::nullopt;
}

void Handshakes::leave(const EntryPointer& entry) {
  const std::scoped_lock lock(mutex_);
  const State left = entry->state;
  if (left != State::kWaits && left != State::kHolds) return;
  const bool first = entry->at == waiting_.begin();
  (left == State::kWaits ? waiting_ : open_).erase(entry->at);
  if (first || left == State::kHolds) wakeFirst();
}

Handshakes::Client::Client(Handshakes& handshakes, boost::asio::any_io_executor executor,
                           std::function<void()> wake)
    : handshakes_(handshakes),
      entry_(std::make_shared<Entry>(std::move(executor), std::move(wake))) {}

Handshakes::Client::~Client() {
  handshakes_.leave(entry_);
  entry_->wake = nullptr;
}

}  // namespace qtet
