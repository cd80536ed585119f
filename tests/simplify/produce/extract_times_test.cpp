// `qtet extract --time`: instants of a series as ordinary files.
#include "simplify/produce/extract_times.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "simplify/read/read_mesh.h"
#include "simplify/samples/samples.h"
#include "tests/simplify/commands/tool_run.h"

namespace qtet {
namespace {

/// A box with a series T of three instants, and a series u of cells that lacks the second one. It
/// has plain fields u of cells and p of points, too.
class ExtractTimes : public Tool {
 protected:
  void SetUp() override {
    TetMesh mesh = boxSample();
    mesh.fields.clear();
    const auto add = [&](const std::string& name, const std::string& association, double first) {
      MeshField& field = mesh.fields.emplace_back(MeshField{name, 1, "float32", {}, association});
      field.values.resize(association == "cell" ? mesh.tetrahedra.size() : mesh.points.size());
      for (std::size_t i = 0; i < field.values.size(); ++i)
        field.values[i] = first + static_cast<double>(i % 7);
    };
    for (const double time : {0., 0.5, 2.}) add("T@" + text(time), "point", 10 * time);
    for (const double time : {0., 2.}) add("u@" + text(time), "cell", time);
    add("u", "cell", 100);
    add("p", "point", 200);
    write("box.vtu", mesh);
    ASSERT_EQ(run("simplify box.vtu -o box.qtet --measure none " + kept_).code, 0);
  }
  static std::string text(double time) {
    return time == 0.5 ? "0.5" : std::to_string(static_cast<int>(time));
  }
  /// The names of a file's fields, ascending.
  std::vector<std::string> namesIn(const std::string& file) {
    const Result<ReadMesh> read = readMesh(folder_ / file);
    EXPECT_TRUE(read) << file;
    std::vector<std::string> out;
    if (read)
      for (const MeshField& field : read->mesh.fields) out.push_back(field.name);
    std::ranges::sort(out);
    return out;
  }
  double leastOf(const std::string& file, const std::string& name) {
    const Result<ReadMesh> read = readMesh(folder_ / file);
    for (const MeshField& field : read->mesh.fields)
      if (field.name == name) return std::ranges::min(field.values);
    ADD_FAILURE() << file << " has no " << name;
    return -1;
  }

  std::string kept_;
};

class ExtractTimesOfInput : public ExtractTimes {
 protected:
  ExtractTimesOfInput() { kept_ = "--keep-order --lossless"; }
};

using Names = std::vector<std::string>;

TEST_F(ExtractTimes, oneInstantIsCalledAsItsSeries) {
  ASSERT_EQ(run("extract box.qtet --level 1 --time 0.5 -o one.vtu").code, 0);
  EXPECT_EQ(namesIn("one.vtu"), (Names{"T", "p", "u"}));
  // a fused value may lie somewhat outside of the range
  EXPECT_NEAR(leastOf("one.vtu", "T"), 5, 1);
  EXPECT_NEAR(leastOf("one.vtu", "u"), 100, 0.1) << "the field without times";
  const Ran last = run("extract box.qtet --level 1 --time last --fields T -o one.vtu --json");
  ASSERT_EQ(last.code, 0) << last.err;
  EXPECT_EQ(last.json()["fields"][0]["name"], "T");
  EXPECT_NEAR(leastOf("one.vtu", "T"), 20, 1);
  ASSERT_EQ(run("extract box.qtet --level 1 --fields p --time last -o one.vtu").code, 0);
  EXPECT_EQ(namesIn("one.vtu"), Names{"p"}) << "no series is among the fields";
}

TEST_F(ExtractTimes, aCollectionHasAFileOfEachInstant) {
  const Ran ran = run("extract box.qtet --level 2 -o 'a&b.pvd' --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.json()["kind"], "pvd");
  ASSERT_EQ(ran.json()["files"].size(), 3u);
  EXPECT_EQ(ran.json()["files"][1]["time"], 0.5);
  EXPECT_EQ(ran.json()["files"][1]["file"], "a&b/a&b_0001.vtu");
  EXPECT_EQ(namesIn("a&b/a&b_0000.vtu"), (Names{"T", "p", "u", "u@0"}));
  EXPECT_EQ(namesIn("a&b/a&b_0001.vtu"), (Names{"T", "p", "u"}));
  EXPECT_NEAR(leastOf("a&b/a&b_0002.vtu", "T"), 20, 0.1);
  EXPECT_NEAR(leastOf("a&b/a&b_0002.vtu", "u@2"), 2, 0.1);
  ReadOptions all;
  all.time = "all";
  all.fields = Names{"T"};
  const Result<ReadMesh> read = readMesh(folder_ / "a&b.pvd", all);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->mesh.fields.size(), 3u);
  EXPECT_EQ(read->mesh.fields[1].name, "T@0.5");
  expectFailure("extract box.qtet --level 2 -o 'a&b.pvd'", 1, "exists");
}

TEST_F(ExtractTimes, someInstantsAreChosenByARange) {
  ASSERT_EQ(run("extract box.qtet --level 0 --time 0.5: -o late.pvd").code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "late/late_0001.vtu"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "late/late_0002.vtu"));
  ASSERT_EQ(run("extract box.qtet --level 0 --time LAST -o last.vtu").code, 0);
  expectFailure("extract box.qtet --level 0 --time all -o all.vtu", 2, "3 instants");
  expectFailure("extract box.qtet --level 0 --time 7 -o all.vtu", 1, "no time step 7");
  expectFailure("extract box.qtet --level 0 --to pvd -o -", 2, "NAME.pvd");
}

TEST_F(ExtractTimesOfInput, theLastLevelIsTheInput) {
  ASSERT_EQ(run("extract box.qtet --ratio 1 -o run.pvd").code, 0);
  const Result<ReadMesh> before = readMesh(folder_ / "box.vtu"),
                         after = readMesh(folder_ / "run/run_0002.vtu");
  ASSERT_TRUE(before && after);
  EXPECT_EQ(after->mesh.tetrahedra, before->mesh.tetrahedra);
  EXPECT_EQ(leastOf("run/run_0002.vtu", "T"), 20) << "exactly";
}

}  // namespace
}  // namespace qtet
