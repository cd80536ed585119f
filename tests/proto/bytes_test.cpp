#include "proto/bytes.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

TEST(Bytes, integersAreLittleEndian) {
  ByteWriter writer;
  writer.write(std::uint32_t{0x01020304});
  writer.write(std::uint16_t{0xABCD});
  writer.write(std::int8_t{-2});
  EXPECT_EQ(writer.bytes(), (Bytes{4, 3, 2, 1, 0xCD, 0xAB, 0xFE}));
}

TEST(Bytes, whatWasWrittenIsReadBack) {
  ByteWriter writer;
  writer.write(std::uint64_t{0xFFFFFFFFFFFFFFFFu});
  writer.write(std::int32_t{-123456789});
  writer.write(std::uint8_t{7});
  const Bytes bytes = writer.take();
  ByteReader reader(bytes);
  EXPECT_EQ(reader.read<std::uint64_t>(), 0xFFFFFFFFFFFFFFFFu);
  EXPECT_EQ(reader.read<std::int32_t>(), -123456789);
  EXPECT_EQ(reader.read<std::uint8_t>(), 7);
  EXPECT_FALSE(reader.failed());
  EXPECT_EQ(reader.remaining(), 0u);
}

TEST(Bytes, aReadBeyondTheEndGivesZeroAndSaysWhere) {
  const Bytes bytes{1, 2, 3};
  ByteReader reader(bytes, 100);
  EXPECT_EQ(reader.read<std::uint16_t>(), 0x0201);
  EXPECT_EQ(reader.read<std::uint32_t>(), 0u);
  ASSERT_TRUE(reader.failed());
  EXPECT_EQ(reader.error().code, ErrorCode::kTruncated);
  EXPECT_EQ(reader.error().offset, 102u);
}

TEST(Bytes, theFirstErrorStaysAndNothingIsReadAfterIt) {
  const Bytes bytes{1, 2, 3, 4};
  ByteReader reader(bytes);
  reader.fail(ErrorCode::kBadValue, "first");
  reader.fail(ErrorCode::kBadMagic, "second");
  EXPECT_EQ(reader.read<std::uint8_t>(), 0);
  EXPECT_TRUE(reader.take(1).empty());
  EXPECT_EQ(reader.error().code, ErrorCode::kBadValue);
  EXPECT_EQ(reader.error().message, "first");
}

TEST(Bytes, aHugeCountIsRefusedAndNotWrappedRound) {
  const Bytes bytes{1, 2, 3, 4};
  ByteReader reader(bytes);
  (void)reader.read<std::uint8_t>();
  EXPECT_TRUE(reader.take(~std::uint64_t{0}).empty());
  EXPECT_EQ(reader.error().code, ErrorCode::kTruncated);
}

TEST(Errors, aTextNamesTheCodeAndTheOffset) {
  EXPECT_EQ((Error{ErrorCode::kBadChecksum, "no match", 12}).text(),
            "bad-checksum at byte 12: no match");
  EXPECT_EQ((Error{ErrorCode::kIo, "no file"}).text(), "io: no file");
}

}  // namespace
}  // namespace qtet
