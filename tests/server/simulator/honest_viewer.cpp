// A client of the stream: changes its view, loses its patience, and has every block in the end.
#include <algorithm>
#include <cstring>
#include <map>
#include <set>

#include "proto/messages.h"
#include "tests/server/simulator/client.h"

namespace qtet::simulator {
namespace {

/// A block, or the blocks of one frame. Bytes.
constexpr std::uint64_t kMaxFrame = 600'000;
using Block = std::pair<std::uint32_t, std::uint32_t>;  // chunk and part

class Viewer final : public Client {
 public:
  using Client::Client;
  void hears(std::string_view bytes) override {
    heard_ += bytes;
    if (!upgraded_) {
      const std::size_t end = heard_.find("\r\n\r\n");
      if (end == std::string::npos) return;
      if (!heard_.starts_with("HTTP/1.1 101 ")) wrong("no stream: " + heard_.substr(0, end));
      heard_.erase(0, end + 4);
      upgraded_ = true;
      open();
      change();
    }
    while (!over() && takeFrame()) {
    }
  }

 private:
  void begin() override {
    log_ = &world_.logs[random().below(world_.logs.size())];
    for (std::uint32_t f = 0; f < log_->index.fields.size(); ++f)
      if (random().chance(500)) parts_.push_back(kFirstFieldPart + f);
    changes_ = random().below(6);
    say(streamHandshake());
    expect(10s + 4 * line().latency, "no answer to the handshake");
  }
  void whenOver(bool lost) override {
    expectNothing();
    const bool mayEnd = closing_ || world_.ending;
    if (lost ? !world_.breaks && !mayEnd : !mayEnd)
      wrong(lost ? "the connection broke" : "the server closed the stream");
  }

  /// Opens the log again with what it has.
  void open() {
    Have have;
    while (has(have.chunks)) ++have.chunks;
    for (const std::uint32_t part : parts_) have.fields.emplace_back(nameOf(part), have.chunks);
    OpenMessage message;
    message.mesh = log_->name;
    message.digest = log_->digest;
    for (const std::uint32_t part : parts_) message.fields.push_back(nameOf(part));
    message.have = have;
    message.credit = random().between(1, 400'000);
    if (changes_ > 0) message.target = targetOf();
    wantsAll_ = changes_ == 0;
    credit_ = static_cast<std::int64_t>(message.credit);
    ++stream_;
    std::erase_if(blocks_, [&](const Block& block) { return block.first >= have.chunks; });
    begun_.clear();
    paused_ = cancelled_ = false;
    tell(message);
    waitForBytes();
  }

  /// Does something else now and then, and at last asks for everything.
  void change() {
    later(random().between(1ms, 4s), [this] {
      if (closing_) return;
      if (changes_ == 0) return open();
      --changes_;
      switch (random().below(5)) {
        case 0: open(); break;
        case 1: tell(TargetMessage{targetOf()}); break;
        case 2: paused_ = true, tell(PauseMessage{}), expectNothing(); break;
        case 3: paused_ = false, tell(ResumeMessage{}); break;
        default: cancelled_ = true, tell(CancelMessage{}), expectNothing();
      }
      change();
    });
  }

  Target targetOf() {
    if (random().chance(500)) return EverythingTarget{};
    return LevelTarget{static_cast<std::uint32_t>(random().below(log_->index.chunks.size()))};
  }

  [[nodiscard]] const std::string& nameOf(std::uint32_t part) const {
    return log_->fields[part - kFirstFieldPart];
  }
  [[nodiscard]] bool has(std::uint32_t chunk) const {
    if (chunk >= log_->index.chunks.size()) return false;
    for (const std::uint32_t part : wanted())
      if (!blocks_.contains({chunk, part})) return false;
    return true;
  }
  [[nodiscard]] std::vector<std::uint32_t> wanted() const {
    std::vector<std::uint32_t> out = {kStructurePart, kPositionsPart};
    out.insert(out.end(), parts_.begin(), parts_.end());
    return out;
  }

  void tell(const ClientMessage& message) { say(frameOf(1, toJson(message))); }

  /// While it asks for everything and grants credit, something has to come.
  void waitForBytes() {
    if (!wantsAll_) return expectNothing();
    expect(10s + 10 * line().latency + line().timeFor(kMaxFrame),
           "no frame comes although there is credit");
  }

  bool takeFrame() {
    const auto byte = [this](std::size_t i) { return static_cast<std::uint8_t>(heard_[i]); };
    if (heard_.size() < 2) return false;
    std::uint64_t bytes = byte(1);
    const std::size_t more = bytes == 126 ? 2 : bytes == 127 ? 8 : 0, head = 2 + more;
    if (heard_.size() < head) return false;
    if (more > 0) bytes = 0;
    for (std::size_t i = 2; i < head; ++i) bytes = bytes << 8 | byte(i);
    if (bytes > 2'000'000) wrong("a frame of " + std::to_string(bytes) + " bytes");
    if (heard_.size() < head + bytes) return false;
    const std::string payload = heard_.substr(head, bytes);
    const unsigned first = byte(0);
    heard_.erase(0, head + bytes);
    switch (first) {
      case 0x81: takeMessage(payload); break;
      case 0x82: takeBlocks(payload); break;
      case 0x88: takeClose(payload); break;
      case 0x89: say(frameOf(0xA, payload)); break;
      default: wrong("a frame that begins with " + std::to_string(first));
    }
    return true;
  }

  void takeMessage(const std::string& text) {
    const Result<ServerMessage> message = parseServerMessage(text);
    if (!message) wrong("a message that is none: " + text);
    if (const auto* error = std::get_if<ErrorMessage>(&*message))
      wrong("an error: " + error->code + ": " + error->detail);
    const auto* done = std::get_if<DoneMessage>(&*message);
    if (done == nullptr || done->stream != stream_ || !wantsAll_) return;
    for (std::uint32_t chunk = 0; chunk < log_->index.chunks.size(); ++chunk)
      if (!has(chunk)) wrong("chunk " + std::to_string(chunk) + " is not whole after done");
    ++world_.seen["logs"];
    closing_ = true;
    say(frameOf(8, std::string("\x03\xE8", 2)));
    expect(8s + 4 * line().latency, "the server does not close");
  }

  void takeClose(const std::string& payload) {
    const unsigned code = payload.size() < 2
                              ? 0
                              : static_cast<unsigned>(static_cast<std::uint8_t>(payload[0]) << 8 |
                                                      static_cast<std::uint8_t>(payload[1]));
    if (!closing_ && !(world_.ending && code == 1001))
      wrong("closed with " + std::to_string(code) + ": " + payload.substr(2));
    if (!closing_) say(frameOf(8, payload));
    closing_ = true;
    expect(8s + 4 * line().latency, "the connection does not end after its close");
  }

  void takeBlocks(const std::string& bytes) {
    const ByteView view(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    const Result<FrameHeader> frame = FrameHeader::parse(view);
    if (!frame) wrong("a binary frame that is none");
    if (frame->stream != stream_) return;
    ++world_.seen["frames"];
    if (credit_ <= 0) wrong("a frame without credit");
    credit_ -= frame->size;
    if (frame->firstPart == FrameHeader::kHead)
      compare(0, log_->index.headBytes(), frame->size, bytes);
    else
      takeParts(*frame, bytes);
    const std::uint64_t granted = frame->size;
    later(random().chance(100) ? random().between(1ms, 2s) : Time(),
          [this, granted, stream = stream_] {
            if (stream != stream_ || closing_) return;
            credit_ += static_cast<std::int64_t>(granted);
            if (granted > 0) tell(CreditMessage{granted});
            if (!paused_ && !cancelled_) waitForBytes();
          });
    if (wantsAll_) expectNothing();
  }

  void takeParts(const FrameHeader& frame, const std::string& bytes) {
    const LogIndex& index = log_->index;
    if (frame.chunk >= index.chunks.size() || frame.firstPart >= index.parts())
      wrong("a frame of a block that the log lacks");
    const BlockEntry& first = index.block(frame.chunk, frame.firstPart);
    std::uint64_t& begun = begun_[{frame.chunk, frame.firstPart}];
    std::uint64_t whole = first.size - begun;
    for (std::uint32_t i = 1; i < frame.parts; ++i)
      whole += index.block(frame.chunk, frame.firstPart + i).size;
    compare(first.offset + begun, frame.parts == FrameHeader::kPiece ? whole - 1 : whole,
            frame.size, bytes);
    begun += frame.size;
    if (frame.parts == FrameHeader::kPiece) return;
    if (frame.size != whole) wrong("blocks that are too short");
    for (std::uint32_t i = 0; i < frame.parts; ++i) {
      const std::uint32_t part = frame.firstPart + i;
      const std::vector<std::uint32_t> asked = wanted();
      if (std::ranges::find(asked, part) == asked.end()) wrong("a block that nobody wants");
      if (!blocks_.insert({frame.chunk, part}).second) wrong("a block twice");
      if (part != kStructurePart && !blocks_.contains({frame.chunk, kStructurePart}))
        wrong("values before their structure");
      ++world_.seen["blocks"];
    }
  }

  void compare(std::uint64_t offset, std::uint64_t most, std::uint64_t size,
               const std::string& bytes) {
    if (size > most || offset + size > log_->bytes.size() ||
        std::memcmp(bytes.data() + FrameHeader::kBytes, log_->bytes.data() + offset, size) != 0)
      wrong("bytes that are not the log's");
  }

  const ServedLog* log_ = nullptr;
  std::vector<std::uint32_t> parts_;
  std::size_t changes_ = 0;
  std::string heard_;
  bool upgraded_ = false, wantsAll_ = false, closing_ = false, paused_ = false, cancelled_ = false;
  std::uint32_t stream_ = 0;
  std::int64_t credit_ = 0;
  std::set<Block> blocks_;
  std::map<Block, std::uint64_t> begun_;  // bytes of blocks that came in part
};

}  // namespace

std::unique_ptr<Client> honestViewer(World& world, LineKind line, std::uint32_t address) {
  return std::make_unique<Viewer>(world, "viewer", line, address);
}

}  // namespace qtet::simulator
