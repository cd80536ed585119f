#include "server/routes/http_router.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "tests/server/program/served_folder.h"
#include "tests/server/support/json.h"

namespace qtet {
namespace {

using test::Json;

class RouterTest : public ::testing::Test {
 protected:
  Reply route(const RequestView& request) { return router_.route(request).reply; }
  Reply get(std::string_view target) { return route({.method = "GET", .target = target}); }
  Reply ask(std::string_view method, std::string_view target) {
    return route({.method = method, .target = target});
  }
  LevelRequest levelOf(const RequestView& request) {
    return std::get<LevelRequest>(router_.route(request).work);
  }

  static std::string header(const Reply& reply, std::string_view name) {
    return std::string(reply.header(name));
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
    EXPECT_TRUE(problem["detail"].string().ends_with('.')) << "a sentence: " << problem["detail"];
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
  EXPECT_EQ(list[1]["fields"], Json::parse(R"(["density","velocity"])"));
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
    sum += mesh["levels"][k]["bytes"].count();
    EXPECT_EQ(mesh["levels"][k]["cumulativeBytes"], sum);
    EXPECT_EQ(sum, index.chunks[k].offset + index.chunks[k].size());
  }
  EXPECT_EQ(sum, folder_.mesh().log.bytes().size());
}

TEST_F(RouterTest, everyLinkLeadsSomewhere) {
  const Json links = json(get("/v1/meshes/a%20b"))["links"];
  EXPECT_EQ(get(links["self"].string()).status, 200u);
  EXPECT_EQ(get(links["log"].string()).status, 200u);
  for (const char* name : {"log", "manifest", "base", "vtu", "glb", "drc", "chunk"}) {
    std::string link = links[name].string();
    if (const auto at = link.find('{'); at != std::string::npos) link.replace(at, 3, "1");
    EXPECT_EQ(get(link).status, 200u) << link;
  }
  EXPECT_EQ(get(links["stream"].string()).status, 426u);
}

TEST_F(RouterTest, theLogIsAViewOfTheMapping) {
  const Reply reply = get(folder_.log());
  EXPECT_EQ(reply.status, 200u);
  EXPECT_EQ(std::get<ByteView>(reply.body).data(), folder_.mesh().log.bytes().data());
  EXPECT_EQ(header(reply, "ETag"), '"' + folder_.mesh().log.digest() + '"');
  EXPECT_EQ(header(reply, "Accept-Ranges"), "bytes");
}

TEST_F(RouterTest, whatStandsUnderADigestMayBeKeptForEver) {
  for (const char* rest : {"log", "manifest", "base", "chunks/3", "fields/velocity/chunks/11",
                           "levels/2.glb", "levels/fit.vtu?tets=50"}) {
    const Reply reply = get(folder_.log(rest));
    EXPECT_EQ(reply.status, 200u) << rest;
    EXPECT_NE(header(reply, "Cache-Control").find("immutable"), std::string::npos) << rest;
  }
  expectProblem(get("/v1/logs/" + std::string(64, '0') + "/log"), 404, "log-changed");
}

TEST_F(RouterTest, baseAndChunksInOrderAreTheWholeLog) {
  const LogIndex& index = folder_.mesh().log.index();
  const std::string file = folder_.file();
  const std::string base = body(get(folder_.log("base")));
  EXPECT_EQ(base, file.substr(0, base.size()));
  std::string all = file.substr(0, index.headBytes());
  for (std::uint32_t chunk = 0; chunk < index.chunks.size(); ++chunk) {
    const std::string number = std::to_string(chunk);
    all += body(get(folder_.log("chunks/" + number)));
    if (chunk == 0) {
      EXPECT_EQ(all, base);
    }
    for (const char* field : {"density", "velocity"})
      all += body(get(folder_.log("fields/" + std::string(field) + "/chunks/" + number)));
  }
  EXPECT_EQ(all, file);
}

TEST_F(RouterTest, anAddressUnderTheNameLeadsToTheDigest) {
  const std::string name = "/v1/meshes/noise/";
  const Reply reply = get(name + "levels/3.vtu?fields=density");
  EXPECT_EQ(reply.status, 307u);
  EXPECT_EQ(header(reply, "Location"), folder_.log("levels/3.vtu?fields=density"));
  EXPECT_EQ(header(reply, "Cache-Control"), "no-cache");
}

TEST_F(RouterTest, theListComesInPages) {
  const Json first = json(get("/v1/meshes?limit=1"));
  ASSERT_EQ(first["meshes"].size(), 1u);
  EXPECT_EQ(first["meshes"][0]["id"], "a b");
  const Json second = json(get(first["next"].string()));
  ASSERT_EQ(second["meshes"].size(), 1u);
  EXPECT_EQ(second["meshes"][0]["id"], "noise");
  EXPECT_FALSE(second.contains("next"));
  EXPECT_NE(header(get("/v1/meshes?limit=1"), "ETag"), header(get("/v1/meshes"), "ETag"));
  EXPECT_EQ(json(get("/v1/meshes?limit=1000"))["meshes"].size(), 2u);
  for (const char* wrong : {"0", "1001", "-1", "", "x", "99999999999999999999"})
    expectProblem(get("/v1/meshes?limit=" + std::string(wrong)), 400, "bad-request");
}

TEST_F(RouterTest, aParameterGivenTwiceIsRefusedByName) {
  for (const char* target : {"/v1/meshes?limit=1&limit=1", "/v1/meshes/noise?x=1&limit&%6Cimit=2",
                             "/v1/logs/none/log?limit=1&limit=2", "/v1/stream?limit=&limit="}) {
    const Reply reply = get(target);
    expectProblem(reply, 400, "bad-request");
    EXPECT_EQ(json(reply)["detail"], "the parameter 'limit' is given twice; give it once.");
  }
  EXPECT_EQ(get("/?mesh=noise&utm=1&utm=2").status, 200u) << "the page's own matter";
}

TEST_F(RouterTest, aPlusInAQueryIsASpace) {
  const Json list = json(get("/v1/meshes?after=a+b"));
  ASSERT_EQ(list["meshes"].size(), 1u);
  EXPECT_EQ(list["meshes"][0]["id"], "noise");
  expectProblem(get("/v1/meshes/a+b"), 404, "not-found");
}

TEST_F(RouterTest, aLevelIsChosenBySizeAndByFields) {
  const auto wanted = [&](const std::string& rest) {
    return levelOf({.method = "GET", .target = folder_.log(rest)});
  };
  const Manifest& manifest = folder_.mesh().manifest;
  const std::string cells = std::to_string(manifest.levels[5].tetrahedra);
  EXPECT_EQ(wanted("levels/fit.vtu?tets=" + cells).level, 5u);
  EXPECT_EQ(wanted("levels/fit.vtu?bytes=" + std::to_string(folder_.mesh().prefixBytes(7))).level,
            7u);
  EXPECT_EQ(header(get(folder_.log("levels/fit.drc?tets=" + cells)), "Content-Location"),
            folder_.log("levels/5.drc"));
  EXPECT_EQ(wanted("levels/3.vtu").fields, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(wanted("levels/3.vtu?fields=velocity,velocity").fields,
            (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(wanted("levels/3.vtu?fields=").fields, (std::vector<std::uint32_t>{}));
  EXPECT_NE(wanted("levels/3.vtu").key(), wanted("levels/3.vtu?fields=velocity").key());
  expectProblem(get(folder_.log("levels/3.vtu?fields=nothing")), 404, "not-found");
  for (const char* wrong : {"levels/fit.vtu", "levels/fit.vtu?tets=1&bytes=2",
                            "levels/fit.vtu?tets=x", "levels/fit.vtu?error=density",
                            "levels/fit.vtu?error=density:-1", "levels/fit.vtu?error=density:nan"})
    expectProblem(get(folder_.log(wrong)), 400, "bad-request");
  expectProblem(get(folder_.log("levels/fit.vtu?error=nothing:0.1")), 404, "not-found");
}

TEST_F(RouterTest, jsonAndVtuAreCompressedForWhoTakesIt) {
  for (const std::string& target : {std::string("/v1/meshes"), std::string("/v1/meshes/noise"),
                                    folder_.log("manifest"), std::string("/openapi.json")}) {
    const Reply plain = get(target);
    for (const char* coding : {"gzip", "zstd"}) {
      const Reply small = route({.method = "GET", .target = target, .acceptEncoding = coding});
      EXPECT_EQ(header(small, "Content-Encoding"), coding) << target;
      EXPECT_LT(*small.bodyBytes(), *plain.bodyBytes()) << target;
      EXPECT_NE(header(small, "ETag"), header(plain, "ETag")) << target;
    }
  }
  EXPECT_EQ(
      header(route({.method = "GET", .target = folder_.log(), .acceptEncoding = "gzip, zstd"}),
             "Content-Encoding"),
      "")
      << "a log's blocks are compressed already";
  const std::string target = folder_.log("levels/1.vtu");
  const RequestView vtu{.method = "GET", .target = target, .acceptEncoding = "zstd"};
  EXPECT_EQ(header(route(vtu), "Content-Encoding"), "zstd");
  EXPECT_EQ(levelOf(vtu).coding, ContentCoding::kZstd);
}

TEST_F(RouterTest, aPageOfTheListIsMadeAndCompressedOnceForEachVersionAndCoding) {
  std::vector<Reply> replies;  // as long as they live, no two of their bytes are in one place
  const auto bytesOf = [&](std::string_view target, std::string_view coding) {
    replies.push_back(route({.method = "GET", .target = target, .acceptEncoding = coding}));
    return std::get<ByteView>(replies.back().body).data();
  };
  const std::uint8_t* gzip = bytesOf("/v1/meshes", "gzip");
  EXPECT_EQ(bytesOf("/v1/meshes?limit=1000", "gzip"), gzip);
  EXPECT_EQ(bytesOf("/v1/meshes?after=A", "gzip"), gzip) << "begins with the same mesh";
  EXPECT_NE(bytesOf("/v1/meshes", "zstd"), gzip);
  EXPECT_NE(bytesOf("/v1/meshes", ""), gzip);
  const std::string before = body(get("/v1/meshes"));
  std::filesystem::remove(folder_.logFolder() / "noise.qtet");
  ASSERT_TRUE(folder_.store().rescan());
  EXPECT_NE(bytesOf("/v1/meshes", "gzip"), gzip);
  EXPECT_NE(body(get("/v1/meshes")), before);
}

TEST_F(RouterTest, rangesAreCutFromTheMapping) {
  const Reply part = route({.method = "GET", .target = folder_.log(), .range = "bytes=10-19"});
  EXPECT_EQ(part.status, 206u);
  EXPECT_EQ(header(part, "Content-Range"), "bytes 10-19/" + std::to_string(folder_.file().size()));
  EXPECT_EQ(body(part), folder_.file().substr(10, 10));
  const Reply behind =
      route({.method = "GET", .target = folder_.log(), .range = "bytes=99999999-"});
  expectProblem(behind, 416, "range-not-satisfiable");
  EXPECT_EQ(header(behind, "Content-Range"), "bytes */" + std::to_string(folder_.file().size()));
}

TEST_F(RouterTest, conditionsAreHonouredOnEveryResource) {
  for (const std::string& target :
       {std::string("/v1/meshes"), std::string("/v1/meshes/noise"), folder_.log(),
        folder_.log("levels/1.vtu"), folder_.log("chunks/1"), std::string("/"),
        std::string("/assets/app-1a2b.js")}) {
    const std::string etag = header(get(target), "ETag");
    ASSERT_FALSE(etag.empty()) << target;
    const Reply same = route({.method = "GET", .target = target, .ifNoneMatch = etag});
    EXPECT_EQ(same.status, 304u) << target;
    EXPECT_EQ(header(same, "ETag"), etag);
    EXPECT_EQ(same.bodyBytes(), 0u);
    expectProblem(route({.method = "GET", .target = target, .ifMatch = "\"other\""}), 412,
                  "precondition-failed");
  }
}

TEST_F(RouterTest, levelsAreToBeMade) {
  const Reply reply = get(folder_.log("levels/11.drc"));
  EXPECT_EQ(reply.status, 200u);
  const std::string target = folder_.log("levels/11.drc");
  const LevelRequest level = levelOf({.method = "GET", .target = target});
  EXPECT_EQ(level.mesh.get(), &folder_.mesh());
  EXPECT_EQ(level.level, 11u);
  EXPECT_EQ(level.form, LevelForm::kDrc);
  EXPECT_NE(header(reply, "ETag"), header(get(folder_.log("levels/11.vtu")), "ETag"));
  EXPECT_NE(header(reply, "ETag"), header(get(folder_.log("levels/10.drc")), "ETag"));
  EXPECT_EQ(ask("HEAD", folder_.log("levels/11.drc")).bodyBytes(), std::nullopt);
}

TEST_F(RouterTest, whatIsSavedIsCalledByTheMeshAndTheLevel) {
  const auto savedAs = [&](const std::string& rest) {
    return header(get(folder_.log(rest)), "Content-Disposition");
  };
  EXPECT_EQ(savedAs("levels/11.vtu"), "attachment; filename=\"noise-level-11.vtu\"");
  EXPECT_EQ(savedAs("levels/fit.glb?tets=1"), "attachment; filename=\"noise-level-0.glb\"");
  EXPECT_EQ(savedAs("poster.webp"), "inline; filename=\"noise-poster.webp\"");
}

TEST_F(RouterTest, whatDoesNotExistIsNotFound) {
  for (const char* target :
       {"/v1", "/v1/", "/v2/meshes", "/v1/meshes/", "/v1/meshes/nothing", "/v1/meshes/nothing/log",
        "/v1/logs", "/v1/logs/", "/v1/meshes/noise.qtet", "/v1/meshes/..%2Fnoise", "/V1/meshes"})
    expectProblem(get(target), 404, "not-found");
  for (const char* rest : {"",
                           "log/",
                           "logs",
                           "levels",
                           "levels/",
                           "levels/12.vtu",
                           "levels/-1.vtu",
                           "levels/01.vtu",
                           "levels/+1.vtu",
                           "levels/1",
                           "levels/.vtu",
                           "levels/1.VTU",
                           "levels/4294967296.vtu",
                           "levels/1.vtu/x",
                           "levels/1e0.vtu",
                           "chunks",
                           "chunks/12",
                           "chunks/00",
                           "chunks/x",
                           "fields",
                           "fields/density",
                           "fields/density/chunks/12",
                           "fields/x/chunks/0",
                           "fields/density/chunk/1"})
    expectProblem(get(folder_.log(rest)), 404, "not-found");
}

TEST_F(RouterTest, theViewerAndNothingElseOfItsFolderIsServed) {
  EXPECT_EQ(body(get("/index.html?field=a")), test::ServedFolder::kPage);
  EXPECT_EQ(body(get("/docs/")), "<title>docs</title>");
  EXPECT_EQ(header(get("/assets/codec.wasm"), "Content-Type"), "application/wasm");
  EXPECT_NE(header(get("/assets/app-1a2b.js"), "Cache-Control").find("immutable"),
            std::string::npos);
  EXPECT_EQ(header(get("/"), "Cache-Control"), "no-cache");
  EXPECT_NE(header(get("/"), "Content-Security-Policy").find("'wasm-unsafe-eval'"),
            std::string::npos);
  for (const char* target :
       {"/.secret", "/%2esecret", "/.git/config", "/../noise.qtet", "/%2e%2e/noise.qtet",
        "/..%2fnoise.qtet", "/assets/../.secret", "/assets%2fapp-1a2b.js", "/assets/", "/docs",
        "//index.html", "/./index.html", "/index.html/", "/..\\noise.qtet",
        "/assets/%2e%2e/index.html", "/%252e%252e/x"})
    expectProblem(get(target), 404, "not-found");
}

TEST_F(RouterTest, thePageSaysWhoMayFrameItAndTellsNobodyWhereItWas) {
  const Reply page = get("/");
  EXPECT_TRUE(header(page, "Content-Security-Policy").ends_with("; frame-ancestors *"));
  EXPECT_EQ(header(page, "Referrer-Policy"), "same-origin");
  const Router strict(folder_.store(), folder_.viewer(), nullptr, std::nullopt,
                      "'self' https://a.example");
  EXPECT_TRUE(
      header(strict.route({.method = "GET", .target = "/"}).reply, "Content-Security-Policy")
          .ends_with("; frame-ancestors 'self' https://a.example"));
}

TEST_F(RouterTest, aCompressedFileGoesToWhoeverTakesIt) {
  const Reply plain = get("/assets/app-1a2b.js");
  const Reply gzip =
      route({.method = "GET", .target = "/assets/app-1a2b.js", .acceptEncoding = "br, gzip"});
  EXPECT_EQ(body(plain), "console.log(1)");
  EXPECT_EQ(header(plain, "Content-Encoding"), "");
  const Bytes compressed = test::ServedFolder::compressedScript();
  EXPECT_EQ(body(gzip), std::string(compressed.begin(), compressed.end()));
  EXPECT_EQ(header(gzip, "Content-Encoding"), "gzip");
  EXPECT_EQ(header(gzip, "Content-Type"), header(plain, "Content-Type"));
  EXPECT_NE(header(gzip, "ETag"), header(plain, "ETag"));
  for (const Reply* reply : {&plain, &gzip}) EXPECT_EQ(header(*reply, "Vary"), "Accept-Encoding");
  const std::string tag = header(gzip, "ETag");
  EXPECT_EQ(route({.method = "GET",
                   .target = "/assets/app-1a2b.js",
                   .ifNoneMatch = tag,
                   .acceptEncoding = "gzip"})
                .status,
            304u);
  EXPECT_EQ(route({.method = "GET", .target = "/assets/app-1a2b.js", .ifNoneMatch = tag}).status,
            200u);
  expectProblem(get("/assets/app-1a2b.js.gz"), 404, "not-found");
  EXPECT_EQ(body(get("/assets/alone.gz")), "an archive");
}

TEST_F(RouterTest, withoutAViewerThePageSaysSo) {
  const ViewerFiles none;
  const Router router(folder_.store(), none);
  const Reply reply = router.route({.method = "GET", .target = "/"}).reply;
  expectProblem(reply, 404, "not-found");
  EXPECT_NE(body(reply).find("--viewer"), std::string::npos);
}

TEST_F(RouterTest, targetsThatAreNoPathsAreBadRequests) {
  for (const char* target :
       {"/%", "/%zz", "/a%00b", "*", "", "/a b", "/\x01", "file:///etc/passwd"})
    expectProblem(get(target), 400, "bad-request");
}

TEST_F(RouterTest, anEncodedNulIsNoPathWhateverTheMethod) {
  for (const char* method : {"GET", "HEAD", "OPTIONS", "POST", "PUT", "DELETE", "BREW"})
    for (const char* target : {"/a%00b", "/v1/meshes/noise%00", "/v1/meshes/%00/log", "/%00"})
      EXPECT_EQ(ask(method, target).status, 400u) << method << " " << target;
  EXPECT_EQ(ask("OPTIONS", "*").status, 204u);
  EXPECT_EQ(ask("CONNECT", "a:80").status, 405u);
}

TEST_F(RouterTest, aSlashBehindAMeshLeadsNowhere) {
  expectProblem(get("/v1/meshes/noise/"), 404, "not-found");
  expectProblem(get("/v1/meshes/noise/levels/"), 404, "not-found");
  EXPECT_EQ(get("/v1/meshes/noise/log").status, 307u);
}

TEST_F(RouterTest, ifMatchTakesTheUncodedTagUnderEveryCoding) {
  const std::string target = "/v1/meshes/noise", tag = header(get(target), "ETag");
  for (const char* coding : {"gzip", "zstd", "identity"}) {
    const Reply reply =
        route({.method = "GET", .target = target, .ifMatch = tag, .acceptEncoding = coding});
    EXPECT_EQ(reply.status, 200u) << coding;
    EXPECT_EQ(header(reply, "Content-Encoding"), coding == std::string("identity") ? "" : coding);
  }
  EXPECT_EQ(
      route({.method = "GET", .target = target, .ifMatch = "\"other\"", .acceptEncoding = "gzip"})
          .status,
      412u);
  EXPECT_EQ(route({.method = "GET", .target = target, .ifNoneMatch = tag, .acceptEncoding = "gzip"})
                .status,
            200u)
      << "other bytes";
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
  for (const std::string& target :
       {std::string("/v1/meshes"), folder_.log(), std::string("/"), std::string("/nothing")}) {
    const Reply head = ask("HEAD", target);
    const Reply whole = get(target);
    EXPECT_FALSE(head.sendBody);
    EXPECT_EQ(head.status, whole.status);
    EXPECT_EQ(head.headers, whole.headers);
    EXPECT_EQ(head.bodyBytes(), whole.bodyBytes());
  }
}

TEST_F(RouterTest, optionsAnswersAPreflight) {
  for (const std::string& target : {std::string("*"), folder_.log()}) {
    const Reply reply = ask("OPTIONS", target);
    EXPECT_EQ(reply.status, 204u);
    EXPECT_NE(header(reply, "Access-Control-Allow-Headers").find("Range"), std::string::npos);
  }
}

TEST_F(RouterTest, everyAnswerMayBeReadFromAnywhereAndIsNotSniffed) {
  for (const std::string& target : {std::string("/v1/meshes"), folder_.log(), std::string("/"),
                                    std::string("/nothing"), std::string("/%")}) {
    const Reply reply = get(target);
    EXPECT_EQ(header(reply, "Access-Control-Allow-Origin"), "*") << target;
    EXPECT_EQ(header(reply, "Access-Control-Expose-Headers"), "*") << target;
    EXPECT_EQ(header(reply, "X-Content-Type-Options"), "nosniff") << target;
  }
}

/// The names of a head's lines, in their order.
std::vector<std::string> namesOf(const Reply& reply) {
  std::vector<std::string> out;
  std::stringstream lines(reply.headers.text());
  for (std::string line; std::getline(lines, line);) out.push_back(line.substr(0, line.find(':')));
  return out;
}

TEST_F(RouterTest, aHeadHasWhatItsClientCanUseAndNoMore) {
  using ::testing::ElementsAre;
  EXPECT_THAT(namesOf(get("/v1/meshes")),
              ElementsAre("ETag", "Last-Modified", "Cache-Control", "Content-Type",
                          "X-Content-Type-Options", "Vary", "Access-Control-Allow-Origin",
                          "Access-Control-Expose-Headers"));
  EXPECT_THAT(
      namesOf(get(folder_.log())),
      ElementsAre("ETag", "Last-Modified", "Cache-Control", "Content-Type",
                  "X-Content-Type-Options", "Timing-Allow-Origin", "Access-Control-Allow-Origin",
                  "Access-Control-Expose-Headers", "Accept-Ranges"));
  EXPECT_THAT(namesOf(get("/nothing")),
              ElementsAre("Cache-Control", "Content-Type", "X-Content-Type-Options",
                          "Access-Control-Allow-Origin", "Access-Control-Expose-Headers"));
  const Reply part = route({.method = "GET", .target = folder_.log(), .range = "bytes=1-3"});
  EXPECT_EQ(part.status, 206u);
  EXPECT_EQ(header(part, "Accept-Ranges"), "") << "206 says it";
}

TEST_F(RouterTest, thePageHoldsNameAndPosterOfTheMeshThatItShows) {
  const std::string poster = "src=\"" + folder_.log("poster.webp").substr(1) + "\"";
  for (const char* target :
       {"/?mesh=noise", "/index.html?mesh=noise", "/?transport=range&mesh=noise"}) {
    const Reply reply = get(target);
    EXPECT_EQ(reply.status, 200u);
    EXPECT_NE(body(reply).find("<h1>noise</h1>"), std::string::npos) << target;
    EXPECT_NE(body(reply).find(poster), std::string::npos) << target;
    EXPECT_NE(header(reply, "Link").find("poster.webp>; rel=preload; as=image"), std::string::npos)
        << header(reply, "Link");
    EXPECT_EQ(header(reply, "Cache-Control"), kRevalidate);
  }
  EXPECT_NE(body(get("/")).find("<h1>a b</h1>"), std::string::npos) << "the first one";
  const std::string tag = header(get("/?mesh=noise"), "ETag");
  EXPECT_NE(tag, header(get("/?mesh=a%20b"), "ETag"));
  EXPECT_EQ(route({.method = "GET", .target = "/?mesh=noise", .ifNoneMatch = tag}).status, 304u);
}

TEST_F(RouterTest, aPageWhosePictureThePosterIsNotHasNone) {
  for (const char* target : {"/?mesh=nothing", "/?mesh=noise&camera=1,0,0,0,0,0", "/?src=x.qtet",
                             "/?field=a", "/?mesh=noise&x", "/?mesh=%3Cb%3E"})
    EXPECT_EQ(body(get(target)), test::ServedFolder::kPage) << target;
}

TEST_F(RouterTest, thePagesLinksGoInItsHeadToo) {
  EXPECT_EQ(header(get("/?field=a"), "Link"),
            "<assets/app-1a2b.js>; rel=modulepreload, <a.css>; rel=preload; as=style, "
            "<assets/codec.wasm>; rel=preload; as=fetch; crossorigin");
  EXPECT_EQ(header(get("/docs/"), "Link"), "");
}

TEST_F(RouterTest, anElementOfAnyPageMayLoadAFileAPictureAndALevel) {
  for (const std::string& target :
       {std::string("/"), folder_.log("poster.webp"), folder_.log("levels/1.glb")}) {
    EXPECT_EQ(header(get(target), "Cross-Origin-Resource-Policy"), "cross-origin") << target;
    EXPECT_EQ(header(get(target), "Timing-Allow-Origin"), "*") << target;
  }
  for (const std::string& target :
       {folder_.log(), std::string("/v1/meshes"), std::string("/nothing")})
    EXPECT_EQ(header(get(target), "Cross-Origin-Resource-Policy"), "") << target;
}

TEST_F(RouterTest, anAnswerWithoutABodyHasNoType) {
  const std::string tag = header(get("/v1/meshes"), "ETag");
  const Reply reply = route({.method = "GET", .target = "/v1/meshes", .ifNoneMatch = tag});
  EXPECT_EQ(reply.status, 304u);
  EXPECT_EQ(header(reply, "ETag"), tag);
  EXPECT_EQ(header(reply, "Content-Type"), "");
  EXPECT_EQ(header(reply, "X-Content-Type-Options"), "");
  EXPECT_EQ(header(reply, "Access-Control-Allow-Origin"), "*");
}

std::string headOf(const Reply& reply, Afterwards afterwards) {
  std::string out;
  appendHead(out, reply, afterwards);
  return out;
}

TEST(Head, speaksOfTheBodyAndTheConnection) {
  Reply reply = problem(404, "not-found", "no");
  const std::string size = std::to_string(*reply.bodyBytes());
  const std::string stays = headOf(reply, Afterwards::kStays);
  EXPECT_TRUE(stays.starts_with("HTTP/1.1 404 Not Found\r\nDate: "));
  EXPECT_TRUE(stays.ends_with("\r\n\r\n"));
  EXPECT_NE(stays.find("\r\nContent-Length: " + size + "\r\n"), std::string::npos);
  EXPECT_EQ(stays.find("\r\nConnection:"), std::string::npos);
  EXPECT_NE(headOf(reply, Afterwards::kKept).find("\r\nConnection: keep-alive\r\n"),
            std::string::npos);
  EXPECT_NE(headOf(reply, Afterwards::kCloses).find("\r\nConnection: close\r\n"),
            std::string::npos);
  reply.status = 304;
  EXPECT_EQ(headOf(reply, Afterwards::kStays).find("Content-Length"), std::string::npos);
}

}  // namespace
}  // namespace qtet
