#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "tests/server/program/loopback.h"

namespace qtet::test {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using beast::error_code;

struct StreamClient::State {
  asio::io_context context;
  websocket::stream<beast::tcp_stream> socket{context};
  beast::flat_buffer buffer;
  websocket::response_type response;
  bool connected = false;
  bool reading = false;
  bool arrived = false;  // a message lies in the buffer
  bool ended = false;

  /// Runs `start(done)` until `done` was called or patience is at its end.
  template <class Start>
  bool run(Start start, std::chrono::milliseconds patience = kPatience) {
    auto result = std::make_shared<std::optional<bool>>();
    start([result](error_code ec, auto...) { *result = !ec; });
    const auto deadline = std::chrono::steady_clock::now() + patience;
    context.restart();
    while (!*result && context.run_one_until(deadline) > 0) {
    }
    return result->value_or(false);
  }

  void read() {
    reading = true;
    socket.async_read(buffer, [this](error_code ec, std::size_t) {
      reading = false;
      (ec ? ended : arrived) = true;
    });
  }
};

StreamClient::StreamClient(std::uint16_t port, const std::string& subprotocol,
                           const std::string& path)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  error_code ec;
  beast::get_lowest_layer(s.socket).socket().connect({asio::ip::address_v4::loopback(), port}, ec);
  if (ec) return;
  s.socket.set_option(
      websocket::stream_base::decorator([subprotocol](websocket::request_type& request) {
        if (!subprotocol.empty())
          request.set(beast::http::field::sec_websocket_protocol, subprotocol);
      }));
  s.socket.read_message_max(0);
  s.connected =
      s.run([&](auto done) { s.socket.async_handshake(s.response, "localhost", path, done); });
}

StreamClient::~StreamClient() = default;

bool StreamClient::connected() const { return state_->connected; }
unsigned StreamClient::httpStatus() const { return state_->response.result_int(); }
std::string StreamClient::acceptedSubprotocol() const {
  return std::string(state_->response[beast::http::field::sec_websocket_protocol]);
}

bool StreamClient::send(const std::string& text) {
  state_->socket.text(true);
  return state_->run([&](auto done) { state_->socket.async_write(asio::buffer(text), done); });
}

bool StreamClient::sendBinary(const std::string& bytes) {
  state_->socket.binary(true);
  return state_->run([&](auto done) { state_->socket.async_write(asio::buffer(bytes), done); });
}

std::optional<StreamClient::Message> StreamClient::receive(std::chrono::milliseconds patience) {
  State& s = *state_;
  const auto deadline = std::chrono::steady_clock::now() + patience;
  if (!s.arrived && !s.reading && !s.ended) s.read();
  s.context.restart();
  while (!s.arrived && !s.ended && s.context.run_one_until(deadline) > 0) {
  }
  if (!s.arrived) return std::nullopt;
  s.arrived = false;
  const std::string text = beast::buffers_to_string(s.buffer.data());
  s.buffer.consume(s.buffer.size());
  return Message{s.socket.got_binary(), Bytes(text.begin(), text.end())};
}

std::optional<ServerMessage> StreamClient::receiveWord() {
  const std::optional<Message> message = receive();
  if (!message || message->binary) return std::nullopt;
  const Result<ServerMessage> word = parseServerMessage(message->text());
  return word ? std::optional(*word) : std::nullopt;
}

unsigned StreamClient::closeCode() {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!state_->ended && std::chrono::steady_clock::now() < deadline) (void)receive();
  return state_->ended ? static_cast<unsigned>(state_->socket.reason().code) : 0;
}

void StreamClient::close() {
  state_->run([&](auto done) { state_->socket.async_close(websocket::close_code::normal, done); });
}

void StreamClient::vanish() { beast::get_lowest_layer(state_->socket).close(); }

}  // namespace qtet::test
