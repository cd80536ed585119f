// Lists of one value for all, whose length no bytes of their file bound, and the time to read.
#include "simplify/read/foam/foam_list.h"

#include <gtest/gtest.h>

#include <fstream>

#include "simplify/read/foam/poly_mesh.h"
#include "tests/simplify/mesh/tet_meshes.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
constexpr std::chrono::seconds kNoTimeLeft{-100};
const std::string kHeader = "FoamFile\n{\n version 2.0;\n format ascii;\n class list;\n}\n";

FoamList listOf(const std::string& body) {
  return FoamList::open(testing::fileWith("list", kHeader + body)).value();
}

Status allFaces(FoamList list) {
  return list.faces([](std::span<const FoamList::Label>) { return Status{}; });
}

TEST(FoamList, oneValueForAllIsReadUpToWhatTheCallerAllows) {
  for (const std::uint64_t most : {11, 12, 13}) {
    const auto labels = listOf("12{7}\n").labels(most);
    ASSERT_EQ(labels.has_value(), most >= 12) << most;
    if (labels) {
      EXPECT_EQ(*labels, std::vector<FoamList::Label>(12, 7));
      continue;
    }
    EXPECT_EQ(labels.error().code, ErrorCode::kBadInput);
    EXPECT_NE(labels.error().message.find("line 7: a list N{VALUE} says that it has 12 labels, "
                                          "but at most 11 are possible"),
              std::string::npos)
        << labels.error().message;
  }
  EXPECT_FALSE(listOf("-1{7}\n").labels(12));
}

TEST(FoamList, facesOfOneValueHaveTogetherAtMostAsManyCornersAsTheFileHasBytes) {
  const std::size_t size = (kHeader + "2\n(\n10{1}\n3{1}\n)\n").size();
  const auto faces = [](std::size_t first, std::size_t second) {
    return allFaces(
        listOf("2\n(\n" + std::to_string(first) + "{1}\n" + std::to_string(second) + "{1}\n)\n"));
  };
  ASSERT_LT(size, 100u) << "so that it has as many digits";
  EXPECT_TRUE(faces(10, 3));
  EXPECT_TRUE(faces(size - 3, 3));
  EXPECT_FALSE(faces(size - 2, 3));
  EXPECT_FALSE(faces(16'777'216, 3));
}

TEST(FoamList, facesAfterSpentOnesMayStillNameTheirCorners) {
  const std::string body = "2\n(\n10{1}\n4(0 1 2 3)\n)\n";
  const std::size_t size = (kHeader + body).size();
  ASSERT_LT(size, 100u) << "so that it has as many digits";
  EXPECT_TRUE(allFaces(listOf("2\n(\n" + std::to_string(size) + "{1}\n4(0 1 2 3)\n)\n")));
}

TEST(FoamList, everyLabelIsReadInTime) {
  const fs::path path = testing::fileWith("list", kHeader + "2\n(\n0\n1\n)\n");
  EXPECT_TRUE(FoamList::open(path).value().labels(2));
  const auto late = FoamList::open(path, kNoTimeLeft).value().labels(2);
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, ErrorCode::kBadInput);
  EXPECT_NE(late.error().message.find("`readSeconds`"), std::string::npos) << late.error().message;
}

TEST(PolyMesh, ownersOfOneValueAreAsManyAsThereAreFaces) {
  const fs::path mesh = testing::freshFolder("uniform-owners") / "constant/polyMesh";
  fs::create_directories(mesh);
  const auto write = [&](const char* name, const std::string& body) {
    std::ofstream(mesh / name) << kHeader << body;
  };
  write("points", "4\n(\n(0 0 0)\n(1 0 0)\n(0 1 0)\n(0 0 1)\n)\n");
  write("faces", "4\n(\n3(0 2 1)\n3(0 1 3)\n3(0 3 2)\n3(1 2 3)\n)\n");
  write("neighbour", "0\n(\n)\n");
  write("boundary", "1\n(\nwalls\n{\n type wall;\n nFaces 4;\n startFace 0;\n}\n)\n");
  write("owner", "4{0}\n");
  const auto cells = checkPolyMeshes(mesh / "../..");
  ASSERT_TRUE(cells) << cells.error().message;
  EXPECT_EQ(*cells, 1u);
  write("owner", "16777216{0}\n");
  const auto more = checkPolyMeshes(mesh / "../..");
  ASSERT_FALSE(more);
  EXPECT_NE(more.error().message.find("at most 4 are possible"), std::string::npos)
      << more.error().message;
  const auto late = checkPolyMeshes(mesh / "../..", kNoTimeLeft);
  ASSERT_FALSE(late);
  EXPECT_NE(late.error().message.find("`readSeconds`"), std::string::npos) << late.error().message;
}

}  // namespace
}  // namespace qtet
