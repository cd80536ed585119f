// Gmsh, Medit, TetGen and SU2: what other programs write, what these tests write, and what damage
// makes of it.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <unordered_map>

#include "simplify/clean/clean_mesh.h"
#include "simplify/read/read_mesh.h"
#include "simplify/read/text/gmsh_elements.h"
#include "simplify/read/text/mesh_scanner.h"
#include "simplify/split/higher_cells.h"
#include "tests/simplify/mesh/tet_meshes.h"
#include "tests/simplify/split/cell_grids.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

using testing::fileWith;
using testing::filledBy;
namespace fs = std::filesystem;

/// Numbers as text or as bytes.
class Out {
 public:
  explicit Out(bool bytes) : bytes_(bytes) {}
  template <class T>
  Out& put(T value) {
    if (bytes_) {
      const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
      text.append(raw.data(), raw.size());
    } else if constexpr (std::floating_point<T>) {
      std::array<char, 40> digits{};
      std::snprintf(digits.data(), digits.size(), "%.17g ", static_cast<double>(value));
      text += digits.data();
    } else {
      text += std::to_string(value) + " ";
    }
    return *this;
  }
  Out& line(const std::string& words = "") {
    text += words + "\n";
    return *this;
  }
  Out& end() {
    if (!bytes_) text += "\n";
    return *this;
  }
  std::string text;

 private:
  bool bytes_;
};

/// Two hexahedra, a wedge and a pyramid upon them, with missing values in the numbers of nodes and
/// elements, a point and a cell field.
CellMesh sample() {
  CellMesh mesh;
  for (int k = 0; k < 2; ++k) {
    for (int j = 0; j < 2; ++j) {
      for (int i = 0; i < 3; ++i) mesh.points.push_back({1.0 * i, 1.0 * j, 0.1 + k});
    }
  }
  mesh.points.push_back({0.5, 0.5, 2});
  mesh.points.push_back({1.5, 0, 2});
  mesh.points.push_back({1.5, 1, 2});
  mesh.addCell(kHexahedronCell, std::array<VertexId, 8>{0, 1, 4, 3, 6, 7, 10, 9});
  mesh.addCell(kHexahedronCell, std::array<VertexId, 8>{1, 2, 5, 4, 7, 8, 11, 10});
  mesh.addCell(kPyramidCell, std::array<VertexId, 5>{6, 7, 10, 9, 12});
  mesh.addCell(kWedgeCell, std::array<VertexId, 6>{7, 8, 13, 10, 11, 14});
  return mesh;
}

std::int64_t gmshType(std::uint8_t type) {
  return type == kHexahedronCell ? 5 : type == kWedgeCell ? 6 : type == kPyramidCell ? 7 : 4;
}
std::uint64_t nodeTag(std::size_t i) { return 3 * i + 5; }
std::uint64_t elementTag(std::size_t i) { return 100 - 7 * i; }

void putData(Out& out, const std::string& name, const CellMesh& mesh, bool ofElements) {
  const std::string section = ofElements ? "ElementData" : "NodeData";
  const std::size_t count = ofElements ? mesh.cells() : mesh.points.size();
  out.line("$" + section)
      .line("1")
      .line("\"" + name + "\"")
      .line("1")
      .line("0.5")
      .line("3")
      .line("0")
      .line(ofElements ? "3" : "1")
      .line(std::to_string(count));
  for (std::size_t i = 0; i < count; ++i) {
    out.put(static_cast<std::int32_t>(ofElements ? elementTag(i) : nodeTag(i)));
    for (int c = 0; c < (ofElements ? 3 : 1); ++c) out.put(static_cast<double>(i) + 0.25 * c);
    out.end();
  }
  out.line("$End" + section);
}

std::string gmsh41(bool bytes) {
  const CellMesh mesh = sample();
  Out out(bytes);
  out.line("$MeshFormat").line(std::string("4.1 ") + (bytes ? "1" : "0") + " 8");
  if (bytes) out.put(std::int32_t{1}).line();
  out.line("$EndMeshFormat")
      .line("$PhysicalNames")
      .line("1")
      .line("3 9 \"solid\"")
      .line("$EndPhysicalNames")
      .line("$Entities");
  for (const std::uint64_t n : {1, 0, 1, 1}) out.put(n);
  out.end().put(std::int32_t{1}).put(0.0).put(0.0).put(0.0).put(std::uint64_t{0}).end();
  for (const int dimension : {2, 3}) {
    out.put(std::int32_t{4});
    for (int k = 0; k < 6; ++k) out.put(0.5 * k);
    out.put(std::uint64_t{1})
        .put(std::int32_t{dimension == 3 ? 9 : 77})
        .put(std::uint64_t{1})
        .put(std::int32_t{-4})
        .end();
  }
  out.line("$EndEntities").line("$Nodes");
  out.put(std::uint64_t{2})
      .put(std::uint64_t{mesh.points.size()})
      .put(nodeTag(0))
      .put(nodeTag(mesh.points.size() - 1))
      .end();
  const auto block = [&](std::size_t first, std::size_t last, bool parametric) {
    out.put(std::int32_t{2})
        .put(std::int32_t{1})
        .put(std::int32_t{parametric})
        .put(std::uint64_t{last - first})
        .end();
    for (std::size_t i = first; i < last; ++i) out.put(nodeTag(i)).end();
    for (std::size_t i = first; i < last; ++i) {
      for (const double x : mesh.points[i]) out.put(x);
      if (parametric) out.put(0.5).put(0.25);
      out.end();
    }
  };
  block(0, 4, true);
  block(4, mesh.points.size(), false);
  out.line("$EndNodes")
      .line("$Elements")
      .put(std::uint64_t{mesh.cells() + 1})
      .put(std::uint64_t{mesh.cells() + 1})
      .put(std::uint64_t{1})
      .put(std::uint64_t{1000})
      .end();
  out.put(std::int32_t{2})
      .put(std::int32_t{1})
      .put(std::int32_t{2})
      .put(std::uint64_t{1})
      .end()
      .put(std::uint64_t{1000})
      .put(nodeTag(0))
      .put(nodeTag(1))
      .put(nodeTag(2))
      .end();
  for (std::size_t i = 0; i < mesh.cells(); ++i) {
    out.put(std::int32_t{3})
        .put(std::int32_t{4})
        .put(static_cast<std::int32_t>(gmshType(mesh.types[i])))
        .put(std::uint64_t{1})
        .end()
        .put(elementTag(i));
    for (const VertexId v : mesh.cell(i)) out.put(nodeTag(v));
    out.end();
  }
  out.line("$EndElements");
  putData(out, "p", mesh, false);
  putData(out, "v", mesh, true);
  return out.text;
}

std::string gmsh22(bool bytes) {
  const CellMesh mesh = sample();
  Out out(bytes);
  out.line("$MeshFormat").line(std::string("2.2 ") + (bytes ? "1" : "0") + " 8");
  if (bytes) out.put(std::int32_t{1}).line();
  out.line("$EndMeshFormat").line("$Nodes").line(std::to_string(mesh.points.size()));
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    out.put(static_cast<std::int32_t>(nodeTag(i)));
    for (const double x : mesh.points[i]) out.put(x);
    out.end();
  }
  out.line("$EndNodes").line("$Elements").line(std::to_string(mesh.cells() + 1));
  const auto element = [&](std::int64_t type, std::uint64_t tag, std::int32_t group,
                           const std::vector<VertexId>& ids) {
    if (bytes)
      out.put(static_cast<std::int32_t>(type))
          .put(std::int32_t{1})
          .put(std::int32_t{2})
          .put(static_cast<std::int32_t>(tag));
    else
      out.put(tag).put(type).put(2);
    out.put(group).put(std::int32_t{4});
    for (const VertexId v : ids) out.put(static_cast<std::int32_t>(nodeTag(v)));
    out.end();
  };
  element(2, 1000, 77, {0, 1, 2});
  for (std::size_t i = 0; i < mesh.cells(); ++i)
    element(gmshType(mesh.types[i]), elementTag(i), 9, {mesh.cell(i).begin(), mesh.cell(i).end()});
  out.line("$EndElements");
  putData(out, "p", mesh, false);
  putData(out, "v", mesh, true);
  return out.text;
}

std::string medit(bool bytes, std::int32_t version) {
  const CellMesh mesh = sample();
  Out out(bytes);
  const auto integer = [&](std::int64_t x) {
    version >= 4 ? out.put(x) : out.put(static_cast<std::int32_t>(x));
  };
  const auto section = [&](const std::string& word, std::int32_t code, std::uint64_t count,
                           const std::function<void()>& rest) {
    if (!bytes) {
      out.line(word).line(std::to_string(count));
      return rest();
    }
    out.put(code);
    const std::size_t at = out.text.size();
    version >= 3 ? out.put(std::uint64_t{0}) : out.put(std::uint32_t{0});
    version >= 4 ? out.put(count) : out.put(static_cast<std::uint32_t>(count));
    rest();
    const std::uint64_t next = out.text.size();
    std::memcpy(out.text.data() + at, &next, version >= 3 ? 8 : 4);
  };
  const auto cells = [&](std::uint8_t type) {
    for (std::size_t i = 0; i < mesh.cells(); ++i) {
      if (mesh.types[i] != type) continue;
      for (const VertexId v : mesh.cell(i)) integer(v + 1);
      integer(10 + static_cast<std::int64_t>(i));
      out.end();
    }
  };
  if (bytes) {
    out.put(std::int32_t{1}).put(version).put(std::int32_t{3});
    version >= 3 ? out.put(std::uint64_t{20}) : out.put(std::uint32_t{16});
    out.put(std::int32_t{3});
  } else {
    out.line("MeshVersionFormatted 2 # double").line().line("Dimension").line("3");
  }
  if (bytes)
    std::memcpy(out.text.data() + 12, std::array<std::uint64_t, 1>{out.text.size()}.data(),
                version >= 3 ? 8 : 4);
  section("Vertices", 4, mesh.points.size(), [&] {
    for (const Position& p : mesh.points) {
      for (const double x : p) bytes&& version == 1 ? out.put(static_cast<float>(x)) : out.put(x);
      integer(0);
      out.end();
    }
  });
  section("Corners", 13, 2, [&] { integer(1), integer(2), out.end(); });
  section("Triangles", 6, 1, [&] { integer(1), integer(2), integer(3), integer(0), out.end(); });
  section("Hexahedra", 10, 2, [&] { cells(kHexahedronCell); });
  section("Pyramids", 49, 1, [&] { cells(kPyramidCell); });
  section("Prisms", 9, 1, [&] { cells(kWedgeCell); });
  if (bytes)
    out.put(std::int32_t{54}), version >= 3 ? out.put(std::uint64_t{0}) : out.put(std::uint32_t{0});
  else
    out.line("End");
  return out.text;
}

std::string su2() {
  const CellMesh mesh = sample();
  Out out(false);
  out.line("% a comment")
      .line("NDIME= 3")
      .line("NELEM = " + std::to_string(mesh.cells()) + " % four");
  for (std::size_t i = 0; i < mesh.cells(); ++i) {
    out.put(static_cast<int>(mesh.types[i]));
    for (const VertexId v : mesh.cell(i)) out.put(v);
    out.put(i).end();
  }
  out.line("NPOIN=" + std::to_string(mesh.points.size()));
  for (const Position& p : mesh.points) out.put(p[0]).put(p[1]).put(p[2]).end();
  out.line("NMARK= 1").line("MARKER_TAG= wall").line("MARKER_ELEMS= 1").line("9 0 1 4 3");
  return out.text;
}

Result<CellMesh> cellsIn(const fs::path& path) {
  ReadReport report;
  return readCells(path, {}, report);
}

/// The sample, whatever order the cells came in.
void expectTheSample(const Result<CellMesh>& read, double precision = 0) {
  ASSERT_TRUE(read) << read.error().text();
  const CellMesh wanted = sample();
  ASSERT_EQ(read->points.size(), wanted.points.size());
  for (std::size_t i = 0; i < wanted.points.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_NEAR(read->points[i][c], wanted.points[i][c], precision);
  }
  EXPECT_EQ(read->types, wanted.types);
  EXPECT_EQ(read->vertices, wanted.vertices);
  EXPECT_EQ(read->begins, wanted.begins);
}

/// One tetrahedron with a reference, as Medit writes it and as Gmsh does.
std::string meditText(const std::string& reference) {
  return "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 " +
         reference + "\nTetrahedra\n1\n1 2 3 4 " + reference + "\nEnd\n";
}
std::string gmshText(const std::string& group) {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 "
         "1\n$EndNodes\n$Elements\n1\n1 4 2 " +
         group + " 1 1 2 3 4\n$EndElements\n";
}

TEST(ReadGmsh, physicalVolumesHaveTheirNames) {
  const std::string names =
      "$PhysicalNames\n3\n2 9 \"wall\"\n3 9 \"hot steel\"\n3 4 \"\"\n$EndPhysicalNames\n";
  for (const bool bytes : {false, true}) {
    std::string text = gmsh22(bytes);
    text.insert(text.find("$EndMeshFormat\n") + 15, names);
    const auto read = readMesh(fileWith("a.msh", text));
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(read->mesh.fields[2].labelNames, (LabelNames{{9, "hot steel"}}));
    text.replace(text.find("\"hot"), 1, " ");
    const auto unquoted = readMesh(fileWith("a.msh", text));
    ASSERT_TRUE(unquoted) << unquoted.error().text();
    EXPECT_EQ(unquoted->mesh.fields[2].labelNames, LabelNames{});
    text.replace(text.find(" hot"), 1, "\"\xE4");
    const auto latin = readMesh(fileWith("a.msh", text));
    ASSERT_TRUE(latin) << latin.error().text();
    EXPECT_EQ(latin->mesh.fields[2].labelNames, LabelNames{}) << "no UTF-8";
    const auto newer = readMesh(fileWith("a.msh", gmsh41(bytes)));
    ASSERT_TRUE(newer) << newer.error().text();
    EXPECT_EQ(newer->mesh.fields[2].labelNames, (LabelNames{{9, "solid"}}));
  }
}

/// A volume of group 7 that is a partition of volume 1.
TEST(ReadGmsh, cellsOfPartitionsHaveTheirGroup) {
  const auto read = readMesh(
      fileWith("a.msh",
               "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
               "$Entities\n0 0 0 1\n1 0 0 0 1 1 1 1 7 0\n$EndEntities\n"
               "$PartitionedEntities\n2 1\n8 2\n0 0 0 1\n2 3 1 2 1 2 0 0 0 1 1 1 1 7 0\n"
               "$EndPartitionedEntities\n"
               "$Nodes\n1 4 1 4\n3 2 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n"
               "$Elements\n1 1 1 1\n3 2 4 1\n1 1 2 3 4\n$EndElements\n"));
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->mesh.fields.size(), 1u);
  EXPECT_EQ(read->mesh.fields[0].values, std::vector<double>{7});
}

TEST(ReadGmsh, textAndBytesOfBothVersionsGiveOneMesh) {
  for (const bool bytes : {false, true}) {
    for (const std::string& text : {gmsh41(bytes), gmsh22(bytes)}) {
      const Result<CellMesh> read = cellsIn(fileWith("sample.msh", text));
      expectTheSample(read);
      if (!read) continue;
      ASSERT_EQ(read->fields.size(), 3u);
      EXPECT_EQ(read->fields[0].name, "p");
      EXPECT_EQ(read->fields[0].values[3], 3);
      EXPECT_EQ(read->fields[1].components, 3u);
      EXPECT_EQ(read->fields[1].association, "cell");
      EXPECT_EQ((std::vector<double>(read->fields[1].values.begin() + 3,
                                     read->fields[1].values.begin() + 6)),
                (std::vector<double>{1, 1.25, 1.5}));
      EXPECT_EQ(read->fields[2].name, "gmsh:physical");
      EXPECT_EQ(read->fields[2].values, (std::vector<double>{9, 9, 9, 9}));
    }
  }
}

TEST(ReadGmsh, gmshsOwnSecondOrderNodesLieWhereVtkHasThem) {
  for (const char* name :
       {"gmsh-hexahedron27", "gmsh-hexahedron20", "gmsh-prism18", "gmsh-prism15"}) {
    const Result<CellMesh> read =
        cellsIn(fs::path(testing::kSourceFolder) / "tests/simplify/read/meshes" /
                (std::string(name) + ".msh"));
    ASSERT_TRUE(read) << read.error().text();
    for (std::size_t i = 0; i < read->cells(); ++i) {
      const auto c = read->cell(i);
      const CurvedNodes nodes = curvedNodesOf(read->types[i]);
      const CellShape shape = shapeOf(read->types[i]);
      ASSERT_TRUE(nodes.curved);
      for (std::size_t e = 0; e < nodes.edges.size(); ++e) {
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(2 * read->points[c[shape.corners + e]][k],
                      read->points[c[nodes.edges[e][0]]][k] + read->points[c[nodes.edges[e][1]]][k],
                      1e-9)
              << name << " edge " << e;
      }
      for (std::size_t f = 0; f < shape.faces.size(); ++f) {
        if (nodes.faceCentre[f] == kNoNode) continue;
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(2 * read->points[c[nodes.faceCentre[f]]][k],
                      read->points[c[shape.faces[f].corner[0]]][k] +
                          read->points[c[shape.faces[f].corner[2]]][k],
                      1e-9)
              << name << " face " << f;
      }
    }
    const Result<ReadMesh> mesh =
        readMesh(fs::path(testing::kSourceFolder) / "tests/simplify/read/meshes" /
                 (std::string(name) + ".msh"));
    ASSERT_TRUE(mesh);
    EXPECT_NEAR(filledBy(mesh->mesh).volume, 1, 1e-9);
    EXPECT_EQ(filledBy(mesh->mesh).openEdges, 0u);
  }
}

/// A node's place in a straight cell, from its corners.
Position placedIn(const CellMesh& mesh, std::size_t cell, int n, const NodePlace& place) {
  const auto c = mesh.cell(cell);
  const double x = place[0], y = place[1], z = place[2], side = n - z;
  std::vector<double> weights;
  if (mesh.types[cell] == kLagrangeTetrahedronCell)
    weights = {n - x - y - z, x, y, z};
  else if (mesh.types[cell] == kLagrangeWedgeCell)
    weights = {(n - x - y) * (n - z), x * (n - z), y * (n - z), (n - x - y) * z, x * z, y * z};
  else if (mesh.types[cell] == kLagrangePyramidCell)
    weights = {(side - x) * (side - y), x * (side - y), x * y, (side - x) * y,
               side > 0 ? z * side : 1};
  else
    weights = {(n - x) * (n - y) * side, x * (n - y) * side, x * y * side, (n - x) * y * side,
               (n - x) * (n - y) * z,    x * (n - y) * z,    x * y * z,    (n - x) * y * z};
  Position out{};
  double sum = 0;
  for (const double weight : weights) sum += weight;
  for (std::size_t v = 0; v < weights.size(); ++v)
    for (std::size_t k = 0; k < 3; ++k) out[k] += weights[v] / sum * mesh.points[c[v]][k];
  return out;
}

// A hexahedron, a pyramid on it, a tetrahedron on each of its sides, and a prism beside the
// hexahedron, which Gmsh gave its nodes (SetOrder).
TEST(ReadGmsh, gmshsOwnNodesOfHigherDegreesLieWhereTheyBelong) {
  for (const int degree : {3, 4}) {
    const fs::path path = fs::path(testing::kSourceFolder) / "tests/simplify/read/meshes" /
                          ("gmsh-mixed" + std::to_string(degree) + ".msh");
    const Result<CellMesh> read = cellsIn(path);
    ASSERT_TRUE(read) << read.error().text();
    ASSERT_EQ(read->cells(), 7u);
    for (std::size_t i = 0; i < read->cells(); ++i) {
      const HigherCell& shape = higherCell(read->types[i], {degree, degree, degree});
      ASSERT_EQ(read->cell(i).size(), shape.places.size());
      for (std::size_t node = 0; node < shape.places.size(); ++node) {
        const Position expected = placedIn(*read, i, degree, shape.places[node]);
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(read->points[read->cell(i)[node]][k], expected[k], 1e-9)
              << cellTypeName(read->types[i]) << " of degree " << degree << ", node " << node;
      }
    }
    const Result<ReadMesh> mesh = readMesh(path);
    ASSERT_TRUE(mesh);
    const auto filled = filledBy(mesh->mesh);
    EXPECT_EQ(mesh->mesh.tetrahedra.size(),
              static_cast<std::size_t>((6 + 2 + 4 + 3) * degree * degree * degree));
    EXPECT_EQ(filled.notPositive + filled.openEdges + filled.facesOfMore, 0u);
  }
}

TEST(ReadGmsh, everyCompleteElementOfHigherDegreeIsKnown) {
  for (const auto& [first, type, lowest, highest] :
       {std::tuple{29, kLagrangeTetrahedronCell, 3, 5},
        std::tuple{71, kLagrangeTetrahedronCell, 6, 10}, std::tuple{90, kLagrangeWedgeCell, 3, 4},
        std::tuple{106, kLagrangeWedgeCell, 5, 9}, std::tuple{92, kLagrangeHexahedronCell, 3, 9},
        std::tuple{118, kLagrangePyramidCell, 3, 9}}) {
    for (int degree = lowest; degree <= highest; ++degree) {
      const GmshElement element = gmshElement(first + degree - lowest);
      EXPECT_EQ(element.type, type);
      ASSERT_EQ(element.nodes, higherCell(type, {degree, degree, degree}).places.size());
      std::vector<std::uint16_t> nodes(element.nodeOf.begin(), element.nodeOf.end());
      std::ranges::sort(nodes);
      for (std::size_t i = 0; i < nodes.size(); ++i)
        ASSERT_EQ(nodes[i], i) << "type " << first + degree - lowest;
    }
  }
  EXPECT_EQ(gmshElement(42).nodes, 28u);   // a triangle
  EXPECT_EQ(gmshElement(51).nodes, 121u);  // a quadrilateral
  EXPECT_EQ(gmshElement(66).nodes, 11u);   // a line
  for (const int number : {0, 32, 52, 99, 105, 111, 117, 125, 131, 132, 140})
    EXPECT_EQ(gmshElement(number).nodes, 0u) << number;
}

TEST(ReadGmsh, whatIsWrongIsSaidWithItsLine) {
  const auto refused = [](std::string text, const std::string& from, const std::string& to,
                          ErrorCode code, const std::string& word) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    const Result<CellMesh> read = cellsIn(fileWith("bad.msh", text.replace(at, from.size(), to)));
    ASSERT_FALSE(read) << from;
    EXPECT_EQ(read.error().code, code) << read.error().text();
    EXPECT_NE(read.error().message.find(word), std::string::npos) << read.error().text();
  };
  refused(gmsh22(false), "2.2 0", "1.0 0", ErrorCode::kBadInput,
          "line 2: the format's version is 1.0");
  refused(gmsh22(false), "2.2 0 8", "2.2 0 4", ErrorCode::kBadInput, "numbers of 4 bytes");
  refused(gmsh22(false), "$Nodes\n15", "$Nodes\n99999999999", ErrorCode::kTruncated,
          "99999999999 nodes are announced, but only");
  refused(gmsh22(false), "$Nodes\n15", "$Nodes\n14", ErrorCode::kBadInput,
          "$EndNodes should be here");
  refused(gmsh22(false), "$Nodes\n15", "$Nodes\nfifteen", ErrorCode::kBadInput,
          "line 5: 'fifteen' is where the number of nodes should be");
  refused(gmsh22(false), "1000 2 2", "1000 99 2", ErrorCode::kBadInput, "elements of type 99");
  refused(gmsh22(false), "$MeshFormat", "$Mesh", ErrorCode::kBadInput,
          "does not begin with $MeshFormat");
  refused(gmsh22(false), "9 4 5 8 17", "9 4 6 8 17", ErrorCode::kBadInput,
          "cell 0 is a hexahedron without 8 vertices among the 15 points");
  refused(gmsh22(false), "\n11 2 0 0.1", "\n8 2 0 0.1", ErrorCode::kBadInput,
          "line 8: two nodes have the number 8");
  refused(gmsh41(true), std::string("\1\0\0\0\n", 5), std::string("\0\0\0\1\n", 5),
          ErrorCode::kBadInput, "big-endian");
}

TEST(ReadGmsh, elementsOfOneNumberLeaveTheDataOfTheOthersWhereTheyBelong) {
  std::string text = gmsh22(false);
  const std::size_t second = text.find("\n93 ");
  ASSERT_NE(second, std::string::npos);
  const Result<CellMesh> read = cellsIn(fileWith("same.msh", text.replace(second, 4, "\n100 ")));
  expectTheSample(read);
  ASSERT_EQ(read->fields[1].name, "v");
  const std::vector<double>& values = read->fields[1].values;
  EXPECT_EQ(values[0], 0);
  EXPECT_TRUE(std::isnan(values[3]));
  EXPECT_EQ(values[6], 2);
  EXPECT_EQ(values[9], 3);
}

TEST(ReadGmsh, stepsOfOneFieldAreCalledByTheirTimes) {
  const std::string text = gmsh22(false), from = "$NodeData\n1\n\"p\"\n1\n0.5";
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos);
  std::string later = text.substr(at);
  later.replace(0, from.size(), "$NodeData\n1\n\"p\"\n1\n12.25");
  const fs::path file = fileWith("steps.msh", text + later);
  const auto names = [&](const std::string& time) {
    ReadOptions options;
    options.time = time;
    ReadReport report;
    const Result<CellMesh> read = readCells(file, options, report);
    const bool told = std::ranges::any_of(report.notes, [](const std::string& note) {
      return note.find("of its 2 time steps the last is read, 12.25") != std::string::npos;
    });
    EXPECT_EQ(told, time == "last") << time;
    std::vector<std::string> out;
    if (!read) return std::vector<std::string>{errorCodeName(read.error().code)};
    for (const MeshField& field : read->fields) out.push_back(field.name);
    return out;
  };
  expectTheSample(cellsIn(file));
  EXPECT_EQ(names("all"),
            (std::vector<std::string>{"p@0.5", "v@0.5", "p@12.25", "v@0.5-2", "gmsh:physical"}));
  EXPECT_EQ(names("last"), (std::vector<std::string>{"p", "gmsh:physical"}));
  EXPECT_EQ(names("12.25"), names("last"));
  EXPECT_EQ(names("first"), (std::vector<std::string>{"p", "v", "v-2", "gmsh:physical"}));
  EXPECT_EQ(names("3"), (std::vector<std::string>{"not-found"}));
}

TEST(ReadGmsh, ofFieldsOfOneTimeNoOtherCanBeAskedFor) {
  const fs::path path = fileWith(
      "once.msh", gmshText("0") + "$NodeData\n1\n\"T\"\n1\n0.5\n3\n0\n1\n1\n1 7\n$EndNodeData\n");
  ReadOptions options;
  for (const char* time : {"0.5", "first", "last", "all"}) {
    options.time = time;
    const auto mesh = readMesh(path, options);
    ASSERT_TRUE(mesh) << time << mesh.error().message;
    EXPECT_EQ(mesh->mesh.fields.front().name, "T");
    EXPECT_TRUE(mesh->report.notes.empty()) << time;
  }
  options.time = "99";
  const auto none = readMesh(path, options);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("it has 0.5"), std::string::npos) << none.error().message;
}

TEST(ReadGmsh, namesThatALogCannotHoldAreReplaced) {
  for (const std::string& name : {std::string("p\xff\xfe"), std::string(257, 'p'), std::string()}) {
    std::string text = gmsh22(false);
    text.replace(text.find("\"p\""), 3, "\"" + name + "\"");
    ReadReport report;
    const Result<CellMesh> read = readCells(fileWith("names.msh", text), {}, report);
    expectTheSample(read);
    EXPECT_EQ(read->fields[0].name, "unnamed-0");
  }
}

TEST(ReadGmsh, numbersMayBeMultiplesOfWhatever) {
  constexpr std::size_t kNodes = 500'000;
  std::unordered_map<std::uint64_t, std::size_t> table;
  table.reserve(kNodes);
  // all would lie in one bucket, each looked at for each
  const std::uint64_t step = table.bucket_count();
  std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + std::to_string(kNodes) + "\n";
  for (std::size_t i = 0; i < kNodes; ++i)
    text += std::to_string((i + 1) * step) + (i == 1   ? " 1 0 0\n"
                                              : i == 2 ? " 0 1 0\n"
                                              : i == 3 ? " 0 0 1\n"
                                                       : " 0 0 0\n");
  text += "$EndNodes\n$Elements\n1\n1 4 0 " + std::to_string(step) + " " +
          std::to_string(2 * step) + " " + std::to_string(3 * step) + " " +
          std::to_string(4 * step) + "\n$EndElements\n";
  const auto mesh = readMesh(fileWith("multiples.msh", text), std::nullopt);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->mesh.tetrahedra, (std::vector<Tetrahedron>{{0, 1, 2, 3}}));
}

TEST(ReadMedit, textAndBytesOfEveryVersionGiveOneMesh) {
  expectTheSample(cellsIn(fileWith("sample.mesh", medit(false, 2))));
  for (const std::int32_t version : {1, 2, 3, 4}) {
    const Result<CellMesh> read = cellsIn(fileWith("sample.meshb", medit(true, version)));
    expectTheSample(read, version == 1 ? 1e-7 : 0);
    if (!read) continue;
    ASSERT_EQ(read->fields.size(), 1u);
    EXPECT_EQ(read->fields[0].name, "medit:ref");
    EXPECT_EQ(read->fields[0].values, (std::vector<double>{10, 11, 12, 13}));
  }
}

TEST(OwnReaders, labelsHaveATypeThatHoldsThem) {
  for (const auto& [name, text] :
       {std::pair{"wide.mesh", &meditText}, std::pair{"wide.msh", &gmshText}})
    for (const auto& [label, type] :
         {std::pair{2147483647.0, "int32"}, std::pair{-2147483648.0, "int32"},
          std::pair{2147483648.0, "int64"}, std::pair{5e9, "int64"},
          std::pair{-0x1p53 + 1, "int64"}}) {
      const auto mesh = readMesh(
          fileWith(name, text(std::to_string(static_cast<std::int64_t>(label)))), std::nullopt);
      ASSERT_TRUE(mesh) << mesh.error().message;
      const MeshField& field = mesh->mesh.fields.back();
      EXPECT_EQ(field.type, type) << name << label;
      EXPECT_EQ(field.values, std::vector{label}) << name;
    }
}

TEST(OwnReaders, labelsThatADoubleCannotHoldAreLeftOutAndRefusedWhereTheyAreAskedFor) {
  for (const auto& [name, text, label] : {std::tuple{"widest.mesh", &meditText, "medit:ref"},
                                          std::tuple{"widest.msh", &gmshText, "gmsh:physical"}}) {
    const fs::path path = fileWith(name, text("9007199254740993"));
    const auto all = readMesh(path, std::nullopt);
    ASSERT_TRUE(all) << name << all.error().text();
    EXPECT_TRUE(std::ranges::none_of(all->mesh.fields,
                                     [&](const MeshField& f) { return f.name == label; }));
    EXPECT_TRUE(std::ranges::any_of(all->report.notes, [&](const std::string& note) {
      return note.find("2^53") != std::string::npos && note.find(label) != std::string::npos &&
             note.find("labels as int32") != std::string::npos;
    })) << name;
    const auto named = readMesh(path, std::vector<std::string>{label});
    ASSERT_FALSE(named) << name;
    EXPECT_EQ(named.error().code, ErrorCode::kBadInput);
    EXPECT_NE(named.error().message.find("2^53"), std::string::npos) << named.error().message;
    EXPECT_TRUE(readMesh(path, std::vector<std::string>{})) << name;
  }
}

TEST(OwnReaders, moreEntriesThanToldAreRefused) {
  const auto refuses = [](const std::string& name, std::string text, const std::string& told,
                          const std::string& less) {
    const std::size_t at = text.find(told);
    ASSERT_NE(at, std::string::npos) << name;
    const Result<CellMesh> read = cellsIn(fileWith(name, text.replace(at, told.size(), less)));
    ASSERT_FALSE(read) << name;
    EXPECT_EQ(read.error().code, ErrorCode::kBadInput) << read.error().text();
    EXPECT_NE(read.error().message.find("announced"), std::string::npos) << read.error().text();
  };
  refuses("vertices.mesh", meditText("1"), "Vertices\n4", "Vertices\n3");
  refuses("cells.mesh", meditText("1"), "1 2 3 4 1\n", "1 2 3 4 1\n1 2 3 4 1\n");
  const std::size_t cells = sample().cells(), points = sample().points.size();
  refuses("elements.su2", su2(), "NELEM = " + std::to_string(cells),
          "NELEM = " + std::to_string(cells - 1));
  refuses("points.su2", su2(), "NPOIN=" + std::to_string(points),
          "NPOIN=" + std::to_string(points - 1));
  const fs::path nodes = fileWith("more.node", "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n");
  std::ofstream(nodes.parent_path() / "more.ele") << "1 4 0\n0 0 1 2 3\n1 0 1 2 3\n";
  const Result<CellMesh> read = cellsIn(nodes);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("announced"), std::string::npos) << read.error().text();
}

TEST(ReadMedit, curvedCellsThatAreNotReadAreRefused) {
  const std::string text = meditText("0");
  const auto with = [&](const std::string& list) {
    return cellsIn(fileWith("curved.mesh", text.substr(0, text.find("End")) + list + "End\n"));
  };
  EXPECT_TRUE(with("HexahedraQ2\n0\n"));
  EXPECT_TRUE(with("TetrahedraP3Ordering\n2\n0 0 0 1\n1 0 0 0\n"));
  for (const std::string word : {"HexahedraQ2", "PrismsP2", "PyramidsP2", "TetrahedraP3"}) {
    const Result<CellMesh> read = with(word + "\n1\n1 2 3 4 0\n");
    ASSERT_FALSE(read) << word;
    EXPECT_EQ(read.error().code, ErrorCode::kBadInput);
    EXPECT_NE(read.error().message.find(word), std::string::npos) << read.error().text();
  }
}

TEST(ReadMedit, severalCellsMayStandOnALine) {
  std::string text = meditText("0");
  const std::string one = "Tetrahedra\n1\n1 2 3 4 0\n";
  text.replace(text.find(one), one.size(),
               "Edges\n4\n1 2 0 2 3 0\n3 4 0 4 1 0\nTetrahedra\n2\n1 2 3 4 0 2 1 3 4 0\n");
  const Result<CellMesh> read = cellsIn(fileWith("line.mesh", text));
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->cells(), 2u);
}

TEST(ReadMedit, wordsMayBeInCapitals) {
  std::string text = meditText("0");
  for (char& c : text) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  for (const std::string mark : {"", "\xEF\xBB\xBF"}) {
    const Result<CellMesh> read = cellsIn(fileWith("capitals.mesh", mark + text));
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(read->cells(), 1u);
  }
}

TEST(ReadMedit, otherFormatsOfThatEndingAreKnownByTheirFirstWord) {
  for (const auto& [text, said] :
       {std::pair("MFEM mesh v1.0\n\ndimension\n3\n\nvertices\n0\n", "MFEM's own format"),
        std::pair("mesh3d\ndimension\n3\n", "Netgen's own format"),
        std::pair("4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1\n1 1 2 3 4\n", "Netgen's neutral format")}) {
    const Result<CellMesh> read = cellsIn(fileWith("other.mesh", text));
    ASSERT_FALSE(read) << text;
    EXPECT_NE(read.error().message.find(said), std::string::npos) << read.error().message;
  }
}

TEST(ReadMesh, aPipeIsNotWaitedFor) {
  const fs::path pipe = testing::freshFolder("pipe") / "pipe.inp";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const auto mesh = readMesh(pipe, std::nullopt);
  ASSERT_FALSE(mesh);
  EXPECT_EQ(mesh.error().code, ErrorCode::kIo);
}

TEST(ReadSu2, volumeElementsAreRead) {
  expectTheSample(cellsIn(fileWith("sample.su2", su2())));
  std::string text = su2();
  text.replace(text.find("NDIME= 3"), 8, "NDIME= 2");
  const Result<CellMesh> flat = cellsIn(fileWith("flat.su2", text));
  ASSERT_FALSE(flat);
  EXPECT_NE(flat.error().message.find("2 dimensions"), std::string::npos);
}

const std::string kNode =
    "# points\n5 3 1 1\n1 0 0 0 0.5 0\n2 1 0 0 1.5 0\n3 0 1 0 2.5 0\n4 0 0 1 3.5 0 # the top\n5 1 "
    "1 1 4.5 1\n";
const std::string kEle = "2 4 1\n1 1 2 3 4 7\n2 2 3 4 5 8\n";

fs::path tetgenFiles(const std::string& node, const std::string& ele) {
  const fs::path path = fileWith("mesh.node", node);
  std::ofstream(path.parent_path() / "mesh.ele") << ele;
  return path;
}

TEST(ReadTetgen, pointsAndTetrahedraWithTheirAttributesAreRead) {
  const fs::path path = tetgenFiles(kNode, kEle);
  for (const fs::path& given : {path, path.parent_path() / "mesh.ele"}) {
    const Result<ReadMesh> read = readMesh(given);
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(read->mesh.tetrahedra, testing::twoCells().tetrahedra);
    EXPECT_EQ(read->mesh.points, testing::twoCells().points);
    ASSERT_EQ(read->mesh.fields.size(), 2u);
    EXPECT_EQ(read->mesh.fields[0].values, (std::vector<double>{0.5, 1.5, 2.5, 3.5, 4.5}));
    EXPECT_EQ(read->mesh.fields[1].values, (std::vector<double>{7, 8}));
  }
  const Result<CellMesh> zero =
      cellsIn(tetgenFiles("4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n", "1 4 0\n0 0 1 2 3\n"));
  ASSERT_TRUE(zero) << zero.error().text();
  EXPECT_EQ(zero->vertices, (std::vector<VertexId>{0, 1, 2, 3}));
}

TEST(ReadTetgen, aMissingPartnerAndWrongNumbersAreRefused) {
  const Result<CellMesh> alone = cellsIn(fileWith("mesh.node", kNode));
  ASSERT_FALSE(alone);
  EXPECT_EQ(alone.error().code, ErrorCode::kNotFound);
  EXPECT_NE(alone.error().message.find("mesh.ele"), std::string::npos);
  const Result<CellMesh> outside = cellsIn(tetgenFiles(kNode, "1 4 0\n1 0 2 3 4\n"));
  ASSERT_FALSE(outside);
  EXPECT_NE(outside.error().message.find("cell 0 is a tetrahedron"), std::string::npos)
      << outside.error().text();
  const Result<CellMesh> order = cellsIn(tetgenFiles("2 3 0 0\n1 0 0 0\n3 0 0 0\n", kEle));
  ASSERT_FALSE(order);
  EXPECT_NE(order.error().message.find("point 3 is where point 2 should be"), std::string::npos)
      << order.error().text();
}

/// A damaged file must give a mesh that passes the checks, or an error with a message.
void expectNoCrash(const std::string& name, const std::string& whole) {
  const fs::path path = fileWith(name, whole);
  const auto read = [&](const std::string& text) {
    // a file that is truncated instead is flushed to the disk by some file systems
    fs::remove(path);
    std::ofstream(path, std::ios::binary) << text;
    const Result<CellMesh> cells = cellsIn(path);
    EXPECT_TRUE(cells || !cells.error().message.empty());
    return cells.has_value();
  };
  const std::size_t step = whole.size() / 100 + 1;
  std::size_t readWhole = 0;
  for (std::size_t length = 0; length < whole.size(); length += step)
    readWhole += read(whole.substr(0, length)) ? 1 : 0;
  // what is cut in the last sections may be read: the fields behind the elements
  EXPECT_LT(readWhole, 50u) << name;
  std::mt19937 random(7);
  for (int round = 0; round < 100; ++round) {
    std::string text = whole;
    for (int changes = 0; changes < 3; ++changes) {
      char& c = text[random() % text.size()];
      c = random() % 2 ? static_cast<char>('0' + random() % 10)
                       : static_cast<char>(c ^ (1 << (random() % 8)));
    }
    (void)read(text);
  }
}

TEST(OwnReaders, damagedFilesNeverCrash) {
  for (const bool bytes : {false, true}) {
    expectNoCrash("damaged.msh", gmsh41(bytes));
    expectNoCrash("damaged22.msh", gmsh22(bytes));
    expectNoCrash(bytes ? "damaged.meshb" : "damaged.mesh", medit(bytes, 3));
  }
  expectNoCrash("damaged.su2", su2());
}

TEST(OwnReaders, aMeshCutBeforeItsLastElementIsRefused) {
  for (const auto& [name, text] :
       std::vector<std::pair<std::string, std::string>>{{"cut.msh", gmsh41(false)},
                                                        {"cut.msh", gmsh41(true)},
                                                        {"cut.msh", gmsh22(false)},
                                                        {"cut.msh", gmsh22(true)}}) {
    const std::size_t last = text.find("$EndElements");
    for (std::size_t length = 1; length < last; length += 37) {
      const Result<CellMesh> read = cellsIn(fileWith(name, text.substr(0, length)));
      ASSERT_FALSE(read) << name << " cut at " << length;
      EXPECT_TRUE(read.error().code == ErrorCode::kTruncated ||
                  read.error().code == ErrorCode::kBadInput)
          << read.error().text();
    }
  }
}

TEST(OwnReaders, noneGoesOnAfterItsTime) {
  const std::string unv = "    -1\n  2411\n 1 1 1 11\n 0 0 0\n    -1\n",
                    legacy =
                        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                        "POINTS 1 float\n0 0 0\n",
                    vtu = "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid/></VTKFile>";
  ReadOptions options;
  options.patience = std::chrono::seconds(-100);
  for (const fs::path& path :
       {fileWith("a.msh", gmsh22(false)), fileWith("b.msh", gmsh41(true)),
        fileWith("a.mesh", medit(false, 2)), fileWith("a.meshb", medit(true, 3)),
        fileWith("a.su2", su2()), tetgenFiles(kNode, kEle), fileWith("a.unv", unv),
        fileWith("a.vtk", legacy), fileWith("a.vtu", vtu),
        fileWith("a.inp", "*NODE\n1, 0, 0, 0\n")}) {
    const Result<ReadMesh> read = readMesh(path, options);
    ASSERT_FALSE(read) << path;
    EXPECT_EQ(read.error().code, ErrorCode::kBadInput) << path;
    EXPECT_NE(read.error().message.find("`readSeconds`"), std::string::npos) << read.error().text();
  }
}

TEST(MeshScanner, theFirstErrorStays) {
  MeshScanner in("1 x 2", "f.txt");
  EXPECT_EQ(in.number<int>("a number"), 1);
  EXPECT_EQ(in.number<int>("a number"), 0);
  EXPECT_TRUE(in.failed());
  EXPECT_EQ(in.number<int>("another"), 0);
  EXPECT_NE(in.status().error().message.find("f.txt, line 1: 'x' is where a number should be"),
            std::string::npos);
  MeshScanner range("300", "f.txt");
  EXPECT_EQ(range.number<std::uint8_t>("a byte"), 0);
  EXPECT_TRUE(range.failed());
  MeshScanner reals("1e400 -1e400 1e-400 0.5 1e-310", "f.txt");
  EXPECT_TRUE(std::isinf(reals.number<double>("a number")));
  EXPECT_TRUE(std::isinf(reals.number<double>("a number")));
  EXPECT_EQ(reals.number<double>("a number"), 0);
  EXPECT_EQ(reals.number<double>("a number"), 0.5);
  EXPECT_EQ(reals.number<double>("a number"), 1e-310);
  EXPECT_FALSE(reals.failed());
  MeshScanner counts("12345678", "f.txt");
  EXPECT_TRUE(counts.fits(4, 2, "things"));
  EXPECT_FALSE(counts.fits(5, 2, "things"));
  EXPECT_FALSE(MeshScanner("1", "f").fits(~std::uint64_t{0}, 8, "things"));
}

}  // namespace
}  // namespace qtet
