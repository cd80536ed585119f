#include "server/wire/client_socket.h"

#include <netinet/tcp.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <sys/sendfile.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>

#include "server/wire/charge.h"

namespace qtet {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

/// Bytes of one TLS record at most.
constexpr std::size_t kRecordBytes = SSL3_RT_MAX_PLAIN_LENGTH;
/// Changes of a key that bring no byte of data, in a row: each costs the server a key schedule and
/// the client 27 bytes.
constexpr std::uintptr_t kMaxKeyUpdates = 32;
/// Bytes of a ClientHello. OpenSSL makes room for as many as its header announces, up to 131,396. A
/// browser's hello has 0.5 to 2 KB.
constexpr std::size_t kMaxHelloBytes = 16u << 10;
constexpr std::size_t kRecordHead = 5, kHelloHead = kRecordHead + 4;
/// Between two looks at an incomplete head: almost always it arrives in one packet.
constexpr auto kHelloWait = std::chrono::milliseconds(50);

/// Bytes of a system call that failed: none, and why. EINTR and EAGAIN are the same to who waits.
std::size_t failed(int why, error_code& ec) {
  ec = why == EAGAIN || why == EINTR ? error_code(asio::error::would_block)
                                     : error_code(why, boost::system::system_category());
  return 0;
}

}  // namespace

void ClientSocket::EndTls::operator()(ssl_st* session) const { ::SSL_free(session); }

ClientSocket::ClientSocket(tcp::socket socket, const TlsContext* tls) : socket_(std::move(socket)) {
  error_code ec;
  socket_.non_blocking(true, ec);
  if (tls != nullptr) tls_.reset(tls->newSession(socket_.native_handle()));
}

std::string ClientSocket::peer() const {
  error_code ec;
  const tcp::endpoint peer = socket_.remote_endpoint(ec);
  return ec ? "" : peer.address().to_string();
}

void ClientSocket::explain(int result, bool& wantsOther, int wanted, error_code& ec) {
  const int why = errno;
  const int kind = ::SSL_get_error(tls_.get(), result);
  wantsOther = kind == wanted;
  if (kind == SSL_ERROR_WANT_READ || kind == SSL_ERROR_WANT_WRITE) {
    ec = asio::error::would_block;
  } else if (kind == SSL_ERROR_ZERO_RETURN) {
    ec = asio::error::eof;
  } else {
    tlsState_ = ERR_GET_REASON(::ERR_peek_error()) == SSL_R_HTTP_REQUEST ? TlsState::kPlainHttp
                                                                         : TlsState::kBroken;
    ec = kind == SSL_ERROR_SYSCALL && why != 0 ? error_code(why, boost::system::system_category())
                                               : asio::error::connection_aborted;
  }
}

/// A plain function: a buffer in a coroutine would be held while it waits.
ProxyHead ClientSocket::lookForProxyHead() {
  std::array<std::uint8_t, kMaxProxyHeadBytes> bytes;
  const ssize_t count = ::recv(socket_.native_handle(), bytes.data(), bytes.size(), MSG_PEEK);
  if (count <= 0) return {ProxyHead::State::kWrong};
  ProxyHead out = readProxyHead(std::span(bytes).first(static_cast<std::size_t>(count)));
  if (out.state == ProxyHead::State::kWhole &&
      ::recv(socket_.native_handle(), bytes.data(), out.bytes, 0) < 0)
    out.state = ProxyHead::State::kWrong;
  return out;
}

asio::awaitable<std::optional<ProxyHead>> ClientSocket::takeProxyHead() {
  cancelled_ = false;
  for (asio::steady_timer timer(get_executor());;) {
    error_code ec = co_await wait(tcp::socket::wait_read);
    if (ec) co_return std::nullopt;
    const ProxyHead head = lookForProxyHead();
    if (head.state == ProxyHead::State::kWrong) co_return std::nullopt;
    if (head.state == ProxyHead::State::kWhole) co_return head;
    timer.expires_after(kHelloWait);  // what was looked at keeps the socket readable
    co_await timer.async_wait(asio::redirect_error(asio::use_awaitable, ec));
    if (cancelled_ || !socket_.is_open()) co_return std::nullopt;
  }
}

asio::awaitable<bool> ClientSocket::announcesSoundHello() {
  for (asio::steady_timer timer(get_executor());;) {
    error_code ec = co_await wait(tcp::socket::wait_read);
    std::array<unsigned char, kHelloHead> head;
    const ssize_t count =
        ec ? -1 : ::recv(socket_.native_handle(), head.data(), head.size(), MSG_PEEK);
    // what is no handshake OpenSSL knows better
    if (count <= 0 || head[0] != SSL3_RT_HANDSHAKE) co_return count > 0;
    if (static_cast<std::size_t>(count) == head.size())
      co_return (std::size_t{head[kRecordHead + 1]} << 16 |
                 std::size_t{head[kRecordHead + 2]} << 8 | head[kRecordHead + 3]) <= kMaxHelloBytes;
    timer.expires_after(kHelloWait);
    co_await timer.async_wait(asio::redirect_error(asio::use_awaitable, ec));
    if (cancelled_ || !socket_.is_open()) co_return false;
  }
}

bool ClientSocket::advanceHandshake(AddressLimits::Client* payer, error_code& ec) {
  const Charge charge(payer);
  ::ERR_clear_error();
  errno = 0;
  const int done = ::SSL_accept(tls_.get());
  if (done != 1) explain(done, readWantsWrite_, SSL_ERROR_WANT_WRITE, ec);
  return done == 1;
}

asio::awaitable<bool> ClientSocket::shakeHands(AddressLimits::Client* payer) {
  cancelled_ = false;
  while (tls_) {
    error_code ec;
    if (advanceHandshake(payer, ec)) break;
    if (ec == asio::error::would_block)
      ec = co_await wait(readWantsWrite_ ? tcp::socket::wait_write : tcp::socket::wait_read);
    if (ec || cancelled_) co_return false;  // perhaps it was cancelled as what it waited for came
  }
  readWantsWrite_ = false;
  co_return true;
}

bool ClientSocket::becomePlainForPlainHttp() {
  const bool plain = tlsState_ == TlsState::kPlainHttp;
  if (plain) tls_.reset();
  return plain;
}

std::size_t ClientSocket::read(std::span<char> into, error_code& ec) {
  assert(!into.empty());
  if (!tls_) {
    const ssize_t count = ::recv(socket_.native_handle(), into.data(), into.size(), 0);
    if (count > 0) return static_cast<std::size_t>(count);
    if (count < 0) return failed(errno, ec);
    ec = asio::error::eof;
    return 0;
  }
  if (tlsState_ != TlsState::kSound) return ec = asio::error::connection_aborted, 0;
  std::size_t count = 0;
  ::ERR_clear_error();
  errno = 0;
  const int done = ::SSL_read_ex(tls_.get(), into.data(), into.size(), &count);
  readWantsWrite_ = false;
  if (done != 1) explain(done, readWantsWrite_, SSL_ERROR_WANT_WRITE, ec);
  if (count > 0) SSL_set_app_data(tls_.get(), nullptr);
  if (reinterpret_cast<std::uintptr_t>(SSL_get_app_data(tls_.get())) > kMaxKeyUpdates)
    tlsState_ = TlsState::kBroken, ec = asio::error::connection_aborted;
  return count;
}

std::size_t ClientSocket::write(std::span<const iovec> parts, bool more, error_code& ec) {
  assert(!parts.empty());
  if (!tls_) {
    msghdr message{};
    message.msg_iov = const_cast<iovec*>(parts.data());
    message.msg_iovlen = parts.size();
    const ssize_t count =
        ::sendmsg(socket_.native_handle(), &message, MSG_NOSIGNAL | (more ? MSG_MORE : 0));
    return count < 0 ? failed(errno, ec) : static_cast<std::size_t>(count);
  }
  if (tlsState_ != TlsState::kSound) return ec = asio::error::connection_aborted, 0;
  // A record: of one large part where it lies, of small ones together.
  std::array<char, kRecordBytes> gathered;
  const void* record = parts.front().iov_base;
  std::size_t bytes = std::min(parts.front().iov_len, kRecordBytes);
  for (std::size_t i = 1; i < parts.size() && bytes < kRecordBytes; ++i) {
    if (i == 1) std::memcpy(gathered.data(), record, bytes), record = gathered.data();
    const std::size_t taken = std::min(parts[i].iov_len, kRecordBytes - bytes);
    if (taken > 0) std::memcpy(gathered.data() + bytes, parts[i].iov_base, taken);
    bytes += taken;
  }
  std::size_t count = 0;
  ::ERR_clear_error();
  errno = 0;
  const int done = ::SSL_write_ex(tls_.get(), record, bytes, &count);
  writeWantsRead_ = false;
  if (done != 1) explain(done, writeWantsRead_, SSL_ERROR_WANT_READ, ec);
  return count;
}

std::size_t ClientSocket::writeFile(FilePart file, ByteView bytes, error_code& ec) {
  if (tls_) {
    const iovec part{const_cast<std::uint8_t*>(bytes.data()), bytes.size()};
    return write({&part, 1}, false, ec);
  }
  auto offset = static_cast<off_t>(file.offset);
  const ssize_t count = ::sendfile(socket_.native_handle(), file.descriptor, &offset, bytes.size());
  if (count > 0) return static_cast<std::size_t>(count);
  return failed(count == 0 ? EIO : errno, ec);
}

void ClientSocket::holdBack(bool hold) {
  const int on = hold ? 1 : 0;
  (void)::setsockopt(socket_.native_handle(), IPPROTO_TCP, TCP_CORK, &on, sizeof(on));
}

asio::awaitable<error_code> ClientSocket::wait(asio::socket_base::wait_type what) {
  error_code ec;
  co_await socket_.async_wait(what, asio::redirect_error(asio::use_awaitable, ec));
  co_return ec;
}

asio::awaitable<error_code> ClientSocket::waitToRead() {
  // decrypted already: the socket would say nothing of it
  if (tls_ && ::SSL_pending(tls_.get()) > 0) {
    co_await asio::post(get_executor(), asio::use_awaitable);
    co_return error_code();
  }
  co_return co_await wait(readWantsWrite_ ? tcp::socket::wait_write : tcp::socket::wait_read);
}

asio::awaitable<error_code> ClientSocket::waitToWrite() {
  co_return co_await wait(writeWantsRead_ ? tcp::socket::wait_read : tcp::socket::wait_write);
}

asio::awaitable<bool> ClientSocket::waitForCancel() {
  const error_code ec = co_await wait(tcp::socket::wait_error);
  co_return ec == asio::error::operation_aborted;
}

Arrived ClientSocket::arrived() {
  char byte = 0;
  if (!tls_) {
    const ssize_t count = ::recv(socket_.native_handle(), &byte, 1, MSG_PEEK | MSG_DONTWAIT);
    if (count > 0) return Arrived::kBytes;
    return count < 0 && (errno == EAGAIN || errno == EINTR) ? Arrived::kNothing : Arrived::kEnd;
  }
  std::size_t count = 0;
  error_code ec;
  ::ERR_clear_error();
  errno = 0;
  const int done = ::SSL_peek_ex(tls_.get(), &byte, 1, &count);
  if (done == 1) return Arrived::kBytes;
  explain(done, readWantsWrite_, SSL_ERROR_WANT_WRITE, ec);
  return ec == asio::error::would_block ? Arrived::kNothing : Arrived::kEnd;
}

void ClientSocket::cancel() {
  cancelled_ = true;
  error_code ec;
  socket_.cancel(ec);
}

void ClientSocket::finishSending() {
  ::ERR_clear_error();
  if (tls_ && tlsState_ == TlsState::kSound && ::SSL_is_init_finished(tls_.get()))
    (void)::SSL_shutdown(tls_.get());
  error_code ec;
  socket_.shutdown(tcp::socket::shutdown_send, ec);
}

void ClientSocket::close() {
  error_code ec;
  socket_.close(ec);
}

}  // namespace qtet
