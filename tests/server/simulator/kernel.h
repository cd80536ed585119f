// A kernel of one's own beneath the server: its clock, its TCP connections, and its epoll. The
// linker leads the server's system calls here (system_calls.cpp), so the server and Asio are those
// of every other build.
#pragma once

#include <sys/epoll.h>
#include <sys/uio.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <queue>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/server/simulator/random.h"

namespace qtet::simulator {

using namespace std::chrono_literals;

/// Since the simulation's beginning.
using Time = std::chrono::nanoseconds;

/// An invariant does not hold. Nothing catches it but the simulator: it is no std::exception.
struct Violation {
  std::string what;
};

/// The line between a client and the server.
struct LineKind {
  Time latency = 20ms;             ///< one way
  double bytesPerSecond = 2e6;     ///< to the client
  std::size_t buffer = 256 << 10;  ///< bytes that the kernel holds for the client
  std::size_t window = 256 << 10;  ///< bytes that the client's kernel holds for it

  /// For so many bytes, all acknowledged.
  [[nodiscard]] Time timeFor(std::uint64_t bytes) const {
    const double trip = std::chrono::duration<double>(2 * latency).count();
    const double windows = static_cast<double>(std::min(buffer, window)) / trip;
    return Time(static_cast<std::int64_t>(static_cast<double>(bytes) * 1e9 /
                                          std::min(bytesPerSecond, windows)));
  }
};

/// The client's side of a connection. All is called between two turns of the server.
class ClientEnd {
 public:
  ClientEnd() = default;
  virtual ~ClientEnd() = default;
  ClientEnd(const ClientEnd&) = delete;
  ClientEnd& operator=(const ClientEnd&) = delete;

  virtual void hears(std::string_view bytes) = 0;
  /// No byte comes any more. `lost`: the connection broke, or the server reset it.
  virtual void ended(bool lost) = 0;
};

/// One connection, as the kernels of both sides know it.
struct Socket {
  int descriptor = -1;
  LineKind line;
  std::uint32_t address = 0;  ///< the client's, IPv4
  ClientEnd* client = nullptr;

  // from the client
  std::string coming;   ///< sent by the client, not there yet
  std::string arrived;  ///< not read by the server
  bool comingMoves = false, endComes = false, endArrived = false;

  // to the client
  std::string unsent;  ///< bytes
  std::size_t underWay = 0;
  std::uint64_t acknowledged = 0;
  std::string unread;  ///< in the client's kernel
  Time lineFree{};
  bool sends = false, lacksRoom = false, shut = false, endSent = false;
  std::size_t maxUnsent = ~std::size_t{0};  ///< TCP_NOTSENT_LOWAT
  bool clientReads = true;

  bool lost = false;    ///< broken; no byte moves
  bool closed = false;  ///< by the server

  // epoll, edge-triggered
  std::uint32_t interest = 0;
  void* data = nullptr;
  bool queued = false;

  /// For whoever looks for the reason of a violation.
  [[nodiscard]] std::string text() const;
};
using SocketPointer = std::shared_ptr<Socket>;

/// How often the server's calls fail, of 1,000.
struct Faults {
  unsigned shortCalls = 20;     ///< reads and writes that move less than they could
  unsigned interrupted = 5;     ///< EINTR, or EAGAIN for nothing
  unsigned broken = 0;          ///< connections that a read or write finds broken
  unsigned withoutFigures = 5;  ///< TCP_INFO
};

/// Whose memory is allocated and freed: the server's, unless a scope says otherwise.
class MemoryOf {
 public:
  enum class Whose : std::uint8_t { kServer, kSimulator };
  explicit MemoryOf(Whose whose);
  ~MemoryOf();
  MemoryOf(const MemoryOf&) = delete;
  MemoryOf& operator=(const MemoryOf&) = delete;

  /// Bytes that the server holds.
  [[nodiscard]] static std::int64_t server();
  /// Allocations of the server so far.
  [[nodiscard]] static std::uint64_t serverAllocations();

 private:
  Whose before_;
};
inline constexpr auto kOwn = MemoryOf::Whose::kSimulator;

class Kernel {
 public:
  explicit Kernel(std::uint64_t seed)
      : random_(seed), allocations_(MemoryOf::serverAllocations()) {}

  /// The one that answers this program's system calls; nullptr: the machine's.
  static inline Kernel* inForce = nullptr;
  /// Descriptors from this number on are this kernel's.
  static constexpr int kFirstDescriptor = 1 << 20;

  [[nodiscard]] Time now() const { return now_; }
  /// The same for the server, whose work is measured by its allocations.
  Time look();
  /// The server has computed for so long.
  void pass(Time time) { now_ += time; }
  /// Calls `what` then, between two turns of the server.
  void at(Time when, std::function<void()> what);
  void after(Time time, std::function<void()> what) { at(now_ + time, std::move(what)); }
  /// How long the server computed between the last two times that it waited.
  [[nodiscard]] Time turn() const { return turn_; }
  /// Called after each step, between two turns of the server.
  std::function<void()> eachStep;
  /// The server has something to do, given by what is not a socket.
  void wake() { woken_ = true; }
  Faults faults;

  // ---- for clients

  [[nodiscard]] SocketPointer connect(LineKind line, std::uint32_t address, ClientEnd& client);
  void send(const SocketPointer& socket, std::string_view bytes);
  /// No further byte is sent.
  void finish(const SocketPointer& socket);
  /// Gives the connection up; the server finds it broken.
  void reset(const SocketPointer& socket);
  void setReads(const SocketPointer& socket, bool reads);
  /// Reads so many of the bytes that wait, while it does not read by itself.
  void readSome(const SocketPointer& socket, std::size_t count);

  // ---- system calls: the results of their namesakes, and -errno

  int poll(std::span<epoll_event> events, int milliseconds);
  int watch(int operation, int descriptor, const epoll_event* event);
  long receive(int descriptor, std::span<char> into, bool peeks);
  long sendAll(int descriptor, std::span<const iovec> parts);
  long sendBytes(int descriptor, std::string_view bytes);
  int finishSending(int descriptor);
  int close(int descriptor);
  [[nodiscard]] Socket* find(int descriptor);
  /// Bytes that a write takes.
  [[nodiscard]] static std::size_t roomOf(const Socket& socket);
  [[nodiscard]] bool hasFigures() { return !random_.chance(faults.withoutFigures); }

  [[nodiscard]] std::size_t openSockets() const { return sockets_.size(); }
  [[nodiscard]] std::uint64_t calls() const { return calls_; }
  /// Over all that has happened: the same in every run of a seed.
  [[nodiscard]] std::uint64_t trace() const { return trace_; }
  void note(std::uint64_t what);

 private:
  struct Event {
    Time when;
    std::uint64_t number;
    std::function<void()> what;
    bool operator<(const Event& other) const {
      return std::tie(when, number) > std::tie(other.when, other.number);
    }
  };
  /// The prices of a system call, of reading the clock, and of an allocation with what is done to
  /// its bytes.
  static constexpr Time kCall = 1us, kLook = 20ns, kAllocation = 800ns;
  void account(std::size_t bytes);
  /// Calls what is due.
  void runDue();
  void queue(Socket& socket);
  [[nodiscard]] static std::uint32_t readiness(const Socket& socket);
  [[nodiscard]] static bool hasRoom(const Socket& socket);
  void transmit(const SocketPointer& socket);
  void moveComing(const SocketPointer& socket, Time delay);
  void arrive(const SocketPointer& socket, const std::string& bytes);
  void breakOff(const SocketPointer& socket);
  /// The fault of a connection that a call finds broken: true, and it is.
  bool breaksNow(int descriptor);
  /// The server waits for room, and some is there.
  void reportRoom(Socket& socket);
  void tellClientLost(const SocketPointer& socket);
  [[nodiscard]] SocketPointer pointer(int descriptor);

  Random random_;
  std::uint64_t allocations_;  // of the server, at the last look
  Time now_{}, woke_{}, turn_{};
  std::priority_queue<Event> events_;
  std::uint64_t numbers_ = 0, calls_ = 0, trace_ = 14695981039346656037u;
  std::map<int, SocketPointer> sockets_;  // that the server has not closed
  std::vector<int> ready_;
  int nextDescriptor_ = kFirstDescriptor + 1;
  void* interrupter_ = nullptr;
  bool interrupted_ = false, woken_ = false;
};

}  // namespace qtet::simulator
