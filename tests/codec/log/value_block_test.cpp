// Value blocks: symbols and digits, Draco and the adaptive coder, there and back; what a damaged
// one may do.
#include "codec/log/value_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "codec/coding/adaptive_block.h"
#include "codec/coding/draco_block.h"
#include "codec/coding/value_digits.h"
#include "proto/limits.h"

namespace qtet {
namespace {

constexpr std::array kCodecs{CodecId::kDraco, CodecId::kAdaptive};
constexpr std::int32_t kLargest = std::numeric_limits<std::int32_t>::max();

std::vector<std::int32_t> someValues(std::mt19937& random, std::size_t count, int bits) {
  std::vector<std::int32_t> out(count);
  for (std::int32_t& value : out) {
    value = static_cast<std::int32_t>((random() & ((1u << bits) - 1)) >>
                                      (random() % static_cast<unsigned>(bits)));
    if (random() % 2) value = -value;
  }
  return out;
}

TEST(ValueDigits, everyNumberOfBitsComesBackFromItsSymbolAndDigits) {
  for (int bits = 0; bits <= digits::kMaxBits; ++bits)
    for (const std::int64_t off : {-1, 0, 1}) {
      const std::int64_t magnitude = (std::int64_t{1} << bits) + off;
      if (magnitude > kLargest || magnitude < 0) continue;
      for (const auto value :
           {static_cast<std::int32_t>(magnitude), -static_cast<std::int32_t>(magnitude)}) {
        const digits::Split s = digits::split(value);
        ASSERT_LT(std::abs(s.symbol), digits::kSymbols) << value;
        ASSERT_EQ(digits::countOf(s.symbol), s.count) << value;
        ASSERT_EQ(s.digits >> s.count, 0u) << value;
        ASSERT_EQ(digits::join(s.symbol, s.digits), value);
      }
    }
}

TEST(ValueDigits, twelveBitsTakeLessThanAHundredSymbols) {
  std::vector<std::int32_t> values;
  for (std::int32_t value = -4095; value <= 4095; ++value) values.push_back(value);
  std::vector<std::int32_t> symbols = splitValues(values).symbols;
  std::ranges::sort(symbols);
  EXPECT_LT(std::ranges::unique(symbols).begin() - symbols.begin(), 100);
}

TEST(ValueDigits, tooFewTooManyAndLeftOverDigitsAreRefused) {
  const std::vector<std::int32_t> values{1000, -77, 3, 123456};
  const SymbolsAndDigits parts = splitValues(values);
  ASSERT_EQ(joinValues(parts.symbols, parts.digits).value(), values);
  for (std::size_t size = 0; size < parts.digits.size(); ++size)
    EXPECT_EQ(joinValues(parts.symbols, ByteView(parts.digits).first(size)).error().code,
              ErrorCode::kBadValue)
        << size;
  Bytes longer = parts.digits;
  longer.push_back(0);
  EXPECT_EQ(joinValues(parts.symbols, longer).error().code, ErrorCode::kBadValue);
  // one digit, seven bits left over
  Bytes dirty = splitValues(std::vector<std::int32_t>{5}).digits;
  dirty[0] |= 0x80;
  EXPECT_EQ(joinValues(std::vector<std::int32_t>{digits::split(5).symbol}, dirty).error().code,
            ErrorCode::kBadValue);
  for (const std::int32_t symbol :
       {digits::kSymbols, -digits::kSymbols, kLargest, std::numeric_limits<std::int32_t>::min()})
    EXPECT_EQ(joinValues(std::vector{symbol}, Bytes(8, 0)).error().code, ErrorCode::kBadValue)
        << symbol;
}

TEST(ValueBlock, givesBackWhatItWasGiven) {
  std::mt19937 random(1);
  for (const CodecId codec : kCodecs)
    for (const std::uint32_t components : {1u, 3u, 9u, 16u})
      for (const int bits : {1, 8, 16, 30}) {
        const std::vector<std::int32_t> values =
            someValues(random, std::size_t{components} * 500, bits);
        const Bytes block = encodeValueBlock(values, components, codec).value();
        ASSERT_EQ(decodeValueBlock(block, components, 500, codec).value(), values)
            << components << " components of " << bits << " bits";
      }
}

TEST(ValueBlock, theLargestValuesComeBackAndTheOneBeyondIsRefused) {
  const std::vector<std::int32_t> edge{kLargest, -kLargest, 0, 1};
  for (const CodecId codec : kCodecs) {
    EXPECT_EQ(decodeValueBlock(encodeValueBlock(edge, 1, codec).value(), 1, 4, codec).value(),
              edge);
    EXPECT_EQ(encodeValueBlock(std::vector{std::numeric_limits<std::int32_t>::min()}, 1, codec)
                  .error()
                  .code,
              ErrorCode::kLimitExceeded);
  }
}

TEST(ValueBlock, noTuplesAreNoBytes) {
  for (const CodecId codec : kCodecs) {
    EXPECT_TRUE(encodeValueBlock({}, 3, codec).value().empty());
    EXPECT_TRUE(decodeValueBlock({}, 3, 0, codec).value().empty());
    EXPECT_EQ(decodeValueBlock(Bytes{1}, 3, 0, codec).error().code, ErrorCode::kBadValue);
  }
}

TEST(ValueBlock, itsFirstPartIsAnOrdinaryDracoStream) {
  std::mt19937 random(2);
  const std::vector<std::int32_t> values = someValues(random, 900, 12);
  const Bytes block = encodeValueBlock(values, 3, CodecId::kDraco).value();
  const std::size_t digitBytes = splitValues(values).digits.size();
  const auto symbols =
      decodeDracoBlock(ByteView(block).first(block.size() - 4 - digitBytes), 3, 300);
  ASSERT_TRUE(symbols) << symbols.error().text();
  EXPECT_EQ(*symbols, splitValues(values).symbols);
}

TEST(ValueBlock, everyTruncationIsRefused) {
  std::mt19937 random(3);
  const std::vector<std::int32_t> values = someValues(random, 300, 14);
  for (const CodecId codec : kCodecs) {
    const Bytes block = encodeValueBlock(values, 3, codec).value();
    for (std::size_t size = 0; size < block.size(); ++size) {
      const auto decoded = decodeValueBlock(ByteView(block).first(size), 3, 100, codec);
      ASSERT_TRUE(!decoded || *decoded != values) << size;
    }
    EXPECT_FALSE(decodeValueBlock(block, 3, 99, codec));
    EXPECT_FALSE(decodeValueBlock(block, 3, 101, codec));
  }
}

TEST(AdaptiveBlock, aPromiseBeyondItsBytesAllocatesNothing) {
  EXPECT_EQ(decodeAdaptiveBlock(Bytes(8, 0), 16, 1u << 29).error().code, ErrorCode::kLimitExceeded);
}

TEST(AdaptiveBlock, mayPromiseAsManyValuesAsItsBytesHoldDecisionsAndNoMore) {
  constexpr std::size_t kBytes = 6;
  constexpr std::uint32_t kMax = kMaxDecisionsPerByte * (kBytes + 4);
  for (const std::uint32_t components : {1u, 16u})
    for (const std::uint32_t tuples : {kMax / components - 1, kMax / components}) {
      const auto decoded = decodeAdaptiveBlock(Bytes(kBytes, 0), components, tuples);
      EXPECT_TRUE(decoded || decoded.error().code != ErrorCode::kLimitExceeded) << tuples;
    }
  for (const std::uint32_t components : {1u, 16u})
    EXPECT_EQ(decodeAdaptiveBlock(Bytes(kBytes, 0), components, kMax / components + 1).error().code,
              ErrorCode::kLimitExceeded);
}

TEST(AdaptiveBlock, isSmallerThanDracosOnWhatAMeshHas) {
  std::mt19937 random(4);
  std::vector<std::int32_t> values;
  for (int i = 0; i < 6000; ++i) {
    const double scale = i < 3000 ? 6 : 60;
    values.push_back(static_cast<std::int32_t>(std::normal_distribution<double>(0, scale)(random)));
  }
  EXPECT_LT(encodeValueBlock(values, 3, CodecId::kAdaptive).value().size() * 100,
            encodeValueBlock(values, 3, CodecId::kDraco).value().size() * 97);
}

}  // namespace
}  // namespace qtet
