// Servers that lie about the log that they have.
#include "simplify/remote/old_log.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>

#include "proto/checksum.h"
#include "tests/simplify/remote/canned_server.h"
#include "tests/support/forged_log.h"
#include "tests/support/meshes.h"
#include "tests/support/written_log.h"

namespace qtet {
namespace {

std::string answered(unsigned status, const std::string& body) {
  return "HTTP/1.1 " + std::to_string(status) +
         " Said\r\nContent-Length: " + std::to_string(body.size()) +
         "\r\nConnection: close\r\n\r\n" + body;
}

/// A server that has a log, and what may be wrong with its answers.
struct Liar {
  Bytes log = testing::logBytes(testing::gridMesh(3, 1));
  std::string digest = sha256Hex(log);
  std::uint64_t bytes = log.size();
  unsigned status = 206;
  std::size_t missing = 0;  ///< bytes of each range
  std::string description{};

  [[nodiscard]] std::string answer(const std::string& head) const {
    const std::size_t range = head.find("Range: bytes=");
    if (range == head.npos)
      return answered(200, !description.empty() ? description
                                                : R"({"digest":")" + digest + R"(","bytes":)" +
                                                      std::to_string(bytes) + "}");
    char* end = nullptr;
    const std::size_t first = std::strtoull(head.c_str() + range + 13, &end, 10);
    const std::size_t last = std::strtoull(end + 1, nullptr, 10);
    std::string body;
    for (std::size_t i = first; i + missing <= last; ++i)
      body += static_cast<char>(i < log.size() ? log[i] : 0);
    return answered(status, body);
  }
  [[nodiscard]] Result<OldLog> fetched() const {
    const test::CannedServer server([this](const std::string& head) { return answer(head); });
    return fetchOldLog({server.origin(), "/"}, {.method = "GET", .target = "/v1/meshes/a"});
  }
};

TEST(OldLog, hasTheTableOfTheServersLog) {
  const Liar honest;
  const Result<OldLog> old = honest.fetched();
  ASSERT_TRUE(old) << old.error().text();
  EXPECT_EQ(old->digest, honest.digest);
  EXPECT_EQ(old->index.fileBytes, honest.log.size());
  EXPECT_GT(old->index.chunks.size(), 1u);
}

void expectRefused(const std::function<void(Liar&)>& lie, ErrorCode code) {
  Liar liar;
  lie(liar);
  const Result<OldLog> old = liar.fetched();
  ASSERT_FALSE(old);
  EXPECT_EQ(old.error().code, code) << old.error().text();
}

TEST(OldLog, whatCannotBeIsRefused) {
  for (const char* text : {"no JSON", "[]", "{}", R"({"digest":1,"bytes":9})",
                           R"({"digest":"ab","bytes":9})", R"({"digest":"ab","bytes":-9})"})
    expectRefused([&](Liar& liar) { liar.description = text; }, ErrorCode::kIo);
  expectRefused([](Liar& liar) { liar.digest += "/../x"; }, ErrorCode::kIo);
  expectRefused([](Liar& liar) { liar.status = 200; }, ErrorCode::kIo);
  expectRefused([](Liar& liar) { liar.status = 404; }, ErrorCode::kNotFound);
  expectRefused([](Liar& liar) { liar.missing = 1; }, ErrorCode::kIo);
  expectRefused([](Liar& liar) { ++liar.bytes; }, ErrorCode::kIo);
  expectRefused([](Liar& liar) { liar.bytes = 10; }, ErrorCode::kTruncated);
  expectRefused([](Liar& liar) { liar.log[40] ^= 1; }, ErrorCode::kBadChecksum);
}

TEST(OldLog, aFrontOf32MiBIsFetchedAndALongerOneIsNot) {
  constexpr std::uint32_t kMax = 32u << 20;
  const auto claim = [](Liar& liar, std::uint32_t bytesBehindTheHeader) {
    constexpr std::size_t kFileBytesAt = 16, kManifestBytesAt = 24, kTableBytesAt = 28;
    std::uint32_t manifest = 0;
    std::memcpy(&manifest, liar.log.data() + kManifestBytesAt, 4);
    const std::uint32_t table = bytesBehindTheHeader - manifest;
    std::memcpy(liar.log.data() + kTableBytesAt, &table, 4);
    liar.bytes = kMax + 4096;
    std::memcpy(liar.log.data() + kFileBytesAt, &liar.bytes, 8);
    testing::mendChecksums(liar.log);
  };
  for (const std::uint32_t bytes : {kMax - 1, kMax})
    expectRefused([&](Liar& liar) { claim(liar, bytes); }, ErrorCode::kBadChecksum);
  expectRefused([&](Liar& liar) { claim(liar, kMax + 1); }, ErrorCode::kLimitExceeded);
}

}  // namespace
}  // namespace qtet
