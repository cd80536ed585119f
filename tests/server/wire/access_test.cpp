// Tokens, tickets, and who gets what over real sockets where reading is guarded.
#include "server/wire/access.h"

#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <set>
#include <span>

#include "proto/checksum.h"
#include "server/wire/id_limits.h"
#include "server/wire/token_limits.h"
#include "tests/server/program/loopback.h"
#include "tests/server/program/served_folder.h"
#include "tests/server/support/json.h"

namespace qtet {
namespace {

using test::HttpResponse;
using test::Json;
using test::RawClient;
using Scope = Tokens::Scope;
using Verdict = Tokens::Verdict;

const std::string kReader = "readerSecretOfManyChars", kWriter = "writerSecretOfManyChars",
                  kOther = "otherSecretOfManyChars";

std::string bearer(const std::string& token) { return "Authorization: Bearer " + token + "\r\n"; }
std::optional<SecretDigest> bearerOf(const std::string& token) {
  return bearerDigest("Bearer " + token);
}

TEST(Tokens, theFirstNameOfATokenIsItsName) {
  const auto tokens =
      Tokens::parse("write a " + kWriter + "\nwrite b " + kWriter + " name=lab-1.x_y@z\nwrite c " +
                    kWriter + " name=other\nread * " + kReader);
  ASSERT_TRUE(tokens) << tokens.error().message;
  EXPECT_EQ(tokens->nameOf(bearerOf(kWriter)), "lab-1.x_y@z");
  EXPECT_EQ(tokens->nameOf(bearerOf(kReader)), "sha256:" + hexDigestOf(kReader).substr(0, 8));
  EXPECT_EQ(tokens->nameOf(bearerOf(kWriter + "x")), "");
  EXPECT_EQ(tokens->nameOf(std::nullopt), "");
  const auto named = [](const std::string& name) {
    return Tokens::parse("read * " + kReader + " name=" + name).has_value();
  };
  EXPECT_TRUE(named(std::string(limits::kMaxTokenName - 1, 'a')));
  EXPECT_TRUE(named(std::string(limits::kMaxTokenName, 'a')));
  EXPECT_FALSE(named(std::string(limits::kMaxTokenName + 1, 'a')));
  EXPECT_FALSE(named(""));
  EXPECT_FALSE(named("a\"b"));
}

TEST(Tokens, aNameThatNoMeshCanHaveIsMatchedByNoPattern) {
  const auto tokens = Tokens::parse("write * " + kWriter);
  ASSERT_TRUE(tokens) << tokens.error().message;
  for (const std::size_t size : {limits::kMaxIdBytes - 1, limits::kMaxIdBytes})
    EXPECT_EQ(tokens->may(Scope::kWrite, bearerOf(kWriter), std::string(size, 'a')),
              Verdict::kAllowed);
  EXPECT_EQ(
      tokens->may(Scope::kWrite, bearerOf(kWriter), std::string(limits::kMaxIdBytes + 1, 'a')),
      Verdict::kForbidden);
}

TEST(Tokens, linesAreReadAndWrongOnesNamed) {
  const auto tokens = Tokens::parse("# who\n\nwrite lab-* " + kWriter +
                                    "\nwrite x sha256:" + sha256Hex(ByteView()) + "\n");
  ASSERT_TRUE(tokens) << tokens.error().message;
  EXPECT_EQ(tokens->may(Scope::kWrite, bearerOf(kWriter), "lab-1"), Verdict::kAllowed);
  EXPECT_EQ(tokens->may(Scope::kWrite, bearerOf(kWriter), "other"), Verdict::kForbidden);
  EXPECT_EQ(tokens->may(Scope::kWrite, bearerOf(kWriter + "x"), "lab-1"), Verdict::kUnknown);
  EXPECT_EQ(tokens->may(Scope::kWrite, std::nullopt, "lab-1"), Verdict::kUnknown);
  EXPECT_EQ(tokens->may(Scope::kWrite, bearerOf(""), "x"), Verdict::kUnknown)
      << "the empty token is none, even if its digest stands there";
  EXPECT_FALSE(tokens->guardReading());
  EXPECT_EQ(tokens->may(Scope::kRead, std::nullopt, "any"), Verdict::kAllowed)
      << "no line speaks of reading";
  for (const std::string& wrong : std::vector<std::string>{
           "write lab-* short", "own lab-* " + kWriter, "write " + kWriter,
           "write x " + kWriter + " more", "write x sha256:00", "write x anyone", "read"}) {
    const auto refused = Tokens::parse("# first\n" + wrong);
    ASSERT_FALSE(refused) << wrong;
    EXPECT_NE(refused.error().message.find("line 2"), std::string::npos) << refused.error().message;
    EXPECT_EQ(refused.error().message.find(kWriter), std::string::npos)
        << "a message that goes to a log tells no secret";
  }
}

TEST(Tokens, aLineOfReadingGuardsAllMeshesAndWritingIncludesReading) {
  const auto tokens =
      Tokens::parse("read lab-* " + kReader + "\nwrite lab-1 " + kWriter + "\nread demo anyone\n");
  ASSERT_TRUE(tokens) << tokens.error().message;
  EXPECT_TRUE(tokens->guardReading());
  EXPECT_EQ(tokens->may(Scope::kRead, bearerOf(kReader), "lab-1"), Verdict::kAllowed);
  EXPECT_EQ(tokens->may(Scope::kWrite, bearerOf(kReader), "lab-1"), Verdict::kForbidden);
  EXPECT_EQ(tokens->may(Scope::kRead, bearerOf(kReader), "x"), Verdict::kForbidden);
  EXPECT_EQ(tokens->may(Scope::kRead, bearerOf(kWriter), "lab-1"), Verdict::kAllowed);
  EXPECT_EQ(tokens->may(Scope::kRead, bearerOf(kWriter), "lab-2"), Verdict::kForbidden);
  EXPECT_EQ(tokens->may(Scope::kRead, std::nullopt, "lab-1"), Verdict::kUnknown);
  EXPECT_EQ(tokens->may(Scope::kRead, std::nullopt, "demo"), Verdict::kAllowed);
  EXPECT_EQ(tokens->may(Scope::kRead, bearerOf(kOther), "demo"), Verdict::kAllowed);
  EXPECT_TRUE(tokens->knows(bearerOf(kReader)));
  EXPECT_FALSE(tokens->knows(bearerOf(kOther)));
  EXPECT_FALSE(tokens->knows(std::nullopt));
}

TEST(Tickets, areForOnceForThirtySecondsAndForTheirTokenAlone) {
  Access access(*Tokens::parse("read * " + kReader));
  const auto now = Access::Clock::time_point() + std::chrono::hours(1);
  const auto first = access.giveTicket(*bearerOf(kReader), now),
             second = access.giveTicket(*bearerOf(kReader), now);
  ASSERT_TRUE(first && second);
  EXPECT_NE(*first, *second);
  EXPECT_EQ(access.takeTicket(*first, now + limits::kTicketTime - std::chrono::milliseconds(1)),
            bearerOf(kReader));
  EXPECT_EQ(access.takeTicket(*first, now), std::nullopt) << "used";
  EXPECT_EQ(access.takeTicket(*second, now + limits::kTicketTime), std::nullopt) << "too old";
  EXPECT_EQ(access.takeTicket("nonsense", now), std::nullopt);
  EXPECT_EQ(access.takeTicket("", now), std::nullopt);
}

TEST(Tickets, ofOneServerAreTakenOnceByEveryOtherThatHasItsKey) {
  const std::string key(32, 'k');
  Access one(*Tokens::parse("read * " + kReader), key),
      two(*Tokens::parse("read * " + kReader), key),
      stranger(*Tokens::parse("read * " + kReader), std::string(32, 'x'));
  const auto now = Access::Clock::now();
  const std::string ticket = *one.giveTicket(*bearerOf(kReader), now);
  EXPECT_EQ(stranger.takeTicket(ticket, now), std::nullopt);
  for (std::size_t at = 0; at < ticket.size(); at += 7) {
    std::string forged = ticket;
    forged[at] = forged[at] == 'a' ? 'b' : 'a';
    EXPECT_EQ(two.takeTicket(forged, now), std::nullopt) << at;
  }
  EXPECT_EQ(two.takeTicket(ticket.substr(0, ticket.size() - 1), now), std::nullopt);
  EXPECT_EQ(two.takeTicket(ticket, now), bearerOf(kReader));
  EXPECT_EQ(two.takeTicket(ticket, now), std::nullopt) << "used";
  EXPECT_EQ(one.takeTicket(ticket, now), bearerOf(kReader));
  EXPECT_EQ(one.takeTicket(ticket, now), std::nullopt) << "used, and its own is no foreign one";
}

std::int64_t systemSeconds() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// The ticket of a server with `key`, which ends at that second of the system clock.
std::string ticketUntil(std::int64_t end, const std::string& key) {
  std::array<char, 17> hex{};
  std::snprintf(hex.data(), hex.size(), "%016llx", static_cast<unsigned long long>(end));
  std::string out = std::string(16, 'f') + hex.data() + std::string(64, '0');
  const auto addHex = [&](std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) {
      std::snprintf(hex.data(), hex.size(), "%02x", unsigned{byte});
      out += hex.data();
    }
  };
  addHex(*bearerOf(kReader));
  SecretDigest mac{};
  unsigned bytes = 0;
  EXPECT_NE(
      ::HMAC(::EVP_sha256(), key.data(), static_cast<int>(key.size()),
             reinterpret_cast<const std::uint8_t*>(out.data()), out.size(), mac.data(), &bytes),
      nullptr);
  addHex(mac);
  return out;
}

TEST(Tickets, ofAnotherServerEndWithinThirtySeconds) {
  const std::string key(32, 'k');
  constexpr std::int64_t kMax = limits::kTicketTime.count();
  for (const std::int64_t left : {std::int64_t{-1}, std::int64_t{0}, std::int64_t{1}, kMax - 1,
                                  kMax, kMax + 1, std::int64_t{1} << 40}) {
    std::optional<SecretDigest> taken;
    std::int64_t now = 0;
    do {  // again where a second has passed meanwhile
      Access access(*Tokens::parse("read * " + kReader), key);
      now = systemSeconds();
      taken = access.takeTicket(ticketUntil(now + left, key));
    } while (systemSeconds() != now);
    EXPECT_EQ(taken, 0 < left && left <= kMax ? bearerOf(kReader) : std::nullopt) << left;
  }
}

// Only the steady clock advances here, so the ticket itself is still valid when its mark is
// removed.
TEST(Tickets, ofAnotherServerAreRememberedAsUsedAsLongAsOneMayLast) {
  const std::string key(32, 'k');
  Access access(*Tokens::parse("read * " + kReader), key);
  const std::string ticket = ticketUntil(systemSeconds() + limits::kTicketTime.count(), key);
  const auto now = Access::Clock::now();
  EXPECT_EQ(access.takeTicket(ticket, now), bearerOf(kReader));
  EXPECT_EQ(access.takeTicket(ticket, now + limits::kTicketTime - std::chrono::nanoseconds(1)),
            std::nullopt);
  EXPECT_EQ(access.takeTicket(ticket, now + limits::kTicketTime), bearerOf(kReader));
}

TEST(Tickets, theKeyOfAFolderIsMadeOnceAndForItsOwnerAlone) {
  const test::TempFolder folder;
  const auto file = folder.path() / "key";
  const auto made = loadTicketKey(file);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_GE(made->size(), 32u);
  EXPECT_EQ(loadTicketKey(file), *made);
  EXPECT_EQ(std::filesystem::status(file).permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  folder.write("short", std::string_view("abc\n"));
  EXPECT_EQ(loadTicketKey(folder.path() / "short").error().code, ErrorCode::kBadValue);
  EXPECT_EQ(loadTicketKey("/proc/nothing/key").error().code, ErrorCode::kIo);
}

TEST(Tickets, ofOneTokenAreBoundedAndOfAnotherStillToBeHad) {
  Access access(*Tokens::parse("read * " + kReader));
  const auto now = Access::Clock::now();
  std::set<std::string> given;
  for (std::size_t i = 0; i < limits::kMaxTickets; ++i)
    given.insert(access.giveTicket(*bearerOf(kReader), now).value_or(""));
  EXPECT_EQ(given.size(), limits::kMaxTickets);
  EXPECT_EQ(access.giveTicket(*bearerOf(kReader), now), std::nullopt);
  EXPECT_TRUE(access.giveTicket(*bearerOf(kOther), now));
  EXPECT_TRUE(access.takeTicket(*given.begin(), now));
  EXPECT_TRUE(access.giveTicket(*bearerOf(kReader), now)) << "a used one leaves its place";
  EXPECT_TRUE(access.giveTicket(*bearerOf(kReader), now + limits::kTicketTime))
      << "and so do those that are too old";
}

/// `noise` for one token, `a b` for everybody.
class GuardedTest : public ::testing::Test {
 protected:
  HttpResponse get(const std::string& target, const std::string& headers = "") {
    return RawClient(server_.port()).get(target, headers);
  }
  HttpResponse postTicket(const std::string& headers) {
    RawClient client(server_.port());
    client.send("POST /v1/tickets HTTP/1.1\r\nHost: a\r\nContent-Length: 0\r\n" + headers + "\r\n");
    return client.receive();
  }
  std::string ticket(const std::string& token) {
    const Json ticket = Json::parse(postTicket(bearer(token)).body)["ticket"];
    return ticket.isNull() ? "" : ticket.string();
  }
  std::string openWord(test::StreamClient& stream, const std::string& mesh) {
    stream.send(R"({"type":"open","credit":0,"mesh":")" + mesh + "\"}");
    const auto message = stream.receive();
    const Json word = message ? Json::parse(message->text()) : Json();
    if (word.isNull()) return "nothing";
    return (word["type"] == "error" ? word["code"] : word["type"]).string();
  }

  test::ServedFolder folder_;
  Access access_{*Tokens::parse("read noise " + kReader + "\nread a* anyone\nread none " + kOther +
                                "\nwrite up* " + kWriter)};
  test::RunningServer server_{folder_.store(), folder_.viewer(), {.access = &access_}};
};

TEST_F(GuardedTest, aMeshIsForItsTokenAndNamesAreNotTold) {
  EXPECT_EQ(get("/v1/meshes/noise", bearer(kReader)).status, 200u);
  EXPECT_EQ(get("/v1/meshes/noise").status, 401u);
  EXPECT_EQ(get("/v1/meshes/noise").header("www-authenticate"), "Bearer realm=\"qtet\"");
  EXPECT_EQ(get("/v1/meshes/noise", bearer(kOther)).status, 403u);
  for (const char* rest : {"", "/log", "/levels/0.vtu"}) {
    EXPECT_EQ(get(std::string("/v1/meshes/noise") + rest).body,
              get(std::string("/v1/meshes/nothing") + rest).body)
        << "there or not";
    EXPECT_EQ(get(std::string("/v1/meshes/noise") + rest, bearer(kOther)).body,
              get(std::string("/v1/meshes/nothing") + rest, bearer(kOther)).body);
  }
  EXPECT_EQ(get("/v1/meshes/none", bearer(kOther)).status, 404u)
      << "who may read it may learn that it is not there";
  EXPECT_EQ(get("/v1/meshes/a%20b").status, 200u);
}

TEST_F(GuardedTest, whatIsUnderADigestIsThereForThoseAloneWhoMayReadItUnderSomeName) {
  for (const char* part : {"log", "manifest", "base", "chunks/0", "levels/0.vtu", "poster.webp"}) {
    EXPECT_EQ(get(folder_.log(part)).status, 404u) << part;
    EXPECT_EQ(get(folder_.log(part), bearer(kOther)).status, 404u) << part;
  }
  const HttpResponse own = get(folder_.log(), bearer(kReader));
  EXPECT_EQ(own.body, folder_.file());
  EXPECT_TRUE(own.header("cache-control").starts_with("private")) << own.header("cache-control");
  const std::string open = "/v1/logs/" + folder_.store().find("a b")->log.digest() + "/log";
  EXPECT_TRUE(get(open).header("cache-control").starts_with("public"));
}

TEST_F(GuardedTest, thePageOfAGuardedMeshIsThatOfNone) {
  const HttpResponse guarded = get("/?mesh=noise"), none = get("/?mesh=nothing");
  EXPECT_EQ(guarded.body, none.body);
  EXPECT_EQ(guarded.header("etag"), none.header("etag"));
  EXPECT_EQ(guarded.header("link"), none.header("link"));
  EXPECT_EQ(get("/?mesh=noise", bearer(kReader)).body, none.body) << "pages come without a token";
  EXPECT_NE(get("/?mesh=a%20b").body, none.body);
  EXPECT_EQ(get("/").body, get("/?mesh=a%20b").body) << "the first that everybody may read";
}

TEST_F(GuardedTest, aSavedFileIsCalledByANameThatTheAskerMayKnow) {
  const auto savedAs = [&](const std::string& headers) {
    RawClient client(server_.port());
    client.send("HEAD " + folder_.log("levels/1.vtu") + " HTTP/1.1\r\nHost: a\r\n" + headers +
                "\r\n");
    return client.receive(true).header("content-disposition");
  };
  EXPECT_EQ(savedAs(bearer(kReader)), "attachment; filename=\"noise-level-1.vtu\"");
  std::filesystem::copy(folder_.logFolder() / "noise.qtet", folder_.logFolder() / "a2.qtet");
  ASSERT_TRUE(folder_.store().rescan());
  EXPECT_EQ(savedAs(""), "attachment; filename=\"a2-level-1.vtu\"");
}

TEST_F(GuardedTest, theListHoldsWhatMayBeReadAndItsTagTellsItApart) {
  const auto ids = [&](const std::string& headers) {
    std::string out;
    const Json list = Json::parse(get("/v1/meshes", headers).body);
    for (std::size_t i = 0; i < list["meshes"].size(); ++i)
      out += list["meshes"][i]["id"].string() + ";";
    return out;
  };
  EXPECT_EQ(ids(""), "a b;");
  EXPECT_EQ(ids(bearer(kReader)), "a b;noise;");
  EXPECT_EQ(get("/v1/meshes", bearer("nobodysSecretOfManyChars")).status, 401u);
  EXPECT_NE(get("/v1/meshes").header("etag"), get("/v1/meshes", bearer(kReader)).header("etag"));
  const HttpResponse page = get("/v1/meshes?limit=1", bearer(kReader));
  EXPECT_NE(page.header("link").find("after=a%20b"), std::string::npos);
  EXPECT_EQ(get("/v1/meshes?limit=1").header("link"), "") << "nothing follows that may be seen";
}

TEST_F(GuardedTest, aTicketOpensOneStreamWithItsTokensMeshes) {
  EXPECT_EQ(postTicket("").status, 401u);
  EXPECT_EQ(postTicket(bearer("nobodysSecretOfManyChars")).status, 401u);
  const std::string path = "/v1/stream?ticket=" + ticket(kReader);
  test::StreamClient stream(server_.port(), "qtet.v1", path);
  ASSERT_TRUE(stream.connected());
  EXPECT_EQ(openWord(stream, "noise"), "opened");
  EXPECT_EQ(openWord(stream, "a b"), "opened");
  EXPECT_EQ(openWord(stream, "none"), "not-found");
  test::StreamClient again(server_.port(), "qtet.v1", path);
  EXPECT_EQ(again.httpStatus(), 401u) << "used";
  test::StreamClient other(server_.port(), "qtet.v1", "/v1/stream?ticket=" + ticket(kOther));
  ASSERT_TRUE(other.connected());
  EXPECT_EQ(openWord(other, "noise"), "not-found");
  test::StreamClient nobody(server_.port());
  ASSERT_TRUE(nobody.connected());
  EXPECT_EQ(openWord(nobody, "noise"), "not-found");
  EXPECT_EQ(openWord(nobody, "a b"), "opened");
  EXPECT_EQ(get("/v1/tickets", bearer(kReader)).status, 405u);
}

TEST_F(GuardedTest, aTokenThatIsTakenAwayIsNoGoodFromTheNextRequestOn) {
  const std::string before = ticket(kReader);
  test::StreamClient stream(server_.port(), "qtet.v1", "/v1/stream?ticket=" + ticket(kReader));
  EXPECT_EQ(openWord(stream, "noise"), "opened");
  access_.replace(*Tokens::parse("read noise " + kOther));
  EXPECT_EQ(get("/v1/meshes/noise", bearer(kReader)).status, 401u);
  EXPECT_EQ(get("/v1/meshes/noise", bearer(kOther)).status, 200u);
  EXPECT_EQ(openWord(stream, "noise"), "not-found");
  EXPECT_EQ(
      test::StreamClient(server_.port(), "qtet.v1", "/v1/stream?ticket=" + before).httpStatus(),
      401u);
}

TEST_F(GuardedTest, whoMayReadMayNotWrite) {
  RawClient client(server_.port());
  client.send("DELETE /v1/meshes/noise HTTP/1.1\r\nHost: a\r\n" + bearer(kReader) + "\r\n");
  EXPECT_EQ(client.receive().status, 403u);
  EXPECT_EQ(get("/v1/meshes/noise", bearer(kReader)).status, 200u);
}

TEST(Origins, ofOtherPagesGetNoTicketsAndChangeNothing) {
  const test::ServedFolder folder;
  Access access(*Tokens::parse("write * " + kWriter + "\n"));
  test::RunningServer server(folder.store(), folder.viewer(),
                             {.access = &access, .allowedOrigins = {"https://a.example"}});
  const auto ask = [&](const std::string& line, const std::string& origin) {
    RawClient client(server.port());
    client.send(line + " HTTP/1.1\r\nHost: a\r\n" + bearer(kWriter) + "Content-Length: 0\r\n" +
                (origin.empty() ? "" : "Origin: " + origin + "\r\n") + "\r\n");
    return client.receive().status;
  };
  EXPECT_EQ(ask("POST /v1/tickets", "https://b.example"), 403u);
  EXPECT_EQ(ask("PUT /v1/meshes/new", "https://b.example"), 403u);
  EXPECT_EQ(ask("DELETE /v1/meshes/noise", "https://b.example"), 403u);
  EXPECT_EQ(ask("GET /v1/meshes/noise", "https://b.example"), 200u) << "reading is for every page";
  EXPECT_EQ(ask("POST /v1/tickets", "https://a.example"), 201u);
  EXPECT_EQ(ask("POST /v1/tickets", ""), 201u) << "no browser";
  EXPECT_EQ(ask("DELETE /v1/meshes/noise", "https://a.example"), 204u);
}

TEST(Origins, aPreflightSaysWhatTheRequestWouldGet) {
  const test::ServedFolder folder;
  Access access(*Tokens::parse("write * " + kWriter + "\n"));
  const auto serve = [&](std::vector<std::string> origins) {
    return test::RunningServer(folder.store(), folder.viewer(),
                               {.access = &access, .allowedOrigins = std::move(origins)});
  };
  const auto server = serve({"https://a.example", "https://c.example"}), open = serve({});
  struct Case {
    const test::RunningServer& server;
    std::string target, origin, method, allowOrigin, allowMethods;
  };
  const std::string mesh = "/v1/meshes/new", tickets = "/v1/tickets",
                    reading = "GET, HEAD, OPTIONS";
  const std::string stranger = "https://b.example", page = "https://c.example";
  const std::string all = reading + ", PUT, DELETE";
  for (const Case& one :
       {Case{server, mesh, stranger, "PUT", "", reading},
        Case{server, mesh, stranger, "DELETE", "", reading},
        Case{server, mesh, stranger, "SURPRISE", "", reading},
        Case{server, mesh, stranger, "GET", "*", reading},
        Case{server, mesh, "null", "PUT", "", reading}, Case{server, mesh, page, "PUT", page, all},
        Case{server, tickets, stranger, "POST", "", "OPTIONS"},
        Case{server, tickets, page, "POST", page, "POST, OPTIONS"},
        Case{server, "/v1/meshes", stranger, "GET", "*", reading},
        Case{server, mesh, "", "", "*", all}, Case{open, mesh, stranger, "PUT", "*", all}}) {
    RawClient client(one.server.port());
    client.send(
        "OPTIONS " + one.target + " HTTP/1.1\r\nHost: a\r\n" +
        (one.origin.empty() ? "" : "Origin: " + one.origin + "\r\n") +
        (one.method.empty() ? "" : "Access-Control-Request-Method: " + one.method + "\r\n") +
        "\r\n");
    const test::HttpResponse answer = client.receive();
    const std::string what = one.method + " " + one.target + " of " + one.origin;
    EXPECT_EQ(answer.status, 204u) << what;
    EXPECT_EQ(answer.header("access-control-allow-origin"), one.allowOrigin) << what;
    EXPECT_EQ(answer.header("access-control-allow-methods"), one.allowMethods) << what;
    EXPECT_EQ(answer.header("vary"),
              &one.server == &open ? "" : "Origin, Access-Control-Request-Method")
        << what;
  }
}

}  // namespace
}  // namespace qtet
