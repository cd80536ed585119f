// Numbered files, as the shell, patterns and folders name them, for the tool's commands.
#include <set>

#include "simplify/read/read_mesh.h"
#include "tests/simplify/commands/tool_run.h"

namespace qtet {
namespace {

/// Steps 8 to 11 of a box, whose shell order is 10, 11, 8, 9.
class NumberedFilesTool : public Tool {
 protected:
  void SetUp() override {
    TetMesh mesh = boxWithT();
    std::filesystem::create_directory(folder_ / "run");
    for (const int step : {8, 9, 10, 11}) {
      for (double& value : mesh.fields[0].values) value *= 0.9;
      write("run/step_" + std::to_string(step) + ".vtu", mesh);
    }
    std::filesystem::remove(folder_ / "box.vtu");
  }
  /// The names of its fields, which stand in the order of coding.
  [[nodiscard]] std::set<std::string> fieldsOf(const std::string& log) {
    std::set<std::string> out;
    const Ran ran = run("info " + log + " --json");
    EXPECT_EQ(ran.code, 0) << ran.err;
    if (ran.code != 0) return out;
    const nlohmann::json info = ran.json();
    for (const auto& field : info["fields"]) out.insert(field["name"].get<std::string>());
    return out;
  }
  const std::set<std::string> all_{"T@8", "T@9", "T@10", "T@11"};
};

TEST_F(NumberedFilesTool, wordsPatternsAndFoldersGiveOneLog) {
  for (const char* words : {"run/step_*.vtu", "'run/step_*.vtu'", "run", "run/"}) {
    const Ran made = run("simplify " + std::string(words) + " --time all -o log.qtet --json");
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_NE(made.err.find("--times gives others"), std::string::npos) << made.err;
    EXPECT_EQ(fieldsOf("log.qtet"), all_) << words;
    EXPECT_EQ(run("verify log.qtet --against 'run/step_*.vtu'").code, 0) << words;
    EXPECT_EQ(run("verify log.qtet --against run").code, 0) << words;
  }
  EXPECT_EQ(run("simplify run/step_*.vtu -o last.qtet").code, 0);
  EXPECT_EQ(run("verify last.qtet --against run/step_11.vtu").code, 0) << "the last counts";
  EXPECT_EQ(run("simplify run --time ~8.8 -o near.qtet").code, 0);
  EXPECT_EQ(run("verify near.qtet --against run/step_9.vtu").code, 0);
}

TEST_F(NumberedFilesTool, timesAreGivenOneAFile) {
  ASSERT_EQ(run("simplify run --times 0,.5,1,1.5 --time all -o log.qtet").code, 0);
  EXPECT_EQ(fieldsOf("log.qtet"), (std::set<std::string>{"T@0", "T@0.5", "T@1", "T@1.5"}));
  ASSERT_EQ(run("simplify run/step_9.vtu --times 7 --time all -o log.qtet --no-clobber").code, 1);
  expectFailure("simplify run --times 1,2 -o log.qtet", 1, "--times gives 2 times for 4 files");
  expectFailure("simplify run --times 1,x -o log.qtet", 2, "--times '1,x' is no list of numbers");
  expectFailure("simplify run/step_*.vtu --times 1,2,3,4 -o log.qtet", 1,
                "run/step_11.vtu stands before run/step_8.vtu");
  expectFailure("simplify run/step_*.vtu", 2, "--output is missing");
}

TEST_F(NumberedFilesTool, otherCommandsTakeThem) {
  EXPECT_EQ(run("check run/step_*.vtu").code, 0);
  EXPECT_EQ(run("check run").code, 0);
  const Ran converted = run("convert 'run/step_*.vtu' --time all -o all.vtu --json");
  ASSERT_EQ(converted.code, 0) << converted.err;
  EXPECT_EQ(converted.json()["fields"].size(), 4u);
  ASSERT_EQ(run("simplify run --time 8,9 -o log.qtet").code, 0);
  const Ran added = run("add-steps log.qtet run --json");
  ASSERT_EQ(added.code, 0) << added.err;
  EXPECT_EQ(added.json()["skipped"], 2);
  EXPECT_EQ(fieldsOf("log.qtet"), all_);
  ASSERT_EQ(run("simplify run --time 8 --times 0,1,2,3 -o log.qtet").code, 1) << "no such time";
  ASSERT_EQ(run("simplify run --time 0,1 --times 0,1,2,3 -o log.qtet").code, 0);
  ASSERT_EQ(run("add-steps log.qtet 'run/*.vtu' --times 0,1,2,3").code, 0);
  EXPECT_EQ(fieldsOf("log.qtet"), (std::set<std::string>{"T@0", "T@1", "T@2", "T@3"}));
  const Ran out = run("extract log.qtet --ratio 1 --time ~1.2 -o near.vtu");
  EXPECT_EQ(out.code, 0);
  EXPECT_NE(out.err.find("time 1.2 is none; the nearest, 1, is taken"), std::string::npos);
  ASSERT_EQ(run("simplify run --time all -o list.json").code, 0);
  EXPECT_EQ(run("verify list.json --against run").code, 0);
}

}  // namespace
}  // namespace qtet
