#include "tests/server/simulator/traffic.h"

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <memory>
#include <vector>

#include "tests/server/simulator/client.h"
#include "tests/server/simulator/host.h"

namespace qtet::simulator {
namespace {

/// Memory that the server may hold for one connection: a head, two messages, and answers that wait.
constexpr std::int64_t kMaxOfConnection = 320 << 10;
/// And beside all connections: pages, levels that are sent, catalogues.
constexpr std::int64_t kMaxBeside = 24 << 20;
/// Memory that stays when all have gone: for each address, and for buffers that are used again.
constexpr std::int64_t kMaxLeft = 160 << 10, kMaxOfAddress = 200;
/// Longer than any connection without a client's doing.
constexpr Time kQuiet = 200s;
/// Between two looks at what is due.
constexpr Time kLook = 50ms;
/// That of a turn, of which the server has a metric (connection_limits.h).
constexpr Time kLongestTurn = 5ms;

/// The clients of one run, and what has to hold.
class Traffic {
 public:
  Traffic(std::uint64_t seed, Time time, const MeshStore& store, const ViewerFiles& viewer)
      : kernel_(seed), random_(seed * 2 + 1), end_(time), world_{kernel_, random_, {}} {
    Kernel::inForce = &kernel_;
    readLogs(store);
    drawFaults();
    const MemoryOf server(MemoryOf::Whose::kServer);
    before_ = MemoryOf::server();
    host_ = std::make_unique<Host>(kernel_, seed, store, viewer, limits_);
  }
  ~Traffic() {
    clients_.clear();
    {
      const MemoryOf server(MemoryOf::Whose::kServer);
      host_.reset();
    }
    Kernel::inForce = nullptr;
  }
  Traffic(const Traffic&) = delete;
  Traffic& operator=(const Traffic&) = delete;

  Outcome run() {
    Outcome out;
    kernel_.eachStep = [this] { look(); };
    arriveNext();
    kernel_.at(end_, [this] { waitForSound(); });
    try {
      const MemoryOf server(MemoryOf::Whose::kServer);
      const auto work = boost::asio::make_work_guard(host_->context());
      host_->context().run();
    } catch (const Violation& violation) {
      out.violation = violation.what;
    }
    if (out.violation.empty()) out.violation = leftovers();
    out.at = kernel_.now();
    out.trace = kernel_.trace();
    out.calls = kernel_.calls();
    out.seen = world_.seen;
    return out;
  }

 private:
  void readLogs(const MeshStore& store) {
    for (const EntryPointer& entry : store.catalogue()->meshes) {
      const MeshPointer mesh = store.find(entry->id);
      ServedLog log{mesh->id, mesh->log.digest(), {}, mesh->log.index(), {}};
      log.bytes.assign(mesh->log.bytes().begin(), mesh->log.bytes().end());
      for (const ManifestField& field : mesh->manifest.fields) log.fields.push_back(field.name);
      world_.logs.push_back(std::move(log));
    }
    std::ranges::sort(world_.logs, {}, [](const ServedLog& log) { return log.bytes.size(); });
  }

  /// Each run is of a kind: calm, faulty, crowded.
  void drawFaults() {
    if (random_.chance(300)) kernel_.faults.broken = 1, world_.breaks = true;
    if (random_.chance(300)) kernel_.faults.shortCalls = 400, kernel_.faults.interrupted = 50;
    if (random_.chance(100)) kernel_.faults.withoutFigures = 1000;
    hostilePart_ = random_.chance(500) ? 300 : random_.below(900);
    meanGap_ = random_.between(30ms, 3s);
  }

  [[nodiscard]] LineKind drawLine() {
    constexpr double kSlow = 60e3, kPhone = 600e3, kHome = 6e6, kOffice = 100e6;
    const double rates[] = {kSlow, kPhone, kHome, kOffice};
    LineKind out;
    out.bytesPerSecond = rates[random_.below(4)];
    out.latency = random_.between(200us, 150ms);
    out.buffer = std::size_t{16 << 10} << random_.below(6);
    out.window = std::size_t{16 << 10} << random_.below(6);
    return out;
  }

  void arriveNext() {
    // a crowd comes at once now and then
    const Time gap = random_.chance(30) ? Time() : random_.between(Time(1), 2 * meanGap_);
    kernel_.after(gap, [this] {
      if (kernel_.now() >= end_) return;
      const std::size_t count = random_.chance(10) ? random_.between(10, 60) : 1;
      const bool isHostile = random_.chance(hostilePart_);
      for (std::size_t i = 0; i < count && clients_.size() < kMaxClients; ++i)
        arrive(isHostile, isHostile && random_.chance(500));
      arriveNext();
    });
  }

  /// Some of the hostile come from one address.
  void arrive(bool isHostile, bool fromOne) {
    constexpr std::uint32_t kFirst = 0x0A000000, kOfOne = 0xC0A80001;
    const std::uint32_t address = fromOne ? kOfOne : kFirst + ++addresses_;
    const LineKind line = drawLine();
    std::unique_ptr<Client> client = isHostile             ? hostileClient(world_, line, address)
                                     : random_.chance(500) ? honestReader(world_, line, address)
                                                           : honestViewer(world_, line, address);
    const SocketPointer socket = client->connect();
    ++world_.seen[client->kind()];
    if (!host_->accept(socket)) {
      ++world_.seen["turned away"];
      if (host_->open() < limits_.connections && !fromOne) client->wrong("turned away");
      return;  // the kernel lets go of it, too
    }
    clients_.push_back(std::move(client));
  }

  /// After each step of the server.
  void look() {
    if (!host_->fault.empty()) throw Violation{host_->fault};
    const std::int64_t held = MemoryOf::server() - before_;
    const auto open = static_cast<std::int64_t>(host_->open());
    mostHeld_ = std::max(mostHeld_, held);
    if (held > kMaxBeside + open * kMaxOfConnection)
      throw Violation{"the server holds " + std::to_string(held) + " bytes for " +
                      std::to_string(open) + " connections"};
    longestTurn_ = std::max(longestTurn_, kernel_.turn());
    if (kernel_.turn() > kLongestTurn)
      throw Violation{"a turn of " + std::to_string(kernel_.turn() / 1us) + " us"};
    if (kernel_.now() < next_) return;
    next_ = kernel_.now() + kLook;
    for (const auto& client : clients_)
      if (client->holds() && client->due() && client->due()->when < kernel_.now())
        client->wrong(client->due()->what);
    std::erase_if(clients_, [](const auto& client) { return client->over(); });
  }

  /// Sound clients go when they have what they want. The others are left then.
  void waitForSound() {
    const bool isOne = std::ranges::any_of(
        clients_, [](const auto& client) { return client->kind() != kHostile && !client->over(); });
    if (isOne) return kernel_.after(1s, [this] { waitForSound(); });
    kernel_.after(kQuiet, [this] { settle(); });
  }

  /// All clients have had time to go. Nothing may be left; then some more come, and the server
  /// ends.
  void settle() {
    for (const auto& client : clients_)
      if (client->holds()) client->wrong("is still there when all is over");
    if (host_->open() > 0)
      throw Violation{std::to_string(host_->open()) + " connections are left over"};
    const std::int64_t held =
        MemoryOf::server() - before_ - static_cast<std::int64_t>(host_->keptBytes());
    if (held > kMaxLeft + addresses_ * kMaxOfAddress)
      throw Violation{std::to_string(held) + " bytes are left over"};
    world_.seen["most bytes"] = static_cast<std::uint64_t>(mostHeld_);
    world_.seen["us of the longest turn"] = static_cast<std::uint64_t>(longestTurn_ / 1us);
    world_.seen["bytes left"] = static_cast<std::uint64_t>(held);
    const std::size_t count = random_.below(30);
    for (std::size_t i = 0; i < count; ++i) arrive(random_.chance(300), false);
    kernel_.after(random_.between(1ms, 3s), [this] {
      world_.ending = true;
      const MemoryOf server(MemoryOf::Whose::kServer);
      host_->end([this] {
        host_->context().stop();
        kernel_.wake();
      });
    });
    kernel_.after(kGrace, [this] {
      host_->context().stop();
      kernel_.wake();
    });
  }

  /// Behind the end: what is left is cut, and nothing stays.
  std::string leftovers() {
    for (const auto& client : clients_)
      if (client->holds() && client->kind() != kHostile &&
          client->line().timeFor(world_.logs.back().bytes.size()) < kGrace / 4)
        return client->kind() + ": not ended with the server";
    {
      const MemoryOf server(MemoryOf::Whose::kServer);
      host_.reset();
    }
    if (kernel_.openSockets() > 0)
      return std::to_string(kernel_.openSockets()) + " sockets are not closed";
    return "";
  }

  static constexpr std::size_t kMaxClients = 400;
  static constexpr Time kGrace = 20s;
  Kernel kernel_;
  Random random_;
  const Time end_;
  World world_;
  HostLimits limits_;
  std::unique_ptr<Host> host_;
  std::vector<std::unique_ptr<Client>> clients_;
  std::uint64_t hostilePart_ = 0;
  Time meanGap_{};
  std::uint32_t addresses_ = 0;
  std::int64_t before_ = 0, mostHeld_ = 0;
  Time next_{}, longestTurn_{};
};

}  // namespace

Outcome simulate(std::uint64_t seed, Time traffic, const MeshStore& store,
                 const ViewerFiles& viewer) {
  const MemoryOf own(kOwn);
  return Traffic(seed, traffic, store, viewer).run();
}

}  // namespace qtet::simulator
