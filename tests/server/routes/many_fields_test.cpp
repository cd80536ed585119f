// Levels of a log with more fields than some kinds of file can hold, through a real server.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "codec/log/log_manifest.h"
#include "codec/refine/log_file.h"
#include "proto/limits.h"
#include "server/store/level_memory.h"
#include "tests/server/program/loopback.h"
#include "tests/server/store/synthetic_log.h"
#include "tests/support/forged_log.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

/// A sound log whose first field, a scalar of points, is there under each of the names.
Bytes logOfFields(const std::vector<std::string>& names) {
  const LogFile golden =
      LogFile::open(std::string(testing::kGoldenFolder) + "/valid/solid.qtet").value();
  testing::TakenApart log = testing::takeApart(golden.bytes());
  Manifest manifest = manifestOf(log.index).value();
  EXPECT_EQ(manifest.fields.front().association, "point");
  EXPECT_EQ(manifest.fields.front().components, 1u);
  manifest.fields.assign(names.size(), ManifestField(manifest.fields.front()));
  for (std::size_t f = 0; f < names.size(); ++f) manifest.fields[f].name = names[f];
  for (ManifestLevel& level : manifest.levels) level.error.reset();
  manifest.opening.reset();
  log.index.fields.assign(names.size(), FieldShape(log.index.fields.front()));
  for (std::vector<Bytes>& parts : log.blocks) {
    const Bytes values = parts[kFirstFieldPart];
    parts.resize(kFirstFieldPart);
    parts.resize(kFirstFieldPart + names.size(), values);
  }
  log.index.manifest = manifestBlock(manifest).value();
  return log.together();
}

const std::string kLongName(kMaxNameBytes, 'n');

/// 299 instants of a series T, and a field with the longest name.
class ManyFields : public ::testing::Test {
 protected:
  void SetUp() override {
    std::vector<std::string> names;
    for (int f = 0; f < 299; ++f) names.push_back("T@" + std::to_string(f));
    names.push_back(kLongName);
    folder_.write("many.qtet", logOfFields(names));
    Result<MeshStore> store = MeshStore::open(folder_.path());
    ASSERT_TRUE(store) << store.error().message;
    store_ = std::move(*store);
    server_.emplace(store_, viewer_);
    client_.emplace(server_->port());
  }
  test::HttpResponse get(const std::string& level) {
    return client_->get("/v1/logs/" + store_.find("many")->log.digest() + "/levels/" + level);
  }
  void expectRefused(const std::string& level, const std::vector<std::string>& says) {
    const test::HttpResponse refused = get(level);
    ASSERT_EQ(refused.status, 422u) << level << refused.body;
    EXPECT_NE(refused.body.find("/problems/unwritable-level"), std::string::npos) << refused.body;
    for (const std::string& said : says)
      EXPECT_NE(refused.body.find(said), std::string::npos) << said << " in " << refused.body;
    EXPECT_EQ(refused.body.find('`'), std::string::npos) << refused.body;
  }
  /// "T@0,T@1" and so on.
  static std::string instants(int count) {
    std::string out = "T@0";
    for (int f = 1; f < count; ++f) out += ",T@" + std::to_string(f);
    return out;
  }

  test::TempFolder folder_;
  MeshStore store_;
  ViewerFiles viewer_;
  std::optional<test::RunningServer> server_;
  std::optional<test::RawClient> client_;
};

TEST_F(ManyFields, moreThanDracoTakesAreRefusedBeforeAJobBeginsAndTheServerGoesOn) {
  expectRefused("0.glb", {"300 point fields", "at most 127", "fields=", "time="});
  expectRefused("0.drc", {"300 point fields", "at most 128", "fields=", "time="});
  expectRefused("0.glb?fields=T", {"299 point fields"});
  expectRefused("fit.drc?tets=1000000", {"300 point fields"});
  EXPECT_TRUE(server_->comesTo("levels_made_total", 0));
  EXPECT_TRUE(server_->comesTo("levels_failed_total", 0));
  for (const char* level : {"0.vtu", "0.usda", "0.obj", "0.glb?time=7", "0.drc?time=7"})
    EXPECT_EQ(get(level).status, 200u) << level;
}

TEST_F(ManyFields, asManyAsDracoTakesAreServed) {
  const test::HttpResponse glb = get("0.glb?fields=" + instants(127));
  ASSERT_EQ(glb.status, 200u) << glb.body;
  EXPECT_NE(glb.body.find("\"_T@126\""), std::string::npos);
  EXPECT_EQ(get("0.glb?fields=" + instants(128)).status, 422u);
  EXPECT_EQ(get("0.drc?fields=" + instants(128)).status, 200u);
  EXPECT_EQ(get("0.drc?fields=" + instants(129)).status, 422u);
}

TEST_F(ManyFields, aLevelThatTakesTooMuchMemoryIsRefusedBeforeAJobBegins) {
  const MeshPointer mesh = store_.find("many");
  const LevelRequest few{mesh, 0, LevelForm::kVtu, {7, 299}};  // the last field has no time
  for (const std::uint64_t room : {memoryOf(few) - 1, memoryOf(few), memoryOf(few) + 1}) {
    server_.emplace(store_, viewer_, ServerOptions{.maxLevelBytes = room});
    client_.emplace(server_->port());
    const test::HttpResponse all = get("0.vtu"), one = get("0.vtu?time=7");
    EXPECT_EQ(all.status, 413u);
    for (const char* says : {"content-too-large", "--max-level-bytes", "time=", "fields="})
      EXPECT_NE(all.body.find(says), std::string::npos) << says << " in " << all.body;
    EXPECT_EQ(one.status, room >= memoryOf(few) ? 200u : 413u) << one.body;
    EXPECT_TRUE(server_->comesTo("levels_failed_total", 0));
  }
}

TEST_F(ManyFields, aNameThatIsTooLongForAKindOfFileIsRefused) {
  expectRefused("0.msh", {"256 bytes", "at most 252", "fields="});
  expectRefused("0.vtk", {"256 bytes", "at most 255", "fields="});
  for (const char* level : {"0.msh?fields=T@1,T@2", "0.vtk?fields=T"})
    EXPECT_EQ(get(level).status, 200u) << level;
}

}  // namespace
}  // namespace qtet
