// `qtet push` against a real server: the whole way from a file to a served mesh.
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <numeric>

#include "codec/refine/log_edit.h"
#include "codec/refine/log_file.h"
#include "proto/checksum.h"
#include "tests/server/http/held_check.h"
#include "tests/server/program/loopback.h"
#include "tests/server/program/served_folder.h"
#include "tests/server/routes/push_run.h"
#include "tests/support/meshes.h"
#include "tests/support/written_log.h"

namespace qtet {
namespace {

using Outcome = test::PushOutcome;

class PushTest : public ::testing::Test {
 protected:
  Outcome push(const std::string& words, const std::string& token = test::kPushToken,
               const std::function<void(const std::string&)>& hear = {}) {
    return test::runPush(file_, words, token, hear);
  }
  std::string url(const std::string& path = "/") const {
    return "http://127.0.0.1:" + std::to_string(server_.port()) + path;
  }
  std::string served(const std::string& path) {
    return test::RawClient(server_.port()).get(path).body;
  }

  test::ServedFolder folder_;
  test::TempFolder mine_;
  const Bytes log_ = testing::logBytes(testing::soundMesh(8, 99));
  const std::filesystem::path file_ = mine_.path() / "my wing.qtet";
  const std::string digest_ = (mine_.write("my wing.qtet", log_), sha256Hex(log_));
  test::HeldCheck check_;
  Access access_{*Tokens::parse(std::string("write * ") + test::kPushToken)};
  std::unique_ptr<MeshStore> store_ =
      std::make_unique<MeshStore>(*MeshStore::open(folder_.logFolder()));
  test::RunningServer server_{
      *store_, folder_.viewer(), {.access = &access_, .uploads = {.check = std::ref(check_)}}};
};

TEST_F(PushTest, aLogIsServedUnderItsNameOrTheOneGiven) {
  const Outcome first = push(url());
  EXPECT_EQ(first.code, 0) << first.text;
  EXPECT_NE(first.text.find("/v1/meshes/my%20wing  new"), std::string::npos) << first.text;
  EXPECT_EQ(served("/v1/logs/" + digest_ + "/log"), std::string(log_.begin(), log_.end()));
  const Outcome again = push(url());
  EXPECT_EQ(again.code, 0);
  EXPECT_NE(again.text.find("replaced"), std::string::npos) << again.text;
  EXPECT_EQ(push(url("/v1/meshes/other")).code, 0);
  EXPECT_NE(served("/v1/meshes/other").find(digest_), std::string::npos);
}

TEST_F(PushTest, itGoesOnWhereAnEarlierOneStopped) {
  const std::string part =
      (folder_.logFolder() / (".upload-" + digest_ + "-my wing.part")).string();
  std::ofstream(part, std::ios::binary)
      .write(reinterpret_cast<const char*>(log_.data()),
             static_cast<std::streamsize>(log_.size() / 2));
  const Outcome rest = push(url());
  EXPECT_EQ(rest.code, 0) << rest.text;
  EXPECT_EQ(served("/v1/logs/" + digest_ + "/log"), std::string(log_.begin(), log_.end()));
  // The first half was not sent again: had it been, its bytes would have replaced these.
  Bytes wrong = log_;
  wrong[100] ^= 1;
  std::ofstream(part, std::ios::binary)
      .write(reinterpret_cast<const char*>(wrong.data()),
             static_cast<std::streamsize>(wrong.size() / 2));
  std::filesystem::rename(part, folder_.logFolder() / (".upload-" + digest_ + "-other.part"));
  const Outcome refused = push(url("/v1/meshes/other"));
  EXPECT_EQ(refused.code, 1);
  EXPECT_NE(refused.text.find("422"), std::string::npos) << refused.text;
  EXPECT_EQ(push(url()).code, 0) << "what was wrong is gone";
}

TEST_F(PushTest, whatTheServerHasWholeIsNotSentAgain) {
  const std::string part =
      (folder_.logFolder() / (".upload-" + digest_ + "-my wing.part")).string();
  Bytes wrong = log_;
  wrong[100] ^= 1;
  std::ofstream(part, std::ios::binary)
      .write(reinterpret_cast<const char*>(wrong.data()),
             static_cast<std::streamsize>(wrong.size()));
  EXPECT_NE(push(url()).text.find("422"), std::string::npos) << "it was checked as it lay there";
  std::ofstream(part, std::ios::binary)
      .write(reinterpret_cast<const char*>(log_.data()), static_cast<std::streamsize>(log_.size()));
  EXPECT_EQ(push(url()).code, 0);
  EXPECT_EQ(served("/v1/logs/" + digest_ + "/log"), std::string(log_.begin(), log_.end()));
}

TEST_F(PushTest, whatTheServersLogHasIsNotSentAgain) {
  // The second time the server finds the log unsound, as if checksums had agreed by chance.
  int checks = 0;
  const test::RunningServer server(
      *store_, folder_.viewer(),
      {.access = &access_,
       .uploads = {.check = [&](const ServedMesh&, const CheckLimits&, const std::stop_token&) {
         using End = CheckVerdict::End;
         return ++checks == 2 ? CheckVerdict{End::kUnsound, "unsound"} : CheckVerdict();
       }}});
  const std::string url = "http://127.0.0.1:" + std::to_string(server.port()) + "/";
  const LogFile log = *LogFile::fromBytes(log_);
  std::vector<std::uint32_t> kept(log.fields().size() - 1);
  std::iota(kept.begin(), kept.end(), 0u);
  const Bytes old = withFields(log, kept, {})->together();
  for (const bool isDelta : {true, false}) {
    mine_.write("old.qtet", ByteView(old));
    std::filesystem::rename(mine_.path() / "old.qtet", folder_.logFolder() / "my wing.qtet");
    ASSERT_TRUE(store_->rescan());
    const Outcome pushed = push(url);
    EXPECT_EQ(pushed.code, 0) << pushed.text;
    const std::size_t place = pushed.text.find(" bytes, ");
    ASSERT_NE(place, std::string::npos) << pushed.text;
    const auto sent = std::stoul(pushed.text.substr(place + 8));
    if (isDelta)
      EXPECT_LT(sent, log_.size() / 2);
    else
      EXPECT_GT(sent, log_.size()) << "the delta and the log";
    EXPECT_EQ(test::RawClient(server.port()).get("/v1/logs/" + digest_ + "/log").body,
              std::string(log_.begin(), log_.end()));
  }
  EXPECT_EQ(checks, 3);
}

TEST_F(PushTest, aLogThatCameMeanwhileIsNotReplaced) {
  const auto place = [this](std::uint32_t seed) {
    const Bytes log = testing::logBytes(testing::soundMesh(6, seed));
    mine_.write("other.qtet", log);
    std::filesystem::rename(mine_.path() / "other.qtet", folder_.logFolder() / "my wing.qtet");
    EXPECT_TRUE(store_->rescan());
    return sha256Hex(log);
  };
  for (const bool isNew : {true, false}) {
    std::string others;
    check_.hold(true);
    const Outcome pushed = push(url(), test::kPushToken, [&](const std::string& said) {
      if (!others.empty() || said.find("the server checks the log") == std::string::npos) return;
      others = place(isNew ? 71 : 72);
      check_.hold(false);
    });
    EXPECT_EQ(pushed.code, 1) << pushed.text;
    EXPECT_NE(pushed.text.find("412"), std::string::npos) << pushed.text;
    EXPECT_NE(served("/v1/meshes/my%20wing").find(others), std::string::npos) << isNew;
  }
}

TEST_F(PushTest, anUnsoundFileOfTheNameIsReplaced) {
  mine_.write("bad.qtet", std::string_view("no log"));
  std::filesystem::rename(mine_.path() / "bad.qtet", folder_.logFolder() / "my wing.qtet");
  ASSERT_TRUE(store_->rescan());
  const Outcome pushed = push(url());
  EXPECT_EQ(pushed.code, 0) << pushed.text;
}

TEST_F(PushTest, itSaysThatTheServerChecks) {
  check_.hold(true);
  const Outcome pushed = push(url(), test::kPushToken, [this](const std::string& said) {
    if (said.find("the server checks the log") != std::string::npos) check_.hold(false);
  });
  EXPECT_EQ(pushed.code, 0) << pushed.text;
}

TEST_F(PushTest, whatGoesWrongIsSaid) {
  const Outcome stranger = push(url(), "x");
  EXPECT_EQ(stranger.code, 1);
  EXPECT_NE(stranger.text.find("401: send a token"), std::string::npos) << stranger.text;
  EXPECT_NE(push(url(), "").text.find("QTET_TOKEN"), std::string::npos);
  for (const char* wrong : {"ftp://x/", "http://", "http://a:b/", "nonsense"})
    EXPECT_EQ(push(wrong).code, 2) << wrong;
  mine_.write("my wing.qtet", std::string_view("no log"));
  EXPECT_EQ(push(url()).code, 1);
}

}  // namespace
}  // namespace qtet
