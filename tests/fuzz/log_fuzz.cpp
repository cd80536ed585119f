// Fuzzes the front of a log: the input stands for header, manifest and table. Checksums are made right first, so that the checks behind them
// are reached; whatever is accepted is encoded again and must give the same bytes.
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "codec/log_index.h"
#include "proto/crc32c.h"
#include "proto/manifest.h"

namespace {

std::uint32_t u32(const qtet::Bytes& bytes, std::size_t at) {
  return std::uint32_t{bytes[at]} | std::uint32_t{bytes[at + 1]} << 8 | std::uint32_t{bytes[at + 2]} << 16 | std::uint32_t{bytes[at + 3]} << 24;
}

void put(qtet::Bytes& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

void mendChecksums(qtet::Bytes& bytes) {
  if (bytes.size() < qtet::LogIndex::kHeaderBytes) return;
  const std::uint64_t manifest = u32(bytes, 24);
  const std::uint64_t table = u32(bytes, 28);
  if (64 + manifest + table <= bytes.size()) {
    put(bytes, 32, qtet::crc32c(qtet::ByteView(bytes).subspan(64, manifest)));
    put(bytes, 36, qtet::crc32c(qtet::ByteView(bytes).subspan(64 + manifest, table)));
  }
  put(bytes, 60, qtet::crc32c(qtet::ByteView(bytes).first(60)));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  qtet::Bytes bytes(data, data + size);
  mendChecksums(bytes);
  (void)qtet::LogIndex::headBytesOf(bytes);
  const auto index = qtet::LogIndex::parse(bytes);
  if (!index) return 0;
  (void)qtet::manifestFromJson(index->manifest);
  const qtet::Bytes again = index->encode();
  const auto reparsed = qtet::LogIndex::parse(again);
  if (!reparsed || reparsed->encode() != again || reparsed->headBytes() != index->headBytes()) std::abort();
  return 0;
}
