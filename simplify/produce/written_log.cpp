#include "simplify/produce/written_log.h"

#include "proto/checksum.h"

namespace qtet {

Result<WrittenLog> writeLog(const Output& output, const ByteSource& log) {
  WrittenLog out;
  Sha256 sha;
  const Status written = writeOutput(output, [&](const ByteSink& file) {
    return log([&](ByteView piece) {
      sha.update(piece);
      out.bytes += piece.size();
      return file(piece);
    });
  });
  if (!written) return std::unexpected(written.error());
  out.digest = toHex(sha.finish());
  return out;
}

}  // namespace qtet
