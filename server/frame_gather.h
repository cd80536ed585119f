// WebSocket frames put together for one write: heads of our own, payloads where they lie.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "server/limits.h"
#include "server/stream_protocol.h"
#include "server/web_socket_reader.h"

namespace qtet {

class FrameGather {
 public:
  FrameGather() {
    items_.reserve(limits::kFramesPerWrite);
    parts_.reserve(2 * limits::kFramesPerWrite);
  }

  /// REQUIRES: not full(). A text, or what a control frame carries.
  void add(std::uint8_t kind, std::string payload) {
    items_.push_back({{}, 0, std::move(payload), nullptr});
    Item& item = items_.back();
    const WebSocketHeader header(kind, item.text.size());
    item.headBytes = header.size;
    std::copy_n(header.bytes, header.size, item.head.begin());
    append(item, boost::asio::buffer(item.text));
  }
  /// REQUIRES: not full().
  void add(OutgoingFrame frame) {
    items_.push_back({{}, 0, {}, std::move(frame.mesh)});
    Item& item = items_.back();
    const WebSocketHeader header(WebSocketHeader::kBinary, FrameHeader::kBytes + frame.payload.size());
    const auto inner = frame.header.encode();
    std::copy_n(header.bytes, header.size, item.head.begin());
    std::ranges::copy(inner, item.head.begin() + header.size);
    item.headBytes = header.size + inner.size();
    append(item, boost::asio::const_buffer(frame.payload.data(), frame.payload.size()));
  }

  [[nodiscard]] bool full() const { return items_.size() == limits::kFramesPerWrite || bytes_ >= limits::kBytesPerWrite; }
  [[nodiscard]] bool empty() const { return items_.empty(); }
  /// Of what is still to be written; consume() shortens it.
  [[nodiscard]] const std::vector<boost::asio::const_buffer>& parts() const { return parts_; }
  void consume(std::size_t bytes) {
    std::size_t gone = 0;
    while (gone < parts_.size() && bytes >= parts_[gone].size()) bytes -= parts_[gone++].size();
    parts_.erase(parts_.begin(), parts_.begin() + static_cast<std::ptrdiff_t>(gone));
    if (!parts_.empty()) parts_.front() += bytes;
  }

 private:
  struct Item {
    std::array<std::uint8_t, sizeof(WebSocketHeader::bytes) + FrameHeader::kBytes> head;
    std::size_t headBytes;
    std::string text;
    MeshPointer mesh;  ///< keeps the payload mapped
  };
  void append(const Item& item, boost::asio::const_buffer payload) {
    parts_.push_back(boost::asio::buffer(item.head.data(), item.headBytes));
    if (payload.size() > 0) parts_.push_back(payload);
    bytes_ += payload.size();
  }

  std::vector<Item> items_;  // reserved, so that nothing in it moves
  std::vector<boost::asio::const_buffer> parts_;
  std::size_t bytes_ = 0;
};

}  // namespace qtet
