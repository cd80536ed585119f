#include "server/http_router.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/server/served_folder.h"

namespace qtet {
namespace {

using Json = nlohmann::json;

class RouterTest : public testing::Test {
 protected:
  Reply get(std::string_view target) { return router_.route({.method = "GET", .target = target}); }
  Reply ask(std::string_view method, std::string_view target) { return router_.route({.method = method, .target = target}); }

  static std::string header(const Reply& reply, std::string_view name) {
    for (const auto& [key, value] : reply.headers)
      if (key == name) return value;
    return "";
  }
  static std::string body(const Reply& reply) {
    if (const auto* text = std::get_if<std::string>(&reply.body)) return *text;
    if (const auto* view = std::get_if<ByteView>(&reply.body)) return {view->begin(), view->end()};
    return "(a level)";
  }
  static Json json(const Reply& reply) { return Json::parse(body(reply)); }
  static void expectProblem(const Reply& reply, unsigned status, const std::string& type) {
    EXPECT_EQ(reply.status, status);
    EXPECT_EQ(header(reply, "Content-Type"), "application/problem+json");
    const Json problem = json(reply);
    EXPECT_EQ(problem["type"], "/problems/" + type);
    EXPECT_EQ(problem["status"], status);
    EXPECT_EQ(problem["title"], std::string(reasonPhrase(status)));
    EXPECT_FALSE(problem["detail"].get<std::string>().empty());
  }

  test::ServedFolder folder_;
  Router router_{folder_.store(), folder_.viewer()};
};

TEST_F(RouterTest, theListNamesEveryMeshInOrder) {
  const Reply reply = get("/v1/meshes");
  EXPECT_EQ(reply.status, 200u);
  EXPECT_EQ(header(reply, "Content-Type"), "application/json");
  const Json list = json(reply)["meshes"];
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0]["id"], "a b");
  EXPECT_EQ(list[0]["links"]["self"], "/v1/meshes/a%20b");
  EXPECT_EQ(list[1]["id"], "noise");
  EXPECT_EQ(list[1]["digest"], folder_.mesh().log.digest());
  EXPECT_EQ(list[1]["bytes"], folder_.mesh().log.bytes().size());
  EXPECT_EQ(list[1]["tetrahedra"], 210);
  EXPECT_EQ(list[1]["vertices"], 105);
  EXPECT_EQ(list[1]["fields"], (Json{"density", "velocity"}));
}

TEST_F(RouterTest, aMeshTellsItsManifestAndWhatEachLevelCosts) {
  const Json mesh = json(get("/v1/meshes/noise"));
  const LogIndex& index = folder_.mesh().log.index();
  EXPECT_EQ(mesh["manifest"], Json::parse(manifestToJson(folder_.mesh().manifest)));
  EXPECT_EQ(mesh["headBytes"], index.headBytes());
  ASSERT_EQ(mesh["levels"].size(), 12u);
  std::uint64_t sum = 0;
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_EQ(mesh["levels"][k]["level"], k);
    sum += mesh["levels"][k]["bytes"].get<std::uint64_t>();
    EXPECT_EQ(mesh["levels"][k]["cumulativeBytes"], sum);
    EXPECT_EQ(sum, index.chunks[k].offset + index.chunks[k].size());
  }
  EXPECT_EQ(sum, folder_.mesh().log.bytes().size());
}

TEST_F(RouterTest, everyLinkLeadsSomewhere) {
  const Json links = json(get("/v1/meshes/a%20b"))["links"];
  EXPECT_EQ(get(links["self"].get<std::string>()).status, 200u);
  EXPECT_EQ(get(links["log"].get<std::string>()).status, 200u);
  for (const char* name : {"vtu", "drc"}) {
    std::string link = links[name];
    link.replace(link.find("{k}"), 3, "1");
    EXPECT_EQ(get(link).status, 200u) << link;
  }
  EXPECT_EQ(get(links["stream"].get<std::string>()).status, 426u);
}

TEST_F(RouterTest, theLogIsAViewOfTheMapping) {
  const Reply reply = get("/v1/meshes/noise/log");
  EXPECT_EQ(reply.status, 200u);
  EXPECT_EQ(std::get<ByteView>(reply.body).data(), folder_.mesh().log.bytes().data());
  EXPECT_EQ(header(reply, "ETag"), '"' + folder_.mesh().log.digest() + '"');
  EXPECT_EQ(header(reply, "Accept-Ranges"), "bytes");
  EXPECT_EQ(header(reply, "Cache-Control"), "no-cache");
}

TEST_F(RouterTest, aLogUnderItsDigestMayBeKeptForEver) {
  const Reply same = get("/v1/meshes/noise/log?digest=" + folder_.mesh().log.digest());
  EXPECT_EQ(same.status, 200u);
  EXPECT_NE(header(same, "Cache-Control").find("immutable"), std::string::npos);
  expectProblem(get("/v1/meshes/noise/log?digest=" + std::string(64, '0')), 404, "log-changed");
}

TEST_F(RouterTest, rangesAreCutFromTheMapping) {
  const Reply part = router_.route({.method = "GET", .target = "/v1/meshes/noise/log", .range = "bytes=10-19"});
  EXPECT_EQ(part.status, 206u);
  EXPECT_EQ(header(part, "Content-Range"), "bytes 10-19/" + std::to_string(folder_.file().size()));
  EXPECT_EQ(body(part), folder_.file().substr(10, 10));
  const Reply behind = router_.route({.method = "GET", .target = "/v1/meshes/noise/log", .range = "bytes=99999999-"});
  expectProblem(behind, 416, "range-not-satisfiable");
  EXPECT_EQ(header(behind, "Content-Range"), "bytes */" + std::to_string(folder_.file().size()));
}

TEST_F(RouterTest, conditionsAreHonouredOnEveryResource) {
  for (const char* target :
       {"/v1/meshes", "/v1/meshes/noise", "/v1/meshes/noise/log", "/v1/meshes/noise/levels/1.vtu", "/", "/assets/app-1a2b.js"}) {
    const std::string etag = header(get(target), "ETag");
    ASSERT_FALSE(etag.empty()) << target;
    const Reply same = router_.route({.method = "GET", .target = target, .ifNoneMatch = etag});
    EXPECT_EQ(same.status, 304u) << target;
    EXPECT_EQ(header(same, "ETag"), etag);
    EXPECT_EQ(same.bodyBytes(), 0u);
    expectProblem(router_.route({.method = "GET", .target = target, .ifMatch = "\"other\""}), 412, "precondition-failed");
  }
}

TEST_F(RouterTest, levelsAreToBeMade) {
  const Reply reply = get("/v1/meshes/noise/levels/11.drc");
  EXPECT_EQ(reply.status, 200u);
  const auto& level = std::get<LevelRequest>(reply.body);
  EXPECT_EQ(level.mesh, &folder_.mesh());
  EXPECT_EQ(level.level, 11u);
  EXPECT_EQ(level.form, LevelRequest::Form::kDrc);
  EXPECT_NE(header(reply, "ETag"), header(get("/v1/meshes/noise/levels/11.vtu"), "ETag"));
  EXPECT_NE(header(reply, "ETag"), header(get("/v1/meshes/noise/levels/10.drc"), "ETag"));
  EXPECT_EQ(ask("HEAD", "/v1/meshes/noise/levels/11.drc").bodyBytes(), std::nullopt);
}

TEST_F(RouterTest, whatDoesNotExistIsNotFound) {
  for (const char* target : {"/v1",
                             "/v1/",
                             "/v2/meshes",
                             "/v1/meshes/",
                             "/v1/meshes/nothing",
                             "/v1/meshes/noise/",
                             "/v1/meshes/noise/log/",
                             "/v1/meshes/noise/logs",
                             "/v1/meshes/noise/levels",
                             "/v1/meshes/noise/levels/",
                             "/v1/meshes/noise/levels/12.vtu",
                             "/v1/meshes/noise/levels/-1.vtu",
                             "/v1/meshes/noise/levels/01.vtu",
                             "/v1/meshes/noise/levels/+1.vtu",
                             "/v1/meshes/noise/levels/1",
                             "/v1/meshes/noise/levels/.vtu",
                             "/v1/meshes/noise/levels/1.VTU",
                             "/v1/meshes/noise/levels/4294967296.vtu",
                             "/v1/meshes/noise/levels/1.vtu/x",
                             "/v1/meshes/noise.qtet",
                             "/v1/meshes/..%2Fnoise",
                             "/V1/meshes",
                             "/v1/meshes/noise/levels/1e0.vtu"})
    expectProblem(get(target), 404, "not-found");
}

TEST_F(RouterTest, theViewerAndNothingElseOfItsFolderIsServed) {
  EXPECT_EQ(body(get("/")), "<!doctype html><title>viewer</title>");
  EXPECT_EQ(body(get("/?mesh=noise")), "<!doctype html><title>viewer</title>");
  EXPECT_EQ(body(get("/index.html")), "<!doctype html><title>viewer</title>");
  EXPECT_EQ(body(get("/docs/")), "<title>docs</title>");
  EXPECT_EQ(header(get("/assets/codec.wasm"), "Content-Type"), "application/wasm");
  EXPECT_NE(header(get("/assets/app-1a2b.js"), "Cache-Control").find("immutable"), std::string::npos);
  EXPECT_EQ(header(get("/"), "Cache-Control"), "no-cache");
  EXPECT_NE(header(get("/"), "Content-Security-Policy").find("'wasm-unsafe-eval'"), std::string::npos);
  for (const char* target : {"/.secret", "/%2esecret", "/.git/config", "/../noise.qtet", "/%2e%2e/noise.qtet", "/..%2fnoise.qtet",
                             "/assets/../.secret", "/assets%2fapp-1a2b.js", "/assets/", "/docs", "//index.html", "/./index.html",
                             "/index.html/", "/..\\noise.qtet", "/assets/%2e%2e/index.html", "/%252e%252e/x"})
    expectProblem(get(target), 404, "not-found");
}

TEST_F(RouterTest, aCompressedFileGoesToWhoeverTakesIt) {
  const Reply plain = get("/assets/app-1a2b.js");
  const Reply gzip = router_.route({.method = "GET", .target = "/assets/app-1a2b.js", .acceptEncoding = "br, gzip"});
  EXPECT_EQ(body(plain), "console.log(1)");
  EXPECT_EQ(header(plain, "Content-Encoding"), "");
  EXPECT_EQ(body(gzip), "(compressed)");
  EXPECT_EQ(header(gzip, "Content-Encoding"), "gzip");
  EXPECT_EQ(header(gzip, "Content-Type"), header(plain, "Content-Type"));
  EXPECT_NE(header(gzip, "ETag"), header(plain, "ETag"));
  for (const Reply* reply : {&plain, &gzip}) EXPECT_EQ(header(*reply, "Vary"), "Accept-Encoding");
  const std::string tag = header(gzip, "ETag");
  EXPECT_EQ(router_.route({.method = "GET", .target = "/assets/app-1a2b.js", .ifNoneMatch = tag, .acceptEncoding = "gzip"}).status, 304u);
  EXPECT_EQ(router_.route({.method = "GET", .target = "/assets/app-1a2b.js", .ifNoneMatch = tag}).status, 200u);
  expectProblem(get("/assets/app-1a2b.js.gz"), 404, "not-found");
  EXPECT_EQ(body(get("/assets/alone.gz")), "an archive");
}

TEST_F(RouterTest, withoutAViewerThePageSaysSo) {
  const ViewerFiles none;
  const Router router(folder_.store(), none);
  const Reply reply = router.route({.method = "GET", .target = "/"});
  expectProblem(reply, 404, "not-found");
  EXPECT_NE(body(reply).find("--viewer"), std::string::npos);
}

TEST_F(RouterTest, targetsThatAreNoPathsAreBadRequests) {
  for (const char* target : {"/%", "/%zz", "/a%00b", "*", "", "/a b", "/\x01", "file:///etc/passwd"})
    expectProblem(get(target), 400, "bad-request");
}

TEST_F(RouterTest, onlyReadingIsAllowed) {
  for (const char* method : {"POST", "PUT", "DELETE", "PATCH", "TRACE", "CONNECT"}) {
    const Reply reply = ask(method, "/v1/meshes");
    expectProblem(reply, 405, "method-not-allowed");
    EXPECT_EQ(header(reply, "Allow"), "GET, HEAD, OPTIONS");
  }
  expectProblem(ask("get", "/v1/meshes"), 501, "not-implemented");
}

TEST_F(RouterTest, headIsGetWithoutTheBody) {
  for (const char* target : {"/v1/meshes", "/v1/meshes/noise/log", "/", "/nothing"}) {
    const Reply head = ask("HEAD", target);
    const Reply whole = get(target);
    EXPECT_FALSE(head.sendBody);
    EXPECT_EQ(head.status, whole.status);
    EXPECT_EQ(head.headers, whole.headers);
    EXPECT_EQ(head.bodyBytes(), whole.bodyBytes());
  }
}

TEST_F(RouterTest, optionsAnswersAPreflight) {
  for (const char* target : {"*", "/v1/meshes/noise/log"}) {
    const Reply reply = ask("OPTIONS", target);
    EXPECT_EQ(reply.status, 204u);
    EXPECT_NE(header(reply, "Access-Control-Allow-Headers").find("Range"), std::string::npos);
  }
}

TEST_F(RouterTest, everyAnswerMayBeReadFromAnywhereAndIsNotSniffed) {
  for (const char* target : {"/v1/meshes", "/v1/meshes/noise/log", "/", "/nothing", "/%"}) {
    const Reply reply = get(target);
    EXPECT_EQ(header(reply, "Access-Control-Allow-Origin"), "*") << target;
    EXPECT_EQ(header(reply, "X-Content-Type-Options"), "nosniff") << target;
  }
}

TEST(HeaderText, speaksOfTheBodyAndTheConnection) {
  Reply reply = problem(404, "not-found", "no");
  const std::string size = std::to_string(*reply.bodyBytes());
  const std::string kept = headerText(reply, true);
  EXPECT_TRUE(kept.starts_with("HTTP/1.1 404 Not Found\r\nDate: "));
  EXPECT_TRUE(kept.ends_with("\r\n\r\n"));
  EXPECT_NE(kept.find("\r\nContent-Length: " + size + "\r\n"), std::string::npos);
  EXPECT_NE(kept.find("\r\nConnection: keep-alive\r\n"), std::string::npos);
  reply.close = true;
  EXPECT_NE(headerText(reply, true).find("\r\nConnection: close\r\n"), std::string::npos);
  reply.status = 304;
  EXPECT_EQ(headerText(reply, true).find("Content-Length"), std::string::npos);
}

}  // namespace
}  // namespace qtet
