// The reports of --json about files that were written: by extract, convert, add-field and
// remove-field.

#include <gmock/gmock.h>

#include <algorithm>

#include "simplify/read/read_mesh.h"
#include "simplify/samples/samples.h"
#include "tests/simplify/commands/tool_run.h"

namespace qtet {
namespace {

using Json = nlohmann::json;
using ::testing::ElementsAre;

std::vector<std::string> namesOf(const Json& fields) {
  std::vector<std::string> out;
  for (const Json& field : fields) out.push_back(field["name"]);
  return out;
}

class WrittenJson : public Tool {
 protected:
  /// box.vtu and box.qtet, with the point field Scalar and the cell field Part.
  void SetUp() override {
    TetMesh mesh = boxSample();
    MeshField part{"Part", 1, "uint8", {}, "cell"};
    for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i)
      part.values.push_back(static_cast<double>(i % 3));
    mesh.fields.push_back(part);
    write("box.vtu", mesh);
    ASSERT_EQ(run("simplify box.vtu -o box.qtet").code, 0);
  }
};

TEST_F(WrittenJson, extractTellsTheLevelAndItsErrors) {
  const Json levels = run("info box.qtet --json").json()["levels"];
  const auto measured = std::find_if(levels.begin() + 1, levels.end(),
                                     [](const Json& one) { return one.contains("error"); });
  ASSERT_NE(measured, levels.end());
  const Json& level = *measured;
  const Ran ran =
      run("extract box.qtet --level " + level["level"].dump() + " -o level.vtu --json --quiet");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const Json told = ran.json();
  EXPECT_EQ(told["output"], "level.vtu");
  EXPECT_EQ(told["input"], "box.qtet");
  EXPECT_EQ(told["kind"], "vtu");
  EXPECT_EQ(told["bytes"], std::filesystem::file_size(folder_ / "level.vtu"));
  for (const char* same : {"level", "tetrahedra", "vertices", "boundaryTriangles", "error"})
    EXPECT_EQ(told[same], level[same]) << same;
  const Result<ReadMesh> read = readMesh(folder_ / "level.vtu");
  ASSERT_TRUE(read);
  EXPECT_EQ(told["tetrahedra"], read->mesh.tetrahedra.size());
  EXPECT_EQ(told["vertices"], read->mesh.points.size());
  EXPECT_THAT(namesOf(told["fields"]), ElementsAre("Scalar", "Part"));
  EXPECT_EQ(told["fields"][1]["association"], "cell");
}

TEST_F(WrittenJson, onlyFieldsThatTheFileHoldsAreNamed) {
  const Json errors = run("info box.qtet --json").json()["levels"][0]["error"]["fields"];
  const Json chosen = run("extract box.qtet --level 0 --fields Part -o a.vtu --json").json();
  EXPECT_THAT(namesOf(chosen["fields"]), ElementsAre("Part"));
  EXPECT_EQ(chosen["error"]["fields"], Json::array({errors[1]}));
  const Json surface = run("extract box.qtet --level 0 -o a.glb --json").json();
  EXPECT_THAT(namesOf(surface["fields"]), ElementsAre("Scalar"));
  EXPECT_EQ(surface["error"]["fields"], Json::array({errors[0]}));
  EXPECT_TRUE(run("convert box.vtu -o a.obj --json").json()["fields"].empty());
  EXPECT_EQ(run("convert box.vtu -o a.vtk --json").json()["fields"].size(), 2u);
}

TEST_F(WrittenJson, convertTellsWhatItWroteAlsoOfALog) {
  const Json told = run("convert box.vtu -o a.msh --json").json();
  EXPECT_EQ(told["kind"], "msh");
  EXPECT_EQ(told["tetrahedra"], 3072);
  EXPECT_EQ(told["vertices"], 729);
  EXPECT_EQ(told["bytes"], std::filesystem::file_size(folder_ / "a.msh"));
  const Json log = run("convert box.qtet -o b --to msh --json").json();
  EXPECT_EQ(log["kind"], "msh");
  EXPECT_EQ(log["level"], log["levels"]);
  EXPECT_EQ(log["tetrahedra"], 3072);
  EXPECT_EQ(run("convert no.vtu -o a.msh --json").json()["error"]["code"], "not-found");
  EXPECT_EQ(run("extract no.qtet --level 0 -o a.msh --json").json()["error"]["code"], "io");
  expectFailure("extract box.qtet --level 0 --to vtu -o - --json", 2, "both want");
}

TEST_F(WrittenJson, addedAndRemovedFieldsAreTold) {
  const Json removed = run("remove-field box.qtet --fields Part -o less.qtet --json").json();
  EXPECT_EQ(removed["fields"], Json::array({"Scalar"}));
  EXPECT_EQ(removed["bytes"], std::filesystem::file_size(folder_ / "less.qtet"));
  EXPECT_EQ(removed["bytesBefore"], std::filesystem::file_size(folder_ / "box.qtet"));
  const Json added =
      run("add-field less.qtet --from box.vtu --fields Part -o more.qtet --json").json();
  EXPECT_EQ(added["output"], "more.qtet");
  EXPECT_EQ(added["fields"], (Json{"Scalar", "Part"}));
  const Json info = run("info more.qtet --json").json();
  EXPECT_EQ(added["digest"], info["digest"]);
  ASSERT_EQ(added["added"].size(), 1u);
  for (const char* same : {"name", "association", "type", "bits", "step", "range", "bytes"})
    EXPECT_EQ(added["added"][0][same], info["fields"][1][same]) << same;
  EXPECT_EQ(added["added"][0]["error"], info["levels"][0]["error"]["fields"][1]);
  EXPECT_EQ(run("add-field more.qtet --from no.vtu --json").json()["error"]["code"], "not-found");
}

}  // namespace
}  // namespace qtet
