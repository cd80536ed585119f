// Small writes to a file, gathered into large ones.
#pragma once

#include <cerrno>
#include <cstddef>

#include "codec/files/file_calls.h"
#include "proto/bytes.h"

namespace qtet {

class BufferedFile {
 public:
  /// `calls` must outlive it; `file` stays the caller's.
  BufferedFile(int file, FileCalls& calls) : calls_(calls), file_(file) {}

  /// False, and errno: a write failed. Flush() writes the rest of the buffer.
  [[nodiscard]] bool write(ByteView bytes) {
    if (bytes.size() >= kBytes) return flush() && writeAll(bytes);
    if (held_.size() + bytes.size() > kBytes && !flush()) return false;
    held_.insert(held_.end(), bytes.begin(), bytes.end());
    return true;
  }
  [[nodiscard]] bool flush() {
    const bool isWritten = writeAll(held_);
    held_.clear();
    return isWritten;
  }

 private:
  static constexpr std::size_t kBytes = 1 << 20;  // of one write

  bool writeAll(ByteView bytes) {
    while (!bytes.empty()) {
      // Linux writes at most 2^31 - 4096 bytes a call.
      const ssize_t written = calls_.write(file_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written == 0) errno = EIO;
      if (written <= 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return true;
  }

  FileCalls& calls_;
  int file_;
  Bytes held_;
};

}  // namespace qtet
