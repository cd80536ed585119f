// Blocks that touch make one mesh of a file, whatever is read of it, and at whichever steps.
#include <algorithm>
#include <array>

#include "tests/simplify/commands/tool_run.h"

namespace qtet {
namespace {

/// A run of three steps of two boxes that touch, with rho and T in their points.
class TouchingBlocksTool : public Tool {
 protected:
  using ValuesOfSteps = std::array<double, 3>;

  void SetUp() override { box_ = boxWithT(); }
  /// Writes run.pvd. The left block has 1 as rho and T, the right one these.
  void writeRun(const ValuesOfSteps& rho, const ValuesOfSteps& t) {
    std::string sets;
    for (std::size_t step = 0; step < rho.size(); ++step) {
      const std::string number = std::to_string(step);
      write("left" + number + ".vtu", blockOf(0, 1, 1));
      write("right" + number + ".vtu", blockOf(width(), rho[step], t[step]));
      put("step" + number + ".vtm",
          R"(<VTKFile type="vtkMultiBlockDataSet" version="1.0"><vtkMultiBlockDataSet>)"
          R"(<DataSet index="0" name="left" file="left)" +
              number +
              R"(.vtu"/>)"
              R"(<DataSet index="1" name="right" file="right)" +
              number +
              R"(.vtu"/>)"
              "</vtkMultiBlockDataSet></VTKFile>");
      sets += "<DataSet timestep=\"" + number + "\" file=\"step" + number + ".vtm\"/>";
    }
    put("run.pvd", R"(<VTKFile type="Collection"><Collection>)" + sets + "</Collection></VTKFile>");
  }
  [[nodiscard]] std::size_t pointsOf(const std::string& time) {
    const auto mesh = readMesh(folder_ / "run.pvd", optionsOf(time));
    EXPECT_TRUE(mesh.has_value());
    return mesh ? mesh->mesh.points.size() : 0;
  }
  void expectOneMesh() {
    for (const char* const words :
         {"simplify run.pvd --time 0:1 --fields T -o some.qtet --base-cells 600",
          "add-steps some.qtet run.pvd --time 2", "verify some.qtet --against run.pvd",
          "add-field some.qtet --from run.pvd --time 1 --fields rho -o more.qtet"}) {
      const Ran ran = run(words);
      EXPECT_EQ(ran.code, 0) << words << "\n" << ran.err;
    }
  }
  [[nodiscard]] std::size_t pointsOfBox() const { return box_.points.size(); }
  [[nodiscard]] std::size_t pointsThatTouch() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(box_.points, [](const Position& p) { return p[0] == 0; }));
  }

 private:
  [[nodiscard]] double width() const {
    double out = 0;
    for (const Position& p : box_.points) out = std::max(out, p[0]);
    return out;
  }
  [[nodiscard]] TetMesh blockOf(double x, double rho, double t) const {
    TetMesh out = box_;
    for (Position& p : out.points) p[0] += x;
    const std::size_t n = out.points.size();
    out.fields = {{"rho", 1, "float64", std::vector<double>(n, rho), "point"},
                  {"T", 1, "float64", std::vector<double>(n, t), "point"}};
    return out;
  }
  static ReadOptions optionsOf(const std::string& time) {
    ReadOptions out;
    out.time = time;
    out.fields = {{"T"}};
    return out;
  }

  TetMesh box_;
};

TEST_F(TouchingBlocksTool, blocksThatDifferAtTheFirstStepStayApartInAllSteps) {
  writeRun({8000, 8000, 8000}, {1, 2, 1});
  for (const char* const time : {"0", "2", "last", "all", "1,2"})
    EXPECT_EQ(pointsOf(time), 2 * pointsOfBox()) << time;
  expectOneMesh();
}

TEST_F(TouchingBlocksTool, blocksThatAgreeAtTheFirstStepAreJoinedInAllSteps) {
  writeRun({1, 1, 1}, {1, 2, 1});
  ASSERT_GT(pointsThatTouch(), 0u);
  for (const char* const time : {"0", "1", "last", "all", "1,2"})
    EXPECT_EQ(pointsOf(time), 2 * pointsOfBox() - pointsThatTouch()) << time;
  expectOneMesh();
  const Ran ran = run("simplify run.pvd --time 1 -o warned.qtet --base-cells 600");
  EXPECT_NE(ran.err.find("points were joined with another block's point"), std::string::npos)
      << ran.err;
}

}  // namespace
}  // namespace qtet
