#include "simplify/read/ensight/read_ensight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "simplify/read/ensight/ensight_values.h"
#include "simplify/read/read_mesh.h"
#include "tests/simplify/mesh/tet_meshes.h"
#include "tests/simplify/read/ensight/ensight_files.h"
#include "tests/simplify/split/cell_grids.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using testing::EnSightKind;
using testing::EnSightWriter;
using testing::filledBy;
using testing::kEnSightKinds;
using testing::writeBytes;

/// Where the encodings of EnSight differ, beside text and binary.
struct Dialect {
  EnSightKind kind;
  bool isGold;
};

std::vector<Dialect> dialects() {
  std::vector<Dialect> out;
  for (const EnSightKind kind : kEnSightKinds)
    for (const bool isGold : {true, false}) out.push_back({kind, isGold});
  return out;
}

/// The corners of a bar of two unit cubes.
std::vector<Position> barPoints(double stretch) {
  std::vector<Position> out;
  for (int x = 0; x < 3; ++x)
    for (const auto& [y, z] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
      out.push_back({x * stretch, static_cast<double>(y), static_cast<double>(z)});
  return out;
}

/// One cube as a hexahedron, one as two wedges, and a quadrilateral between them.
const std::vector<std::int32_t> kQuad{5, 6, 7, 8}, kHexa{1, 2, 3, 4, 5, 6, 7, 8},
    kWedges{5, 6, 7, 9, 10, 11, 5, 7, 8, 9, 11, 12};

/// `ids`: what its line says of ids; they are 10, 20 ...
std::string geometry(Dialect dialect, double stretch, const std::string& ids,
                     bool hasHeader = true) {
  EnSightWriter out(dialect.kind, dialect.isGold);
  if (hasHeader) out.header();
  out.line("a bar").line("").line("node id " + ids).line("element id " + ids);
  const std::vector<Position> points = barPoints(stretch);
  const bool hasIds = ids == "given" || ids == "ignore";
  std::vector<std::int32_t> numbers;
  for (std::size_t i = 0; i < points.size(); ++i)
    numbers.push_back(static_cast<std::int32_t>(10 * i + 10));
  if (dialect.isGold) {
    out.line("extents").reals({0, 2, 0, 1, 0, 1}, 2);
    out.line("part").integers({7}).line("").line("coordinates").integers({12});
    if (hasIds) out.integers(numbers);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::vector<float> some;
      for (const Position& p : points) some.push_back(static_cast<float>(p[axis]));
      out.reals(some);
    }
  } else {
    out.line("coordinates").integers({12});
    std::vector<float> all;
    if (hasIds && !out.isText()) out.integers(numbers);
    for (std::size_t i = 0; i < points.size(); ++i) {
      std::vector<float> some;
      for (const double x : points[i]) some.push_back(static_cast<float>(x));
      if (!out.isText()) all.insert(all.end(), some.begin(), some.end());
      if (hasIds && out.isText()) out.integers({numbers[i]});
      if (out.isText()) out.reals(some);
    }
    out.reals(all);
    out.line("part 7").line("");
  }
  const auto cells = [&](const char* kind, std::size_t nodes, std::vector<std::int32_t> corners) {
    const std::size_t count = corners.size() / nodes;
    out.line(kind).integers({static_cast<std::int32_t>(count)});
    if (!dialect.isGold && ids == "given")
      for (std::int32_t& id : corners) id *= 10;
    if (hasIds && (dialect.isGold || !out.isText()))
      out.integers(std::vector<std::int32_t>(count, 5));
    for (std::size_t i = count; hasIds && !dialect.isGold && out.isText() && i-- > 0;)
      corners.insert(corners.begin() + static_cast<std::ptrdiff_t>(i * nodes), 5);
    out.integers(corners, nodes);
  };
  cells("quad4", 4, kQuad);
  cells("hexa8", 8, kHexa);
  cells("penta6", 6, kWedges);
  return out.bytes();
}

/// A variable of nodes: components x + c, or of elements: rows + c.
std::string values(Dialect dialect, std::size_t components, bool isOfElements, float more) {
  EnSightWriter out(dialect.kind, dialect.isGold);
  const auto put = [&](std::vector<float> tuples) {
    std::vector<float> all;
    for (std::size_t i = 0; i < tuples.size() * components; ++i) {
      const std::size_t tuple = dialect.isGold ? i % tuples.size() : i / components,
                        c = dialect.isGold ? i / tuples.size() : i % components;
      all.push_back(tuples[tuple] + more + static_cast<float>(c));
    }
    out.reals(all);
  };
  out.line("values");
  if (dialect.isGold)
    out.line("part").integers({7});
  else if (isOfElements)
    out.line("part 7");
  if (isOfElements) {
    out.line("quad4"), put({0});
    out.line("hexa8"), put({1});
    out.line("penta6"), put({2, 3});
  } else {
    if (dialect.isGold) out.line("coordinates");
    put({0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2});
  }
  return out.bytes();
}

std::string front(Dialect dialect) {
  return std::string("FORMAT\ntype: ensight") + (dialect.isGold ? " gold" : "") + "\nGEOMETRY\n";
}

const MeshField* fieldOf(const CellMesh& mesh, const std::string& name) {
  const auto at = std::ranges::find(mesh.fields, FieldName(name), &MeshField::name);
  return at == mesh.fields.end() ? nullptr : &*at;
}

/// The mesh of the case's step, which must be read.
CellMesh readCase(const fs::path& path, const std::string& time = "last",
                  ReadReport* report = nullptr) {
  ReadOptions options;
  options.time = time;
  ReadReport own;
  Result<std::vector<TimedCells>> read = readEnSight(path, options, report ? *report : own);
  EXPECT_TRUE(read) << read.error().text();
  return read && !read->empty() ? std::move(read->back().cells) : CellMesh{};
}

std::string refusal(const fs::path& path) {
  ReadReport report;
  const Result<std::vector<TimedCells>> read = readEnSight(path, {}, report);
  EXPECT_FALSE(read);
  return read ? "" : read.error().message;
}

/// A case of one step with the geometry and one variable.
fs::path caseWith(Dialect dialect, const std::string& geo, const std::string& variable,
                  const std::string& bytes) {
  const fs::path path = testing::fileWith(
      "one.case", front(dialect) + "model: one.geo\nVARIABLE\n" + variable + ": V one.V\n");
  writeBytes(path.parent_path() / "one.geo", geo);
  writeBytes(path.parent_path() / "one.V", bytes);
  return path;
}

TEST(ReadEnSight, everyKindOfFileGivesTheSameMesh) {
  for (const Dialect dialect : dialects()) {
    for (const char* ids : {"off", "assign", "given", "ignore"}) {
      const fs::path path = testing::fileWith(
          "bar.case", front(dialect) +
                          "model: bar.geo\nVARIABLE\nscalar per node: T bar.T\nvector per node: U "
                          "bar.U\ntensor symm per element: S bar.S\n");
      const fs::path folder = path.parent_path();
      writeBytes(folder / "bar.geo", geometry(dialect, 1, ids));
      writeBytes(folder / "bar.T", values(dialect, 1, false, 0));
      writeBytes(folder / "bar.U", values(dialect, 3, false, 0.5F));
      writeBytes(folder / "bar.S", values(dialect, 6, true, 0));
      SCOPED_TRACE(std::string(ids) + (dialect.isGold ? " gold " : " 6 ") +
                   std::to_string(static_cast<int>(dialect.kind)));
      ReadReport report;
      const CellMesh mesh = readCase(path, "last", &report);
      EXPECT_EQ(mesh.points, barPoints(1));
      EXPECT_EQ(mesh.pointType, "float32");
      EXPECT_EQ(mesh.types, (std::vector<std::uint8_t>{kHexahedronCell, kWedgeCell, kWedgeCell}));
      EXPECT_EQ(mesh.vertices, (std::vector<VertexId>{0, 1, 2,  3, 4, 5, 6, 7, 4,  6,
                                                      5, 8, 10, 9, 4, 7, 6, 8, 11, 10}));
      EXPECT_EQ(mesh.cellIds, (std::vector<std::uint64_t>{1, 2, 3}));
      EXPECT_EQ(report.ignoredCells, 1u);
      const MeshField *t = fieldOf(mesh, "T"), *u = fieldOf(mesh, "U"), *s = fieldOf(mesh, "S");
      ASSERT_TRUE(t && u && s);
      for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        EXPECT_EQ(t->values[i], mesh.points[i][0]);
        for (std::size_t c = 0; c < 3; ++c)
          EXPECT_EQ(u->values[3 * i + c], mesh.points[i][0] + 0.5 + static_cast<double>(c));
      }
      EXPECT_EQ(s->values,
                (std::vector<double>{1, 2, 3, 4, 6, 5, 2, 3, 4, 5, 7, 6, 3, 4, 5, 6, 8, 7}))
          << "VTK's order: xy, yz, xz";
      const Result<ReadMesh> whole = readMesh(path);
      ASSERT_TRUE(whole) << whole.error().text();
      EXPECT_NEAR(filledBy(whole->mesh).volume, 2, 1e-9);
      EXPECT_EQ(filledBy(whole->mesh).openEdges, 0u);
    }
  }
}

constexpr const char* kSteps =
    "TIME\ntime set: 1\nnumber of steps: 3\nfilename start number: 8\nfilename increment: 2\n"
    "time values: 0 0.5 1\n";

void expectSteps(const fs::path& path) {
  for (const auto& [time, stretch] : {std::pair{"0", 1.0}, {"0.5", 1.5}, {"last", 2.0}}) {
    const CellMesh mesh = readCase(path, time);
    EXPECT_EQ(mesh.points, barPoints(stretch)) << time;
    const MeshField* t = fieldOf(mesh, "T");
    ASSERT_TRUE(t);
    EXPECT_EQ(t->values.front(), 10 * stretch) << time;
  }
  ReadOptions options;
  options.time = "all";
  const Result<ReadMesh> all = readMesh(path, options);
  ASSERT_TRUE(all) << all.error().text();
  EXPECT_EQ(all->report.times, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(all->report.motion, "Displacement");
  EXPECT_EQ(all->mesh.fields.size(), 6u);
}

TEST(ReadEnSight, stepsMayBeFilesOfTheirOwn) {
  for (const Dialect dialect : dialects()) {
    const fs::path path =
        testing::fileWith("run.case", front(dialect) +
                                          "model: 1 run.***.geo\nVARIABLE\nscalar per node: 1 T "
                                          "run.*.T\n" +
                                          kSteps);
    for (int step = 0; step < 3; ++step) {
      const std::string number = std::to_string(8 + 2 * step);
      writeBytes(
          path.parent_path() / ("run." + std::string(3 - number.size(), '0') + number + ".geo"),
          geometry(dialect, 1 + 0.5 * step, "assign"));
      writeBytes(path.parent_path() / ("run." + number + ".T"),
                 values(dialect, 1, false, static_cast<float>(10 + 5 * step)));
    }
    expectSteps(path);
  }
}

TEST(ReadEnSight, stepsMayStandInOneFile) {
  for (const Dialect dialect : dialects()) {
    const fs::path path = testing::fileWith(
        "run.case", front(dialect) +
                        "model: 1 1 run.geo\nVARIABLE\nscalar per node: 1 1 T run.T\n" + kSteps +
                        "FILE\nfile set: 1\nnumber of steps: 3\n");
    std::string geo = EnSightWriter(dialect.kind, true).header().bytes(), variable;
    const auto within = [&](const std::string& bytes) {
      return EnSightWriter(dialect.kind, true).line("BEGIN TIME STEP").bytes() + bytes +
             EnSightWriter(dialect.kind, true).line("END TIME STEP").bytes();
    };
    for (int step = 0; step < 3; ++step) {
      geo += within(geometry(dialect, 1 + 0.5 * step, "given", false));
      variable += within(values(dialect, 1, false, static_cast<float>(10 + 5 * step)));
    }
    writeBytes(path.parent_path() / "run.geo", geo);
    writeBytes(path.parent_path() / "run.T", variable);
    expectSteps(path);
    writeBytes(path.parent_path() / "run.T", variable.substr(0, variable.size() / 3));
    EXPECT_NE(refusal(path).find("it holds 1 steps, but step 2"), std::string::npos)
        << refusal(path);
  }
}

TEST(ReadEnSight, cellsOfOneStepMayHoldForAll) {
  const Dialect dialect{EnSightKind::kBig, true};
  const fs::path path = testing::fileWith(
      "run.case", front(dialect) + "model: 1 run.***.geo change_coords_only 1\n" + kSteps);
  const fs::path folder = path.parent_path();
  for (const int step : {0, 2}) {
    const std::string whole = geometry(dialect, 1 + 0.5 * step, "assign");
    writeBytes(folder / (step == 0 ? "run.008.geo" : "run.012.geo"),
               whole.substr(0, whole.find("quad4")));
  }
  writeBytes(folder / "run.010.geo", geometry(dialect, 1.5, "assign"));
  for (const auto& [time, stretch] : {std::pair{"0", 1.0}, {"0.5", 1.5}, {"1", 2.0}}) {
    ReadReport report;
    const CellMesh mesh = readCase(path, time, &report);
    EXPECT_EQ(mesh.points, barPoints(stretch));
    EXPECT_EQ(mesh.cells(), 3u);
    EXPECT_EQ(report.ignoredCells, 1u);
  }
  EnSightWriter none(dialect.kind, true);
  none.header().line("").line("").line("node id off").line("element id off");
  writeBytes(folder / "run.012.geo", none.bytes());
  EXPECT_NE(refusal(path).find("change_coords_only"), std::string::npos);
}

/// A part of Gold whose cells follow; its points are those of the bar.
EnSightWriter partOfGold(EnSightKind kind, bool hasNodes = true) {
  EnSightWriter out(kind, true);
  out.header().line("").line("").line("node id off").line("element id off");
  out.line("part").integers({7}).line("");
  if (!hasNodes) return out;
  out.line("coordinates").integers({12});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<float> some;
    for (const Position& p : barPoints(1)) some.push_back(static_cast<float>(p[axis]));
    out.reals(some);
  }
  return out;
}

TEST(ReadEnSight, polyhedraAreReadAndPolygonsAndGhostsLeftOut) {
  for (const EnSightKind kind : kEnSightKinds) {
    EnSightWriter geo = partOfGold(kind);
    geo.line("nsided").integers({2}).integers({3, 4}).integers({1, 2, 3, 1, 2, 3, 4});
    geo.line("g_hexa8").integers({1}).integers(kHexa, 8);
    geo.line("nfaced").integers({1}).integers({6}).integers({4, 4, 4, 4, 4, 4});
    geo.integers({1, 4, 3, 2, 5, 6, 7, 8, 1, 2, 6, 5, 2, 3, 7, 6, 3, 4, 8, 7, 4, 1, 5, 8}, 4);
    EnSightWriter variable(kind, true);
    variable.line("").line("part").integers({7}).line("nsided").reals({1, 2});
    variable.line("g_hexa8").reals({3}).line("nfaced").reals({4});
    const fs::path path =
        caseWith({kind, true}, geo.bytes(), "scalar per element", variable.bytes());
    ReadReport report;
    const CellMesh mesh = readCase(path, "last", &report);
    EXPECT_EQ(mesh.types, std::vector<std::uint8_t>{kPolyhedronCell});
    EXPECT_EQ(mesh.cellIds, std::vector<std::uint64_t>{3});
    EXPECT_EQ(report.ignoredCells, 2u);
    ASSERT_TRUE(fieldOf(mesh, "V"));
    EXPECT_EQ(fieldOf(mesh, "V")->values, std::vector<double>{4});
    const Result<ReadMesh> whole = readMesh(path);
    ASSERT_TRUE(whole) << whole.error().text();
    EXPECT_NEAR(filledBy(whole->mesh).volume, 1, 1e-9);
  }
}

TEST(ReadEnSight, gridsBecomeHexahedraWithoutThoseThatAreBlank) {
  for (const EnSightKind kind : kEnSightKinds) {
    for (const char* grid : {"block", "block rectilinear", "block uniform", "block iblanked",
                             "block uniform with_ghost", "block uniform range"}) {
      const std::string line = grid;
      EnSightWriter geo = partOfGold(kind, false);
      const bool isRange = line.ends_with("range");
      geo.line(line).integers(isRange ? std::vector{9, 9, 9} : std::vector{3, 2, 2}, 3);
      if (isRange) geo.integers({1, 3, 2, 3, 4, 5}, 6);
      if (line.contains("uniform"))
        geo.reals({0, 0, 0, 1, 1, 1});
      else if (line.contains("rectilinear"))
        geo.reals({0, 1, 2, 0, 1, 0, 1});
      else
        geo.reals({0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2})
            .reals({0, 0, 0, 1, 1, 1, 0, 0, 0, 1, 1, 1})
            .reals({0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1});
      const bool isBlank = line.ends_with("iblanked"), isGhost = line.ends_with("ghost");
      if (isBlank) geo.integers({0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1});
      if (isGhost) geo.line("ghost_flags").integers({1, 0});
      geo.line("node_ids").integers({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
      EnSightWriter variable(kind, true);
      variable.line("").line("part").integers({7}).line("block").reals({5, 6});
      const fs::path path =
          caseWith({kind, true}, geo.bytes(), "scalar per element", variable.bytes());
      SCOPED_TRACE(line);
      const bool isOne = isBlank || isGhost;
      const CellMesh mesh = readCase(path);
      ASSERT_TRUE(fieldOf(mesh, "V"));
      EXPECT_EQ(fieldOf(mesh, "V")->values,
                isOne ? std::vector<double>{6} : (std::vector<double>{5, 6}));
      const Result<ReadMesh> whole = readMesh(path);
      ASSERT_TRUE(whole) << whole.error().text();
      EXPECT_NEAR(filledBy(whole->mesh).volume, isOne ? 1 : 2, 1e-9);
    }
  }
}

// EnSight 6 has the nodes of all parts first; without any the order of bytes is still open.
TEST(ReadEnSight, gridsOfEnSight6StandBehindNoNodes) {
  for (const EnSightKind kind : kEnSightKinds) {
    EnSightWriter geo(kind, false), variable(kind, false);
    geo.header().line("").line("").line("node id off").line("element id off");
    geo.line("coordinates")
        .integers({0})
        .line("part 3")
        .line("")
        .line("block")
        .integers({2, 2, 2}, 3);
    geo.reals({0, 1, 0, 1, 0, 1, 0, 1}).reals({0, 0, 1, 1, 0, 0, 1, 1});
    geo.reals({0, 0, 0, 0, 1, 1, 1, 1});
    variable.line("").line("part 3").line("block");
    variable.reals({1, 2, 3, 4, 5, 6, 7, 8})
        .reals(std::vector<float>(8))
        .reals(std::vector<float>(8, 9));
    const CellMesh mesh =
        readCase(caseWith({kind, false}, geo.bytes(), "vector per node", variable.bytes()));
    EXPECT_EQ(mesh.types, std::vector<std::uint8_t>{kHexahedronCell});
    ASSERT_TRUE(fieldOf(mesh, "V"));
    const std::vector<double>& v = fieldOf(mesh, "V")->values;
    EXPECT_EQ(std::vector<double>(v.begin(), v.begin() + 6),
              (std::vector<double>{1, 0, 9, 2, 0, 9}));
  }
}

TEST(ReadEnSight, aGridThatFewBytesUnfoldIsBoundedByMemory) {
  for (const std::vector<std::int32_t>& sides :
       {std::vector<std::int32_t>{2147483647, 2147483647, 2147483647},
        {65536, 65536, 1},
        {0, 2, 2},
        {-1, 2, 2},
        {65535, 65535, 1}}) {
    EnSightWriter geo = partOfGold(EnSightKind::kBig, false);
    geo.line("block uniform").integers(sides, 3).reals({0, 0, 0, 1, 1, 1});
    const std::string error =
        refusal(caseWith({EnSightKind::kBig, true}, geo.bytes(), "scalar per node", "x"));
    EXPECT_TRUE(error.contains("points has none, or 2^32 and more") ||
                error.contains("does not fit in this machine's memory"))
        << error;
  }
}

TEST(ReadEnSight, undefinedValuesAndThoseThatAreNotListedAreMissing) {
  for (const EnSightKind kind : kEnSightKinds) {
    EnSightWriter geo = partOfGold(kind);
    geo.line("hexa8").integers({1}).integers(kHexa, 8);
    EnSightWriter undefined(kind, true), partial(kind, true);
    undefined.line("").line("part").integers({7}).line("coordinates undef").reals({-999});
    undefined.reals({-999, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, -999});
    CellMesh mesh =
        readCase(caseWith({kind, true}, geo.bytes(), "scalar per node", undefined.bytes()));
    ASSERT_TRUE(fieldOf(mesh, "V"));
    EXPECT_TRUE(std::isnan(fieldOf(mesh, "V")->values[0]));
    EXPECT_EQ(fieldOf(mesh, "V")->values[10], 10);
    EXPECT_TRUE(std::isnan(fieldOf(mesh, "V")->values[11]));
    partial.line("").line("part").integers({7}).line("coordinates partial").integers({2});
    partial.integers({12, 3}).reals({1, 2, 3, 4, 5, 6});
    mesh = readCase(caseWith({kind, true}, geo.bytes(), "vector per node", partial.bytes()));
    ASSERT_TRUE(fieldOf(mesh, "V"));
    const std::vector<double>& v = fieldOf(mesh, "V")->values;
    EXPECT_EQ(std::vector<double>(v.begin() + 33, v.end()), (std::vector<double>{1, 3, 5}));
    EXPECT_EQ(std::vector<double>(v.begin() + 6, v.begin() + 9), (std::vector<double>{2, 4, 6}));
    EXPECT_EQ(std::ranges::count_if(v, [](double x) { return std::isnan(x); }), 30);
    for (const std::int32_t number : {0, 13}) {
      EnSightWriter wrong(kind, true);
      wrong.line("").line("part").integers({7}).line("coordinates partial").integers({1});
      wrong.integers({number}).reals({1});
      EXPECT_NE(refusal(caseWith({kind, true}, geo.bytes(), "scalar per node", wrong.bytes()))
                    .find("of number " + std::to_string(number) + " of the 12"),
                std::string::npos);
    }
  }
}

TEST(ReadEnSight, fullColumnsOfTextStandSideBySide) {
  const fs::path path = caseWith({EnSightKind::kText, false},
                                 "\n\nnode id given\nelement id off\ncoordinates\n       4\n"
                                 "10000001-1.00000e+00-1.00000e+00-1.00000e+00\n"
                                 "10000002 1.00000e+00-1.00000e+00-1.00000e+00\n"
                                 "10000003-1.00000e+00 1.00000e+00-1.00000e+00\n"
                                 "10000004-1.00000e+00-1.00000e+00 1.00000e+00\n"
                                 "part 1\n\ntetra4\n       1\n10000001100000021000000310000004\n",
                                 "scalar per node", "\n-1.00000e+00-2.00000e+00-3.00000e+00 4\n");
  const CellMesh mesh = readCase(path);
  EXPECT_EQ(mesh.vertices, (std::vector<VertexId>{0, 1, 2, 3}));
  EXPECT_EQ(mesh.points[1], (Position{1, -1, -1}));
  ASSERT_TRUE(fieldOf(mesh, "V"));
  EXPECT_EQ(fieldOf(mesh, "V")->values, (std::vector<double>{-1, -2, -3, 4}));
}

EnSightEncoding encodingOf(Dialect dialect) {
  EnSightEncoding out;
  out.isGold = dialect.isGold;
  if (dialect.kind != EnSightKind::kText) out.kind = EnSightEncoding::kC;
  return out;
}

Result<EnSightGeometry> parsedGeometry(Dialect dialect, std::string_view bytes,
                                       std::uint64_t room = 1 << 20) {
  ReadReport report;
  EnSightBounds bounds{kReadPatience, room};
  return readEnSightGeometry(bytes, "g", encodingOf(dialect), bounds, report);
}

bool areValuesRead(const EnSightGeometry& of, bool isOfElements, std::string_view bytes) {
  EnSightBounds bounds{kReadPatience, 1 << 20};
  return readEnSightValues(bytes, "v", {"V", isOfElements, 3, {}}, of, bounds).has_value();
}

TEST(ReadEnSight, whatUnfoldsTakesNoMoreThanItsRoom) {
  const Dialect dialect{EnSightKind::kText, true};
  EnSightWriter geo = partOfGold(dialect.kind, false);
  geo.line("block uniform").integers({2, 2, 2}, 3).reals({0, 0, 0, 1, 1, 1});
  EXPECT_FALSE(parsedGeometry(dialect, geo.bytes(), 8 * kEnSightGridPointBytes - 1));
  EXPECT_TRUE(parsedGeometry(dialect, geo.bytes(), 8 * kEnSightGridPointBytes));
  EXPECT_TRUE(parsedGeometry(dialect, geo.bytes(), 8 * kEnSightGridPointBytes + 1));
  const auto whole = parsedGeometry(dialect, geometry(dialect, 1, "off"));
  ASSERT_TRUE(whole) << whole.error().text();
  const std::uint64_t bytes = 12 * 3 * sizeof(double);  // of 12 vectors
  for (const std::uint64_t room : {bytes - 1, bytes, bytes + 1}) {
    EnSightBounds bounds{kReadPatience, room};
    const auto read =
        readEnSightValues(values(dialect, 3, false, 0), "v", {"V", false, 3, {}}, *whole, bounds);
    EXPECT_EQ(read.has_value(), room >= bytes);
    if (read) EXPECT_EQ(bounds.room, room - bytes);
  }
}

TEST(ReadEnSight, everyCutOfAFileIsRefused) {
  for (const EnSightKind kind : {EnSightKind::kText, EnSightKind::kLittle, EnSightKind::kBig}) {
    for (const bool isGold : {true, false}) {
      const Dialect dialect{kind, isGold};
      const std::string geo = geometry(dialect, 1, "given");
      const auto whole = parsedGeometry(dialect, geo);
      ASSERT_TRUE(whole) << whole.error().text();
      // a cut within the last number of a text cannot be seen
      const std::size_t unseen = kind == EnSightKind::kText ? 12 : 0;
      for (std::size_t left = 0; left + unseen < geo.size(); ++left) {
        const auto read = parsedGeometry(dialect, std::string_view(geo).substr(0, left));
        // between a part's kinds of cells nothing is cut, nor are its blanks behind
        const std::size_t blocks = read ? read->blocks.size() : 0;
        const bool hasLess = blocks == 0 || read->blocks[0].elements < 4;
        EXPECT_TRUE(!read || hasLess) << left;
      }
      for (const bool isOfElements : {false, true}) {
        const std::string variable = values(dialect, 3, isOfElements, 0.25F);
        EXPECT_TRUE(areValuesRead(*whole, isOfElements, variable));
        const std::size_t hexa = std::min(variable.find("hexa8"), variable.size());
        for (std::size_t left = 0; left + unseen < hexa; ++left)
          EXPECT_FALSE(
              areValuesRead(*whole, isOfElements, std::string_view(variable).substr(0, left)))
              << left << isOfElements;
      }
    }
  }
}

TEST(ReadEnSight, aRecordOfFortranThatIsCutOffIsRefused) {
  for (const EnSightKind kind : {EnSightKind::kFortranLittle, EnSightKind::kFortranBig}) {
    const Dialect dialect{kind, true};
    const std::string geo = geometry(dialect, 1, "off"), variable = values(dialect, 1, false, 0);
    const fs::path path = caseWith(dialect, geo, "scalar per node", variable);
    for (std::size_t left = 1; left < variable.size(); left += 5) {
      writeBytes(path.parent_path() / "one.V", variable.substr(0, left));
      EXPECT_NE(refusal(path).find("its variable V: "), std::string::npos) << left;
    }
    writeBytes(path.parent_path() / "one.V", variable.substr(0, variable.size() - 1));
    EXPECT_NE(refusal(path).find("should have 48 bytes"), std::string::npos) << refusal(path);
  }
}

TEST(ReadEnSight, countsThatAreTooLargeAreRefusedBeforeAllocating) {
  for (const bool isGold : {true, false}) {
    const Dialect dialect{EnSightKind::kBig, isGold};
    const std::string geo = geometry(dialect, 1, "given"), variable = values(dialect, 3, true, 0);
    const auto whole = parsedGeometry(dialect, geo);
    ASSERT_TRUE(whole) << whole.error().text();
    for (const std::string_view number :
         {"\x7F\xFF\xFF\xFF", "\xFF\xFF\xFF\xFF", "\x40\x01\x02\x03"}) {
      // an error or a mesh: the sanitizers see the rest
      for (std::size_t at = 0; at + number.size() <= geo.size(); ++at)
        (void)parsedGeometry(dialect, std::string(geo).replace(at, number.size(), number));
      for (std::size_t at = 0; at + number.size() <= variable.size(); ++at)
        (void)areValuesRead(*whole, true, std::string(variable).replace(at, number.size(), number));
    }
  }
}

TEST(ReadEnSight, aVariableOfAnotherMeshIsRefusedWithItsNameAndFile) {
  const Dialect dialect{EnSightKind::kLittle, true};
  const std::string geo = geometry(dialect, 1, "assign");
  const auto errorOf = [&](const std::string& variable, const EnSightWriter& bytes) {
    const std::string error = refusal(caseWith(dialect, geo, variable, bytes.bytes()));
    EXPECT_TRUE(error.contains("its variable V: ") && error.contains("one.V")) << error;
    return error;
  };
  const auto begun = [&](std::int32_t part) {
    EnSightWriter out(dialect.kind, true);
    return out.line("").line("part").integers({part});
  };
  EXPECT_NE(errorOf("scalar per node", begun(8).line("coordinates").reals({1}))
                .find("values of part 8, which the geometry has not"),
            std::string::npos);
  EXPECT_NE(errorOf("scalar per node", begun(7).line("coordinates").reals({1, 2}))
                .find("it has 2 of the 12 values of the nodes of part 7"),
            std::string::npos);
  EXPECT_NE(errorOf("scalar per node", begun(7).line("coordinates").reals(std::vector<float>(40)))
                .find("has more numbers than the mesh"),
            std::string::npos);
  EXPECT_NE(errorOf("scalar per node", begun(7).line("block").reals({1, 2}))
                .find("'block' is where \"coordinates\" should be"),
            std::string::npos);
  EXPECT_NE(errorOf("scalar per element", begun(7).line("tetra4").reals({1, 2}))
                .find("'tetra4' is where a kind of elements that part 7 has should be"),
            std::string::npos);
  EXPECT_NE(errorOf("scalar per element", EnSightWriter(dialect.kind, true).line(""))
                .find("it has no values"),
            std::string::npos);
  const fs::path path = caseWith(dialect, geo, "scalar per node", "");
  fs::remove(path.parent_path() / "one.V");
  EXPECT_NE(refusal(path).find("there is no file"), std::string::npos);
  ReadOptions without;
  without.fields.emplace();
  ReadReport report;
  EXPECT_TRUE(readEnSight(path, without, report)) << "nobody asked for it";
}

TEST(ReadEnSight, aPartWithoutValuesHasMissingOnesAndOneOfSurfacesIsNoField) {
  const Dialect dialect{EnSightKind::kLittle, true};
  EnSightWriter geo = partOfGold(dialect.kind);
  geo.line("hexa8").integers({1}).integers(kHexa, 8);
  for (const std::int32_t part : {8, 9}) {
    geo.line("part").integers({part}).line("").line("coordinates").integers({4});
    geo.reals({5, 5, 5, 6}).reals({0, 1, 0, 0}).reals({0, 0, 1, 0});
    geo.line(part == 8 ? "tetra4" : "quad4").integers({1}).integers({1, 2, 3, 4}, 4);
  }
  EnSightWriter variable(dialect.kind, true), ofSurface(dialect.kind, true);
  variable.line("").line("part").integers({8}).line("coordinates").reals({1, 2, 3, 4});
  const CellMesh mesh =
      readCase(caseWith(dialect, geo.bytes(), "scalar per node", variable.bytes()));
  ASSERT_EQ(mesh.points.size(), 16u);
  ASSERT_TRUE(fieldOf(mesh, "V"));
  EXPECT_TRUE(std::isnan(fieldOf(mesh, "V")->values[11]));
  EXPECT_EQ(fieldOf(mesh, "V")->values[12], 1);
  ofSurface.line("").line("part").integers({9}).line("coordinates").reals({1, 2, 3, 4});
  ReadReport report;
  EXPECT_FALSE(
      fieldOf(readCase(caseWith(dialect, geo.bytes(), "scalar per node", ofSurface.bytes()), "last",
                       &report),
              "V"));
  EXPECT_TRUE(std::ranges::any_of(report.notes, [](const std::string& note) {
    return note.contains("parts without volumes alone");
  }));
}

TEST(ReadEnSight, filesThatVtkWroteAreReadAndRefusedWhereTheyAreCutOff) {
  const fs::path from = fs::path(testing::kSourceFolder) / "tests/simplify/read/meshes";
  const fs::path folder = testing::freshFolder("cut-ensight");
  for (const char* name : {"ens.0.case", "ens.0.00000.geo", "ens.0.00000_c.mat", "ens.0.00000_n.T"})
    fs::copy_file(from / name, folder / name);
  const Result<ReadMesh> read = readMesh(folder / "ens.0.case");
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_NEAR(filledBy(read->mesh).volume, 2, 1e-9);
  EXPECT_EQ(filledBy(read->mesh).openEdges, 0u);
  const auto t = std::ranges::find(read->mesh.fields, "T_n", &MeshField::name);
  ASSERT_NE(t, read->mesh.fields.end());
  for (std::size_t i = 0; i < read->mesh.points.size(); ++i)
    EXPECT_NEAR(t->values[i], read->mesh.points[i][0], 1e-5);
  const std::uintmax_t size = fs::file_size(folder / "ens.0.00000_n.T");
  for (std::uintmax_t left = 0; left < size; left += left == 80 ? 20 : 40) {
    fs::copy_file(from / "ens.0.00000_n.T", folder / "ens.0.00000_n.T",
                  fs::copy_options::overwrite_existing);
    fs::resize_file(folder / "ens.0.00000_n.T", left);
    const Result<ReadMesh> cut = readMesh(folder / "ens.0.case");
    ASSERT_FALSE(cut) << left;
    EXPECT_EQ(cut.error().code, ErrorCode::kBadInput);
  }
}

TEST(ReadEnSight, partsAreBlocksWithTheirNumbersAndNames) {
  for (const Dialect dialect : dialects()) {
    SCOPED_TRACE(std::string(dialect.isGold ? "gold " : "6 ") +
                 std::to_string(static_cast<int>(dialect.kind)));
    EnSightWriter out(dialect.kind, dialect.isGold);
    out.header().line("two parts").line("").line("node id off").line("element id off");
    const std::vector<Position> points = barPoints(1);
    const auto write = [&](std::size_t begin, std::size_t end) {
      out.line("coordinates").integers({static_cast<std::int32_t>(end - begin)});
      std::vector<float> all;
      for (std::size_t i = 0; i < 3 * (end - begin); ++i) {
        const std::size_t point = dialect.isGold ? i % (end - begin) : i / 3,
                          axis = dialect.isGold ? i / (end - begin) : i % 3;
        all.push_back(static_cast<float>(points[begin + point][axis]));
      }
      out.reals(all, dialect.isGold ? 1 : 3);
    };
    if (!dialect.isGold) write(0, 12);
    for (const std::int32_t part : {7, 9}) {
      if (dialect.isGold)
        out.line("part").integers({part});
      else
        out.line("part " + std::to_string(part));
      out.line(part == 7 ? "wing " : "tail");
      if (dialect.isGold) write(part == 7 ? 0 : 4, part == 7 ? 8 : 12);
      const std::int32_t first = part == 7 || dialect.isGold ? 1 : 5;
      std::vector<std::int32_t> corners(8);
      for (std::int32_t k = 0; k < 8; ++k) corners[static_cast<std::size_t>(k)] = first + k;
      out.line("hexa8").integers({1}).integers(corners, 8);
    }
    const fs::path path = testing::fileWith("parts.case", front(dialect) + "model: parts.geo\n");
    writeBytes(path.parent_path() / "parts.geo", out.bytes());
    const Result<ReadMesh> read = readMesh(path);
    ASSERT_TRUE(read) << read.error().text();
    ASSERT_EQ(read->mesh.fields.size(), 1u);
    const MeshField& field = read->mesh.fields[0];
    EXPECT_EQ(field.name, "BlockId");
    EXPECT_EQ(field.labelNames, (LabelNames{{7, "wing"}, {9, "tail"}}));
    EXPECT_EQ(field.values.front(), 7);
    EXPECT_EQ(field.values.back(), 9);
  }
}

}  // namespace
}  // namespace qtet
