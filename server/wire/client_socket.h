// The socket of one client, plain or with TLS, that never blocks: what cannot be done at once is
// waited for elsewhere.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <sys/uio.h>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "proto/bytes.h"
#include "server/wire/address_limits.h"
#include "server/wire/file_part.h"
#include "server/wire/proxy_head.h"
#include "server/wire/tls_context.h"

namespace qtet {

/// The client's bytes that wait to be read, if any.
enum class Arrived : std::uint8_t {
  kNothing,
  kBytes,
  kEnd,  ///< it has closed its half, or the connection is lost
};

/// A client's connection, plain or with TLS. TLS runs on the socket itself, by SSL_read and
/// SSL_write. Asio's ssl::stream would keep 34 KB of buffers a connection, and would need two
/// versions of all code for connections. Here a plain connection pays one branch a call. Only for
/// its executor, a single thread or a strand. If `ec` is would_block, wait and call again with the
/// same bytes (and perhaps more behind them).
class ClientSocket {
 public:
  /// Plain where `tls` is nullptr.
  explicit ClientSocket(boost::asio::ip::tcp::socket socket, const TlsContext* tls = nullptr);

  [[nodiscard]] auto get_executor() { return socket_.get_executor(); }
  [[nodiscard]] int number() { return socket_.native_handle(); }
  [[nodiscard]] bool isOpen() const { return socket_.is_open(); }
  [[nodiscard]] bool isTls() const { return tls_ != nullptr; }
  /// The client's address; "" where it has gone.
  [[nodiscard]] std::string peer() const;

  /// Takes the head of the PROXY protocol, which comes before everything else. Nothing: it is none,
  /// or the peer has gone, or cancel().
  [[nodiscard]] boost::asio::awaitable<std::optional<ProxyHead>> takeProxyHead();
  /// Waits for the head of TLS's handshake and checks the announced length before OpenSSL makes
  /// room for it. False: too long, or the client has gone.
  [[nodiscard]] boost::asio::awaitable<bool> announcesSoundHello();
  /// TLS's handshake, at the cost of `payer`, which may be nullptr. False: the client broke off, or
  /// speaks no TLS that is spoken here; or cancel().
  [[nodiscard]] boost::asio::awaitable<bool> shakeHands(AddressLimits::Client* payer = nullptr);
  /// Whether the handshake failed because the client sent plain HTTP. It may be answered so, and is
  /// not secret.
  [[nodiscard]] bool becomePlainForPlainHttp();

  /// Bytes that have come; `eof` after the last.
  std::size_t read(std::span<char> into, boost::system::error_code& ec);
  /// Bytes taken of the parts, from the first on. `more`: others follow at once.
  std::size_t write(std::span<const iovec> parts, bool more, boost::system::error_code& ec);
  /// Bytes taken of `bytes`, which stand in `file` as well: without TLS the kernel sends them from
  /// there, uncopied. EIO: it has become shorter.
  std::size_t writeFile(FilePart file, ByteView bytes, boost::system::error_code& ec);

  /// Holds back data that fills no packet until `hold` is false, at most 200 ms. Not for a paced
  /// connection, which would wait for a timer each time.
  void holdBack(bool hold);

  /// Until read() or write() may be called again; operation_aborted by cancel() or close().
  [[nodiscard]] boost::asio::awaitable<boost::system::error_code> waitToRead();
  [[nodiscard]] boost::asio::awaitable<boost::system::error_code> waitToWrite();
  /// Until cancel(): true; or the connection breaks.
  [[nodiscard]] boost::asio::awaitable<bool> waitForCancel();
  /// For callers that wait for something else too. Calls once when bytes or the end have arrived.
  /// It may also call for nothing: the reactor may report bytes that were read since.
  template <class Handler>
  void whenReadable(Handler handler) {
    socket_.async_wait(boost::asio::socket_base::wait_read, std::move(handler));
  }
  /// Looks at what the next read() would find. The bytes stay in the socket.
  [[nodiscard]] Arrived arrived();

  void cancel();
  /// Says that nothing more is sent.
  void finishSending();
  void close();

 private:
  enum class TlsState : std::uint8_t {
    kSound,
    kBroken,     ///< nothing may be asked of TLS any more
    kPlainHttp,  ///< likewise: the client speaks HTTP without it
  };
  struct EndTls {
    void operator()(ssl_st* session) const;
  };
  boost::asio::awaitable<boost::system::error_code> wait(boost::asio::socket_base::wait_type what);
  /// Takes it from the socket if it is whole.
  ProxyHead lookForProxyHead();
  /// As far as the client's bytes reach; true: to its end.
  bool advanceHandshake(AddressLimits::Client* payer, boost::system::error_code& ec);
  /// Translates OpenSSL's reason for a result that is not positive.
  void explain(int result, bool& wantsOther, int wanted, boost::system::error_code& ec);

  boost::asio::ip::tcp::socket socket_;
  std::unique_ptr<ssl_st, EndTls> tls_;
  // TLS reads in order to write, and the other way round.
  bool readWantsWrite_ = false;
  bool writeWantsRead_ = false;
  TlsState tlsState_ = TlsState::kSound;
  bool cancelled_ = false;  // since the handshake was begun
};

}  // namespace qtet
