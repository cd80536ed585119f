// A client that asks for files, ranges, lists and levels over one connection.
#include <algorithm>
#include <deque>
#include <string>

#include "tests/server/simulator/client.h"

namespace qtet::simulator {
namespace {

/// How long an answer may take beside what its line takes: for turns of others, and for levels.
constexpr Time kPatience = 2s, kLevelPatience = 10s;
/// A small answer waits at most so long beside what its line takes.
constexpr Time kLongestWait = 200ms;
constexpr std::size_t kSmall = 8192;  // bytes

struct Asked {
  std::string what;       ///< method and target, with the range
  std::string_view body;  ///< that has to come, if `isKnown`
  bool isKnown = false, isHead = false, mayBeRefused = false;
  unsigned status = 200;
  Time since{};  ///< it is the next one to be answered
};

class Reader final : public Client {
 public:
  using Client::Client;
  void hears(std::string_view bytes) override {
    heard_ += bytes;
    while (!asked_.empty() && takeAnswer()) {
    }
    if (asked_.empty() && !heard_.empty()) wrong("bytes that belong to no answer");
  }

 private:
  void begin() override {
    left_ = random().between(1, 12);
    next();
  }
  void whenOver(bool lost) override {
    expectNothing();
    if (lost ? !world_.breaks : !asked_.empty() && !world_.ending)
      wrong(std::string(lost ? "the connection broke" : "the server closed") + " instead of " +
            (asked_.empty() ? "an end" : asked_.front().what));
  }

  void next() {
    if (left_ == 0) {
      if (random().chance(500)) return finish();
      return leave();
    }
    const std::size_t count = random().chance(200) ? random().between(2, 5) : 1;
    std::string text;
    for (std::size_t i = 0; i < count && left_ > 0; ++i, --left_) text += ask();
    say(text);
    waitForAnswer();
  }

  std::string ask() {
    const ServedLog& log = world_.logs[random().below(world_.logs.size())];
    const std::string base = "/v1/logs/" + log.digest + "/";
    Asked out;
    std::string method = "GET", target, headers;
    switch (random().below(9)) {
      case 0:
        target = base + "log";
        out.body = log.bytes, out.isKnown = true;
        break;
      case 1: {
        target = base + "log";
        const std::size_t first = random().below(log.bytes.size());
        const std::size_t last = random().between(first, log.bytes.size() - 1);
        headers = "Range: bytes=" + std::to_string(first) + "-" + std::to_string(last) + "\r\n";
        out.body = std::string_view(log.bytes).substr(first, last - first + 1);
        out.isKnown = true, out.status = 206;
        break;
      }
      case 2:
        method = "HEAD", target = base + "log";
        out.isHead = true;
        break;
      case 3: target = "/v1/meshes"; break;
      case 4: target = "/v1/meshes/" + log.name; break;
      case 5: target = base + "manifest"; break;
      case 6:
        target = base + "levels/" + std::to_string(random().below(log.index.chunks.size())) +
                 (random().chance(500) ? ".vtu" : ".obj");
        out.mayBeRefused = true;
        break;
      case 7: target = "/"; break;
      default: target = "/nothing"; out.status = 404;
    }
    out.what = method + " " + target + " " + headers;
    std::string text =
        method + " " + target + " HTTP/1.1\r\nHost: simulator\r\n" + headers + "\r\n";
    asked_.push_back(std::move(out));
    return text;
  }

  void waitForAnswer() {
    std::size_t bytes = 0;
    Time patience{};
    for (const Asked& asked : asked_) {
      bytes += asked.isKnown ? asked.body.size() : 300'000;
      patience += asked.mayBeRefused ? kLevelPatience : kPatience;
    }
    asked_.front().since = world_.kernel.now();
    expect(patience + 10 * line().latency + 2 * line().timeFor(bytes),
           "no answer to " + asked_.front().what);
  }

  /// True: one was whole.
  bool takeAnswer() {
    const std::size_t end = heard_.find("\r\n\r\n");
    if (end == std::string::npos) return false;
    const std::string head = heard_.substr(0, end + 2);
    if (!head.starts_with("HTTP/1.1 ")) wrong("no HTTP: " + head.substr(0, 40));
    const auto status = static_cast<unsigned>(std::stoul(head.substr(9, 3)));
    const std::size_t length = head.find("\r\nContent-Length: ");
    if (length == std::string::npos) wrong("an answer without a length: " + head);
    const std::size_t bytes = asked_.front().isHead ? 0 : std::stoull(head.substr(length + 18));
    if (heard_.size() < end + 4 + bytes) return false;
    const Asked asked = std::move(asked_.front());
    asked_.pop_front();
    const std::string_view body = std::string_view(heard_).substr(end + 4, bytes);
    judge(asked, status, body);
    heard_.erase(0, end + 4 + bytes);
    ++world_.seen["answers"];
    if (!asked.mayBeRefused && bytes < kSmall) {
      const Time wait =
          world_.kernel.now() - asked.since - 4 * line().latency - line().timeFor(bytes + end);
      if (wait > kLongestWait)
        wrong("waited " + std::to_string(wait / 1ms) + " ms for " + asked.what);
      std::uint64_t& longest = world_.seen["ms of the longest wait"];
      longest = std::max(longest, static_cast<std::uint64_t>(std::max(wait, Time()) / 1ms));
    }
    if (!asked_.empty()) {
      waitForAnswer();
      return true;
    }
    expectNothing();
    const bool closes = head.find("\r\nConnection: close") != std::string::npos;
    if (closes && left_ > 0) left_ = 0;
    later(random().chance(300) ? Time() : random().between(1ms, 30s), [this] { next(); });
    return true;
  }

  void judge(const Asked& asked, unsigned status, std::string_view body) {
    if (asked.mayBeRefused && (status == 503 || status == 429 || status == 500)) return;
    if (status != asked.status)
      wrong("status " + std::to_string(status) + " to " + asked.what + ": " + std::string(body));
    if (asked.isKnown && body != asked.body) wrong("other bytes for " + asked.what);
    const std::pair said{status, std::hash<std::string_view>()(body)};
    if (world_.bodies.emplace(asked.what, said).first->second != said)
      wrong("another answer than before to " + asked.what);
  }

  std::size_t left_ = 0;
  std::deque<Asked> asked_;
  std::string heard_;
};

}  // namespace

std::unique_ptr<Client> honestReader(World& world, LineKind line, std::uint32_t address) {
  return std::make_unique<Reader>(world, "reader", line, address);
}

}  // namespace qtet::simulator
