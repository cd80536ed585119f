// Known vectors: the CRC catalogue's check value and the examples of RFC 3720, appendix B.4. Every
// way of computing it gives the same.
#include "proto/crc32c.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string_view>

namespace qtet {
namespace {

ByteView bytesOf(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// The definition, bit by bit.
std::uint32_t byDefinition(ByteView bytes) {
  std::uint32_t c = ~0u;
  for (const std::uint8_t b : bytes) {
    c ^= b;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1) ? 0x82F63B78u ^ (c >> 1) : c >> 1;
  }
  return ~c;
}

Bytes ascending() {
  Bytes bytes(32);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
  return bytes;
}

Bytes descending() {
  Bytes bytes = ascending();
  std::ranges::reverse(bytes);
  return bytes;
}

/// "An iSCSI - SCSI Read (10) Command PDU".
Bytes scsiRead() {
  Bytes bytes(48, 0);
  bytes[0] = 0x01, bytes[1] = 0xC0, bytes[16] = 0x14, bytes[22] = 0x04, bytes[27] = 0x14,
  bytes[31] = 0x18, bytes[32] = 0x28, bytes[40] = 0x02;
  return bytes;
}

class Crc32c : public ::testing::TestWithParam<Crc32cPath> {};

TEST_P(Crc32c, knownVectors) {
  const auto crc = GetParam().run;
  EXPECT_EQ(crc({}), 0u);
  EXPECT_EQ(crc(bytesOf("123456789")), 0xE3069283u);
  EXPECT_EQ(crc(bytesOf("a")), 0xC1D04330u);
  EXPECT_EQ(crc(Bytes(32, 0x00)), 0x8A9136AAu);
  EXPECT_EQ(crc(Bytes(32, 0xFF)), 0x62A8AB43u);
  EXPECT_EQ(crc(ascending()), 0x46DD794Eu);
  EXPECT_EQ(crc(descending()), 0x113FDB5Cu);
  EXPECT_EQ(crc(scsiRead()), 0xD9963A56u);
}

TEST_P(Crc32c, everyLengthAndAlignmentAgreesWithTheDefinition) {
  std::mt19937 random(1);
  Bytes bytes(300);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  for (std::size_t start = 0; start < 16; ++start)
    for (std::size_t n = 0; n < 130; ++n) {
      const ByteView part = ByteView(bytes).subspan(start, n);
      ASSERT_EQ(GetParam().run(part), byDefinition(part)) << n << " bytes from " << start;
    }
}

TEST_P(Crc32c, longRandomBytesAgreeWithTheTables) {
  std::mt19937 random(2);
  Bytes bytes(100'000);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  for (int i = 0; i < 300; ++i) {
    const std::size_t start = random() % 1000;
    const ByteView part = ByteView(bytes).subspan(start, random() % (bytes.size() - start));
    ASSERT_EQ(GetParam().run(part), crc32cPaths().back().run(part))
        << part.size() << " bytes from " << start;
    if (i % 50 == 0) {
      ASSERT_EQ(GetParam().run(part), byDefinition(part));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, Crc32c,
                         ::testing::ValuesIn(crc32cPaths().begin(), crc32cPaths().end()),
                         [](const auto& path) {
                           return path.index + 1 == crc32cPaths().size() ? "tables" : "instruction";
                         });

TEST(Crc32cPaths, theInstructionIsTakenWhereThereIsOneAndTheTablesAreAlwaysThere) {
  ASSERT_FALSE(crc32cPaths().empty());
  EXPECT_STREQ(crc32cPaths().back().name, "tables");
#if defined(__x86_64__)
  EXPECT_EQ(crc32cPaths().size(), __builtin_cpu_supports("sse4.2") ? 2u : 1u);
#endif
  const Bytes bytes = ascending();
  EXPECT_EQ(crc32c(bytes), crc32cPaths().front().run(bytes));
}

}  // namespace
}  // namespace qtet
