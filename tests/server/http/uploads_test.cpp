// PUT and DELETE over a real socket: a log is there whole or not at all.
#include "server/http/uploads.h"

#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/fsuid.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <new>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "codec/log/decoding_memory.h"
#include "proto/checksum.h"
#include "server/http/upload_limits.h"
#include "server/wire/http_limits.h"
#include "tests/server/http/held_check.h"
#include "tests/server/program/loopback.h"
#include "tests/server/program/served_folder.h"
#include "tests/server/support/json.h"
#include "tests/support/forged_log.h"
#include "tests/support/meshes.h"
#include "tests/support/written_log.h"

namespace {

/// Happens once, just before the next lock is asked for: what another server may do between the
/// opening of a file and its locking.
std::atomic<const std::function<void()>*> beforeLocking = nullptr;

}  // namespace

/// Takes the C library's place in this program.
extern "C" int flock(int file, int how) noexcept {
  if (const auto* meanwhile = beforeLocking.exchange(nullptr)) (*meanwhile)();
  return static_cast<int>(::syscall(SYS_flock, file, how));
}

namespace qtet {
namespace {

namespace fs = std::filesystem;
using test::HttpResponse;
using test::Json;
using test::RawClient;

constexpr const char* kToken = "aSecretOfTwentyTwoChars";
constexpr const char* kOtherToken = "anotherSecretOfManyChars";

class UploadTest : public ::testing::Test {
 protected:
  static std::string textOf(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }
  static std::string digestOf(const std::string& text) {
    return sha256Hex({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  static std::string head(const std::string& method, const std::string& target, std::size_t bytes,
                          const std::string& more = "") {
    return method + " " + target + " HTTP/1.1\r\nHost: a\r\nAuthorization: Bearer " + kToken +
           "\r\nContent-Length: " + std::to_string(bytes) + "\r\n" + more + "\r\n";
  }
  HttpResponse put(const std::string& target, const std::string& body,
                   const std::string& more = "") {
    RawClient client(server_.port());
    client.send(head("PUT", target, body.size(), more) + body);
    return client.receive();
  }
  HttpResponse get(const std::string& target) { return RawClient(server_.port()).get(target); }
  /// Files of the folder that are no mesh.
  std::size_t leftovers() const {
    std::size_t out = 0;
    for (const auto& entry : fs::directory_iterator(folder_.logFolder()))
      out += entry.path().filename().string().starts_with('.');
    return out;
  }

  std::string wholeUpload(const std::string& target) const {
    return head("PUT", target, log_.size()) + log_;
  }
  std::string digested(const std::string& id) const {
    return "/v1/meshes/" + id + "?digest=" + digestOf(log_);
  }
  std::string allIsThere() const {
    return "Content-Range: bytes */" + std::to_string(log_.size()) + "\r\n";
  }

  test::ServedFolder folder_;
  test::HeldCheck check_;
  Access access_{*Tokens::parse(std::string("write new* ") + kToken + "\nwrite noise " + kToken +
                                "\nwrite theirs " + kOtherToken + "\n# nobody\n")};
  std::unique_ptr<MeshStore> store_ =
      std::make_unique<MeshStore>(*MeshStore::open(folder_.logFolder()));
  const std::string log_ = textOf(testing::logBytes(testing::soundMesh(8, 77)));
  test::RunningServer server_{
      *store_,
      folder_.viewer(),
      {.threads = 2,
       .timeouts = {.body = test::kNever},
       .access = &access_,
       .uploads = {.maxBytes = 1 << 20, .deltaPiece = 1000, .check = std::ref(check_)}}};
};

TEST_F(UploadTest, aSoundLogIsServedOnceItIsWhole) {
  RawClient client(server_.port());
  client.send(head("PUT", "/v1/meshes/new%20one", log_.size()) + log_.substr(0, 1000));
  EXPECT_TRUE(server_.comesTo("uploads_open", 1));
  EXPECT_EQ(get("/v1/meshes/new%20one").status, 404u);
  client.send(log_.substr(1000));
  const HttpResponse created = client.receive();
  EXPECT_EQ(created.status, 201u) << created.body;
  EXPECT_EQ(created.header("location"), "/v1/meshes/new%20one");
  EXPECT_EQ(Json::parse(created.body)["digest"], digestOf(log_));
  EXPECT_EQ(client.get("/v1/logs/" + digestOf(log_) + "/log").body, log_)
      << "on the same connection";
  EXPECT_EQ(get("/v1/meshes/new%20one").header("etag"), created.header("etag"));
  EXPECT_EQ(leftovers(), 0u);

  EXPECT_EQ(put("/v1/meshes/new%20one", log_).status, 200u) << "replaced";
}

TEST_F(UploadTest, whatIsNoSoundLogIsNeverServed) {
  std::string flipped = log_;
  flipped.back() = static_cast<char>(flipped.back() ^ 1);
  for (const std::string& body :
       {std::string(), std::string("nonsense"), log_.substr(0, log_.size() - 1), flipped}) {
    const HttpResponse refused = put("/v1/meshes/new", body);
    EXPECT_EQ(refused.status, 422u);
    EXPECT_EQ(Json::parse(refused.body)["type"], "/problems/bad-log");
    EXPECT_EQ(refused.body.find(".upload-"), std::string::npos) << "where it lay: " << refused.body;
    EXPECT_EQ(get("/v1/meshes/new").status, 404u);
  }
  EXPECT_EQ(put("/v1/meshes/new?digest=" + std::string(64, '0'), log_).status, 422u)
      << "sound, but another one";
  EXPECT_EQ(put("/v1/meshes/noise", "nonsense").status, 422u);
  EXPECT_EQ(get(folder_.log()).body, folder_.file()) << "the one that was there stays";
  EXPECT_EQ(leftovers(), 0u);
}

TEST_F(UploadTest, whatDoesNotDecodeIsNeverServedThoughItsChecksumsAreRight) {
  const Bytes sound(log_.begin(), log_.end());
  const auto forged = [&](std::size_t part) {
    testing::TakenApart log = testing::takeApart(sound);
    Bytes& block = log.blocks.back()[part];
    EXPECT_GT(block.size(), 8u);
    for (std::size_t i = 0; i < block.size(); ++i)
      block[i] = static_cast<std::uint8_t>(i * 131 + 7);
    return textOf(log.together());
  };
  EXPECT_EQ(put("/v1/meshes/new", log_).status, 201u);
  for (const std::size_t part : {0u, 1u, 2u, 3u}) {  // structure, positions, two fields
    const std::string bad = forged(part);
    ASSERT_NE(bad, log_);
    for (const char* target : {"/v1/meshes/new", "/v1/meshes/newer"}) {
      const HttpResponse refused = put(target, bad);
      EXPECT_EQ(refused.status, 422u) << part << refused.body;
      EXPECT_EQ(refused.header("content-type"), "application/problem+json");
      EXPECT_EQ(Json::parse(refused.body)["type"], "/problems/bad-log");
    }
    EXPECT_EQ(get("/v1/logs/" + digestOf(bad) + "/log").status, 404u);
    EXPECT_EQ(put("/v1/meshes/newer?digest=" + digestOf(bad), bad).status, 422u);
  }
  EXPECT_NE(put("/v1/meshes/newer", forged(0))
                .body.find("chunk " + std::to_string(testing::takeApart(sound).blocks.size() - 1)),
            std::string::npos)
      << "where";
  EXPECT_EQ(get("/v1/meshes/newer").status, 404u);
  EXPECT_EQ(get("/v1/logs/" + digestOf(log_) + "/log").body, log_)
      << "the one that was there stays";
  EXPECT_EQ(Json::parse(get("/v1/meshes/new").body)["digest"], digestOf(log_));
  EXPECT_EQ(leftovers(), 0u);
}

TEST_F(UploadTest, whatChecksBeyondALimitIsToldTheFigure) {
  const std::uint64_t needed =
      decodingBytes(LogIndex::parse(Bytes(log_.begin(), log_.end())).value());
  const auto answer = [&](CheckLimits limits) {
    test::RunningServer server(*store_, folder_.viewer(),
                               {.access = &access_, .uploads = {.checkLimits = limits}});
    RawClient client(server.port());
    client.send(wholeUpload(digested("new")));
    return client.receive();
  };
  const HttpResponse large = answer({.bytes = needed - 1});
  EXPECT_EQ(large.status, 413u);
  EXPECT_EQ(Json::parse(large.body)["type"], "/problems/content-too-large");
  for (const std::string& figure :
       {std::to_string(needed), std::to_string(needed - 1), std::string("--max-check-bytes")})
    EXPECT_NE(large.body.find(figure), std::string::npos) << large.body;
  const HttpResponse slow = answer({.time = std::chrono::milliseconds(0)});
  EXPECT_EQ(slow.status, 413u);
  EXPECT_NE(slow.body.find("--max-check-seconds"), std::string::npos) << slow.body;
  EXPECT_EQ(get("/v1/meshes/new").status, 404u);
  EXPECT_EQ(leftovers(), 0u) << "it would not be taken another time either";
  EXPECT_EQ(answer({.bytes = needed, .time = test::kNever}).status, 201u);
}

TEST_F(UploadTest, aClientThatGoesEndsTheCheckAndMayAskForItAgain) {
  check_.hold(true);
  {
    RawClient client(server_.port());
    client.send(wholeUpload(digested("new")));
    EXPECT_TRUE(server_.comesTo("uploads_checking", 1));
    EXPECT_EQ(get("/v1/meshes/new").status, 404u);
  }
  EXPECT_TRUE(server_.comesTo("uploads_open", 0)) << "nobody waits for it any more";
  EXPECT_EQ(check_.stopped(), 1);
  EXPECT_EQ(get("/v1/meshes/new").status, 404u);
  check_.hold(false);
  EXPECT_EQ(
      put(digested("new"), "", "Content-Range: bytes */" + std::to_string(log_.size() + 1) + "\r\n")
          .status,
      409u)
      << "not all of them";
  EXPECT_EQ(put(digested("new"), "", allIsThere()).status, 201u) << "without a byte sent twice";
  EXPECT_EQ(get("/v1/logs/" + digestOf(log_) + "/log").body, log_);
  EXPECT_EQ(put(digested("newer"), "", allIsThere()).status, 409u) << "nothing is there";
}

TEST_F(UploadTest, othersAreServedWhileALogIsChecked) {
  check_.hold(true);
  std::vector<std::unique_ptr<RawClient>> clients;
  for (std::size_t i = 0; i + 1 < limits::kMaxUploadsOfToken; ++i) {
    clients.push_back(std::make_unique<RawClient>(server_.port()));
    clients.back()->send(wholeUpload("/v1/meshes/new" + std::to_string(i)));
  }
  EXPECT_TRUE(server_.comesTo("uploads_checking", limits::kCheckThreads)) << "the others wait";
  EXPECT_EQ(get("/v1/meshes/noise").status, 200u);
  EXPECT_EQ(put(digested("new"), log_.substr(0, 5),
                "Content-Range: bytes 0-4/" + std::to_string(log_.size()) + "\r\n")
                .status,
            202u)
      << "what is not whole waits for nobody";
  RawClient remover(server_.port());
  remover.send(head("DELETE", "/v1/meshes/noise", 0));
  EXPECT_EQ(remover.receive().status, 204u);
  clients.push_back(std::make_unique<RawClient>(server_.port()));
  clients.back()->send(wholeUpload("/v1/meshes/new9"));
  EXPECT_TRUE(server_.comesTo("uploads_open", limits::kMaxUploadsOfToken));
  const HttpResponse refused = put("/v1/meshes/new99", log_);
  EXPECT_EQ(refused.status, 503u) << "those that wait have their places";
  EXPECT_EQ(refused.header("retry-after"), "2");
  check_.hold(false);
  for (auto& client : clients) EXPECT_EQ(client->receive().status, 201u);
}

TEST_F(UploadTest, aServerThatEndsBreaksTheCheckOffAndKeepsWhatCanBeGoneOnWith) {
  test::HeldCheck check;
  check.hold(true);
  {
    test::RunningServer server(*store_, folder_.viewer(),
                               {.timeouts = {.grace = test::kShort},
                                .access = &access_,
                                .uploads = {.check = std::ref(check)}});
    RawClient running(server.port()), waiting(server.port());
    running.send(wholeUpload(digested("new")));
    EXPECT_TRUE(server.comesTo("uploads_checking", 1));
    waiting.send(wholeUpload("/v1/meshes/newer"));
    EXPECT_TRUE(server.comesTo("uploads_open", 2));
    server.stop();
    server.join();
  }
  EXPECT_EQ(check.stopped(), 1);
  for (const char* mesh : {"new", "newer"})
    EXPECT_EQ(get(std::string("/v1/meshes/") + mesh).status, 404u);
  EXPECT_EQ(leftovers(), 1u) << "the part of the one that is named by its digest";
  EXPECT_EQ(put(digested("new"), "", allIsThere()).status, 201u);
}

TEST_F(UploadTest, onlyTheRightTokenOpens) {
  const auto with = [&](const char* method, const std::string& target,
                        const std::string& authorization) {
    RawClient client(server_.port());
    client.send(std::string(method) + " " + target +
                " HTTP/1.1\r\nHost: a\r\nContent-Length: 0\r\n" + authorization + "\r\n");
    return client.receive();
  };
  const std::string good = "Authorization: bearer " + std::string(kToken) + "\r\n";
  for (const char* method : {"PUT", "DELETE"}) {
    for (const std::string& wrong :
         {std::string(), std::string("Authorization: Bearer x\r\n"),
          std::string("Authorization: Basic abc\r\n"), std::string("Authorization: Bearer \r\n")}) {
      const HttpResponse refused = with(method, "/v1/meshes/noise", wrong);
      EXPECT_EQ(refused.status, 401u) << wrong;
      EXPECT_TRUE(refused.header("www-authenticate").starts_with("Bearer"));
    }
    EXPECT_EQ(with(method, "/v1/meshes/a%20b", good).status, 403u) << "a token for other meshes";
  }
  EXPECT_EQ(with("PUT", "/v1/meshes/new%2f..%2fx", good).status, 404u) << "no file name";
  EXPECT_EQ(with("PUT", "/v1/meshes", good).status, 405u);
  EXPECT_EQ(get("/v1/meshes/noise").status, 200u);
}

TEST_F(UploadTest, theBodyOfARefusedRequestIsNeverTakenForTheNextOne) {
  const std::string hidden = "GET /v1/meshes HTTP/1.1\r\nHost: a\r\n\r\n";
  const std::string token = "Authorization: Bearer " + std::string(kToken) + "\r\n";
  for (const auto& [target, more, status] :
       std::vector<std::tuple<std::string, std::string, unsigned>>{
           {"/v1/meshes/new", "", 401},
           {"/v1/meshes/a%20b", token, 403},
           {"/v1/meshes/new%2fx", token, 404},
           {"/v1/meshes", token, 405},
           {"/v1/meshes/noise", token + "If-None-Match: *\r\n", 412},
           {"/v1/meshes/new", token + "Content-Encoding: br\r\n", 415},
           {"/v1/meshes/new?digest=1", token, 400}}) {
    RawClient client(server_.port());
    client.send("PUT " + target + " HTTP/1.1\r\nHost: a\r\nContent-Length: " +
                std::to_string(hidden.size()) + "\r\n" + more + "\r\n" + hidden);
    const HttpResponse refused = client.receive();
    EXPECT_EQ(refused.status, status) << target;
    EXPECT_EQ(refused.header("connection"), "close") << target;
    EXPECT_TRUE(client.closedByServer()) << target;
  }
}

TEST_F(UploadTest, aRefusedBodyIsReadUpToABoundSoThatNoResetOvertakesTheAnswer) {
  for (const int more : {-1, 0, 1}) {
    RawClient client(server_.port());
    ASSERT_TRUE(client.send(head("PUT", "/v1/meshes/a%20b", std::size_t{1} << 30) +
                            std::string(limits::kLingerBytes + more, 'x')))
        << more;
    if (more < 0) client.finishSending();
    EXPECT_EQ(client.receive().status, 403u) << more;
    EXPECT_TRUE(client.closedByServer()) << more;
    EXPECT_TRUE(server_.comesTo("connections_open", 1)) << more;
    if (more > 0)
      EXPECT_TRUE(test::eventually([&] { return client.wasReset(); }));
    else
      EXPECT_FALSE(client.wasReset()) << more;
  }
}

TEST_F(UploadTest, aRefusedBodyIsWaitedForASecond) {
  RawClient client(server_.port());
  client.send(head("PUT", "/v1/meshes/a%20b", 5));
  EXPECT_EQ(client.receive().status, 403u);
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_TRUE(client.closedByServer()) << "its half";
  EXPECT_TRUE(server_.comesTo("connections_open", 1));
  EXPECT_GT(std::chrono::steady_clock::now() - begun,
            std::chrono::milliseconds(limits::kLingerTime) / 2);
}

TEST_F(UploadTest, aMeshIsRemovedAndItsDigestWithIt) {
  RawClient client(server_.port());
  client.send(head("DELETE", "/v1/meshes/noise", 0, "If-Match: \"other\"\r\n"));
  EXPECT_EQ(client.receive().status, 412u);
  client.send(head("DELETE", "/v1/meshes/noise", 0));
  EXPECT_EQ(client.receive().status, 204u);
  EXPECT_EQ(get("/v1/meshes/noise").status, 404u);
  EXPECT_EQ(get(folder_.log()).status, 404u);
  client.send(head("DELETE", "/v1/meshes/noise", 0));
  EXPECT_EQ(client.receive().status, 404u);
}

TEST_F(UploadTest, conditionsProtectWhatIsThere) {
  EXPECT_EQ(put("/v1/meshes/noise", log_, "If-None-Match: *\r\n").status, 412u);
  EXPECT_EQ(put("/v1/meshes/noise", log_, "If-Match: \"other\"\r\n").status, 412u);
  EXPECT_EQ(put("/v1/meshes/new", log_, "If-Match: *\r\n").status, 412u);
  EXPECT_EQ(
      put("/v1/meshes/noise", log_, "If-Match: " + get("/v1/meshes/noise").header("etag") + "\r\n")
          .status,
      200u);
  EXPECT_EQ(put("/v1/meshes/new", log_, "If-None-Match: *\r\n").status, 201u);
}

TEST_F(UploadTest, aConditionStillHoldsWhenTheLogGetsItsName) {
  RawClient slow(server_.port());
  slow.send(head("PUT", "/v1/meshes/new", log_.size(), "If-None-Match: *\r\n") +
            log_.substr(0, 100));
  EXPECT_TRUE(server_.comesTo("uploads_open", 1));
  const std::string other = textOf(testing::logBytes(testing::soundMesh(6, 78)));
  EXPECT_EQ(put("/v1/meshes/new", other, "If-None-Match: *\r\n").status, 201u);
  slow.send(log_.substr(100));
  EXPECT_EQ(slow.receive().status, 412u);
  EXPECT_EQ(get("/v1/logs/" + digestOf(other) + "/log").body, other) << "who came first stays";
}

TEST_F(UploadTest, anUploadThatBrokeOffGoesOnWhereItStopped) {
  const std::string target = "/v1/meshes/new?digest=" + digestOf(log_);
  const std::string ask = "GET /v1/meshes/new/upload?digest=" + digestOf(log_) +
                          " HTTP/1.1\r\nHost: a\r\nAuthorization: Bearer " + kToken + "\r\n\r\n";
  {
    RawClient client(server_.port());
    client.send(head("PUT", target, log_.size()) + log_.substr(0, 3000));
    client.finishSending();
    (void)client.readToEnd();
  }
  RawClient client(server_.port());
  client.send(ask);
  const HttpResponse there = client.receive();
  ASSERT_EQ(there.status, 200u) << there.body;
  EXPECT_EQ(Json::parse(there.body)["bytes"], 3000);
  const auto range = [&](std::size_t first) {
    return "Content-Range: bytes " + std::to_string(first) + "-" + std::to_string(log_.size() - 1) +
           "/" + std::to_string(log_.size()) + "\r\n";
  };
  EXPECT_EQ(put(target, log_.substr(2999), range(2999)).status, 409u);
  EXPECT_EQ(put(target, log_.substr(3000, 5),
                "Content-Range: bytes 3000-3004/" + std::to_string(log_.size()) + "\r\n")
                .status,
            202u);
  EXPECT_EQ(put(target, log_.substr(3005), range(3005)).status, 201u);
  EXPECT_EQ(get("/v1/logs/" + digestOf(log_) + "/log").body, log_);
  client.send(ask);
  EXPECT_EQ(client.receive().status, 404u);
  for (const char* wrong : {"bytes 1-2/3", "bytes 5-2/9", "items 0-1/2", "bytes */9", "bytes */0",
                            "bytes 0-18446744073709551616/9"})
    EXPECT_EQ(put(target, "abc", "Content-Range: " + std::string(wrong) + "\r\n").status, 400u)
        << wrong;
}

TEST_F(UploadTest, aDeltaToTheMeshsLogGivesTheNewOne) {
  const auto instruction = [](std::uint64_t from, std::uint64_t copied, const std::string& own) {
    ByteWriter out;
    out.write(from);
    out.write(copied);
    out.write(own.size());
    return textOf(out.bytes()) + own;
  };
  const std::string size = std::to_string(log_.size());
  const auto send = [&](const std::string& from, std::size_t first, const std::string& delta) {
    return put("/v1/meshes/new?digest=" + digestOf(log_) + "&from=" + from, delta,
               "Content-Range: bytes " + std::to_string(first) + "-" +
                   std::to_string(log_.size() - 1) + "/" + size + "\r\n");
  };
  const std::string old = textOf(testing::logBytes(testing::soundMesh(9, 4)));
  ASSERT_EQ(put("/v1/meshes/new", old).status, 201u);
  std::string delta = instruction(0, 0, log_.substr(0, 100));
  const HttpResponse none = send(std::string(64, 'a'), 0, delta);
  EXPECT_EQ(none.status, 409u) << none.body;
  EXPECT_EQ(send("abc", 0, delta).status, 400u);
  EXPECT_EQ(put("/v1/meshes/new?digest=" + digestOf(log_) + "&from=" + digestOf(old), delta).status,
            400u)
      << "without Content-Range";
  EXPECT_EQ(put("/v1/meshes/new?from=" + digestOf(old), delta).status, 400u) << "without digest";

  EXPECT_EQ(send(digestOf(old), 0, instruction(0, old.size() + 1, "")).status, 400u);
  EXPECT_EQ(send(digestOf(old), 0, instruction(0, 0, "")).status, 400u) << "gives no byte";
  const std::size_t last = log_.size() - 1;
  EXPECT_EQ(send(digestOf(old), last, std::string(25, 'x')).status, 409u) << "long, not too long";
  EXPECT_EQ(send(digestOf(old), last, std::string(49, 'x')).status, 409u);
  EXPECT_EQ(send(digestOf(old), last, std::string(50, 'x')).status, 413u);
  const HttpResponse short1 = send(digestOf(old), 0, delta + "and half an instruction");
  EXPECT_EQ(short1.status, 400u) << short1.body;
  EXPECT_EQ(send(digestOf(old), 0, delta).status, 202u);
  const HttpResponse wrong = send(digestOf(old), 100, instruction(0, log_.size() - 100, ""));
  EXPECT_EQ(wrong.status, 422u) << "another digest: " << wrong.body;
  EXPECT_EQ(leftovers(), 0u);
  EXPECT_EQ(send(digestOf(old), 0, instruction(0, 0, log_)).status, 200u);
  EXPECT_EQ(get("/v1/logs/" + digestOf(log_) + "/log").body, log_);
  const HttpResponse same = send(digestOf(log_), 0, instruction(0, log_.size(), ""));
  EXPECT_EQ(same.status, 200u) << same.body;
  EXPECT_EQ(leftovers(), 0u);
}

TEST_F(UploadTest, aDeltaIsNotPublishedWhereItsBaseWasReplaced) {
  const std::string old = textOf(testing::logBytes(testing::soundMesh(9, 4)));
  const std::string other = textOf(testing::logBytes(testing::soundMesh(6, 78)));
  ASSERT_EQ(put("/v1/meshes/new", old).status, 201u);
  ByteWriter instruction;
  for (const std::uint64_t number : {std::uint64_t{0}, std::uint64_t{0}, log_.size()})
    instruction.write(number);
  const std::string delta = textOf(instruction.bytes()) + log_;
  RawClient slow(server_.port());
  slow.send(head("PUT", "/v1/meshes/new?digest=" + digestOf(log_) + "&from=" + digestOf(old),
                 delta.size(),
                 "Content-Range: bytes 0-" + std::to_string(log_.size() - 1) + "/" +
                     std::to_string(log_.size()) + "\r\n") +
            delta.substr(0, 100));
  EXPECT_TRUE(server_.comesTo("uploads_open", 1));
  EXPECT_EQ(put("/v1/meshes/new", other).status, 200u);
  slow.send(delta.substr(100));
  const HttpResponse refused = slow.receive();
  EXPECT_EQ(refused.status, 409u) << refused.body;
  EXPECT_NE(refused.body.find("was replaced or removed"), std::string::npos) << refused.body;
  EXPECT_EQ(get("/v1/logs/" + digestOf(other) + "/log").body, other);
}

TEST_F(UploadTest, askingForTheCheckOfNothingTakesNothingAway) {
  const auto request = [&](const std::string& range) {
    return put(digested("new"), "", "Content-Range: " + range + "\r\n");
  };
  EXPECT_EQ(put(digested("new"), log_.substr(0, 10),
                "Content-Range: bytes 0-9/" + std::to_string(log_.size()) + "\r\n")
                .status,
            202u);
  EXPECT_EQ(request("bytes */0").status, 400u);
  EXPECT_EQ(request("bytes */" + std::to_string(log_.size())).status, 409u)
      << "the rest is missing";
  EXPECT_EQ(put(digested("new"), log_.substr(10),
                "Content-Range: bytes 10-" + std::to_string(log_.size() - 1) + "/" +
                    std::to_string(log_.size()) + "\r\n")
                .status,
            201u);
  EXPECT_EQ(request("bytes */" + std::to_string(log_.size())).status, 409u)
      << "it is published, and no part any more";
}

TEST_F(UploadTest, goingOnWithWhatIsNotThereLeavesNothing) {
  const std::string digest = digestOf(log_), more = "Content-Range: bytes 10-14/100\r\n";
  const HttpResponse refused = put("/v1/meshes/new?digest=" + digest, "abcde", more);
  EXPECT_EQ(refused.status, 409u);
  EXPECT_NE(refused.body.find("there are 0 bytes"), std::string::npos) << refused.body;
  EXPECT_EQ(leftovers(), 0u);
}

TEST_F(UploadTest, whatIsTooLargeOrWithoutALengthIsRefusedBeforeItIsSent) {
  RawClient large(server_.port());
  large.send(head("PUT", "/v1/meshes/new", (1 << 20) + 1, "Expect: 100-continue\r\n"));
  EXPECT_EQ(large.receive().status, 413u);
  RawClient overflowing(server_.port());
  overflowing.send("PUT /v1/meshes/new HTTP/1.1\r\nHost: a\r\nAuthorization: Bearer " +
                   std::string(kToken) + "\r\nContent-Length: 99999999999999999999\r\n\r\n");
  EXPECT_GE(overflowing.receive().status, 400u);
  RawClient none(server_.port());
  none.send("PUT /v1/meshes/new HTTP/1.1\r\nHost: a\r\nAuthorization: Bearer " +
            std::string(kToken) + "\r\n\r\n");
  EXPECT_EQ(none.receive().status, 411u);
  EXPECT_EQ(put("/v1/meshes/new", log_, "Content-Encoding: gzip\r\n").status, 415u);
  EXPECT_EQ(put("/v1/meshes/new", std::string(1 << 20, 'x')).status, 422u)
      << "as large as it may be, and no log";
}

TEST_F(UploadTest, aClientThatAsksFirstIsToldToGoOn) {
  RawClient client(server_.port());
  client.send(head("PUT", "/v1/meshes/new", log_.size(), "Expect: 100-continue\r\n"));
  EXPECT_EQ(client.receive().status, 100u);
  client.send(log_);
  EXPECT_EQ(client.receive().status, 201u);
}

TEST_F(UploadTest, aClientOfHttp10IsToldNothingBeforehand) {
  RawClient client(server_.port());
  client.send("PUT /v1/meshes/new HTTP/1.0\r\nAuthorization: Bearer " + std::string(kToken) +
              "\r\nContent-Length: " + std::to_string(log_.size()) +
              "\r\nExpect: 100-continue\r\n\r\n" + log_);
  EXPECT_EQ(client.receive().status, 201u);
}

TEST_F(UploadTest, aConditionOnASecondLineCounts) {
  EXPECT_EQ(
      put("/v1/meshes/noise", log_, "If-None-Match: \"other\"\r\nIf-None-Match: *\r\n").status,
      412u);
}

TEST_F(UploadTest, aBodyThatDoesNotComeEndsInTime) {
  test::RunningServer hasty(*store_, folder_.viewer(),
                            {.timeouts = {.body = test::kShort}, .access = &access_});
  RawClient client(hasty.port());
  client.send(head("PUT", "/v1/meshes/new", log_.size()) + "abc");
  EXPECT_EQ(client.receive().status, 408u);
  EXPECT_TRUE(client.closedByServer());
  EXPECT_EQ(leftovers(), 0u);
}

TEST_F(UploadTest, oneTokenHasSoManyUploadsAndLeavesPlacesToOthers) {
  std::vector<std::unique_ptr<RawClient>> clients;
  for (std::size_t i = 0; i < limits::kMaxUploadsOfToken; ++i) {
    clients.push_back(std::make_unique<RawClient>(server_.port()));
    const std::string digest = i == 0 ? "?digest=" + digestOf(log_) : "";
    clients.back()->send(head("PUT", "/v1/meshes/new" + std::to_string(i) + digest, log_.size()) +
                         log_.substr(0, 10));
  }
  EXPECT_TRUE(server_.comesTo("uploads_open", limits::kMaxUploadsOfToken));
  EXPECT_EQ(put("/v1/meshes/new0?digest=" + digestOf(log_), log_).status, 409u);
  const HttpResponse refused = put("/v1/meshes/new9", log_);
  EXPECT_EQ(refused.status, 503u);
  EXPECT_EQ(refused.header("retry-after"), "2");
  RawClient other(server_.port());
  other.send("PUT /v1/meshes/theirs HTTP/1.1\r\nHost: a\r\nAuthorization: Bearer " +
             std::string(kOtherToken) + "\r\nContent-Length: " + std::to_string(log_.size()) +
             "\r\n\r\n" + log_);
  EXPECT_EQ(other.receive().status, 201u) << "trickling bytes keep nobody else out";
  for (auto& client : clients) {
    client->send(log_.substr(10));
    EXPECT_EQ(client->receive().status, 201u);
  }
}

/// An upload of four bytes under a digest of that digit.
UploadRequest fourBytes(char digit, const std::string& token = "one") {
  return {.id = "wing",
          .token = token,
          .digest = std::string(64, digit),
          .bodyBytes = 4,
          .totalBytes = 4};
}

/// Begins it and breaks it off behind its first byte.
unsigned beginAndBreakOff(Uploads& uploads, const UploadRequest& request) {
  const auto begun = uploads.begin(request);
  if (!begun) return begun.error().status;
  EXPECT_FALSE((*begun)->append(ByteView(Bytes{1})));
  return 0;
}

TEST(Uploads, theOldestPartsOfATokenMakeRoomForItsNextOne) {
  const test::ServedFolder folder;
  Uploads uploads(folder.store(), {.parts = {.maxOfToken = 2}});
  const auto has = [&](char digit) {
    return uploads.partialBytes("wing", std::string(64, digit)).has_value();
  };
  const auto age = [&](char digit, int minutes) {
    fs::last_write_time(folder.logFolder() / (".upload-" + std::string(64, digit) + "-wing.part"),
                        fs::file_time_type::clock::now() - std::chrono::minutes(minutes));
  };
  EXPECT_EQ(beginAndBreakOff(uploads, fourBytes('f', "other")), 0u);
  age('f', 90);
  for (const char digit : {'a', 'b'}) EXPECT_EQ(beginAndBreakOff(uploads, fourBytes(digit)), 0u);
  age('b', 60);
  EXPECT_EQ(beginAndBreakOff(uploads, fourBytes('c')), 0u);
  EXPECT_TRUE(has('a') && has('c'));
  EXPECT_FALSE(has('b')) << "the oldest of this token";
  EXPECT_TRUE(has('f')) << "somebody else's";
}

TEST(Uploads, bytesOfATokensPartsAreBoundedLikewise) {
  const test::ServedFolder folder;
  Uploads uploads(folder.store(), {.parts = {.bytesOfToken = 5}});
  for (const char digit : {'a', 'b'}) EXPECT_EQ(beginAndBreakOff(uploads, fourBytes(digit)), 0u);
  EXPECT_EQ(beginAndBreakOff(uploads, fourBytes('c')), 0u);
  EXPECT_FALSE(uploads.partialBytes("wing", std::string(64, 'a')) &&
               uploads.partialBytes("wing", std::string(64, 'b')));
  UploadRequest large = fourBytes('d');
  large.totalBytes = 6;
  EXPECT_EQ(beginAndBreakOff(uploads, large), 507u) << "alone beyond the bound";
}

TEST(Uploads, partsOfAllTogetherAreBoundedAndNobodyElsesGo) {
  const test::ServedFolder folder;
  Uploads uploads(folder.store(), {.parts = {.most = 2}});
  EXPECT_EQ(beginAndBreakOff(uploads, fourBytes('a', "one")), 0u);
  EXPECT_EQ(beginAndBreakOff(uploads, fourBytes('b', "two")), 0u);
  EXPECT_EQ(beginAndBreakOff(uploads, fourBytes('c', "three")), 507u);
  EXPECT_EQ(uploads.partialBytes("wing", std::string(64, 'c')), std::nullopt);
  EXPECT_TRUE(uploads.partialBytes("wing", std::string(64, 'a')));
  EXPECT_EQ(beginAndBreakOff(uploads, fourBytes('d', "two")), 0u) << "in the place of its own";
}

TEST(Uploads, aDiskWithTooLittleLeftTakesNothing) {
  const test::ServedFolder folder;
  std::uintmax_t left = 103;
  Uploads uploads(folder.store(),
                  {.parts = {.reserve = 100, .freeBytes = [&](const fs::path&) { return left; }}});
  EXPECT_EQ(beginAndBreakOff(uploads, fourBytes('a')), 507u);
  left = 104;
  const auto first = uploads.begin(fourBytes('a'));
  EXPECT_TRUE(first);
  EXPECT_EQ(beginAndBreakOff(uploads, fourBytes('b')), 507u) << "what is to come counts";
  left = 108;
  EXPECT_EQ(beginAndBreakOff(uploads, fourBytes('b')), 0u);
}

/// Makes this thread another user's for the file system while it lives, if it is root's: root may
/// write everywhere.
class WithoutPrivileges {
 public:
  WithoutPrivileges() : user_(static_cast<uid_t>(::setfsuid(kNobody))) {}
  ~WithoutPrivileges() { ::setfsuid(user_); }
  WithoutPrivileges(const WithoutPrivileges&) = delete;
  WithoutPrivileges& operator=(const WithoutPrivileges&) = delete;

 private:
  static constexpr uid_t kNobody = 65534;
  const uid_t user_;
};

/// The refusal of the beginning, and what was logged meanwhile.
std::pair<Reply, std::string> refusalOfBegin(Uploads& uploads) {
  ::testing::internal::CaptureStdout();
  auto begun = uploads.begin(fourBytes('a'));
  std::string logged = ::testing::internal::GetCapturedStdout();
  EXPECT_FALSE(begun);
  return {begun ? Reply{} : std::move(begun.error()), std::move(logged)};
}

void expectUnwritable(Uploads& uploads, const std::string& reason) {
  const auto [reply, logged] = refusalOfBegin(uploads);
  EXPECT_EQ(reply.status, 503u);
  EXPECT_NE(reply.header("Retry-After"), "");
  EXPECT_NE(std::get<std::string>(reply.body).find("writable"), std::string::npos)
      << "the client is told what to do";
  EXPECT_NE(logged.find("[error]"), std::string::npos) << logged;
  EXPECT_NE(logged.find(reason), std::string::npos) << logged;
}

TEST(Uploads, aFolderThatMayNotBeWrittenIs503AndTheReasonIsLogged) {
  const test::ServedFolder folder;
  Uploads uploads(folder.store(), {});
  fs::permissions(folder.logFolder(), fs::perms(0555));
  {
    const WithoutPrivileges nobody;
    expectUnwritable(uploads, "Permission denied");
    EXPECT_EQ(uploads.remove({.id = "noise"}).status, 503u);
  }
  fs::permissions(folder.logFolder(), fs::perms(0755));
  EXPECT_TRUE(folder.store().find("noise"));
  EXPECT_EQ(beginAndBreakOff(uploads, fourBytes('a')), 0u) << "writable again, and all is well";
}

TEST(Uploads, aFolderThatIsGoneOrNoFolderIs503) {
  const test::ServedFolder folder;
  Uploads uploads(folder.store(), {});
  const fs::path away = folder.logFolder().string() + ".away";
  fs::rename(folder.logFolder(), away);
  expectUnwritable(uploads, "No such file or directory");
  std::ofstream(folder.logFolder()) << "no folder";
  expectUnwritable(uploads, "Not a directory");
  fs::remove(folder.logFolder());
  fs::rename(away, folder.logFolder());
  EXPECT_EQ(beginAndBreakOff(uploads, fourBytes('a')), 0u);
}

TEST(Uploads, aFolderOfTheMeshsNameIs409BeforeAByteIsTaken) {
  const test::ServedFolder folder;
  Uploads uploads(folder.store(), {});
  fs::create_directory(folder.logFolder() / "wing.qtet");
  const Reply reply = refusalOfBegin(uploads).first;
  EXPECT_EQ(reply.status, 409u);
  EXPECT_NE(std::get<std::string>(reply.body).find("wing.qtet"), std::string::npos);
  EXPECT_EQ(uploads.partialBytes("wing", std::string(64, 'a')), std::nullopt);
  fs::remove(folder.logFolder() / "wing.qtet");
  EXPECT_EQ(beginAndBreakOff(uploads, fourBytes('a')), 0u);
}

TEST(Uploads, aFolderThatTakesTheNameMeanwhileIs409AndThePartStays) {
  const test::ServedFolder folder;
  Uploads uploads(folder.store(), {});
  const Bytes log = testing::logBytes(testing::soundMesh(8, 77));
  for (const bool newly : {false, true}) {
    UploadRequest request{.id = "wing", .digest = sha256Hex(log)};
    request.bodyBytes = request.totalBytes = log.size();
    if (newly) request.ifNoneMatch = "*";
    auto begun = uploads.begin(request);
    ASSERT_TRUE(begun);
    ASSERT_FALSE((*begun)->append(log));
    fs::create_directories(folder.logFolder() / "wing.qtet" / "inside");
    EXPECT_EQ((*begun)->finish({}).status, 409u);
    begun->reset();
    EXPECT_EQ(uploads.partialBytes("wing", sha256Hex(log)), log.size());
    fs::remove_all(folder.logFolder() / "wing.qtet");
  }
}

TEST(Uploads, ofTwoServersOnOneFolderOneMakesANewMesh) {
  const test::ServedFolder folder;
  const MeshStore others = *MeshStore::open(folder.logFolder());
  Uploads first(folder.store(), {}), second(others, {});
  const Bytes log = testing::logBytes(testing::soundMesh(8, 77)),
              another = testing::logBytes(testing::soundMesh(8, 78));
  const auto send = [](Uploads& uploads, const Bytes& bytes, const UploadRequest& conditions) {
    UploadRequest request = conditions;
    request.id = "wing";
    request.digest = sha256Hex(bytes);
    request.bodyBytes = request.totalBytes = bytes.size();
    auto begun = uploads.begin(request);
    EXPECT_TRUE(begun);
    EXPECT_FALSE((*begun)->append(bytes));
    return std::move(*begun);
  };
  auto one = send(first, log, {.ifNoneMatch = "*"}),
       two = send(second, another, {.ifNoneMatch = "*"});
  EXPECT_EQ(one->finish({}).status, 201u);
  EXPECT_EQ(two->finish({}).status, 412u);
  one.reset(), two.reset();
  const std::string tag = folder.store().find("wing")->description().etag();
  (void)others.rescan();
  const auto third = send(first, another, {.ifMatch = tag}),
             fourth = send(second, log, {.ifMatch = tag});
  EXPECT_EQ(third->finish({}).status, 200u);
  EXPECT_EQ(fourth->finish({}).status, 412u) << "the other server has changed it meanwhile";
}

TEST(Uploads, aDiskThatKeepsAWriterWaitingHoldsUpNoOtherClient) {
  const test::ServedFolder folder;
  const MeshStore store = *MeshStore::open(folder.logFolder());
  Access access(*Tokens::parse(std::string("write * ") + kToken));
  std::atomic<bool> isWriting = false, goesOn = false;
  UploadOptions options;
  options.write = [&](int file, ByteView bytes) {
    isWriting = true;
    goesOn.wait(false);
    return writeTo(file, bytes);
  };
  const test::RunningServer server(
      store, folder.viewer(), {.threads = 1, .access = &access, .uploads = std::move(options)});
  const Bytes log = testing::logBytes(testing::soundMesh(8, 77));
  RawClient sender(server.port()), other(server.port());
  sender.send("PUT /v1/meshes/wing HTTP/1.1\r\nHost: a\r\nAuthorization: Bearer " +
              std::string(kToken) + "\r\nContent-Length: " + std::to_string(log.size()) +
              "\r\n\r\n" + std::string(log.begin(), log.end()));
  EXPECT_TRUE(test::eventually([&] { return isWriting.load(); }));
  EXPECT_EQ(other.get("/livez").status, 200u);
  goesOn = true;
  goesOn.notify_all();
  EXPECT_EQ(sender.receive().status, 201u);
}

TEST(Uploads, anotherServersPartsAreLetAlone) {
  const test::ServedFolder folder;
  const auto old =
      fs::file_time_type::clock::now() - limits::kPartialUploadTime - std::chrono::minutes(1);
  const std::string digest(64, 'a');
  const UploadRequest named{.id = "wing", .digest = digest, .bodyBytes = 4, .totalBytes = 4},
      nameless{.id = "wing", .bodyBytes = 4, .totalBytes = 4};
  Uploads first(folder.store(), {.maxBytes = 100}), second(folder.store(), {.maxBytes = 100});
  auto one = first.begin(named), other = first.begin(nameless);
  ASSERT_TRUE(one && other);
  EXPECT_FALSE((*one)->append(ByteView(Bytes{1, 2})));
  for (const auto& entry : fs::directory_iterator(folder.logFolder()))
    if (entry.path().extension() == ".part") fs::last_write_time(entry.path(), old);
  second.sweep();
  const auto refused = second.begin(named);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().status, 409u);
  EXPECT_EQ(first.partialBytes("wing", digest), 2u) << "neither swept nor begun anew";
  EXPECT_FALSE((*other)->append(ByteView(Bytes{1, 2, 3, 4})));
  EXPECT_FALSE((*other)->partial()) << "all is there";
  one->reset();
  EXPECT_TRUE(second.begin(named)) << "its sender has gone";
}

TEST(Uploads, whatAKilledServerLeftIsSweptUnlessItCanBeGoneOnWith) {
  const test::ServedFolder folder;
  const std::string digest(64, 'a');
  const fs::path resumable = folder.logFolder() / (".upload-" + digest + "-wing.part"),
                 lost = folder.logFolder() / ".upload-12.0.part";
  for (const fs::path& path : {resumable, lost}) std::ofstream(path) << "half";
  Uploads uploads(folder.store(), {.maxBytes = 100});
  uploads.sweep();
  EXPECT_TRUE(fs::exists(resumable));
  EXPECT_FALSE(fs::exists(lost));
  EXPECT_EQ(uploads.partialBytes("wing", digest), 4u);
  EXPECT_EQ(uploads.partialBytes("other", digest), std::nullopt);
  EXPECT_EQ(uploads.partialBytes("wing", "../../etc/passwd"), std::nullopt);
  fs::last_write_time(resumable, fs::file_time_type::clock::now() - limits::kPartialUploadTime -
                                     std::chrono::minutes(1));
  uploads.sweep();
  EXPECT_FALSE(fs::exists(resumable));
}

TEST(Uploads, bytesOfPartsAreThoseUnderWayAndThoseThatAreKept) {
  const test::ServedFolder folder;
  const std::string digest(64, 'a');
  std::ofstream(folder.logFolder() / (".upload-" + std::string(64, 'b') + "-old.part")) << "half";
  Uploads uploads(folder.store(), {.maxBytes = 100});
  uploads.sweep();
  EXPECT_EQ(uploads.partBytes(), 4u) << "of an earlier run";
  UploadRequest named{.id = "wing", .digest = digest, .bodyBytes = 9, .totalBytes = 9};
  auto one = uploads.begin(named);
  auto other = uploads.begin({.id = "wing", .bodyBytes = 9, .totalBytes = 9});
  ASSERT_TRUE(one && other);
  EXPECT_FALSE((*one)->append(ByteView(Bytes{1, 2})));
  EXPECT_FALSE((*other)->append(ByteView(Bytes{1, 2, 3})));
  EXPECT_EQ(uploads.partBytes(), 4u + 2 + 3);
  one->reset();
  other->reset();
  EXPECT_EQ(uploads.partBytes(), 4u + 2) << "the nameless one has gone";
  named.first = 2;
  one = uploads.begin(named);
  ASSERT_TRUE(one);
  EXPECT_FALSE((*one)->append(ByteView(Bytes{3})));
  EXPECT_EQ(uploads.partBytes(), 4u + 3) << "resumed, and counted once";
}

TEST(Uploads, aServerThatRunsForYearsKeepsNoOldParts) {
  const test::ServedFolder folder;
  const auto old =
      fs::file_time_type::clock::now() - limits::kPartialUploadTime - std::chrono::minutes(1);
  const fs::path lost = folder.logFolder() / ".upload-12.0.part",
                 resumable =
                     folder.logFolder() / (".upload-" + std::string(64, 'a') + "-wing.part");
  const fs::path others = folder.logFolder() / ".upload-13.0.part",
                 young = folder.logFolder() / (".upload-" + std::string(64, 'b') + "-wing.part");
  for (const fs::path& path : {lost, resumable, others, young}) std::ofstream(path) << "half";
  for (const fs::path& path : {lost, resumable}) fs::last_write_time(path, old);
  Uploads uploads(folder.store(), {.maxBytes = 100});
  const auto begin = [&](char digit) {
    return uploads.begin(
        {.id = "wing", .digest = std::string(64, digit), .bodyBytes = 4, .totalBytes = 4});
  };
  const auto first = begin('c');
  ASSERT_TRUE(first);
  for (const fs::path& path : {lost, resumable}) EXPECT_FALSE(fs::exists(path)) << path;
  for (const fs::path& path : {others, young}) EXPECT_TRUE(fs::exists(path)) << path;
  const fs::path underWay = folder.logFolder() / (".upload-" + std::string(64, 'c') + "-wing.part");
  fs::last_write_time(underWay, old);
  ASSERT_TRUE(begin('d'));
  EXPECT_TRUE(fs::exists(underWay)) << "somebody is sending it";
}

TEST(Uploads, whatAnotherServerPublishesMeanwhileIsNotWrittenInto) {
  const test::ServedFolder folder;
  const Bytes log = testing::logBytes(testing::soundMesh(8, 77));
  const UploadRequest request{
      .id = "wing", .digest = sha256Hex(log), .bodyBytes = log.size(), .totalBytes = log.size()};
  const MeshStore others = *MeshStore::open(folder.logFolder());
  Uploads first(folder.store(), {}), second(others, {});
  auto one = first.begin(request);
  ASSERT_TRUE(one);
  EXPECT_FALSE((*one)->append(log));
  const std::function<void()> publish = [&] {
    EXPECT_EQ((*one)->finish({}).status, 201u);
    one->reset();
  };
  beforeLocking = &publish;
  const auto late = second.begin(request);
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().status, 409u);
  EXPECT_EQ(fs::file_size(folder.logFolder() / "wing.qtet"), log.size());
  EXPECT_TRUE(second.begin(request)) << "the next one begins anew";
}

TEST(Uploads, aPartThatTookTheNameOfAnOldOneIsNotSweptInItsPlace) {
  const test::ServedFolder folder;
  // in two containers the processes may have the same number
  const fs::path part = folder.logFolder() / ".upload-1.0.part";
  std::ofstream(part) << "old";
  const std::function<void()> replace = [&] {
    fs::remove(part);
    std::ofstream(part) << "another one";
  };
  beforeLocking = &replace;
  Uploads(folder.store(), {}).sweep();
  EXPECT_TRUE(fs::exists(part));
}

TEST(Uploads, aCheckThatThrowsEndsOneUploadAndIsNotCountedForEver) {
  const test::ServedFolder folder;
  const Bytes log = testing::logBytes(testing::soundMesh(8, 77));
  const UploadRequest request{
      .id = "wing", .digest = sha256Hex(log), .bodyBytes = log.size(), .totalBytes = log.size()};
  for (const bool memory : {true, false}) {
    Uploads uploads(folder.store(), {.check = [memory](const ServedMesh&, const CheckLimits&,
                                                       const std::stop_token&) -> CheckVerdict {
                      if (memory) throw std::bad_alloc();
                      throw std::length_error("too long");
                    }});
    auto upload = uploads.begin(request);
    ASSERT_TRUE(upload);
    EXPECT_FALSE((*upload)->append(log));
    EXPECT_EQ((*upload)->finish({}).status, memory ? 503u : 500u);
    EXPECT_EQ(uploads.checking(), 0u);
    upload->reset();
    EXPECT_EQ(uploads.partialBytes("wing", *request.digest), log.size())
        << "may be asked for again";
  }
}

}  // namespace
}  // namespace qtet
