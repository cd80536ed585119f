#include <cassert>
#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/wire/connections.h"

#include <boost/asio/post.hpp>
#include <vector>

namespace qtet {

void Connection::requestEnd(const std::shared_ptr<Connection>& connection) {
  boost::asio::post(connection->executor_, [connection] {
    connection->ending_ = true;
    if (connection->wake_) connection->wake_();
  });
}

std::shared_ptr<Connection> Connections::enter(boost::asio::any_io_executor executor) {
  const std::scoped_lock lock(mutex_);
  if (ending_ || open_.size() >= most_) return nullptr;
  // The deleter takes the connection off the list before it goes, so that endAll never meets a dead
  // one.
  std::shared_ptr<Connection> out(new Connection(std::move(executor)),
                                  [this, number = ++entered_](Connection* connection) {
                                    leave(number);
                                    delete connection;
                                  });
  open_.emplace(entered_, out);
  assert(open_.size() <= most_);
  return out;
}

std::size_t Connections::open() const {
  const std::scoped_lock lock(mutex_);
  return open_.size();
}

void Connections::leave(std::uint64_t number) {
  std::function<void()> whenEmpty;
  {
    const std::scoped_lock lock(mutex_);
    [[maybe_unused]] const std::size_t gone = open_.erase(number);
    assert(gone == 1);
    if (ending_ && open_.empty()) whenEmpty = std::exchange(whenEmpty_, nullptr);
  }
  if (whenEmpty) whenEmpty();
}

void Connections::endAll(std::function<void()> whenEmpty) {
  // held past the lock: the last owner's deleter takes it again
  std::vector<std::shared_ptr<Connection>> open;
  {
    const std::scoped_lock lock(mutex_);
    ending_ = true;
    if (!open_.empty()) whenEmpty_ = std::exchange(whenEmpty, nullptr);
    for (const auto& [number, weak] : open_)
      if (auto connection = weak.lock()) open.push_back(std::move(connection));
  }
  for (const auto& connection : open) Connection::requestEnd(connection);
  if (whenEmpty) whenEmpty();
}

}  // namespace qtet
