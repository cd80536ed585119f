#include "server/wire/digest.h"

#include <gtest/gtest.h>

#include "proto/checksum.h"

namespace qtet {
namespace {

TEST(Digest, isThatOfTheStandard) {
  EXPECT_EQ(hexDigestOf(std::string_view()),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hexDigestOf("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Digest, isTheSameAsOursForEveryLengthRoundABlock) {
  Bytes bytes;
  for (unsigned i = 0; i < 200; ++i) {
    EXPECT_EQ(hexDigestOf(bytes), sha256Hex(bytes)) << i;
    EXPECT_EQ(toHex(digestOf(bytes)), sha256Hex(bytes)) << i;
    bytes.push_back(static_cast<std::uint8_t>(i * 37));
  }
}

}  // namespace
}  // namespace qtet
