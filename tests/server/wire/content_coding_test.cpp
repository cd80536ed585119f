#include "server/wire/content_coding.h"

#include <gtest/gtest.h>
#include <zlib.h>
#include <zstd.h>

namespace qtet {
namespace {

TEST(ContentCoding, theClientsWeightsDecide) {
  using enum ContentCoding;
  const auto chosen = [](const char* value) { return chooseCoding(value, true, true); };
  for (const char* value : {"gzip", "GZIP", "deflate, gzip;q=1.0, br", "br , gzip ; q=0.001",
                            "x-gzip", "gzip;q=0.5,*;q=0", "gzip, zstd;q=0.9"})
    EXPECT_EQ(chosen(value), kGzip) << value;
  for (const char* value :
       {"zstd", "gzip, deflate, br, zstd", "*", "gzip;q=0.5, zstd;q=0.51", "identity, zstd"})
    EXPECT_EQ(chosen(value), kZstd) << value;
  for (const char* value : {"", "br", "gzip;q=0", "gzip; q=0.000, zstd;q=0, *", "*;q=0", "identity",
                            "gzipped", ";;,,", "*;Q=0.0", "identity;q=1, gzip;q=0.5"})
    EXPECT_EQ(chosen(value), kIdentity) << value;
  EXPECT_EQ(chooseCoding("gzip, zstd", true, false), kGzip);
  EXPECT_EQ(chooseCoding("gzip, zstd", false, false), kIdentity);
}

Bytes unpackedGzip(const Bytes& bytes, std::size_t size) {
  Bytes out(size + 1);
  z_stream stream{};
  inflateInit2(&stream, 15 + 16);
  stream.next_in = const_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  inflateEnd(&stream);
  return out;
}

TEST(ContentCoding, whatIsPackedCanBeUnpacked) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{5000},
                                 std::size_t{1} << 20, (std::size_t{5} << 20) + 3}) {
    Bytes bytes(size);
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>((i * i) >> 12);
    EXPECT_EQ(unpackedGzip(encoded(bytes, ContentCoding::kGzip), size), bytes) << size;
    const Bytes zstd = encoded(bytes, ContentCoding::kZstd);
    Bytes back(size);
    EXPECT_EQ(ZSTD_decompress(back.data(), back.size(), zstd.data(), zstd.size()), size);
    EXPECT_EQ(back, bytes) << size;
  }
}

TEST(ContentCoding, whatDoesNotGetSmallerIsLeftAlone) {
  EXPECT_TRUE(compressed(Bytes(3, 1), ContentCoding::kGzip).empty());
  EXPECT_FALSE(compressed(Bytes(3000, 1), ContentCoding::kZstd).empty());
}

}  // namespace
}  // namespace qtet
