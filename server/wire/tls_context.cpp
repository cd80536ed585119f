#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/wire/tls_context.h"

#include <openssl/err.h>
#include <openssl/ssl.h>

#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/error.hpp>
#include <cstdint>
#include <ctime>
#include <new>
#include <string>
#include <string_view>

namespace qtet {
namespace {

namespace asio = boost::asio;
namespace ssl = asio::ssl;
using boost::system::error_code;

/// For TLS 1.2; all ciphers of TLS 1.3 are of this kind.
constexpr const char* kCiphers = "ECDHE+AESGCM:ECDHE+CHACHA20";
/// As ALPN writes it: its length, then the name.
constexpr std::string_view kHttp11 = "\x08http/1.1";

/// Chooses HTTP/1.1. A client that offers others alone is refused by the alert
/// no_application_protocol (RFC 7301, 3.2). One without ALPN does not come here, and is served.
int chooseProtocol(SSL*, const unsigned char** out, unsigned char* outBytes,
                   const unsigned char* offered, unsigned offeredBytes, void*) {
  unsigned char* chosen = nullptr;
  const auto* ours = reinterpret_cast<const unsigned char*>(kHttp11.data());
  if (::SSL_select_next_proto(&chosen, outBytes, ours, kHttp11.size(), offered, offeredBytes) !=
      OPENSSL_NPN_NEGOTIATED)
    return SSL_TLSEXT_ERR_ALERT_FATAL;
  *out = chosen;
  return SSL_TLSEXT_ERR_OK;
}

/// A client of TLS 1.3 may send any number of key updates. The session's application data counts
/// those that have arrived since the last bytes of data.
void countKeyUpdates(int sent, int, int type, const void* bytes, std::size_t count, SSL* session,
                     void*) {
  if (sent != 0 || type != SSL3_RT_HANDSHAKE || count == 0 ||
      *static_cast<const unsigned char*>(bytes) != SSL3_MT_KEY_UPDATE)
    return;
  SSL_set_app_data(session, reinterpret_cast<void*>(
                                reinterpret_cast<std::uintptr_t>(SSL_get_app_data(session)) + 1));
}

class OpenSslContext : public TlsContext {
 public:
  OpenSslContext() {
    SSL_CTX* context = context_.native_handle();
    ::SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION);
    ::SSL_CTX_set_cipher_list(context, kCiphers);
    ::SSL_CTX_set_options(context, SSL_OP_NO_COMPRESSION | SSL_OP_NO_RENEGOTIATION);
    // Idle connections hold no buffers; what is written next may lie elsewhere, and be taken in
    // part.
    ::SSL_CTX_set_mode(context, SSL_MODE_RELEASE_BUFFERS | SSL_MODE_ENABLE_PARTIAL_WRITE |
                                    SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
    // One record a call: others have their turn between those that bring no data.
    ::SSL_CTX_clear_mode(context, SSL_MODE_AUTO_RETRY);
    ::SSL_CTX_set_msg_callback(context, countKeyUpdates);
    ::SSL_CTX_set_alpn_select_cb(context, chooseProtocol, nullptr);
  }
  [[nodiscard]] ssl::context& context() { return context_; }
  [[nodiscard]] ssl_st* newSession(int socket) const override {
    SSL* out = ::SSL_new(context_.native_handle());
    if (out == nullptr || ::SSL_set_fd(out, socket) != 1) {
      ::SSL_free(out);
      throw std::bad_alloc();
    }
    ::SSL_set_accept_state(out);
    return out;
  }
  [[nodiscard]] std::chrono::system_clock::time_point expires() const override {
    const X509* certificate = ::SSL_CTX_get0_certificate(context_.native_handle());
    std::tm end{};
    if (certificate == nullptr || ::ASN1_TIME_to_tm(::X509_get0_notAfter(certificate), &end) != 1)
      return {};
    return std::chrono::system_clock::from_time_t(::timegm(&end));
  }

 private:
  // its handle is not const; SSL_new only counts a reference
  mutable ssl::context context_{ssl::context::tls_server};
};

}  // namespace

Result<std::shared_ptr<const TlsContext>> TlsContext::load(const std::filesystem::path& certificate,
                                                           const std::filesystem::path& key) {
  auto out = std::make_shared<OpenSslContext>();
  error_code ec;
  const auto refused = [&](const std::filesystem::path& path, const std::string& what) {
    return fail(ErrorCode::kBadValue, path.string() + " " + what + " (" + ec.message() + ")");
  };
  // A server has nobody to ask for a pass phrase.
  out->context().set_password_callback(
      [](std::size_t, ssl::context::password_purpose) { return std::string(); }, ec);
  if (!ec) out->context().use_certificate_chain_file(certificate.string(), ec);
  if (ec)
    return refused(certificate, "holds no certificate that can be read, in PEM, its own first");
  out->context().use_private_key_file(key.string(), ssl::context::pem, ec);
  if (ec)
    return refused(key,
                   "holds no key in PEM, unencrypted, that belongs to " + certificate.string());
  // OpenSSL keeps a key of each kind: one of another kind than the certificate's is no error to it.
  ::ERR_clear_error();
  if (::SSL_CTX_check_private_key(out->context().native_handle()) != 1) {
    ec = error_code(static_cast<int>(::ERR_get_error()), asio::error::get_ssl_category());
    return refused(key, "holds a key, but not that of " + certificate.string());
  }
  return out;
}

}  // namespace qtet
