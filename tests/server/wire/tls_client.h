// A TLS client that sends the given bytes, and certificates to serve it with.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "tests/server/program/loopback.h"

namespace qtet::test {

/// Makes NAME.crt and NAME.key in `folder` with the openssl program: for localhost, signed by
/// itself. `algorithm` is what follows -newkey. False: there is no such program.
[[nodiscard]] bool makeCertificate(
    const std::filesystem::path& folder, const std::string& name,
    const std::string& algorithm = "ec -pkeyopt ec_paramgen_curve:prime256v1");

/// Signs NAME.crt of `folder` again with NAME.key, for a day in the past. False: it did not go.
[[nodiscard]] bool expireCertificate(const std::filesystem::path& folder, const std::string& name);

/// The first bytes of a handshake over TLS 1.3, whole.
[[nodiscard]] std::string clientHello();

struct TlsChoice {
  int least = 0;  ///< TLS1_2_VERSION and so on; 0: what OpenSSL likes
  int most = 0;
  std::string alpn{};  ///< as on the wire
};

/// Blocks, with a time-out of kPatience. Trusts the certificate in the file and no other.
class TlsClient {
 public:
  TlsClient(std::uint16_t port, const std::filesystem::path& certificate,
            const TlsChoice& choice = {});

  ~TlsClient();
  TlsClient(const TlsClient&) = delete;
  TlsClient& operator=(const TlsClient&) = delete;

  [[nodiscard]] bool connected() const { return connected_; }
  /// OpenSSL's reason (SSL_R_...) why it is not; 0: another one.
  [[nodiscard]] int refusal() const { return refusal_; }
  [[nodiscard]] std::string version() const;
  [[nodiscard]] std::string alpn() const;
  bool send(std::string_view bytes);
  /// The answer to what was sent; status 0: it did not come, or not whole.
  HttpResponse receive();
  /// Reads `bytes` bytes; fewer if the connection ended.
  std::string read(std::size_t bytes);
  /// The body of the answer to a GET; "" where it is no 200 or 206.
  std::string get(std::string_view target, std::string_view headers = "");
  /// Opens `mesh` on `/v1/stream` and joins the payloads of its frames until the server says that
  /// the stream is complete. Returns fewer if the connection ended. Nothing can be sent after this.
  std::string stream(const std::string& mesh);
  /// Changes the key so often; sent with the next bytes. REQUIRES: TLS 1.3.
  void updateKey(int times);
  /// Ends the connection as TLS wants it.
  void shutdown();

 private:
  bool fill();

  struct Line;
  std::unique_ptr<Line> line_;
  bool connected_ = false;
  int refusal_ = 0;
  std::string buffer_;  // what came and was not asked for yet
};

}  // namespace qtet::test
