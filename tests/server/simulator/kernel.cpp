#include "tests/server/simulator/kernel.h"

#include <algorithm>
#include <array>
#include <cerrno>

#include "tests/support/allocation_meter.h"

namespace qtet::simulator {
namespace {

/// Bytes that arrive at once: what the line carries in this time, at least a packet, and at most
/// what a network card cuts itself.
constexpr double kSegmentSeconds = .01;
constexpr std::size_t kPacket = 1448, kMaxSegment = 64 << 10;
/// Bytes that the server's kernel holds for the server.
constexpr std::size_t kServerWindow = 128 << 10;

struct Account {
  std::int64_t held = 0;
  std::uint64_t allocations = 0;
};
std::array<Account, 2> accounts;
Account last;  // of both together, when the account was changed
MemoryOf::Whose whose = MemoryOf::Whose::kServer;

/// Allocations since the last change go to the account in force.
void change(MemoryOf::Whose to) {
  const Account now{testing::heldBytes(), testing::allocations()};
  Account& account = accounts[static_cast<std::size_t>(whose)];
  account.held += now.held - last.held;
  account.allocations += now.allocations - last.allocations;
  last = now;
  whose = to;
}

}  // namespace

MemoryOf::MemoryOf(Whose to) : before_(whose) { change(to); }

MemoryOf::~MemoryOf() { change(before_); }

std::int64_t MemoryOf::server() {
  change(whose);
  return accounts[static_cast<std::size_t>(Whose::kServer)].held;
}

std::uint64_t MemoryOf::serverAllocations() {
  change(whose);
  return accounts[static_cast<std::size_t>(Whose::kServer)].allocations;
}

std::string Socket::text() const {
  std::string out = "socket " + std::to_string(descriptor - Kernel::kFirstDescriptor) + ", " +
                    std::to_string(line.bytesPerSecond / 1000) + " KB/s, " +
                    std::to_string(line.latency / 1us) + " us, buffer " +
                    std::to_string(line.buffer) + ", window " + std::to_string(line.window);
  for (const auto& [name, value] : {std::pair<const char*, std::size_t>{"coming", coming.size()},
                                    {"arrived", arrived.size()},
                                    {"unsent", unsent.size()},
                                    {"under way", underWay},
                                    {"unread", unread.size()},
                                    {"acknowledged", acknowledged}})
    out += ", " + std::to_string(value) + " " + name;
  for (const auto& [name, is] : {std::pair<const char*, bool>{"lacks room", lacksRoom},
                                 {"shut", shut},
                                 {"lost", lost},
                                 {"closed", closed},
                                 {"queued", queued}})
    if (is) out += std::string(", ") + name;
  return out;
}

void Kernel::note(std::uint64_t what) {
  trace_ = (trace_ ^ what ^ static_cast<std::uint64_t>(now_.count())) * 1099511628211u;
}

Time Kernel::look() {
  const std::uint64_t count = MemoryOf::serverAllocations();
  pass(kLook + kAllocation * static_cast<std::int64_t>(count - std::exchange(allocations_, count)));
  return now_;
}

void Kernel::account(std::size_t bytes) {
  ++calls_;
  pass(kCall + Time(bytes / 4));
}

void Kernel::at(Time when, std::function<void()> what) {
  events_.push({std::max(when, now_), numbers_++, std::move(what)});
}

void Kernel::runDue() {
  while (!events_.empty() && events_.top().when <= now_) {
    // the queue shows its first element unchangeable, and drops it at once
    const std::function<void()> what = std::move(const_cast<Event&>(events_.top()).what);
    events_.pop();
    what();
  }
}

// ---- readiness

bool Kernel::hasRoom(const Socket& socket) {
  // the kernel reports room once a third of the buffer is free (sk_stream_is_writeable)
  return socket.lost || socket.shut ||
         ((socket.unsent.size() + socket.underWay) * 3 <= socket.line.buffer * 2 &&
          socket.unsent.size() < socket.maxUnsent);
}

std::uint32_t Kernel::readiness(const Socket& socket) {
  std::uint32_t out = 0;
  if (!socket.arrived.empty() || socket.endArrived || socket.lost) out |= EPOLLIN;
  if (hasRoom(socket)) out |= EPOLLOUT;
  if (socket.lost) out |= EPOLLERR | EPOLLHUP;
  if (socket.endArrived && socket.shut) out |= EPOLLHUP;
  return out;
}

void Kernel::queue(Socket& socket) {
  if (socket.queued || socket.interest == 0) return;
  socket.queued = true;
  ready_.push_back(socket.descriptor);
}

int Kernel::poll(std::span<epoll_event> events, int milliseconds) {
  const MemoryOf own(kOwn);
  account(0);
  turn_ = look() - woke_;
  const Time end = milliseconds < 0 ? Time::max() : now_ + std::chrono::milliseconds(milliseconds);
  for (;;) {
    runDue();
    if (eachStep) eachStep();
    std::size_t count = 0;
    if (std::exchange(interrupted_, false))
      events[count++] = {.events = EPOLLIN, .data = {.ptr = interrupter_}};
    std::vector<int> rest;
    for (const int descriptor : std::exchange(ready_, {})) {
      Socket* const socket = find(descriptor);
      if (socket == nullptr) continue;
      if (count == events.size()) {
        rest.push_back(descriptor);
        continue;
      }
      socket->queued = false;
      const std::uint32_t now = readiness(*socket) & (socket->interest | EPOLLERR | EPOLLHUP);
      if (now != 0) events[count++] = {.events = now, .data = {.ptr = socket->data}};
    }
    ready_.insert(ready_.end(), rest.begin(), rest.end());
    if (count > 0 || std::exchange(woken_, false) || now_ >= end) {
      woke_ = now_;
      return static_cast<int>(count);
    }
    if (events_.empty() && end == Time::max()) throw Violation{"nothing will ever happen again"};
    now_ = events_.empty() ? end : std::clamp(events_.top().when, now_, end);
  }
}

int Kernel::watch(int operation, int descriptor, const epoll_event* event) {
  const MemoryOf own(kOwn);
  account(0);
  if (descriptor < kFirstDescriptor) {  // Asio's, always readable
    interrupter_ = event != nullptr ? event->data.ptr : nullptr;
    interrupted_ = operation != EPOLL_CTL_DEL;
    return 0;
  }
  Socket* const socket = find(descriptor);
  if (socket == nullptr) return -EBADF;
  socket->interest = operation == EPOLL_CTL_DEL ? 0 : event->events;
  if (operation == EPOLL_CTL_DEL) return 0;
  socket->data = event->data.ptr;
  if ((socket->interest & EPOLLOUT) != 0 && !hasRoom(*socket)) socket->lacksRoom = true;
  if ((readiness(*socket) & (socket->interest | EPOLLERR | EPOLLHUP)) != 0) queue(*socket);
  return 0;
}

// ---- from the client

SocketPointer Kernel::connect(LineKind line, std::uint32_t address, ClientEnd& client) {
  auto out = std::make_shared<Socket>();
  out->descriptor = nextDescriptor_++;
  out->line = line;
  out->address = address;
  out->client = &client;
  sockets_[out->descriptor] = out;
  return out;
}

void Kernel::send(const SocketPointer& socket, std::string_view bytes) {
  if (socket->endComes || socket->lost) return;
  socket->coming += bytes;
  if (!socket->comingMoves) moveComing(socket, socket->line.latency);
}

void Kernel::finish(const SocketPointer& socket) {
  socket->endComes = true;
  if (!socket->comingMoves) moveComing(socket, socket->line.latency);
}

/// Fragments arrive one after the other, as far as the server's kernel has room for them.
void Kernel::moveComing(const SocketPointer& socket, Time delay) {
  if (socket->lost || socket->endArrived) return;
  const std::size_t room = kServerWindow - std::min(kServerWindow, socket->arrived.size());
  socket->comingMoves = !socket->coming.empty() ? room > 0 : socket->endComes;
  if (!socket->comingMoves) return;
  const std::size_t most = std::min(room, socket->coming.size());
  const std::size_t count =
      most < 2 || random_.chance(700) ? most : random_.between(1, random_.chance(200) ? 2 : most);
  std::string piece = socket->coming.substr(0, count);
  socket->coming.erase(0, count);
  const bool isEnd = piece.empty();
  after(delay, [this, socket, isEnd, piece = std::move(piece)] {
    if (socket->lost) return;
    if (socket->closed) {
      if (!piece.empty()) tellClientLost(socket);
      return;
    }
    socket->arrived += piece;
    socket->endArrived |= isEnd;
    note(piece.size());
    queue(*socket);
    moveComing(socket, random_.between(Time(), 1ms));
  });
}

void Kernel::reset(const SocketPointer& socket) {
  socket->client = nullptr;
  after(socket->line.latency, [this, socket] { breakOff(socket); });
}

void Kernel::breakOff(const SocketPointer& socket) {
  if (socket->lost) return;
  socket->lost = true;
  socket->arrived.clear();
  socket->coming.clear();
  socket->unsent.clear();
  queue(*socket);
}

bool Kernel::breaksNow(int descriptor) {
  if (!random_.chance(faults.broken)) return false;
  const SocketPointer broken = pointer(descriptor);
  tellClientLost(broken);
  breakOff(broken);
  return true;
}

void Kernel::reportRoom(Socket& socket) {
  if (!socket.lacksRoom || !hasRoom(socket)) return;
  socket.lacksRoom = false;
  queue(socket);
}

void Kernel::tellClientLost(const SocketPointer& socket) {
  after(socket->line.latency, [socket] {
    if (socket->client == nullptr) return;
    socket->unread.clear();
    std::exchange(socket->client, nullptr)->ended(true);
  });
}

long Kernel::receive(int descriptor, std::span<char> into, bool peeks) {
  const MemoryOf own(kOwn);
  Socket* const socket = find(descriptor);
  if (socket == nullptr) return -EBADF;
  account(0);
  if (socket->lost) return -ECONNRESET;
  if (breaksNow(descriptor)) return -ETIMEDOUT;
  if (random_.chance(faults.interrupted)) return random_.chance(500) ? -EINTR : -EAGAIN;
  if (socket->arrived.empty()) return socket->endArrived ? 0 : -EAGAIN;
  std::size_t count = std::min(into.size(), socket->arrived.size());
  if (count > 1 && random_.chance(faults.shortCalls)) count = random_.between(1, count);
  std::copy_n(socket->arrived.begin(), count, into.begin());
  account(count);
  if (peeks) return static_cast<long>(count);
  socket->arrived.erase(0, count);
  note(count);
  if (!socket->comingMoves) moveComing(pointer(descriptor), socket->line.latency);
  return static_cast<long>(count);
}

// ---- to the client

long Kernel::sendBytes(int descriptor, std::string_view bytes) {
  const iovec part{const_cast<char*>(bytes.data()), bytes.size()};
  return sendAll(descriptor, {&part, 1});
}

std::size_t Kernel::roomOf(const Socket& socket) {
  const std::size_t held = socket.unsent.size() + socket.underWay;
  if (held >= socket.line.buffer || socket.unsent.size() >= socket.maxUnsent) return 0;
  return socket.line.buffer - held;
}

long Kernel::sendAll(int descriptor, std::span<const iovec> parts) {
  const MemoryOf own(kOwn);
  Socket* const socket = find(descriptor);
  if (socket == nullptr) return -EBADF;
  account(0);
  if (socket->lost) return -ECONNRESET;
  if (socket->shut) return -EPIPE;
  if (breaksNow(descriptor)) return -ECONNRESET;
  if (random_.chance(faults.interrupted)) return -EINTR;
  std::size_t room = roomOf(*socket);
  if (room == 0) {
    socket->lacksRoom = true;
    return -EAGAIN;
  }
  if (room > 1 && random_.chance(faults.shortCalls)) room = random_.between(1, room);
  std::size_t count = 0;
  for (const iovec& part : parts) {
    const std::size_t taken = std::min(part.iov_len, room - count);
    socket->unsent.append(static_cast<const char*>(part.iov_base), taken);
    count += taken;
  }
  account(count);
  note(count);
  transmit(pointer(descriptor));
  return static_cast<long>(count);
}

/// One segment is on the line at a time; what the client has not read bounds it as well.
void Kernel::transmit(const SocketPointer& socket) {
  if (socket->sends || socket->lost) return;
  const std::size_t used = socket->underWay + socket->unread.size();
  const std::size_t room = socket->line.window - std::min(socket->line.window, used);
  const std::size_t segment =
      std::clamp(static_cast<std::size_t>(socket->line.bytesPerSecond * kSegmentSeconds), kPacket,
                 kMaxSegment);
  const std::size_t count = std::min({socket->unsent.size(), room, segment});
  if (count == 0) {
    if (!socket->unsent.empty() || !socket->shut || std::exchange(socket->endSent, true)) return;
    at(std::max(now_, socket->lineFree) + socket->line.latency, [socket] {
      // behind what the client has not read
      if (socket->client != nullptr && socket->unread.empty())
        std::exchange(socket->client, nullptr)->ended(false);
    });
    return;
  }
  std::string piece = socket->unsent.substr(0, count);
  socket->unsent.erase(0, count);
  socket->underWay += count;
  socket->lineFree = std::max(now_, socket->lineFree) +
                     Time(static_cast<std::int64_t>(static_cast<double>(count) * 1e9 /
                                                    socket->line.bytesPerSecond));
  socket->sends = true;
  at(socket->lineFree, [this, socket] {
    socket->sends = false;
    transmit(socket);
  });
  at(socket->lineFree + socket->line.latency,
     [this, socket, piece = std::move(piece)] { arrive(socket, piece); });
  at(socket->lineFree + 2 * socket->line.latency, [this, socket, count] {
    socket->underWay -= count;
    socket->acknowledged += count;
    reportRoom(*socket);
    transmit(socket);
  });
  reportRoom(*socket);
}

void Kernel::arrive(const SocketPointer& socket, const std::string& bytes) {
  if (socket->lost) return;
  if (socket->client == nullptr) return breakOff(socket);  // nobody is there: reset
  socket->unread += bytes;
  if (socket->clientReads) readSome(socket, socket->unread.size());
}

void Kernel::setReads(const SocketPointer& socket, bool reads) {
  socket->clientReads = reads;
  if (reads) readSome(socket, socket->unread.size());
}

void Kernel::readSome(const SocketPointer& socket, std::size_t count) {
  if (socket->client == nullptr) return;
  const std::string bytes = socket->unread.substr(0, count);
  socket->unread.erase(0, bytes.size());
  if (!bytes.empty()) socket->client->hears(bytes);
  transmit(socket);
  if (socket->endSent && socket->unread.empty() && socket->unsent.empty() &&
      socket->underWay == 0 && socket->client != nullptr)
    std::exchange(socket->client, nullptr)->ended(false);
}

// ---- the end

int Kernel::finishSending(int descriptor) {
  const MemoryOf own(kOwn);
  const SocketPointer socket = pointer(descriptor);
  if (!socket) return -EBADF;
  account(0);
  if (socket->lost) return -ENOTCONN;
  socket->shut = true;
  transmit(socket);
  return 0;
}

/// With bytes that nobody has read, or for whom they are no more, a reset (RFC 9293, 3.10.4).
int Kernel::close(int descriptor) {
  const MemoryOf own(kOwn);
  const SocketPointer socket = pointer(descriptor);
  if (!socket) return -EBADF;
  account(0);
  note(0xC105Eu);
  sockets_.erase(descriptor);
  socket->closed = true;
  socket->interest = 0;
  if (socket->lost) return 0;
  if (!socket->arrived.empty()) {
    socket->unsent.clear();
    socket->lost = true;
    tellClientLost(socket);
    return 0;
  }
  socket->shut = true;
  transmit(socket);
  return 0;
}

Socket* Kernel::find(int descriptor) {
  const auto found = sockets_.find(descriptor);
  return found == sockets_.end() ? nullptr : found->second.get();
}

SocketPointer Kernel::pointer(int descriptor) {
  const auto found = sockets_.find(descriptor);
  return found == sockets_.end() ? nullptr : found->second;
}

}  // namespace qtet::simulator
