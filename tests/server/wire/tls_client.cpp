#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "tests/server/wire/tls_client.h"

#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/write.hpp>
#include <cstdlib>
#include <memory>

#include "proto/messages.h"
#include "tests/server/program/loopback.h"

namespace qtet::test {

namespace asio = boost::asio;
namespace ssl = asio::ssl;
using boost::system::error_code;

bool makeCertificate(const std::filesystem::path& folder, const std::string& name,
                     const std::string& algorithm) {
  const std::string base = (folder / name).string();
  const std::string command = "openssl req -x509 -newkey " + algorithm +
                              " -nodes -days 2 -subj /CN=localhost "
                              "-addext subjectAltName=DNS:localhost -keyout '" +
                              base + ".key' -out '" + base + ".crt' 2> /dev/null";
  return std::system(command.c_str()) == 0;
}

bool expireCertificate(const std::filesystem::path& folder, const std::string& name) {
  constexpr long kHour = 3600;
  const auto file = [&](const char* ending, const char* mode) {
    return std::unique_ptr<BIO, decltype(&::BIO_free)>(
        ::BIO_new_file((folder / (name + ending)).c_str(), mode), &::BIO_free);
  };
  const std::unique_ptr<X509, decltype(&::X509_free)> certificate(
      ::PEM_read_bio_X509(file(".crt", "r").get(), nullptr, nullptr, nullptr), &::X509_free);
  const std::unique_ptr<EVP_PKEY, decltype(&::EVP_PKEY_free)> key(
      ::PEM_read_bio_PrivateKey(file(".key", "r").get(), nullptr, nullptr, nullptr),
      &::EVP_PKEY_free);
  if (!certificate || !key) return false;
  ::X509_gmtime_adj(X509_getm_notBefore(certificate.get()), -25 * kHour);
  ::X509_gmtime_adj(X509_getm_notAfter(certificate.get()), -kHour);
  return ::X509_sign(certificate.get(), key.get(), ::EVP_sha256()) > 0 &&
         ::PEM_write_bio_X509(file(".crt", "w").get(), certificate.get()) == 1;
}

std::string clientHello() {
  ssl::context context(ssl::context::tls_client);
  const std::unique_ptr<SSL, decltype(&::SSL_free)> session(::SSL_new(context.native_handle()),
                                                            &::SSL_free);
  BIO* out = ::BIO_new(::BIO_s_mem());
  ::SSL_set_bio(session.get(), ::BIO_new(::BIO_s_mem()), out);  // they go with it
  (void)::SSL_connect(session.get());
  std::string bytes(1 << 12, '\0');
  bytes.resize(static_cast<std::size_t>(
      std::max(::BIO_read(out, bytes.data(), static_cast<int>(bytes.size())), 0)));
  return bytes;
}

struct TlsClient::Line {
  asio::io_context context;
  ssl::context tls{ssl::context::tls_client};
  ssl::stream<asio::ip::tcp::socket> stream{context, tls};
};

TlsClient::TlsClient(std::uint16_t port, const std::filesystem::path& certificate,
                     const TlsChoice& choice)
    : line_(std::make_unique<Line>()) {
  auto& [context, tls, stream] = *line_;
  SSL* session = stream.native_handle();
  tls.load_verify_file(certificate.string());
  ::SSL_set1_verify_cert_store(session, ::SSL_CTX_get_cert_store(tls.native_handle()));
  stream.set_verify_mode(ssl::verify_peer);
  // Level 0 lets a client offer what is forbidden here, too.
  ::SSL_set_cipher_list(session, "ALL:@SECLEVEL=0");
  ::SSL_set_min_proto_version(session, choice.least);
  ::SSL_set_max_proto_version(session, choice.most);
  if (!choice.alpn.empty())
    ::SSL_set_alpn_protos(session, reinterpret_cast<const unsigned char*>(choice.alpn.data()),
                          static_cast<unsigned>(choice.alpn.size()));
  error_code ec;
  stream.next_layer().connect({asio::ip::address_v4::loopback(), port}, ec);
  const timeval patience{std::chrono::seconds(kPatience).count(), 0};
  ::setsockopt(stream.next_layer().native_handle(), SOL_SOCKET, SO_RCVTIMEO, &patience,
               sizeof(patience));
  if (!ec) stream.handshake(ssl::stream_base::client, ec);
  connected_ = !ec;
  if (ec.category() == asio::error::get_ssl_category())
    refusal_ = ERR_GET_REASON(static_cast<unsigned long>(ec.value()));
}

TlsClient::~TlsClient() = default;

std::string TlsClient::version() const { return ::SSL_get_version(line_->stream.native_handle()); }

std::string TlsClient::alpn() const {
  const unsigned char* name = nullptr;
  unsigned bytes = 0;
  ::SSL_get0_alpn_selected(line_->stream.native_handle(), &name, &bytes);
  return {reinterpret_cast<const char*>(name), bytes};
}

bool TlsClient::send(std::string_view bytes) {
  error_code ec;
  asio::write(line_->stream, asio::buffer(bytes), ec);
  return !ec;
}

bool TlsClient::fill() {
  std::array<char, 16384> piece;
  error_code ec;
  std::size_t count = 0;
  do count = line_->stream.read_some(asio::buffer(piece), ec);
  while (ec == asio::error::interrupted);
  buffer_.append(piece.data(), count);
  return count > 0;
}

HttpResponse TlsClient::receive() {
  return readResponse(buffer_, [this] { return fill(); });
}

std::string TlsClient::read(std::size_t bytes) {
  while (buffer_.size() < bytes && fill()) {
  }
  std::string out = buffer_.substr(0, bytes);
  buffer_.erase(0, out.size());
  return out;
}

std::string TlsClient::get(std::string_view target, std::string_view headers) {
  send("GET " + std::string(target) + " HTTP/1.1\r\nHost: localhost\r\n" + std::string(headers) +
       "\r\n");
  const HttpResponse answer = receive();
  return answer.status == 200 || answer.status == 206 ? answer.body : "";
}

std::string TlsClient::stream(const std::string& mesh) {
  send(
      "GET /v1/stream HTTP/1.1\r\nHost: a\r\nUpgrade: websocket\r\nConnection: "
      "Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: qtet.v1\r\n\r\n");
  const HttpResponse answer = receive();
  const std::string open = R"({"type":"open","credit":100000000,"mesh":")" + mesh + R"("})";
  if (answer.status != 101 || open.size() > 125 ||
      !send(std::string("\x81") + static_cast<char>(0x80 | open.size()) + std::string(4, '\0') +
            open))
    return "";  // the frame is masked with nothing
  for (std::string out;;) {
    const std::string begin = read(2);
    if (begin.size() < 2) return out;
    std::uint64_t bytes = static_cast<std::uint8_t>(begin[1]);
    const std::size_t more = bytes == 126 ? 2 : bytes == 127 ? 8 : 0;
    if (more > 0) bytes = 0;
    for (const char byte : read(more)) bytes = bytes << 8 | static_cast<std::uint8_t>(byte);
    const std::string payload = read(bytes);
    if (payload.size() < bytes) return out;
    if (static_cast<std::uint8_t>(begin[0]) == 0x82)
      out += payload.substr(std::min<std::size_t>(payload.size(), FrameHeader::kBytes));
    else if (payload.find("done") != std::string::npos)
      return out;
  }
}

void TlsClient::updateKey(int times) {
  SSL* session = line_->stream.native_handle();
  for (int i = 0; i < times; ++i) {
    ::SSL_key_update(session, SSL_KEY_UPDATE_NOT_REQUESTED);
    ::SSL_do_handshake(session);
  }
}

void TlsClient::shutdown() {
  error_code ec;
  line_->stream.shutdown(ec);
}

}  // namespace qtet::test
