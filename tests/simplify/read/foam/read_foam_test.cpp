// Cases of OpenFOAM: their times, regions and moving points.
#include <gtest/gtest.h>

#include <algorithm>

#include "simplify/clean/clean_mesh.h"
#include "simplify/read/read_mesh.h"
#include "tests/simplify/mesh/tet_meshes.h"
#include "tests/simplify/read/foam/foam_files.h"
#include "tests/simplify/split/cell_grids.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using testing::filledBy;
using testing::writeFoamField;
using Names = std::vector<std::string>;

/// Two cubes with p and q of 5 and 7 at time 1; gives the case's marker.
fs::path twoCubesCase() {
  const fs::path marker = testing::fileWith("case.foam", ""), folder = marker.parent_path();
  testing::writeTwoCubes(folder / "constant/polyMesh");
  for (const char* name : {"p", "q"})
    writeFoamField(folder / "1" / name, "volScalarField",
                   "nonuniform List<scalar> \n2\n(\n5\n7\n)\n");
  return marker;
}

ReadMesh readAt(const fs::path& path, const std::string& time,
                const FieldNames& fields = std::nullopt) {
  ReadOptions options;
  options.time = time;
  options.fields = fields;
  Result<ReadMesh> read = readMesh(path, options);
  EXPECT_TRUE(read) << read.error().text();
  return read ? std::move(*read) : ReadMesh{};
}

std::string refusalAt(const fs::path& path, const std::string& time) {
  ReadOptions options;
  options.time = time;
  const Result<ReadMesh> read = readMesh(path, options);
  EXPECT_FALSE(read);
  return read ? "" : read.error().message;
}

bool hasNote(const ReadMesh& read, const std::string& part) {
  return std::ranges::any_of(read.report.notes,
                             [&](const std::string& note) { return note.contains(part); });
}

Names fieldsIn(const ReadMesh& read) {
  Names out;
  for (const MeshField& field : read.mesh.fields)
    out.push_back(field.association + ":" + field.name);
  return out;
}

TEST(ReadFoam, casesWithPolyhedraAreRead) {
  const Result<ReadMesh> read = readMesh(twoCubesCase());
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_NEAR(filledBy(read->mesh).volume, 2, 1e-9);
  EXPECT_EQ(filledBy(read->mesh).openEdges, 0u);
  EXPECT_EQ(filledBy(read->mesh).notPositive, 0u);
  EXPECT_EQ(read->report.split.cells[kPolyhedronCell], 1u);
}

TEST(ReadFoam, aCaseIsItsFolderToo) {
  const fs::path marker = twoCubesCase(), folder = marker.parent_path();
  ASSERT_TRUE(fs::remove(marker));
  for (const fs::path& named : {folder, folder / "", folder / "."}) {
    const Result<ReadMesh> read = readMesh(named);
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_NEAR(filledBy(read->mesh).volume, 2, 1e-9) << named;
    EXPECT_EQ(read->report.times, std::vector<double>{1});
  }
  EXPECT_NE(refusalAt(folder, "4").find("no time step 4"), std::string::npos);
  fs::create_directory(folder / "processors2");
  fs::remove_all(folder / "constant");
  EXPECT_NE(refusalAt(folder, "last").find("reconstructPar"), std::string::npos);
}

TEST(ReadFoam, meansAtPointsAreReadAndCellValuesByName) {
  const fs::path file = twoCubesCase();
  const auto fieldsOf = [&](const FieldNames& names) {
    return fieldsIn(readAt(file, "last", names));
  };
  EXPECT_EQ(fieldsOf(std::nullopt), (Names{"point:p", "point:q"}));
  EXPECT_EQ(fieldsOf(Names{"p"}), Names{"point:p"});
  EXPECT_EQ(fieldsOf(Names{"point:p"}), Names{"point:p"});
  EXPECT_EQ(fieldsOf(Names{"cell:p"}), Names{"cell:p"});
  EXPECT_EQ(fieldsOf(Names{"cell:q", "point:p"}), (Names{"cell:q", "point:p"}));
  const ReadMesh all = readAt(file, "last");
  EXPECT_TRUE(hasNote(all, "`fields` cell:p keeps those of cells"));
  // 5 and 7 in cubes of one volume: their mean at the four points that they share
  for (std::size_t v = 0; v < all.mesh.points.size(); ++v) {
    const double x = all.mesh.points[v][0];
    EXPECT_DOUBLE_EQ(all.mesh.fields[0].values[v], x < 0.5 ? 5 : x < 1.5 ? 6 : 7) << v;
  }
  EXPECT_FALSE(readMesh(file, Names{"r"}));
}

TEST(ReadFoam, timesAreFoldersThatAreCalledByNumbers) {
  const fs::path marker = twoCubesCase(), folder = marker.parent_path();
  for (const char* name : {"0", "1.000", "1e-05", "-2", ".5", "0.orig", "1x", "10"})
    fs::create_directory(folder / name);
  std::ofstream(folder / "3") << "a file";
  const ReadMesh read = readAt(marker, "1");
  EXPECT_EQ(read.report.times, (std::vector<double>{-2, 0, 1e-05, 1, 10}));
  EXPECT_TRUE(hasNote(read, "1.000 has the time of "));
  EXPECT_EQ(fieldsIn(read), (Names{"point:p", "point:q"}));
  EXPECT_EQ(fieldsIn(readAt(marker, "10")), Names{});
}

TEST(ReadFoam, withoutATimeTheFolderConstantHasTheFields) {
  const fs::path marker = twoCubesCase(), folder = marker.parent_path();
  fs::rename(folder / "1/p", folder / "constant/p");
  fs::remove_all(folder / "1");
  const ReadMesh read = readAt(marker, "last");
  EXPECT_EQ(read.report.times, std::vector<double>{0});
  EXPECT_EQ(fieldsIn(read), Names{"point:p"});
}

TEST(ReadFoam, pointsThatMoveAreThoseOfTheLatestTimeThatHasSome) {
  const fs::path marker = twoCubesCase(), folder = marker.parent_path();
  for (const char* time : {"0", "2", "3"})
    writeFoamField(folder / time / "p", "volScalarField", "uniform 1");
  const fs::path moved = testing::freshFolder("moved");
  testing::writeTwoCubes(moved, 3);
  fs::create_directories(folder / "2/polyMesh");
  fs::copy_file(moved / "points", folder / "2/polyMesh/points");
  EXPECT_EQ(readAt(marker, "1").mesh.points[0][0], 0);
  EXPECT_EQ(readAt(marker, "2").mesh.points[0][0], 3);
  EXPECT_EQ(readAt(marker, "3").mesh.points[0][0], 3);
  const ReadMesh all = readAt(marker, "all");
  EXPECT_EQ(all.report.motion, "Displacement");
  const auto last = std::ranges::find(all.mesh.fields, "Displacement@3", &MeshField::name);
  ASSERT_NE(last, all.mesh.fields.end());
  EXPECT_EQ(last->values[0], 3);
  testing::writeOneTetrahedron(moved);
  fs::copy_file(moved / "points", folder / "2/polyMesh/points",
                fs::copy_options::overwrite_existing);
  EXPECT_NE(refusalAt(marker, "1,2").find("it has 4 points, but the mesh of "), std::string::npos);
  EXPECT_NE(refusalAt(marker, "3").find("none of the 4 points"), std::string::npos);
}

TEST(ReadFoam, aMeshThatChangesIsThatOfTheLatestTimeThatHasOne) {
  const fs::path marker = twoCubesCase(), folder = marker.parent_path();
  testing::writeOneTetrahedron(folder / "2/polyMesh");
  for (const char* time : {"2", "3"})
    writeFoamField(folder / time / "p", "volScalarField", "nonuniform List<scalar> 1(4)");
  EXPECT_NEAR(filledBy(readAt(marker, "1").mesh).volume, 2, 1e-9);
  for (const char* time : {"2", "3"})
    EXPECT_NEAR(filledBy(readAt(marker, time).mesh).volume, 1.0 / 6, 1e-9) << time;
  fs::remove(folder / "2/polyMesh/points");
  EXPECT_NE(refusalAt(marker, "3").find("2/polyMesh/points"), std::string::npos);
}

TEST(ReadFoam, regionsOfOtherValuesStayApartWhateverIsRead) {
  const fs::path marker = testing::fileWith("regions.foam", ""), folder = marker.parent_path();
  testing::writeTwoCubes(folder / "constant/fluid/polyMesh");
  testing::writeTwoCubes(folder / "constant/solid/polyMesh", 2);
  for (const auto& [region, value] : {std::pair{"fluid", "1"}, std::pair{"solid", "8000"}})
    writeFoamField(folder / "0" / region / "rho", "volScalarField",
                   std::string("uniform ") + value);
  writeFoamField(folder / "0/fluid/p", "volScalarField", "uniform 3");
  ReadOptions options;
  options.fields = Names{"cell:rho", "cell:p"};
  const Result<ReadMesh> read = readMesh(folder, options);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_NEAR(filledBy(read->mesh).volume, 4, 1e-9);
  EXPECT_EQ(read->report.joinedPoints, 0u);
  EXPECT_TRUE(hasNote(*read, "p is not in 1 of 2 blocks"));
  for (std::size_t i = 0; i < read->mesh.tetrahedra.size(); ++i) {
    double x = 0;
    for (const VertexId v : read->mesh.tetrahedra[i]) x += read->mesh.points[v][0] / 4;
    EXPECT_EQ(read->mesh.fields[0].values[i], x < 2 ? 1 : 8000) << i;
  }
  testing::writeTwoCubes(folder / "constant/polyMesh", -2);
  EXPECT_NEAR(filledBy(readAt(marker, "last").mesh).volume, 6, 1e-9);
}

const MeshField* labelOf(const ReadMesh& read, const std::string& name) {
  const auto at = std::ranges::find(read.mesh.fields, FieldName(name), &MeshField::name);
  return at == read.mesh.fields.end() ? nullptr : &*at;
}

// A mean across two regions would be a value of neither.
TEST(ReadFoam, pointsOfRegionsKeepTheValuesOfTheirRegion) {
  const fs::path folder = testing::freshFolder("regions-apart");
  testing::writeTwoCubes(folder / "constant/fluid/polyMesh");
  testing::writeTwoCubes(folder / "constant/solid/polyMesh", 2);
  for (const auto& [region, value] : {std::pair{"fluid", "1"}, std::pair{"solid", "8000"}})
    for (const char* time : {"0", "1"})
      writeFoamField(folder / time / region / "rho", "volScalarField",
                     std::string("uniform ") + value);
  const ReadMesh read = readAt(folder, "last");
  EXPECT_TRUE(hasNote(read, "4 points lie at the place of another block's point"));
  EXPECT_TRUE(hasNote(read, "`weld` 0 joins them"));
  const MeshField *rho = labelOf(read, "rho"), *block = labelOf(read, "BlockId");
  ASSERT_TRUE(rho && block);
  EXPECT_EQ(block->labelNames, (LabelNames{{1, "fluid"}, {2, "solid"}}));
  for (std::size_t t = 0; t < read.mesh.tetrahedra.size(); ++t)
    for (const VertexId v : read.mesh.tetrahedra[t])
      EXPECT_EQ(rho->values[v], block->values[t] == 1 ? 1 : 8000) << t;
  const ReadMesh all = readAt(folder, "all");
  EXPECT_EQ(fieldsIn(all), (Names{"point:rho@0", "point:rho@1", "cell:BlockId"}));
  EXPECT_EQ(all.mesh.points.size(), read.mesh.points.size());
}

TEST(ReadFoam, zonesOfCellsAreALabel) {
  const fs::path marker = twoCubesCase(), mesh = marker.parent_path() / "constant/polyMesh";
  const auto writeZones = [&](const std::string& body) {
    testing::writeFoam(mesh / "cellZones", "regIOobject", body);
    return readAt(marker, "all");
  };
  const std::string first = "first { type cellZone; cellLabels List<label> 1(1); }\n",
                    second = "second\n{\n type cellZone;\n cellLabels\n2{1};\n}\n";
  const ReadMesh one = writeZones("1\n(\n" + first + ")\n");
  EXPECT_EQ(fieldsIn(one), (Names{"point:p", "point:q", "cell:cellZone"}));
  const MeshField* zone = labelOf(one, "cellZone");
  ASSERT_TRUE(zone);
  EXPECT_EQ(zone->labelNames, (LabelNames{{1, "first"}}));
  EXPECT_EQ(zone->values.front(), 0);
  EXPECT_EQ(zone->values.back(), 1);
  const ReadMesh two = writeZones("2\n(\n" + second + first + ")\n");
  EXPECT_TRUE(hasNote(two, "2 cells are in two zones"));
  ASSERT_TRUE(labelOf(two, "cellZone"));
  EXPECT_EQ(labelOf(two, "cellZone")->values.back(), 1) << "the first";
  for (const std::string& bad : std::vector<std::string>{
           std::string("1\n(\nx { cellLabels 1(2); }\n)\n"), "1\n(\nx { cellLabels 3{1}; }\n)\n",
           "2\n(\n" + first + ")\n", std::string("1(x { cellLabels 1(1)"), std::string("9")}) {
    const ReadMesh left = writeZones(bad);
    EXPECT_EQ(fieldsIn(left), (Names{"point:p", "point:q"})) << bad;
    EXPECT_TRUE(hasNote(left, "zones of cells were left out")) << bad;
  }
  EXPECT_EQ(fieldsIn(writeZones("0\n(\n)\n")), (Names{"point:p", "point:q"}));
}

TEST(ReadFoam, zonesAndRegionsOfProcessorsAreThoseOfTheCase) {
  const fs::path folder = testing::freshFolder("zones-of-processors");
  for (int i = 0; i < 2; ++i) {
    const fs::path piece = folder / ("processor" + std::to_string(i));
    for (const auto& [region, x] : {std::pair{"fluid", 0}, std::pair{"solid", 10}}) {
      testing::writeTwoCubes(piece / "constant" / region / "polyMesh", x + 2 * i);
      testing::writeFoam(
          piece / "constant" / region / "polyMesh/cellZones", "regIOobject",
          "2(none { cellLabels 0(); } " + std::string(region) + "Zone { cellLabels 1(0); })");
    }
  }
  const ReadMesh read = readAt(folder, "last");
  EXPECT_EQ(fieldsIn(read), (Names{"cell:BlockId", "cell:cellZone"}));
  EXPECT_EQ(read.report.joinedPoints, 4u);
  EXPECT_EQ(labelOf(read, "BlockId")->labelNames, (LabelNames{{1, "fluid"}, {2, "solid"}}));
  EXPECT_EQ(labelOf(read, "cellZone")->labelNames,
            (LabelNames{{1, "none"}, {2, "fluidZone"}, {3, "solidZone"}}));
}

TEST(ReadFoam, aRegionWithoutAMeshYetIsRefused) {
  const fs::path marker = twoCubesCase(), folder = marker.parent_path();
  testing::writeTwoCubes(folder / "2/late/polyMesh", 2);
  EXPECT_NE(refusalAt(marker, "1").find("1/late has no mesh"), std::string::npos);
  EXPECT_NEAR(filledBy(readAt(marker, "2").mesh).volume, 4, 1e-9);
}

/// Bytes of a file are cut off or changed; labels, numbers and counts go wrong everywhere.
TEST(ReadFoam, everyTruncationAndEveryChangedByteIsAnErrorOrAMesh) {
  const fs::path folder = testing::freshFolder("damaged-case"), mesh = folder / "constant/polyMesh",
                 field = folder / "1/T";
  const std::string arch = "LSB;label=32;scalar=32";
  using testing::bytesOf;
  const auto write = [](const fs::path& path, const std::string& text) {
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
  };
  testing::writeOneTetrahedron(mesh);
  const std::pair<fs::path, std::string> files[] = {
      {mesh / "points", "4(" + bytesOf<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}) + ")"},
      {mesh / "faces", "5(" + bytesOf<std::int32_t>({0, 3, 6, 9, 12}) + ")12(" +
                           bytesOf<std::int32_t>({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}) + ")"},
      {mesh / "owner", "4(" + bytesOf<std::int32_t>({0, 0, 0, 0}) + ")"},
      {field, "internalField nonuniform List<scalar> 1(" + bytesOf<float>({7}) + ");"}};
  const auto header = [&](const fs::path& path) {
    const std::string name = path.filename().string();
    return testing::foamHeader(name == "faces" ? "faceCompactList" : "volScalarField", "binary",
                               arch);
  };
  for (const auto& [path, body] : files) write(path, header(path) + body);
  const ReadMesh whole = readAt(folder, "last", Names{"cell:T"});
  EXPECT_EQ(whole.mesh.tetrahedra.size(), 1u);
  EXPECT_EQ(whole.mesh.fields[0].values, std::vector<double>{7});
  std::size_t refused = 0, tried = 0;
  const auto tryIt = [&](const fs::path& path, const std::string& body) {
    write(path, header(path) + body);
    const Result<ReadMesh> read = readMesh(folder);
    EXPECT_TRUE(read || !read.error().message.empty());
    refused += read ? 0 : 1;
    ++tried;
  };
  for (const auto& [path, body] : files) {
    for (std::size_t at = 0; at < body.size(); ++at) {
      tryIt(path, body.substr(0, at));
      std::string changed = body;
      const unsigned flip = at % 2 == 0 ? 0x01U : 0x80U;
      changed[at] = static_cast<char>(static_cast<unsigned char>(changed[at]) ^ flip);
      tryIt(path, changed);
    }
    write(path, header(path) + body);
  }
  EXPECT_GT(refused, tried / 2);
  EXPECT_LT(refused, tried);
}

TEST(ReadFoam, processorsAreReadTogether) {
  const fs::path marker = testing::fileWith("pieces.foam", ""), folder = marker.parent_path();
  for (int i = 0; i < 2; ++i) {
    const fs::path piece = folder / ("processor" + std::to_string(i));
    testing::writeTwoCubes(piece / "constant/polyMesh", 2 * i);
    writeFoamField(piece / "0.5/p", "volScalarField", "uniform " + std::to_string(i));
  }
  const ReadMesh read = readAt(marker, "last");
  EXPECT_NEAR(filledBy(read.mesh).volume, 4, 1e-9);
  EXPECT_TRUE(hasNote(read, "its 2 processors"));
  EXPECT_EQ(read.report.times, std::vector<double>{0.5});
  fs::create_directory(folder / "processor0/1");
  EXPECT_NE(refusalAt(marker, "last").find("different time steps"), std::string::npos);
}

}  // namespace
}  // namespace qtet
