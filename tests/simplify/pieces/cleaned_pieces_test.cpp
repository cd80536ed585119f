#include "simplify/pieces/cleaned_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "simplify/blocks/mesh_piece.h"
#include "simplify/pieces/cut_pieces.h"
#include "tests/support/random_solid.h"

namespace qtet {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A random solid in doubles, with a field of points, a label and a vector.
TetMesh randomMesh(std::uint32_t seed) {
  const LatticeMesh solid = testing::randomSolid(seed).mesh;
  TetMesh out;
  out.pointType = "float64";
  for (const LatticePoint& p : solid.points)
    out.points.push_back({0.5 * p[0] + 1, 0.5 * p[1], 0.5 * p[2] - 7});
  out.tetrahedra = solid.tetrahedra;
  MeshField t{.name = "T", .values = {}}, u{.name = "U", .components = 3, .values = {}};
  for (const Position& p : out.points) {
    t.values.push_back(p[0] * p[1] + p[2]);
    u.values.insert(u.values.end(), {p[1], -p[0], p[2] * p[2]});
  }
  MeshField label{.name = "Material", .type = "int32", .values = {}, .association = "cell"};
  for (std::size_t c = 0; c < out.tetrahedra.size(); ++c) {
    const std::size_t third = c * 3 / out.tetrahedra.size();
    label.values.push_back(static_cast<double>(third));
  }
  out.fields = {t, u, label};
  return out;
}

/// Shuffles cells, turns components and single cells, adds duplicates, cells that repeat a vertex,
/// unused points and points at the same place.
void damage(TetMesh& mesh, std::mt19937& random) {
  std::vector<std::size_t> order(mesh.tetrahedra.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  for (int i = 0; i < 3; ++i) order.push_back(order[random() % order.size()]);
  const std::vector<Tetrahedron> cells = mesh.tetrahedra;
  const std::vector<double> labels = mesh.fields[2].values;
  mesh.tetrahedra.clear(), mesh.fields[2].values.clear();
  for (const std::size_t i : order) {
    Tetrahedron cell = cells[i];
    if (random() % 3 == 0) std::swap(cell[0], cell[1]);
    mesh.tetrahedra.push_back(cell);
    mesh.fields[2].values.push_back(labels[i]);
  }
  mesh.tetrahedra[random() % mesh.tetrahedra.size()] = {0, 1, 1, 2};
  mesh.points.push_back({5000, 0, 0});
  mesh.points.push_back(mesh.points[mesh.tetrahedra[0][0]]);
  for (int i = 0; i < 2; ++i) {
    mesh.fields[0].values.push_back(1e6);
    mesh.fields[1].values.insert(mesh.fields[1].values.end(), {0, 0, 1e6});
  }
}

struct Small {
  CleanReport clean;
  QuantisedMesh quantised;
};

Result<Small> smallPath(TetMesh mesh) {
  Result<CleanReport> clean = cleanMesh(mesh);
  if (!clean) return std::unexpected(clean.error());
  Result<QuantisedMesh> quantised = quantise(mesh);
  if (!quantised) return std::unexpected(quantised.error());
  return Small{std::move(*clean), std::move(*quantised)};
}

MeshPiece joinedOf(CleanedPieces& pieces) {
  std::vector<MeshPiece> all;
  const Status given = pieces.forEach([&](GivenPiece&& piece) -> Status {
    EXPECT_EQ(piece.number, all.size());
    all.push_back(std::move(piece.piece));
    return {};
  });
  EXPECT_TRUE(given);
  return joined(all, {pieces.fields(), 0, 0});
}

void expectTheSame(CleanedPieces& pieces, const Small& small, bool comparesMissing = true) {
  const LatticeMesh& mesh = small.quantised.mesh;
  EXPECT_EQ(pieces.cleanReport().sentences(), small.clean.sentences());
  EXPECT_NEAR(pieces.cleanReport().volume, small.clean.volume, 1e-9 * small.clean.volume);
  EXPECT_EQ(pieces.cleanReport().box, small.clean.box);
  EXPECT_EQ(pieces.quantiseReport().notes, small.quantised.report.notes);
  EXPECT_EQ(pieces.tetrahedra(), mesh.tetrahedra.size());
  EXPECT_EQ(pieces.vertices(), mesh.points.size());
  EXPECT_EQ(pieces.triangles(), mesh.boundary.size());
  EXPECT_EQ(pieces.lattice().bits, mesh.lattice.bits);
  EXPECT_EQ(pieces.lattice().step, mesh.lattice.step);
  const MeshPiece whole = joinedOf(pieces);
  EXPECT_EQ(whole.points, mesh.points);
  EXPECT_EQ(whole.tetrahedra, mesh.tetrahedra);
  std::vector<Triangle> boundary;
  for (const PieceTriangle& t : whole.boundary) boundary.push_back(t.corners);
  EXPECT_EQ(boundary, mesh.boundary);
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    EXPECT_EQ(pieces.fields()[f].step, mesh.fields[f].step);
    EXPECT_EQ(pieces.fields()[f].bits, mesh.fields[f].bits);
    EXPECT_EQ(pieces.fields()[f].minimum, mesh.fields[f].minimum);
    EXPECT_EQ(pieces.fields()[f].range, mesh.fields[f].range);
    EXPECT_EQ(whole.missing[f], small.quantised.missing[f]);
    if (comparesMissing) {
      EXPECT_EQ(whole.values[f], mesh.values[f]);
    }
  }
}

TEST(CleanedPieces, areWhatTheSmallPathMakesOfTheWhole) {
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    std::mt19937 random(seed);
    TetMesh mesh = randomMesh(seed);
    if (seed % 4 != 0) damage(mesh, random);
    const Result<Small> small = smallPath(mesh);
    for (const std::size_t cells : {std::size_t{1} + random() % 40, mesh.tetrahedra.size()}) {
      TetMesh copy = mesh;
      CutPieces input(std::move(copy), cells);
      Result<CleanedPieces> pieces = CleanedPieces::of(input, {});
      ASSERT_EQ(pieces.has_value(), small.has_value()) << seed;
      if (small)
        expectTheSame(*pieces, *small);
      else
        EXPECT_EQ(pieces.error().code, small.error().code);
      if (HasFailure()) FAIL() << "seed " << seed << ", pieces of " << cells;
    }
  }
}

TEST(CleanedPieces, missingValuesOfSharedVerticesAreTheSameInAllPieces) {
  TetMesh mesh = randomMesh(4);
  for (std::size_t v = 0; v < mesh.points.size(); v += 2) mesh.fields[0].values[v] = kNaN;
  mesh.fields[2].values[1] = kNaN, mesh.fields[2].type = "float32";
  const Result<Small> small = smallPath(mesh);
  ASSERT_TRUE(small);
  CutPieces input(std::move(mesh), 5);
  Result<CleanedPieces> pieces = CleanedPieces::of(input, {});
  ASSERT_TRUE(pieces) << pieces.error().text();
  expectTheSame(*pieces, *small, false);
  std::map<WholeVertex, std::int32_t> values;
  const Status given = pieces->forEach([&](GivenPiece&& piece) -> Status {
    for (std::size_t v = 0; v < piece.piece.vertices.size(); ++v) {
      const auto [at, isNew] =
          values.try_emplace(piece.piece.vertices[v], piece.piece.values[0][v]);
      EXPECT_EQ(at->second, piece.piece.values[0][v]);
    }
    return {};
  });
  EXPECT_TRUE(given);
}

TEST(CleanedPieces, overlapsAndRingsAreFoundAcrossPieces) {
  TetMesh crowd;
  crowd.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}};
  crowd.tetrahedra = {{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 1, 2, 5}};
  const Result<Small> small = smallPath(crowd);
  ASSERT_FALSE(small);
  for (const std::size_t cells : {1, 2, 3}) {
    TetMesh copy = crowd;
    CutPieces input(std::move(copy), cells);
    const Result<CleanedPieces> pieces = CleanedPieces::of(input, {});
    ASSERT_FALSE(pieces);
    EXPECT_EQ(pieces.error().message, small.error().message);
  }
}

/// The cells of a mesh as parts that have their own points.
class OwnParts final : public InputPieces {
 public:
  OwnParts(const TetMesh& mesh, std::uint32_t parts) : mesh_(mesh), parts_(parts) {}

  [[nodiscard]] std::uint64_t points() const override {
    return std::uint64_t{parts_} * mesh_.points.size();
  }
  [[nodiscard]] std::uint32_t parts() const override { return parts_; }
  [[nodiscard]] Result<std::optional<InputPiece>> next() override {
    if (part_ == parts_) return std::nullopt;
    const std::size_t cells = mesh_.tetrahedra.size();
    InputPiece out = cutOut(mesh_, part_ * cells / parts_, (part_ + 1) * cells / parts_);
    for (WholeVertex& v : out.vertices) v += std::uint64_t{part_} * mesh_.points.size();
    out.part = part_++;
    return out;
  }

 private:
  const TetMesh& mesh_;
  std::uint32_t parts_, part_ = 0;
};

TEST(CleanedPieces, partsJoinAtPointsThatLieAtOnePlace) {
  const TetMesh mesh = randomMesh(8);
  TetMesh copy = mesh;
  CutPieces whole(std::move(copy));
  const Result<CleanedPieces> one = CleanedPieces::of(whole, {});
  ASSERT_TRUE(one);
  OwnParts input(mesh, 4);
  Result<CleanedPieces> pieces = CleanedPieces::of(input, {});
  ASSERT_TRUE(pieces) << pieces.error().text();
  EXPECT_EQ(pieces->tetrahedra(), one->tetrahedra());
  EXPECT_EQ(pieces->vertices(), one->vertices());
  EXPECT_EQ(pieces->triangles(), one->triangles());
  EXPECT_EQ(pieces->cleanReport().components, one->cleanReport().components);
  EXPECT_EQ(pieces->cleanReport().coincidentPoints.count, 0u);
  const MeshPiece joined = joinedOf(*pieces);
  EXPECT_EQ(joined.tetrahedra.size(), mesh.tetrahedra.size());
  EXPECT_EQ(joined.vertices.size(), one->vertices());
}

TEST(CleanedPieces, aJoinedPointHasTheEarlierPartsValuesWhereItHasSome) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.tetrahedra = {{0, 1, 2, 3}, {4, 1, 3, 2}};
  mesh.fields = {{.name = "T", .values = {0, 1, 2, 3, 4}}};
  class Differing final : public InputPieces {
   public:
    explicit Differing(const TetMesh& mesh) : parts_(mesh, 2) {}
    [[nodiscard]] std::uint64_t points() const override { return parts_.points(); }
    [[nodiscard]] std::uint32_t parts() const override { return 2; }
    [[nodiscard]] Result<std::optional<InputPiece>> next() override {
      auto out = parts_.next();
      if (!out || !*out) return out;
      std::vector<double>& values = (*out)->mesh.fields[0].values;
      if ((*out)->part == 0)
        values[1] = kNaN;
      else
        for (double& value : values) value += 0.25;
      return out;
    }

   private:
    OwnParts parts_;
  };
  Differing input(mesh);
  Result<CleanedPieces> pieces = CleanedPieces::of(input, {});
  ASSERT_TRUE(pieces) << pieces.error().text();
  const MeshPiece whole = joinedOf(*pieces);
  std::vector<double> values;
  for (const std::int32_t v : whole.values[0]) values.push_back(pieces->fields()[0].value(0, v));
  const std::vector<double> expected{0, 1.25, 2, 3, 4.25};
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(values[i], expected[i], 2e-3);
}

TEST(CleanedPieces, aPlaceWithSeveralPointsOfAPartIsRefused) {
  TetMesh mesh;  // two cells that touch in a point, each with its own, and a third one
  mesh.points = {{0, 0, 0}, {1, 0, 0},  {0, 1, 0},  {0, 0, 1},
                 {0, 0, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  mesh.tetrahedra = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}};
  OwnParts input(mesh, 2);
  const Result<CleanedPieces> pieces = CleanedPieces::of(input, {});
  ASSERT_FALSE(pieces);
  EXPECT_EQ(pieces.error().code, ErrorCode::kBadInput);
  EXPECT_NE(pieces.error().message.find("lie at one place"), std::string::npos);
}

}  // namespace
}  // namespace qtet
