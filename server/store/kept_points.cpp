#include "server/store/kept_points.h"

#include <cassert>
#include <functional>
#include <utility>

namespace qtet {

KeptAnswer KeptPoints::atHand(const std::string& key) {
  const std::scoped_lock lock(mutex_);
  const auto it = byKey_.find(key);
  if (it == byKey_.end()) return std::nullopt;
  entries_.splice(entries_.begin(), entries_, it->second);
  return it->second->answer;
}

bool KeptPoints::has(const std::string& key) const {
  const std::scoped_lock lock(mutex_);
  return byKey_.contains(key);
}

Result<LevelFile> KeptPoints::put(const std::string& key, Result<LevelFile> made) {
  if (!made && made.error().code != ErrorCode::kNotFound) return made;
  const std::uint64_t bytes =
      2 * key.size() + (made ? made->bytes.size() : made.error().message.size());
  if (bytes > maxBytes_) return made;
  const std::scoped_lock lock(mutex_);
  if (byKey_.contains(key)) return made;
  entries_.push_front({key, made, bytes});
  byKey_[key] = entries_.begin();
  bytes_ += bytes;
  while (bytes_ > maxBytes_ || entries_.size() > most_) forgetOldest();
  return made;
}

void KeptPoints::forgetOldest() {
  assert(!entries_.empty() && entries_.back().bytes <= bytes_);
  bytes_ -= entries_.back().bytes;
  byKey_.erase(entries_.back().key);
  entries_.pop_back();
  assert(byKey_.size() == entries_.size());
}

std::uintmax_t KeptPoints::bytes() const {
  const std::scoped_lock lock(mutex_);
  return bytes_;
}

}  // namespace qtet
