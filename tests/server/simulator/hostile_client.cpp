// Clients that stall, break rules, or ask for more than there is. The server has to end most of
// them within its limits; the others leave.
#include <array>

#include "proto/messages.h"
#include "tests/server/simulator/client.h"

namespace qtet::simulator {
namespace {

/// Beside a limit of the server's: its grain, and turns of others.
constexpr Time kSlack = 5s;
/// The server's limits (http_limits.h, stream_limits.h) as its documents name them.
constexpr Time kHead = 10s, kIdle = 75s, kWrite = 30s, kSilence = 30s, kClosing = 5s, kLinger = 1s;

class Hostile final : public Client {
 public:
  using Client::Client;
  void hears(std::string_view /*bytes*/) override { expectStill(); }

 private:
  void begin() override {
    constexpr std::array kWays = {
        &Hostile::saysNothing,     &Hostile::sendsHeadSlowly, &Hostile::readsNothing,
        &Hostile::readsSlowly,     &Hostile::sendsNoise,      &Hostile::sendsBody,
        &Hostile::asksForEver,     &Hostile::asksTooOften,    &Hostile::changesRequest,
        &Hostile::streamsSilently, &Hostile::streamsUnread,   &Hostile::sendsWrongFrames,
        &Hostile::sendsManyFrames, &Hostile::opensOften,      &Hostile::asksOddly,
        &Hostile::wantsLevels,     &Hostile::halfCloses};
    // some break off in the midst of it
    if (random().chance(250)) later(random().between(1ms, 5s), [this] { leave(); });
    (this->*kWays[random().below(kWays.size())])();
  }
  void whenOver(bool /*lost*/) override {
    ++world_.seen["ended by the server"];
    expectNothing();
  }
  [[nodiscard]] const ServedLog& anyLog() {
    return world_.logs[random().below(world_.logs.size())];
  }
  [[nodiscard]] std::string request(const std::string& target) {
    return "GET " + target + " HTTP/1.1\r\nHost: simulator\r\n\r\n";
  }
  void leaveLater() {
    later(random().between(1s, 100s), [this] { leave(); });
  }

  void saysNothing() { expect(kIdle + kSlack, "an idle connection stays"); }

  void sendsHeadSlowly() {
    expect(kHead + kLinger + kSlack, "a head that comes slowly holds a connection");
    say("GET / HTTP/1.1\r\nX: ");
    drip("x", 500ms);
  }
  /// The same again and again, until the connection ends.
  void drip(std::string bytes, Time interval) {
    later(random().between(interval / 2, interval), [this, bytes = std::move(bytes), interval] {
      say(bytes);
      drip(bytes, interval);
    });
  }

  void readsNothing() {
    world_.kernel.setReads(socket_, false);
    for (int i = 0; i < 20; ++i) say(request("/v1/logs/" + world_.logs.back().digest + "/log"));
    // its kernels hold some; each piece that they take begins the time again
    expect(2 * kWrite + kSlack + kIdle, "a client that reads nothing holds a connection");
  }
  void readsSlowly() {
    world_.kernel.setReads(socket_, false);
    say(request("/v1/logs/" + anyLog().digest + "/log"));
    readOn();
    leaveLater();
  }
  void readOn() {
    later(random().between(10ms, 1s), [this] {
      world_.kernel.readSome(socket_, random().between(1, 4000));
      readOn();
    });
  }

  void sendsNoise() {
    say(random().bytes(random().between(1, 40'000)));
    expect(kIdle + kHead + kLinger + kSlack, "noise holds a connection");
  }
  /// Refused, and the rest is read for a moment alone.
  void sendsBody() {
    say("PUT /v1/meshes/new HTTP/1.1\r\nHost: simulator\r\nContent-Length: 100000000\r\n\r\n");
    expect(kHead + kLinger + kSlack, "a body that is refused goes on");
    drip(std::string(5000, 'b'), 100ms);
  }

  void asksForEver() {
    drip(request("/v1/meshes/" + anyLog().name), 200ms);
    leaveLater();
  }
  void asksTooOften() {
    std::string text;
    const std::size_t count = random().between(50, 1500);
    for (std::size_t i = 0; i < count; ++i) text += request(i % 3 == 0 ? "/" : "/v1/meshes");
    say(text);
    leaveLater();
  }
  /// Asks for what only a program asks for.
  void asksOddly() {
    constexpr std::array kNumbers = {"0",          "1",          "-1",  "99",
                                     "4294967295", "4294967296", "1e9", "LAST"};
    constexpr std::array kEndings = {".vtu", ".glb", ".drc", ".usda", ".msh", "", ".exe"};
    constexpr std::array kQueries = {"",          "?fields=",    "?fields=density,density",
                                     "?time=nan", "?time=1e308", "?level=0",
                                     "?bytes=0"};
    const auto any = [this](const auto& words) -> std::string {
      return words[random().below(words.size())];
    };
    const std::string log = "/v1/logs/" + anyLog().digest + "/";
    std::string text;
    for (int i = 0; i < 5; ++i) {
      const std::string number = any(kNumbers), query = any(kQueries);
      const std::array<std::string, 5> targets = {
          log + "levels/" + number + any(kEndings) + query, log + "levels/fit.vtu" + query,
          log + "chunks/" + number + query, log + "series/" + number + query,
          "/v1/meshes?limit=" + number};
      text += request(targets[random().below(targets.size())]);
    }
    say(text);
    leaveLater();
  }
  void changesRequest() {
    std::string text = request("/v1/logs/" + anyLog().digest + "/log");
    text.insert(text.size() - 2, "Range: bytes=0-99,200-299\r\nConnection: keep-alive\r\n");
    const std::size_t changes = random().between(1, 5);
    for (std::size_t i = 0; i < changes; ++i)
      text[random().below(text.size())] = static_cast<char>(random().below(256));
    say(text);
    expect(kIdle + kHead + kLinger + kSlack, "a changed request holds a connection");
  }
  void wantsLevels() {
    std::string text;
    const ServedLog& log = anyLog();
    for (std::size_t i = 0; i < log.index.chunks.size(); ++i)
      text += request("/v1/logs/" + log.digest + "/levels/" + std::to_string(i) + ".vtk");
    say(text);
    // gone while its levels wait
    later(random().between(1ms, 500ms), [this] { leave(); });
  }
  void halfCloses() {
    say(request("/v1/logs/" + anyLog().digest + "/log"));
    finish();
    leaveLater();
  }

  // ---- on the stream

  void upgrade(std::string first) {
    say(streamHandshake());
    say(first);
  }
  [[nodiscard]] std::string openFrame(std::uint64_t credit) {
    OpenMessage message;
    message.mesh = anyLog().name;
    message.credit = credit;
    return frameOf(1, toJson(ClientMessage(std::move(message))));
  }
  /// No pong, and nothing else after the first message.
  void streamsSilently() {
    upgrade(random().chance(500) ? openFrame(random().between(1, 1'000'000)) : "");
    expect(2 * kSilence + kClosing + kSlack + line().timeFor(1'500'000), "a silent stream stays");
  }
  void streamsUnread() {
    world_.kernel.setReads(socket_, false);
    upgrade(openFrame(1'000'000'000));
    expect(kSilence + kWrite + kSilence / 2 + kClosing + kSlack, "an unread stream stays");
  }
  void sendsWrongFrames() {
    upgrade(openFrame(100'000));
    later(random().between(1ms, 1s), [this] {
      std::string frame =
          frameOf(static_cast<unsigned>(random().below(16)), random().bytes(random().below(200)));
      frame[random().below(2)] = static_cast<char>(random().below(256));
      say(frame);
      if (random().chance(500)) say(random().bytes(random().below(5000)));
      leaveLater();
    });
  }
  void sendsManyFrames() {
    upgrade("");
    std::string text;
    const unsigned opcode = random().chance(500) ? 9 : 0;
    if (opcode == 0) text = frameOf(1, "", false);
    for (int i = 0; i < 1000; ++i) text += frameOf(opcode, "", opcode == 9);
    say(text);
    expect(kClosing + kSlack + 4 * line().latency, "a flood of frames goes on");
  }
  /// Reads nothing of what it asks for.
  void opensOften() {
    world_.kernel.setReads(socket_, false);
    upgrade("");
    std::string text;
    for (int i = 0; i < 400; ++i) text += openFrame(random().between(1, 100));
    say(text);
    expect(kSilence + kWrite + kSilence / 2 + kClosing + kSlack, "a flood of opens goes on");
  }
};

}  // namespace

std::unique_ptr<Client> hostileClient(World& world, LineKind line, std::uint32_t address) {
  return std::make_unique<Hostile>(world, std::string(kHostile), line, address);
}

std::string frameOf(unsigned opcode, std::string_view payload, bool isLast) {
  constexpr std::string_view kMask = "mask";
  std::string out{static_cast<char>((isLast ? 0x80 : 0) | opcode)};
  if (payload.size() < 126) {
    out += static_cast<char>(0x80 | payload.size());
  } else {
    out += static_cast<char>(0x80 | 126);
    out += static_cast<char>(payload.size() >> 8);
    out += static_cast<char>(payload.size() & 255);
  }
  out += kMask;
  for (std::size_t i = 0; i < payload.size(); ++i)
    out += static_cast<char>(payload[i] ^ kMask[i % kMask.size()]);
  return out;
}

std::string streamHandshake() {
  return "GET /v1/stream HTTP/1.1\r\nHost: simulator\r\nUpgrade: websocket\r\nConnection: "
         "Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
         "dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: qtet.v1\r\n\r\n";
}

}  // namespace qtet::simulator
