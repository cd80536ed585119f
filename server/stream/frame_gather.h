// WebSocket frames put together for as few system calls as they take: heads of our own, payloads
// where they lie.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <cassert>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "server/stream/stream_limits.h"
#include "server/stream/stream_protocol.h"
#include "server/wire/client_socket.h"
#include "server/wire/file_part.h"
#include "server/wire/http_limits.h"
#include "server/wire/web_socket_reader.h"

namespace qtet {

class FrameGather {
 public:
  FrameGather() { items_.reserve(limits::kFramesPerWrite); }

  /// The answer to the handshake, before all frames. REQUIRES: empty().
  void addAnswer(std::string text) {
    assert(empty());
    items_.push_back({{}, 0, std::move(text), nullptr});
    append(items_.back(), boost::asio::buffer(items_.back().text));
  }
  /// REQUIRES: not full(). A text, or what a control frame carries.
  void add(std::uint8_t kind, std::string payload) {
    assert(!full());
    items_.push_back({{}, 0, std::move(payload), nullptr});
    Item& item = items_.back();
    const WebSocketHeader header(kind, item.text.size());
    item.headBytes = header.size;
    std::copy_n(header.bytes, header.size, item.head.begin());
    append(item, boost::asio::buffer(item.text));
  }
  /// REQUIRES: not full().
  void add(OutgoingFrame frame) {
    assert(!full() && frame.mesh && frame.header.size == frame.payload.size());
    items_.push_back({{}, 0, {}, std::move(frame.mesh)});
    Item& item = items_.back();
    const WebSocketHeader header(WebSocketHeader::kBinary,
                                 FrameHeader::kBytes + frame.payload.size());
    const auto inner = frame.header.encode();
    std::copy_n(header.bytes, header.size, item.head.begin());
    std::ranges::copy(inner, item.head.begin() + header.size);
    item.headBytes = header.size + inner.size();
    const int file = item.mesh->descriptor->number;
    const auto offset =
        static_cast<std::uint64_t>(frame.payload.data() - item.mesh->log.bytes().data());
    assert(offset + frame.payload.size() <= item.mesh->log.bytes().size());
    append(item, boost::asio::const_buffer(frame.payload.data(), frame.payload.size()),
           {file, offset});
  }

  [[nodiscard]] bool full() const {
    return items_.size() == limits::kFramesPerWrite || bytes_ >= limits::kBytesPerWrite;
  }
  [[nodiscard]] bool empty() const { return items_.empty(); }
  /// Binary ones that were added.
  [[nodiscard]] std::size_t frames() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(items_, [](const Item& item) { return item.mesh != nullptr; }));
  }
  [[nodiscard]] bool several() const { return items_.size() > 1; }
  [[nodiscard]] bool written() const { return parts_.empty(); }
  /// Writes as much as the socket accepts in one call. That is the parts in memory up to the next
  /// part in a file, or one part in a file. With TLS all parts are in memory. Returns the bytes
  /// taken; `ec` is would_block, or another error. REQUIRES: not written().
  std::size_t write(ClientSocket& socket, boost::system::error_code& ec);

 private:
  struct Item {
    std::array<std::uint8_t, sizeof(WebSocketHeader::bytes) + FrameHeader::kBytes> head;
    std::size_t headBytes;
    std::string text;
    MeshPointer mesh;  ///< keeps the payload mapped
  };
  struct Part {
    boost::asio::const_buffer bytes;
    /// Where the bytes lie as well, if it pays to have the kernel take them from there.
    FilePart file{};

    [[nodiscard]] bool inFile() const { return file.descriptor >= 0; }
  };
  void append(const Item& item, boost::asio::const_buffer payload, FilePart file = {}) {
    if (item.headBytes > 0)
      parts_.push_back({boost::asio::buffer(item.head.data(), item.headBytes)});
    if (payload.size() > 0)
      parts_.push_back({payload, payload.size() >= limits::kMinFromFile ? file : FilePart()});
    bytes_ += payload.size();
  }
  void consume(std::size_t bytes);

  std::vector<Item> items_;  // reserved, so that nothing in it moves
  std::deque<Part> parts_;
  std::size_t bytes_ = 0;
};

}  // namespace qtet
