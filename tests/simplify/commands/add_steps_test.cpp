// `qtet add-steps`: the steps of a run that goes on.
#include <cmath>
#include <map>

#include "proto/number_text.h"
#include "simplify/read/options/time_steps.h"
#include "simplify/read/read_mesh.h"
#include "tests/simplify/commands/tool_run.h"

namespace qtet {
namespace {

/// A box with a series T of cells and points, and its log of the first three steps.
class AddStepsTool : public Tool {
 protected:
  static constexpr int kSteps = 14;

  void SetUp() override {
    mesh_ = boxWithT();
    scalar_ = mesh_.fields[0].values;
    for (int step = 0; step < kSteps; ++step) write(fileOf(step), at(step));
    put("run.pvd", collection(0, kSteps));
    const Ran made = run("simplify run.pvd --time 0:1 -o log.qtet --base-cells 600");
    ASSERT_EQ(made.code, 0) << made.err;
  }
  static std::string fileOf(int step) { return "step-" + std::to_string(step) + ".vtu"; }
  [[nodiscard]] TetMesh at(int step) const {
    TetMesh out = mesh_;
    for (std::size_t i = 0; i < scalar_.size(); ++i)
      out.fields[0].values[i] = scalar_[i] * (1 - 0.02 * step);
    return out;
  }
  static std::string collection(int first, int end) {
    std::string out = R"(<VTKFile type="Collection"><Collection>)";
    for (int step = first; step < end; ++step)
      out +=
          "<DataSet timestep=\"" + shortestText(0.5 * step) + "\" file=\"" + fileOf(step) + "\"/>";
    return out + "</Collection></VTKFile>";
  }
  static std::array<int, 3> placeOf(const Position& p) {
    const auto of = [](double x) { return static_cast<int>(std::lround(1024 * x)); };
    return {of(p[0]), of(p[1]), of(p[2])};
  }
  /// Expects the values of every third step below `end` in the log.
  void expectSteps(const std::string& log, int end) {
    for (int step = 0; step < end; step += 3) {  // every value, by its point
      const Ran ran =
          run("extract " + log + " --ratio 1 --time " + shortestText(0.5 * step) + " -o out.vtu");
      ASSERT_EQ(ran.code, 0) << ran.err;
      const TetMesh mesh = readMesh(folder_ / "out.vtu").value().mesh;
      std::map<std::array<int, 3>, double> values;  // by place, in 1 / 1024
      for (std::size_t i = 0; i < mesh.points.size(); ++i)
        values[placeOf(mesh.points[i])] = mesh.fields[0].values[i];
      ASSERT_EQ(values.size(), mesh_.points.size());
      const TetMesh expected = at(step);
      for (std::size_t i = 0; i < mesh_.points.size(); ++i)
        ASSERT_NEAR(values.at(placeOf(mesh_.points[i])), expected.fields[0].values[i], 1e-3)
            << step << " " << i;
    }
    EXPECT_EQ(run("verify " + log).code, 0);
  }

  TetMesh mesh_;
  std::vector<double> scalar_;
};

TEST_F(AddStepsTool, aCollectionThatGoesOn) {
  const Ran ran = run("add-steps log.qtet run.pvd --time 1.5: --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.json()["added"].size(), kSteps - 3u);
  EXPECT_EQ(ran.json()["fields"].size(), std::size_t{kSteps});
  EXPECT_EQ(ran.json()["files"], nlohmann::json{"run.pvd"});
  expectSteps("log.qtet", kSteps);
}

TEST_F(AddStepsTool, aLogIsVerifiedAgainstItsOwnInstants) {
  EXPECT_EQ(run("verify log.qtet --against run.pvd").code, 0) << "three of fourteen";
  EXPECT_EQ(run("verify log.qtet --against run.pvd --time 0:1").code, 0);
  expectFailure("verify log.qtet --against run.pvd --time 0.5", 1, "T@0");
  put("late.pvd", collection(1, kSteps));
  expectFailure("verify log.qtet --against late.pvd", 1, "no time step 0");
  ASSERT_EQ(run("sample fin --cells 2000 --steps 3 -o fin.vtu").code, 0);
  ASSERT_EQ(run("simplify fin.vtu -o fin.qtet").code, 0);
  EXPECT_EQ(run("verify fin.qtet --against fin.vtu").code, 0) << "instants of a file without times";
}

TEST_F(AddStepsTool, aWordForATimeIsTakenInAnyCase) {
  for (const char* word : {"LAST", "First", "ALL"}) {
    const Ran ran = run(std::string("check run.pvd --time ") + word);
    EXPECT_EQ(ran.code, 0) << ran.err;
  }
  ASSERT_EQ(run("simplify run.pvd --time ALL -o all.qtet --base-cells 600").code, 0);
  EXPECT_EQ(run("info all.qtet --json").json()["fields"].size(), std::size_t{kSteps});
}

TEST_F(AddStepsTool, filesThatKnowNoTime) {
  std::string files, times;
  for (int step = 3; step < kSteps; ++step) {
    files += " " + fileOf(step);
    times += (step > 3 ? "," : "") + shortestText(0.5 * step);
  }
  const Ran ran = run("add-steps log.qtet" + files + " --times " + times + " -o more.qtet");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_NE(ran.out.find("point field T: 11 instants, "), std::string::npos) << ran.out;
  expectSteps("more.qtet", kSteps);
  expectSteps("log.qtet", 3);
}

TEST_F(AddStepsTool, theSameCommandMayBeGivenAgainAndAgain) {
  put("some.pvd", collection(0, 7));
  ASSERT_EQ(run("add-steps log.qtet some.pvd").code, 0);
  const Ran rest = run("add-steps log.qtet run.pvd --json");
  ASSERT_EQ(rest.code, 0) << rest.err;
  EXPECT_EQ(rest.json()["added"].size(), kSteps - 7u);
  EXPECT_EQ(rest.json()["skipped"], 7);
  expectSteps("log.qtet", kSteps);
  const std::string before = contentOf(folder_ / "log.qtet");
  const Ran none = run("add-steps log.qtet run.pvd");
  EXPECT_EQ(none.code, 0);
  EXPECT_EQ(none.out, "log.qtet: nothing to add\n");
  EXPECT_NE(none.err.find("14 steps were left out, since the log has their times"),
            std::string::npos)
      << none.err;
  EXPECT_EQ(
      run("add-steps log.qtet step-2.vtu --times 1.0000000000000002 --json").json()["skipped"], 1);
  EXPECT_EQ(contentOf(folder_ / "log.qtet"), before);
  ASSERT_EQ(run("add-steps log.qtet run.pvd -o same.qtet").code, 0);
  EXPECT_EQ(contentOf(folder_ / "same.qtet"), before);
}

TEST_F(AddStepsTool, aSeriesThatIsNewFillsWindowsBesideOneThatIsNot) {
  for (int step = 3; step < kSteps; ++step) {
    TetMesh two = at(step);
    two.fields.push_back(two.fields[0]);
    two.fields[1].name = "P";
    write(fileOf(step), two);
  }
  put("rest.pvd", collection(3, kSteps));
  const Ran ran = run("add-steps log.qtet rest.pvd --fields T,P --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.json()["added"].size(), 2u * (kSteps - 3));
  EXPECT_EQ(run("verify log.qtet --against rest.pvd").code, 1) << "T@0 is not there";
  put("all.pvd", collection(0, kSteps));
  EXPECT_EQ(run("verify log.qtet --against all.pvd").code, 0);
}

TEST_F(AddStepsTool, aStepMayComeLongAfterThoseBehindIt) {
  std::string files, times;
  for (int step = 3; step < 13; ++step)
    files += " " + fileOf(step), times += shortestText(0.5 * step) + ",";
  const Ran ran = run("add-steps log.qtet" + files + " step-13.vtu --times " + times + "1.75");
  ASSERT_EQ(ran.code, 0) << ran.err;
  expectSteps("log.qtet", 13);
}

TEST_F(AddStepsTool, integersThatLoseNothingAloneKeepTheirStep) {
  for (int step = 0; step < 6; ++step) {
    TetMesh mesh = at(step);
    mesh.fields[0].type = "int64", mesh.fields[0].name = "Id";
    for (std::size_t i = 0; i < mesh.fields[0].values.size(); ++i)
      mesh.fields[0].values[i] = static_cast<double>(i % 5) * (step < 3 ? 3e10 : 1);
    write(fileOf(step), mesh);
  }
  put("ids.pvd", collection(0, 6));
  ASSERT_EQ(run("simplify ids.pvd --time :1 -o ids.qtet --base-cells 600").code, 0);
  ASSERT_EQ(run("add-steps ids.qtet ids.pvd").code, 0);
  for (const auto& field : run("info ids.qtet --json").json()["fields"])
    EXPECT_EQ(field["step"] == 1, field["range"][1] < 5) << field;
}

TEST_F(AddStepsTool, aStepBetweenThoseOfTheLogIsAddedWithAWarning) {
  const Ran ran = run("add-steps log.qtet step-3.vtu step-4.vtu --times 3,0.75");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_NE(ran.err.find("1 step lies before time 1, the last one of the log (0.75)"),
            std::string::npos)
      << ran.err;
  const nlohmann::json fields = run("info log.qtet --json").json()["fields"];
  EXPECT_EQ(fields.size(), 5u);
  EXPECT_EQ(run("verify log.qtet").code, 0);
}

TEST_F(AddStepsTool, whatCannotBeAddedIsRefusedAndTheLogStays) {
  const std::string before = contentOf(folder_ / "log.qtet");
  expectFailure("add-steps log.qtet step-5.vtu", 1, "knows no time; give it with --times");
  expectFailure("add-steps log.qtet step-5.vtu --times 2,3", 2, "2 times for 1 file");
  expectFailure("add-steps log.qtet step-5.vtu --times nan", 2, "no list of numbers");
  expectFailure("add-steps log.qtet step-5.vtu --times 1,", 2, "no list of numbers");
  expectFailure("add-steps log.qtet run.pvd --time 2:3 --times 5", 1, "has times of its own");
  expectFailure("add-steps log.qtet step-5.vtu --times 2 --follow -o x.qtet", 2, "leave -o out");
  expectFailure("add-steps no.qtet run.pvd --follow", 1, "no.qtet");
  expectFailure("add-steps log.qtet run.pvd --every 0.05 --follow", 2, "--every");
  TetMesh other = at(5);
  other.fields[0].type = "int64";
  for (double& value : other.fields[0].values) value = std::round(value);
  write("other.vtu", other);
  expectFailure("add-steps log.qtet other.vtu --times 2", 1, "T@2 has 1 x int64");
  other = at(5);
  other.fields[0].name = "U";
  write("other.vtu", other);
  expectFailure("add-steps log.qtet other.vtu --times 2", 1, "it has U)");
  other.fields[0].name = "T";
  other.points[0][0] += 0.25;
  write("other.vtu", other);
  expectFailure("add-steps log.qtet other.vtu --times 2", 1, "point");
  EXPECT_EQ(contentOf(folder_ / "log.qtet"), before);
}

TEST_F(AddStepsTool, floatsOfTheOtherWidthJoinTheirSeries) {
  TetMesh other = at(3);
  other.fields[0].type = other.fields[0].type == "float32" ? "float64" : "float32";
  other.fields.push_back(other.fields[0]);
  other.fields[1].name = "U";
  write("other.vtu", other);
  const Ran ran = run("add-steps log.qtet other.vtu --times 1.5");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_NE(ran.err.find("no such series: U;"), std::string::npos) << ran.err;
  expectSteps("log.qtet", 4);
}

TEST_F(AddStepsTool, statisticsThatDoNotCountTheNewInstantsAreNamed) {
  const Ran made =
      run("simplify run.pvd --time 0:1 -o counted.qtet --base-cells 600 --time-statistics --json");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_TRUE(made.json()["bytesOf"]["fields"].contains("T_stddev"));
  const Ran ran = run("add-steps counted.qtet run.pvd --time 1.5: -o more.qtet");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_NE(
      ran.err.find("qtet: warning: T_average, T_minimum, T_maximum, T_stddev do not count the "
                   "added instants; "),
      std::string::npos)
      << ran.err;
  EXPECT_EQ(run("remove-field more.qtet -o less.qtet --fields T_average,T_minimum,T_maximum,"
                "T_stddev")
                .code,
            0);
  EXPECT_EQ(run("add-steps log.qtet run.pvd --time 1.5: -q").err, "") << "a log without them";
  expectFailure("simplify run.pvd --time first -o no.qtet --time-statistics", 1,
                "--time-statistics needs a series");
}

// The instants that go must not be what the new ones rest on.
TEST_F(AddStepsTool, aBoundKeepsTheScaleOfTheSeriesWhereThatHoldsIt) {
  const std::string make = "simplify run.pvd --time 0:1 -o log.qtet --measure none --error T=";
  const auto within = [&](std::size_t f) {
    return run("info log.qtet --json").json()["fields"][f]["largestRoundingError"].get<double>();
  };
  for (const std::string bound : {"0.5%", "0.004"}) {
    ASSERT_EQ(run(make + bound).code, 0);
    const double first = within(0);
    ASSERT_EQ(run("add-steps log.qtet run.pvd --time 0:2 --error T=" + bound).code, 0);
    EXPECT_EQ(within(3), first) << "though the values of these steps span less";
    EXPECT_EQ(within(4), first);
    const Ran finer = run("add-steps log.qtet run.pvd --time 0:3 --error all=0.001");
    ASSERT_EQ(finer.code, 0) << finer.err;
    EXPECT_LE(within(5), 0.001);
    EXPECT_EQ(within(5), within(6)) << "they share a scale of their own";
    EXPECT_EQ(run("verify log.qtet --against run.pvd").code, 0);
  }
  expectFailure("add-steps log.qtet run.pvd --error S=1", 1, "--error: the mesh carries no field");
}

TEST_F(AddStepsTool, addFieldReplacesInstantsThatLaterOnesCouldRestOn) {
  const Ran ran = run("add-field log.qtet --from run.pvd --time 0:3 --replace -o new.qtet");
  ASSERT_EQ(ran.code, 0) << ran.err;
  expectSteps("new.qtet", 7);
}

TEST_F(AddStepsTool, aSeriesThatTheLogLacksIsAddedByName) {
  TetMesh other = at(5);
  other.fields[0].name = "U";
  write("other.vtu", other);
  const Ran ran = run("add-steps log.qtet other.vtu --times 2 --fields U");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_NE(ran.out.find("point field U: 1 instant, "), std::string::npos) << ran.out;
}

TEST_F(AddStepsTool, aStepsFieldCanBeNamedAmongAllSteps) {
  const Ran one = run("simplify run.pvd --time all --fields T@0.5 -o one.qtet --base-cells 600");
  ASSERT_EQ(one.code, 0) << one.err;
  EXPECT_EQ(run("info one.qtet --json").json()["fields"].size(), 1u);
  const Ran part =
      run("simplify run.pvd --time all --threshold T@0.5=0: -o part.qtet --base-cells 100");
  EXPECT_EQ(part.code, 0) << part.err;
}

// Blocks say of no step what they are. A log has them from its first steps on.
TEST_F(AddStepsTool, blocksWithNamesAreNoStep) {
  put("blocks.vtm",
      R"(<VTKFile type="vtkMultiBlockDataSet"><vtkMultiBlockDataSet><DataSet name="left" )"
      R"(file="step-0.vtu"/><DataSet name="right" file="moved.vtu"/></vtkMultiBlockDataSet>)"
      "</VTKFile>");
  TetMesh moved = at(0);
  for (Position& p : moved.points) p[0] += 5;
  write("moved.vtu", moved);
  const auto list = [&](const std::string& name, const std::vector<std::string>& times) {
    std::string sets;
    for (const std::string& time : times)
      sets += "<DataSet timestep=\"" + time + "\" file=\"blocks.vtm\"/>";
    put(name, R"(<VTKFile type="Collection"><Collection>)" + sets + "</Collection></VTKFile>");
  };
  list("first.pvd", {"0", "1"});
  list("more.pvd", {"2", "3"});
  const Ran made = run("simplify first.pvd --time all -o blocks.qtet --base-cells 600");
  ASSERT_EQ(made.code, 0) << made.err;
  const Ran added = run("add-steps blocks.qtet more.pvd -o more.qtet");
  ASSERT_EQ(added.code, 0) << added.err;
  const Ran info = run("info more.qtet");
  EXPECT_NE(info.out.find("BlockId: 1 = left, 2 = right"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("T: 4 instants"), std::string::npos) << info.out;
  TetMesh other = at(0);
  other.fields[0].name = "p";
  write("step-0.vtu", other);
  moved.fields[0].name = "p";
  write("moved.vtu", moved);
  const Ran field = run("add-field blocks.qtet --from blocks.vtm -o field.qtet");
  EXPECT_EQ(field.code, 0) << field.err;
}

}  // namespace
}  // namespace qtet
