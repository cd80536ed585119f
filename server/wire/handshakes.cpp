#include "server/wire/handshakes.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <cassert>

namespace qtet {

Handshakes::Counts Handshakes::counts() const {
  const std::scoped_lock lock(mutex_);
  return {open_.size(), waiting_.size() + aside_, displaced_};
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

void Handshakes::admit(const EntryPointer& entry) {
  entry->state = State::kWaits;
  entry->at = waiting_.insert(waiting_.end(), entry);
  if (entry->address != nullptr) ++addresses_[entry->address].admitted;
}

void Handshakes::admitNextOf(const void* address) {
  const auto found = addresses_.find(address);
  if (found == addresses_.end()) return;
  auto& [admitted, aside] = found->second;
  assert(admitted > 0);
  --admitted;
  if (!aside.empty()) {
    const EntryPointer next = aside.front();
    aside.pop_front();
    assert(aside_ > 0);
    --aside_;
    admit(next);
    wake(next);
    if (!aside.empty()) wake(aside.front());
  }
  if (admitted == 0) addresses_.erase(found);
}

void Handshakes::displace(const EntryPointer& entry) {
  assert(entry->state == State::kHolds);
  open_.erase(entry->at);
  entry->state = State::kDisplaced;
  ++displaced_;
  wake(entry);
  admitNextOf(entry->address);
}

/// The first one aside takes the place of the oldest of its own address.
std::optional<Handshakes::Clock::time_point> Handshakes::waitAside(const EntryPointer& entry,
                                                                   Clock::time_point now) {
  // Those behind the first are woken when they are the first.
  if (addresses_[entry->address].aside.front() != entry) return Clock::time_point::max();
  const auto oldest = std::ranges::find(open_, entry->address, &Entry::address);
  if (oldest == open_.end()) return now + bounds_.patience;
  if ((*oldest)->since + bounds_.patience > now) return (*oldest)->since + bounds_.patience;
  displace(EntryPointer(*oldest));
  return std::nullopt;
}

std::optional<Handshakes::Clock::time_point> Handshakes::enter(const EntryPointer& entry) {
  const std::scoped_lock lock(mutex_);
  const auto now = Clock::now();
  if (entry->state == State::kNew) {
    if (entry->address == nullptr || addresses_[entry->address].admitted < bounds_.ofAddress) {
      admit(entry);
    } else {
      Line& aside = addresses_[entry->address].aside;
      entry->state = State::kAside;
      entry->at = aside.insert(aside.end(), entry);
      ++aside_;
    }
  }
  if (entry->state == State::kAside)
    if (const auto again = waitAside(entry, now)) return again;
  // Those behind the first are woken when they are the first.
  if (waiting_.front() != entry) return Clock::time_point::max();
  if (open_.size() >= bounds_.most) {
    const EntryPointer oldest = open_.front();
    if (oldest->since + bounds_.patience > now) return oldest->since + bounds_.patience;
    displace(oldest);
  }
  entry->state = State::kHolds;
  entry->since = now;
  open_.splice(open_.end(), waiting_, entry->at);
  assert(open_.size() <= bounds_.most);
  wakeFirst();
  return std::nullopt;
}

void Handshakes::leave(const EntryPointer& entry) {
  const std::scoped_lock lock(mutex_);
  const State left = entry->state;
  if (left == State::kAside) {
    Line& aside = addresses_[entry->address].aside;
    const bool first = entry->at == aside.begin();
    aside.erase(entry->at);
    --aside_;
    if (first && !aside.empty()) wake(aside.front());
  }
  if (left != State::kWaits && left != State::kHolds) return;
  const bool first = entry->at == waiting_.begin();
  (left == State::kWaits ? waiting_ : open_).erase(entry->at);
  admitNextOf(entry->address);
  if (first || left == State::kHolds) wakeFirst();
}

Handshakes::Client::Client(Handshakes& handshakes, boost::asio::any_io_executor executor,
                           std::function<void()> wake, const void* address)
    : handshakes_(handshakes),
      entry_(std::make_shared<Entry>(std::move(executor), std::move(wake), address)) {}

Handshakes::Client::~Client() {
  handshakes_.leave(entry_);
  entry_->wake = nullptr;
}

}  // namespace qtet
