// Lists of logs: series whose cells change.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "proto/number_text.h"
#include "proto/segment_list.h"
#include "simplify/log/opened_log.h"
#include "simplify/read/options/time_steps.h"
#include "simplify/read/read_mesh.h"
#include "tests/simplify/commands/tool_run.h"

namespace qtet {
namespace {

/// Five steps 0, 0.1 ... of a box with the field T, which is 10 times the step everywhere. The
/// cells of the steps 3 and 4 are others.
class SegmentListTool : public Tool {
 protected:
  void SetUp() override {
    TetMesh mesh = boxWithT();
    for (int step = 0; step < kSteps; ++step) {
      if (step == 3) mesh.tetrahedra.pop_back();
      std::ranges::fill(mesh.fields[0].values, 10. * step);
      mesh.fields[0].values[0] += 1;
      write("step-" + std::to_string(step) + ".vtu", mesh);
    }
    put("run.pvd", collection(0, kSteps));
  }
  static std::string collection(int first, int end, double begin = 0, double rate = 10) {
    std::string out = R"(<VTKFile type="Collection"><Collection>)";
    for (int step = first; step < end; ++step)
      out += "<DataSet timestep=\"" + shortestText(begin + step / rate) + "\" file=\"step-" +
             std::to_string(step) + ".vtu\"/>";
    return out + "</Collection></VTKFile>";
  }
  void makeList() {
    const Ran ran = run("simplify run.pvd --time all --measure none -o run.json");
    ASSERT_EQ(ran.code, 0) << ran.err;
  }
  SegmentList list(const std::string& name = "run.json") {
    return readSegmentList(contentOf(folder_ / name)).value();
  }
  /// The name of a log of run.json.
  std::string log(std::size_t number) { return list().segments.at(number).log; }
  std::string digestOf(const std::string& log) { return openLog(folder_ / log)->file.digest(); }
  std::vector<std::string> fieldsOf(const std::string& log) {
    const Result<OpenedLog> opened = openLog(folder_ / log);
    EXPECT_TRUE(opened) << log;
    std::vector<std::string> out;
    for (const ManifestField& field : opened->manifest.fields) out.push_back(field.name);
    std::ranges::sort(out);
    return out;
  }
  /// The names of all files in the test's folder that begin so, ascending.
  std::vector<std::string> filesLike(const std::string& begin) {
    std::vector<std::string> out;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      if (entry.path().filename().string().starts_with(begin))
        out.push_back(entry.path().filename().string());
    std::ranges::sort(out);
    return out;
  }

  static constexpr int kSteps = 5;
};

TEST_F(SegmentListTool, eachRunOfEqualCellsIsALog) {
  const Ran ran = run("simplify run.pvd --time all --measure none -o run.json --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  ASSERT_EQ(list().segments.size(), 2u);
  EXPECT_EQ(log(0), "run.0." + digestOf(log(0)).substr(0, 12) + ".qtet");
  EXPECT_EQ(list().segments[0].times, (std::vector<double>{0, 0.1, 0.2}));
  EXPECT_EQ(list().segments[1].times, (std::vector<double>{0.3, 0.4}));
  EXPECT_EQ(fieldsOf(log(0)), (std::vector<std::string>{"T@0", "T@0.1", "T@0.2"}));
  EXPECT_EQ(fieldsOf(log(1)), (std::vector<std::string>{"T@0.3", "T@0.4"}));
  EXPECT_EQ(ran.json()["times"].size(), 5u);
  EXPECT_EQ(ran.json()["segments"][1]["made"]["output"], log(1));
  EXPECT_EQ(filesLike(".run"), std::vector<std::string>{}) << "unpublished logs";
}

TEST_F(SegmentListTool, aSegmentOfOneStepHasItsFieldAsAnInstant) {
  ASSERT_EQ(run("simplify run.pvd --time 0:0.3:3 --measure none -o run.json").code, 0);
  ASSERT_EQ(list().segments.size(), 2u);
  EXPECT_EQ(list().segments[0].times, std::vector<double>{0});
  EXPECT_EQ(fieldsOf(log(0)), std::vector<std::string>{"T@0"});
  EXPECT_EQ(fieldsOf(log(1)), std::vector<std::string>{"T@0.3"});
}

TEST_F(SegmentListTool, stepsWithTheSameCellsAreOneSegment) {
  ASSERT_EQ(run("simplify run.pvd --time :0.2 --measure none -o run.json").code, 0);
  ASSERT_EQ(list().segments.size(), 1u);
  ASSERT_EQ(run("simplify run.pvd --time :0.2 --measure none -o run.qtet").code, 0);
  EXPECT_EQ(contentOf(folder_ / log(0)), contentOf(folder_ / "run.qtet"));
}

TEST_F(SegmentListTool, timesInUnixSecondsStayApart) {
  put("run.pvd", collection(2, 4, 1700000000, 1));  // the first one has other cells
  makeList();
  ASSERT_EQ(list().times(), (std::vector<double>{1700000002, 1700000003}));
  ASSERT_EQ(list().segments.size(), 2u);
  for (int step = 2; step < 4; ++step) {
    const Ran ran =
        run("extract run.json --ratio 1 -o out.vtu --time 170000000" + std::to_string(step));
    ASSERT_EQ(ran.code, 0) << ran.err;
    const TetMesh mesh = readMesh(folder_ / "out.vtu").value().mesh;
    EXPECT_NEAR(std::ranges::min(mesh.fields.at(0).values), 10 * step, 1e-2);
  }
}

TEST_F(SegmentListTool, oneLogOfChangingCellsIsRefused) {
  expectFailure("simplify run.pvd --time all -o run.qtet", 1,
                "the mesh at time 0.3 is not that of time 0");
  expectFailure("simplify run.pvd --time all -o run.qtet", 1, "-o NAME.json");
}

TEST_F(SegmentListTool, afterAnErrorAnOlderListStays) {
  makeList();
  const std::string before = contentOf(folder_ / "run.json"), first = log(0),
                    content = contentOf(folder_ / first);
  put("step-4.vtu", "no mesh");
  expectFailure("simplify run.pvd --time all --measure none --fields none -o run.json", 1,
                "step-4.vtu");
  TetMesh other = readMesh(folder_ / "box.vtu").value().mesh;
  other.fields.clear();  // so it has no T
  write("step-4.vtu", other);
  expectFailure("simplify run.pvd --time all --measure none --fields T -o run.json", 1, "T");
  EXPECT_EQ(contentOf(folder_ / "run.json"), before);
  EXPECT_EQ(contentOf(folder_ / first), content);
  EXPECT_EQ(filesLike(".run"), std::vector<std::string>{});
}

TEST_F(SegmentListTool, aNewListTakesThePlaceOfTheOlderLogs) {
  makeList();
  const std::string first = log(0), second = log(1);
  makeList();
  EXPECT_EQ(filesLike("run."), (std::vector<std::string>{first, second, "run.json", "run.pvd"}));
  SegmentList renamed = list();
  renamed.segments[1].log = "run.1.mine.qtet";
  std::filesystem::rename(folder_ / second, folder_ / "run.1.mine.qtet");
  put("run.json", segmentListText(renamed).value());
  put("run.0.0123456789ab.qtet", "of no list");
  std::array<char, 256> host{};
  ASSERT_EQ(::gethostname(host.data(), host.size() - 1), 0);
  std::filesystem::create_directory(
      folder_ / (std::string(".run.qtet-unpublished-") + host.data() + "-abcdef"));
  ASSERT_EQ(run("simplify run.pvd --time all --measure none --field-bits 9 -o run.json").code, 0);
  EXPECT_NE(log(0), first);
  std::vector<std::string> expected{
      log(0), log(1), "run.0.0123456789ab.qtet", "run.1.mine.qtet", "run.json", "run.pvd"};
  std::ranges::sort(expected);
  EXPECT_EQ(filesLike("run."), expected);
  EXPECT_EQ(filesLike(".run"), std::vector<std::string>{}) << "what a killed process left";
}

TEST_F(SegmentListTool, aLogThatCannotBeMovedLeavesTheOlderList) {
  makeList();
  const std::string first = log(0), second = log(1), before = contentOf(folder_ / "run.json");
  std::filesystem::remove(folder_ / "run.json");
  std::filesystem::remove(folder_ / first);
  std::filesystem::remove(folder_ / second);
  std::filesystem::create_directories(folder_ / second / "in the way");
  expectFailure("simplify run.pvd --time all --measure none -o run.json", 1, second);
  EXPECT_EQ(filesLike("run."), (std::vector<std::string>{second, "run.pvd"}));
  put("run.json", before);
  put(first, "of the older list");
  expectFailure("simplify run.pvd --time all --measure none -o run.json", 1, second);
  EXPECT_EQ(contentOf(folder_ / "run.json"), before);
  EXPECT_TRUE(std::filesystem::exists(folder_ / first));
}

TEST_F(SegmentListTool, aListNeedsTimesAndANameThatItCanHold) {
  expectFailure("simplify box.vtu -o box.json", 1, "box.vtu has no times");
  EXPECT_EQ(filesLike("box."), std::vector<std::string>{"box.vtu"});
  expectFailure("simplify run.pvd --time all -o a..b.json", 1, "a..b.0.");
  expectFailure("simplify run.pvd --time all -o run.json --time-statistics", 2, "-o NAME.qtet");
}

TEST_F(SegmentListTool, aListOfOneStepOfAGmshFileSaysHowToTakeAll) {
  std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
      "$EndNodes\n$Elements\n1\n1 4 0 1 2 3 4\n$EndElements\n";
  for (const char* time : {"0", "1"})
    text += std::string("$NodeData\n1\n\"T\"\n1\n") + time +
            "\n3\n0\n1\n4\n1 1\n2 2\n3 3\n4 4\n$EndNodeData\n";
  put("steps.msh", text);
  expectFailure("simplify steps.msh -o steps.json", 1, "--time all");
  EXPECT_EQ(run("simplify steps.msh -o steps.json").err.find("has no times"), std::string::npos);
  const Ran ran = run("simplify steps.msh --time all --measure none -o steps.json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(list("steps.json").times(), (std::vector<double>{0, 1}));
}

TEST_F(SegmentListTool, infoShowsEachSegment) {
  makeList();
  const nlohmann::json info = run("info run.json --json").json();
  ASSERT_EQ(info["segments"].size(), 2u);
  EXPECT_EQ(info["instants"], 5);
  EXPECT_EQ(info["timeRange"], nlohmann::json({0., 0.4}));
  EXPECT_EQ(info["segments"][1]["log"], log(1));
  EXPECT_EQ(info["segments"][0]["tetrahedra"].get<int>() - 1, info["segments"][1]["tetrahedra"]);
  const Ran ran = run("info run.json");
  EXPECT_NE(ran.out.find("2 logs, 5 instants, 0 to 0.4"), std::string::npos) << ran.out;
}

TEST_F(SegmentListTool, extractTakesTheLogThatHasTheTime) {
  ASSERT_EQ(run("simplify run.pvd --time 0.1:0.3 --measure none -o run.json").code, 0);
  for (int step = 1; step <= 3; ++step) {  // the last one is alone in its log
    const Ran ran =
        run("extract run.json --ratio 1 --time " + shortestText(step / 10.) + " -o out.vtu --json");
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(ran.json()["log"], log(step < 3 ? 0 : 1));
    const TetMesh mesh = readMesh(folder_ / "out.vtu").value().mesh;
    ASSERT_EQ(mesh.fields.size(), 1u);
    EXPECT_EQ(mesh.fields[0].name, "T");
    EXPECT_NEAR(std::ranges::min(mesh.fields[0].values), 10 * step, 1e-2);
  }
  ASSERT_EQ(run("extract run.json --ratio 0.5 --time last -o out.vtu").code, 0);
  expectFailure("extract run.json --ratio 1 --time 0.25 -o out.vtu", 1,
                "run.json has no time step 0.25; it has 0.1, 0.2, 0.3");
  expectFailure("extract run.json --ratio 1 -o out.vtu", 2, "--time T");
  expectFailure("extract run.json --ratio 1 --time all -o out.vtu", 2, "3 instants");
}

TEST_F(SegmentListTool, anErrorHoldsAtEachOfTheChosenTimes) {
  ASSERT_EQ(run("simplify run.pvd --time 0.1:0.3 -o run.json").code, 0);
  const auto levelAt = [&](const std::string& time, const std::string& output) {
    const Ran ran = run("extract run.json --error T=1e-4 --time " + time + " --json -o " + output);
    EXPECT_EQ(ran.code, 0) << ran.err;
    return ran.json().value("level", 0u);
  };
  std::uint32_t worst = 0;
  for (const std::string time : {"0.1", "0.2"}) {
    const auto alone =
        run("extract " + log(0) + " --json -o o.vtu --error T@" + time + "=1e-4").json();
    EXPECT_EQ(levelAt(time, "o.vtu"), alone["level"].get<std::uint32_t>()) << time;
    worst = std::max(worst, alone["level"].get<std::uint32_t>());
  }
  EXPECT_GE(levelAt("0.1:0.2", "worst.pvd"), worst);
  EXPECT_EQ(run("extract run.json --error T=0.01 -o all.pvd").code, 0);
  expectFailure("extract run.json --error T@0=0.01 -o at.pvd", 2, "--time T");
  expectFailure("extract run.json --error u=0.01 -o u.pvd", 1, "u");
}

TEST_F(SegmentListTool, allTimesAreOneCollection) {
  makeList();
  const Ran ran = run("extract run.json --ratio 1 --time all -o out.pvd --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.json()["files"].size(), 5u);
  EXPECT_EQ(ran.json()["segments"][1]["times"], nlohmann::json({0.3, 0.4}));
  // the collection is a series whose cells change in the same place
  ASSERT_EQ(run("simplify out.pvd --time all --measure none -o out.json").code, 0);
  EXPECT_EQ(list("out.json").times(), list().times());
  EXPECT_EQ(list("out.json").segments[1].times, list().segments[1].times);
  std::filesystem::remove_all(folder_ / "out");
  std::filesystem::remove(folder_ / log(1));
  expectFailure("extract run.json --ratio 1 -o out.pvd", 1, log(1));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(SegmentListTool, eachLogIsVerifiedAgainstItsSteps) {
  makeList();
  const Ran ran = run("verify run.json --against run.pvd --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  ASSERT_EQ(ran.json()["segments"].size(), 2u);
  EXPECT_EQ(ran.json()["segments"][1]["log"], log(1));
  const nlohmann::json against = ran.json()["segments"][1]["verified"]["against"];
  EXPECT_EQ(against["largestFieldErrorSteps"].size(), 2u) << against;
  EXPECT_NE(run("verify run.json").out.find(log(1) + "\ndigest "), std::string::npos);
  expectFailure("verify run.json --against run.pvd --time all", 2, "leave out --time");
  std::filesystem::copy_file(folder_ / "step-0.vtu", folder_ / "step-4.vtu",
                             std::filesystem::copy_options::overwrite_existing);
  expectFailure("verify run.json --against run.pvd", 1, "time 0.4");
  put(log(1), contentOf(folder_ / log(1)) + "more");
  expectFailure("verify run.json", 1, log(1));
}

TEST_F(SegmentListTool, aListThatIsDamagedIsRefused) {
  expectFailure("info run.json", 1, "there is no list run.json");
  put("run.json", R"({"qtet":"series","segments":[{"log":"../a.qtet","times":[0]}]})");
  expectFailure("info run.json", 1, "run.json: /segments/0/log");
  put("run.json", std::string(kMaxListBytes + 1, ' '));
  expectFailure("extract run.json --ratio 1 --time 0 -o out.vtu", 1, "limit-exceeded");
  makeList();
  SegmentList other = list();
  other.segments[0].times = {0, 0.15};
  put("run.json", segmentListText(other).value());
  expectFailure("info run.json", 1, "the log " + log(0) + " has no instant at time 0.15");
  put(log(0), "no log");
  expectFailure("info run.json", 1, "run.json names it");
  std::filesystem::remove(folder_ / log(0));
  expectFailure("info run.json", 1,
                "run.json names the log " + log(0) + ", which is not beside it");
}

TEST_F(SegmentListTool, aPublishedListIsOneMesh) {
  makeList();
  std::filesystem::create_directories(folder_ / "viewer");
  put("viewer/index.html", "<head></head><body></body>");
  const Ran ran = run("publish site run.json --viewer viewer --plain");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto index = nlohmann::json::parse(contentOf(folder_ / "site" / "index.json"));
  ASSERT_EQ(index["meshes"].size(), 1u);
  const auto& mesh = index["meshes"][0];
  EXPECT_EQ(mesh["id"], "run");
  EXPECT_EQ(mesh["links"]["list"], "run.json");
  EXPECT_EQ(mesh["links"]["log"], log(0));
  ASSERT_EQ(mesh["segments"].size(), 2u);
  EXPECT_EQ(mesh["segments"][1]["log"], log(1));
  EXPECT_EQ(mesh["segments"][1]["times"].size(), 2u);
  for (const std::string& name : {std::string("run.json"), log(0), log(1), std::string("run.webp")})
    EXPECT_TRUE(std::filesystem::exists(folder_ / "site" / name)) << name;
  EXPECT_EQ(readSegmentList(contentOf(folder_ / "site" / "run.json"))->segments.size(), 2u);
}

TEST_F(SegmentListTool, aListWithTheNameOfTheFoldersOwnIsRefused) {
  makeList();
  std::filesystem::copy_file(folder_ / "run.json", folder_ / "index.json");
  const Ran ran = run("publish site index.json");
  EXPECT_EQ(ran.code, 2);
  EXPECT_NE(ran.err.find("rename it"), std::string::npos) << ran.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "site"));
}

TEST_F(SegmentListTool, viewSaysHowToShowAList) {
  makeList();
  const Ran ran = run("view run.json --no-open");
  EXPECT_EQ(ran.code, 2);
  EXPECT_NE(ran.err.find("qtet publish"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace qtet
