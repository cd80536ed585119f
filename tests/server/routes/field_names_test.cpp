// Requests that name many fields of a log with as many as a log may have. They are routed on a
// thread that serves other clients, too. So tests count the names that are compared.
#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

#include "proto/limits.h"
#include "server/routes/http_router.h"
#include "server/store/descriptions.h"
#include "server/store/store_limits.h"
#include "server/stream/stream_protocol.h"
#include "tests/server/program/loopback.h"
#include "tests/server/store/synthetic_log.h"
#include "tests/server/support/json.h"

namespace qtet {
namespace {

/// The keys are two fields, then as many instants of one series as there may be.
std::vector<std::string> instants() {
  std::vector<std::string> out{"p", "velocity"};
  for (std::size_t f = out.size(); f < kMaxFields; ++f) out.push_back("T@" + std::to_string(f));
  return out;
}

/// Different names of 11 bytes.
std::vector<std::string> singles() {
  std::vector<std::string> out;
  for (std::size_t f = 0; f < kMaxFields; ++f)
    out.push_back("f" + std::to_string(1'000'000'000 + f));
  return out;
}

class FieldNames : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TempFolder;
    folder_->write("series.qtet",
                   test::makeLog({.chunks = 2, .fields = instants(), .largestBlock = 8}));
    folder_->write("singles.qtet",
                   test::makeLog({.chunks = 1, .fields = singles(), .largestBlock = 8}));
    Result<MeshStore> opened =
        MeshStore::open(folder_->path(), {.nameTime = std::chrono::hours(1)});
    ASSERT_TRUE(opened) << opened.error().message;
    store_ = new MeshStore(std::move(*opened));
    while (!store_->catalogue()->complete()) ASSERT_TRUE(store_->readOn());
  }
  static void TearDownTestSuite() {
    delete store_;
    delete folder_;
  }
  static std::string pathOf(const std::string& mesh) {
    return "/v1/logs/" + store_->find(mesh)->log.digest();
  }
#ifndef NDEBUG
  /// Making the map included. A walk for each of 1,024 names would be 8 million.
  static void expectFew(std::uint64_t before) {
    constexpr std::uint64_t kOfOneField = 200;
    EXPECT_LT(namesCompared - before, kMaxFields * kOfOneField);
  }
  static std::uint64_t compared() { return namesCompared; }
#else
  static void expectFew(std::uint64_t) {}
  static std::uint64_t compared() { return 0; }
#endif

  static test::TempFolder* folder_;
  static MeshStore* store_;
  ViewerFiles viewer_;
  Router router_{*store_, viewer_};
};
test::TempFolder* FieldNames::folder_ = nullptr;
MeshStore* FieldNames::store_ = nullptr;

TEST_F(FieldNames, describingEveryFieldWalksTheFieldsOnce) {
  const std::uint64_t before = compared();
  const test::Json mesh = test::Json::parse(describeMesh(*store_->find("series")));
  ASSERT_EQ(mesh["fields"].size(), kMaxFields);
  EXPECT_EQ(mesh["fields"][std::size_t{kMaxFields} - 1]["key"],
            "T@" + std::to_string(kMaxFields - 1));
  expectFew(before);
}

TEST_F(FieldNames, longTextsAreMadeOnAnotherThread) {
  const std::string description = "/v1/meshes/series", manifest = pathOf("series") + "/manifest";
  const auto route = [&](const std::string& target) {
    return router_.route({.method = "GET", .target = target}).work;
  };
  for (const std::string& target : {description, manifest})
    EXPECT_TRUE(std::holds_alternative<TextRequest>(route(target))) << target;
  const test::RunningServer server(*store_, viewer_);
  test::RawClient client(server.port());
  for (const std::string& target : {description, manifest}) {
    const test::HttpResponse made = client.get(target);
    EXPECT_EQ(made.status, 200u);
    EXPECT_NE(made.body.find("\"T@" + std::to_string(kMaxFields - 1) + '"'), std::string::npos);
    EXPECT_FALSE(made.header("etag").empty());
    EXPECT_TRUE(std::holds_alternative<std::monostate>(route(target))) << "it is made";
  }
}

TEST_F(FieldNames, aShortTextIsMadeAtOnce) {
  test::TempFolder folder;
  folder.write("noise.qtet", test::makeLog({}));
  const MeshPointer mesh = *openMesh(folder.path() / "noise.qtet", "noise");
  for (const auto which : {ServedMesh::Text::kDescription, ServedMesh::Text::kManifest})
    EXPECT_TRUE(mesh->isQuick(which));
}

TEST_F(FieldNames, aListNamesASeriesOnceAndNotAllOfManyFields) {
  const std::uint64_t before = compared();
  const test::Json series = test::Json::parse(describeEntry(*store_->find("series")));
  EXPECT_EQ(series["fields"], test::Json::parse(R"(["p","velocity","T"])"));
  EXPECT_EQ(series["series"], test::Json::parse(R"(["T"])"));
  EXPECT_FALSE(series.contains("moreFields"));
  const std::string text = describeEntry(*store_->find("singles"));
  const test::Json singles = test::Json::parse(text);
  EXPECT_EQ(singles["fields"].size(), limits::kMaxListedKeys);
  EXPECT_EQ(singles["moreFields"], kMaxFields - limits::kMaxListedKeys);
  EXPECT_FALSE(singles.contains("series"));
  EXPECT_LT(text.size(), limits::kMaxListedKeyBytes);
  expectFew(before);
}

TEST_F(FieldNames, theKeysOfAListHaveABoundOfBytes) {
  const std::string name(kMaxNameBytes - 1, 'n');
  std::vector<std::string> names;
  for (char c = 'A'; names.size() < limits::kMaxListedKeyBytes / kMaxNameBytes + 1; ++c)
    names.push_back(name + c);
  test::TempFolder folder;
  const auto entryOf = [&](std::size_t fields) {
    folder.write("long.qtet", test::makeLog({.fields = {names.begin(), names.begin() + fields}}));
    return test::Json::parse(describeEntry(**openMesh(folder.path() / "long.qtet", "long")));
  };
  EXPECT_FALSE(entryOf(names.size() - 1).contains("moreFields"));
  EXPECT_EQ(entryOf(names.size())["moreFields"], 1);
}

TEST_F(FieldNames, aLevelWithManyOfThemWalksTheFieldsOnce) {
  std::string names = "p";
  for (std::uint32_t f = 2; f < kMaxRequestFields + 1; ++f) names += ",T@" + std::to_string(f);
  const std::string target = pathOf("series") + "/levels/0.vtu?fields=" + names;
  const std::uint64_t before = compared();
  const Answer answer = router_.route({.method = "GET", .target = target});
  const auto* level = std::get_if<LevelRequest>(&answer.work);
  ASSERT_NE(level, nullptr);
  EXPECT_EQ(level->fields.size(), kMaxRequestFields);
  expectFew(before);
}

TEST_F(FieldNames, aStreamWithManyOfThemWalksTheFieldsOnce) {
  std::string names = R"("p")", held = R"("p":1)";
  for (std::uint32_t f = 2; f < kMaxRequestFields + 1; ++f) {
    names += R"(,"T@)" + std::to_string(f) + '"';
    held += R"(,"T@)" + std::to_string(f) + R"(":1)";
  }
  const std::uint64_t before = compared();
  StreamProtocol protocol(*store_);
  protocol.receive(R"({"type":"open","mesh":"series","credit":1,"fields":[)" + names +
                       R"(],"have":{"chunks":1,"fields":{)" + held + "}}}",
                   StreamProtocol::Clock::now());
  const auto opened = protocol.next();
  ASSERT_TRUE(opened && std::holds_alternative<std::string>(*opened));
  EXPECT_NE(std::get<std::string>(*opened).find(R"("opened")"), std::string::npos);
  expectFew(before);
}

TEST_F(FieldNames, anUnknownOneWalksTheFieldsOnce) {
  const std::uint64_t before = compared();
  StreamProtocol protocol(*store_);
  protocol.receive(
      R"({"type":"open","mesh":"series","credit":1,"target":{"error":0.1,"field":"none"}})",
      StreamProtocol::Clock::now());
  EXPECT_TRUE(protocol.next());
  expectFew(before);
}

}  // namespace
}  // namespace qtet
