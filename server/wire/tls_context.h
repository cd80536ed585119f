// The server's certificate and key, and what of TLS is spoken with them.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>

#include "proto/error.h"

struct ssl_st;  // OpenSSL's SSL: its headers stay in the two .cpp files that use it

namespace qtet {

/// TLS 1.2 with forward secrecy and authenticated encryption, and TLS 1.3; no renegotiation, no
/// compression. Immutable, thread-safe.
class TlsContext {
 public:
  /// PEM files: the certificate with what leads from it to a root, and its key, not encrypted.
  /// Errors: io, bad-value (no certificate, no key, or one of another certificate).
  [[nodiscard]] static Result<std::shared_ptr<const TlsContext>> load(
      const std::filesystem::path& certificate, const std::filesystem::path& key);
  virtual ~TlsContext() = default;

  /// The server's side of one connection over that socket. It keeps this context's certificate,
  /// even when the context has gone. Throws std::bad_alloc.
  [[nodiscard]] virtual ssl_st* newSession(int socket) const = 0;
  /// When the server's own certificate ends.
  [[nodiscard]] virtual std::chrono::system_clock::time_point expires() const = 0;
};

/// The context for new connections; SIGHUP brings another one. Thread-safe: `mutex_` guards the
/// pointer.
class CurrentTls {
 public:
  explicit CurrentTls(std::shared_ptr<const TlsContext> context) : context_(std::move(context)) {}
  [[nodiscard]] std::shared_ptr<const TlsContext> now() const {
    const std::scoped_lock lock(mutex_);
    return context_;
  }
  void replace(std::shared_ptr<const TlsContext> context) {
    const std::scoped_lock lock(mutex_);
    context_.swap(context);
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const TlsContext> context_;
};

}  // namespace qtet
