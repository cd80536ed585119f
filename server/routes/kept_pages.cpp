#include "server/routes/kept_pages.h"

#include <cassert>
#include <utility>

namespace qtet {

KeptPagePointer KeptPages::find(const std::string& key) {
  const std::scoped_lock lock(mutex_);
  const auto found = pages_.find(key);
  if (found == pages_.end()) return nullptr;
  uses_.splice(uses_.begin(), uses_, found->second.use);
  return found->second.page;
}

void KeptPages::keep(const std::string& key, KeptPagePointer page) {
  assert(page);
  const std::size_t cost = page->cost();
  const std::scoped_lock lock(mutex_);
  if (cost > maxBytes_ || pages_.contains(key)) return;
  while (bytes_ + cost > maxBytes_) {
    const auto oldest = pages_.find(uses_.back());
    assert(oldest != pages_.end() && oldest->second.page->cost() <= bytes_);
    bytes_ -= oldest->second.page->cost();
    pages_.erase(oldest);
    uses_.pop_back();
  }
  uses_.push_front(key);
  pages_.emplace(key, Entry{std::move(page), uses_.begin()});
  bytes_ += cost;
  assert(pages_.size() == uses_.size() && bytes_ <= maxBytes_);
}

std::size_t KeptPages::bytes() const {
  const std::scoped_lock lock(mutex_);
  return bytes_;
}

}  // namespace qtet
