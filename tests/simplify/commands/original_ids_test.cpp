// --original-ids: which cell of the file each tetrahedron was split from.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "simplify/read/read_mesh.h"
#include "tests/simplify/commands/tool_run.h"
#include "tests/support/meshes.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// The voxels of a cube of side^3 within a ball, row by row, as hexahedra of a legacy file.
std::string voxelBall(int side) {
  std::map<std::array<int, 3>, std::size_t> points;
  std::string cells;
  std::size_t count = 0;
  const auto point = [&](int i, int j, int k) {
    return points.try_emplace({k, j, i}, points.size()).first->second;
  };
  for (int k = 0; k < side; ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const auto off = [&](int x) { return (x + 0.5) / side - 0.5; };
        if (off(i) * off(i) + off(j) * off(j) + off(k) * off(k) > 0.24) continue;
        ++count;
        cells += "8";
        for (const auto& [a, b, c] : {std::array{0, 0, 0},
                                      {1, 0, 0},
                                      {1, 1, 0},
                                      {0, 1, 0},
                                      {0, 0, 1},
                                      {1, 0, 1},
                                      {1, 1, 1},
                                      {0, 1, 1}})
          cells += " " + std::to_string(point(i + a, j + b, k + c));
        cells += "\n";
      }
  std::vector<std::array<int, 3>> places(points.size());
  for (const auto& [place, number] : points) places[number] = place;
  std::string text = "# vtk DataFile Version 3.0\nv\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " +
                     std::to_string(points.size()) + " float\n";
  for (const auto& [z, y, x] : places)
    text += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
  text += "CELLS " + std::to_string(count) + " " + std::to_string(9 * count) + "\n" + cells +
          "CELL_TYPES " + std::to_string(count) + "\n";
  for (std::size_t i = 0; i < count; ++i) text += "12\n";
  return text;
}

class OriginalIds : public ::testing::Test {
 protected:
  OriginalIds() { std::ofstream(folder_ / "voxels.vtk") << voxelBall(10); }

  int run(const std::string& words) {
    const std::string command = "cd '" + folder_.string() + "' && '" + testing::kTool + "' " +
                                words + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  nlohmann::json json(const std::string& words) {
    EXPECT_EQ(run(words + " --json"), 0) << contentOf(folder_ / "err.txt");
    return nlohmann::json::parse(contentOf(folder_ / "out.txt"));
  }
  TetMesh read(const std::string& name, bool originalIds = false) {
    ReadOptions options;
    options.originalIds = originalIds;
    Result<ReadMesh> out = readMesh(folder_ / name, options);
    EXPECT_TRUE(out) << out.error().text();
    return out ? std::move(out->mesh) : TetMesh{};
  }

  fs::path folder_ = testing::freshFolder(
      std::string("ids-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(OriginalIds, areLeftOutUnlessAskedFor) {
  const nlohmann::json plain = json("simplify voxels.vtk -o plain.qtet");
  EXPECT_TRUE(plain["bytesOf"]["fields"].empty());
  EXPECT_FALSE(plain.contains("kept"));
  ASSERT_EQ(run("convert voxels.vtk -o plain.vtu"), 0);
  EXPECT_TRUE(read("plain.vtu").fields.empty());
  ASSERT_EQ(run("convert voxels.vtk -o ids.vtu --original-ids"), 0);
  ASSERT_EQ(read("ids.vtu").fields.size(), 1u);
  EXPECT_EQ(read("ids.vtu").fields[0].name, kOriginalCellField);
}

TEST_F(OriginalIds, comeBackWithTheLastLevel) {
  const nlohmann::json made = json("simplify voxels.vtk -o ids.qtet --original-ids");
  EXPECT_TRUE(made["bytesOf"]["fields"].empty());
  ASSERT_TRUE(made["kept"].contains("original cells"));
  ASSERT_EQ(run("extract ids.qtet --ratio 1 -o back.vtu"), 0);
  const TetMesh back = read("back.vtu"), input = read("voxels.vtk", true);
  ASSERT_EQ(back.fields.size(), 1u);
  EXPECT_EQ(back.fields[0].name, kOriginalCellField);
  EXPECT_EQ(back.fields[0].type, "int32");
  EXPECT_EQ(back.fields[0].values, input.fields[0].values);
  EXPECT_EQ(back.tetrahedra, input.tetrahedra);
  ASSERT_EQ(run("extract ids.qtet --level 0 -o base.vtu"), 0);
  EXPECT_TRUE(read("base.vtu").fields.empty());
}

TEST_F(OriginalIds, areChosenByName) {
  ASSERT_EQ(run("simplify voxels.vtk -o ids.qtet --original-ids"), 0);
  ASSERT_EQ(run("extract ids.qtet --ratio 1 -o none.vtu --fields none"), 0);
  EXPECT_TRUE(read("none.vtu").fields.empty());
  ASSERT_EQ(run("extract ids.qtet --ratio 1 -o one.vtu --fields OriginalCellId"), 0);
  EXPECT_EQ(read("one.vtu").fields.size(), 1u);
  EXPECT_EQ(run("extract ids.qtet --level 0 -o one.vtu --fields OriginalCellId"), 1);
  EXPECT_NE(contentOf(folder_ / "err.txt").find("for the last level alone"), std::string::npos);
  // as an ordinary field, at every level
  const nlohmann::json made = json("simplify voxels.vtk -o field.qtet --fields OriginalCellId");
  EXPECT_EQ(made["bytesOf"]["fields"].size(), 1u);
}

TEST_F(OriginalIds, takeHalfOfWhatTheFieldTakesOrLess) {
  // large enough for orders to be coded in runs
  std::ofstream(folder_ / "voxels.vtk") << voxelBall(20);
  const nlohmann::json field = json("simplify voxels.vtk -o field.qtet --fields OriginalCellId"),
                       kept = json("simplify voxels.vtk -o ids.qtet --original-ids");
  std::size_t bytes = 0;
  for (const auto& [name, size] : kept["kept"].items()) bytes += size.get<std::size_t>();
  EXPECT_LE(2 * bytes, field["bytesOf"]["fields"].begin()->get<std::size_t>()) << kept["kept"];
  EXPECT_LE(kept["kept"]["original cells"], 100);
}

TEST_F(OriginalIds, areVerified) {
  ASSERT_EQ(run("simplify voxels.vtk -o ids.qtet --original-ids --lossless"), 0);
  const nlohmann::json proof = json("verify ids.qtet --against voxels.vtk")["against"]["kept"];
  EXPECT_EQ(proof["originalCells"], true);
  EXPECT_EQ(proof["positions"], true);
  // the same tetrahedra, but no cells that they were split from
  ASSERT_EQ(run("convert voxels.vtk -o split.vtu"), 0);
  EXPECT_EQ(run("verify ids.qtet --against split.vtu"), 1);
  EXPECT_NE(contentOf(folder_ / "err.txt").find("no cell of the file was split"),
            std::string::npos);
}

TEST_F(OriginalIds, areSaidToBeNeedlessWhereNothingWasSplit) {
  ASSERT_EQ(run("sample box -o box.vtu"), 0);
  ASSERT_EQ(run("simplify box.vtu -o box.qtet --original-ids"), 0);
  EXPECT_NE(contentOf(folder_ / "err.txt").find("no cell was split"), std::string::npos);
}

}  // namespace
}  // namespace qtet
