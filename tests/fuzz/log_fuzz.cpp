// Fuzzes the front of a log: the input stands for header, manifest and table, and then the part of
// later instants. Checksums are made right first, so that the checks behind them are reached.
// Whatever is accepted is encoded again and must give the same bytes.
#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "codec/log/log_manifest.h"
#include "tests/support/forged_log.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  qtet::Bytes bytes(data, data + size);
  qtet::testing::mendChecksums(bytes);
  const auto headBytes = qtet::LogIndex::headBytesOf(bytes);
  const qtet::ByteView input(bytes);
  const auto index = qtet::LogIndex::parse(
      input, input.subspan(std::min<std::size_t>(headBytes.value_or(0), input.size())));
  if (!index) return 0;
  (void)qtet::manifestOf(*index);
  const qtet::Bytes again = index->encode();
  const auto reparsed = qtet::LogIndex::parse(again, index->encodeLater());
  if (!reparsed || reparsed->encode() != again || reparsed->headBytes() != index->headBytes())
    std::abort();
  return 0;
}
