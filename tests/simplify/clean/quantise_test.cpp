#include "simplify/clean/quantise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "codec/mesh/predicates.h"
#include "proto/limits.h"
#include "simplify/clean/quantise_field.h"
#include "tests/simplify/mesh/tet_meshes.h"

namespace qtet {
namespace {

using testing::oneCell;

QuantisedMesh quantised(const TetMesh& mesh, const QuantiseOptions& options = {}) {
  Result<QuantisedMesh> out = quantise(mesh, options);
  EXPECT_TRUE(out) << out.error().text();
  return out ? std::move(*out) : QuantisedMesh{};
}

QuantisedField field(const MeshField& values, int bits) {
  Result<QuantisedField> out = quantiseField(values, bits);
  EXPECT_TRUE(out);
  return out ? std::move(*out) : QuantisedField{};
}

TEST(Quantise, theLongestAxisFillsTheLattice) {
  TetMesh mesh = oneCell();
  for (Position& p : mesh.points) p = {p[0] * 3 - 1, p[1] * 2 + 5, p[2]};
  const QuantisedMesh out = quantised(mesh, {.positionBits = 10});
  EXPECT_EQ(out.mesh.lattice.bits, 10);
  EXPECT_DOUBLE_EQ(out.mesh.lattice.step, 3.0 / 1023);
  EXPECT_EQ(out.mesh.lattice.origin, (Position{-1, 5, 0}));
  EXPECT_EQ(out.mesh.points,
            (std::vector<LatticePoint>{{0, 0, 0}, {1023, 0, 0}, {0, 682, 0}, {0, 0, 341}}));
  EXPECT_EQ(out.mesh.boundary.size(), 4u);
  EXPECT_TRUE(out.report.notes.empty());
}

TEST(Quantise, positionsAreWithinHalfAStep) {
  const TetMesh mesh = finSample();
  const QuantisedMesh out = quantised(mesh);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const Position back = out.mesh.lattice.position(out.mesh.points[v]);
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_LE(std::abs(back[k] - mesh.points[v][k]), out.mesh.lattice.step * (0.5 + 1e-9));
  }
}

TEST(Quantise, bitsAreAddedUntilNoCellIsWorse) {
  TetMesh mesh = oneCell();
  mesh.points[3] = {0.2, 0.2, 1.0 / 5000};  // flat on ten bits, a step high on thirteen
  const QuantisedMesh out = quantised(mesh, {.positionBits = 10});
  EXPECT_EQ(out.mesh.lattice.bits, 12);
  EXPECT_EQ(out.report.worseAtRequestedBits, 1u);
  EXPECT_EQ(out.report.worseCells.count, 0u);
  ASSERT_EQ(out.report.notes.size(), 1u);
  const auto& p = out.mesh.points;
  EXPECT_EQ(orientation(p[0], p[1], p[2], p[3]), 1);
}

/// Cells of height 1e-12 and then of height 1, side by side.
TetMesh thinAndThick(int thin, int thick) {
  TetMesh mesh;
  for (int i = 0; i < thin + thick; ++i) {
    const auto first = static_cast<VertexId>(mesh.points.size());
    const double x = 2.0 * i;
    mesh.points.insert(mesh.points.end(),
                       {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}, {x, 0, i < thin ? 1e-12 : 1}});
    mesh.tetrahedra.push_back({first, first + 1, first + 2, first + 3});
  }
  return mesh;
}

TEST(Quantise, whatNoLatticeHoldsIsReportedAtTheMost) {
  const QuantisedMesh out = quantised(thinAndThick(1, 1));
  EXPECT_EQ(out.mesh.lattice.bits, kMaxPositionBits);
  EXPECT_EQ(out.report.worseCells.first, std::vector<std::uint64_t>{0});
  EXPECT_EQ(out.report.notes.size(), 2u);
}

TEST(Quantise, aMeshOfWhichMostIsFlattenedIsRefused) {
  EXPECT_TRUE(quantise(thinAndThick(49, 51)));
  EXPECT_TRUE(quantise(thinAndThick(50, 50)));
  const auto refused = quantise(thinAndThick(51, 49));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kBadInput);
  EXPECT_NE(refused.error().message.find("51 of its 100 cells would be flattened"),
            std::string::npos)
      << refused.error().message;
}

TEST(Quantise, aCellThatWasFlatMayStayFlat) {
  TetMesh mesh = oneCell();
  mesh.points[3] = {0.5, 0.5, 0};
  EXPECT_EQ(quantised(mesh).mesh.lattice.bits, 16);
}

TEST(Quantise, bitsOutsideTheLimitsAreRefused) {
  for (const int bits : {kMinPositionBits - 1, kMaxPositionBits + 1}) {
    const auto out = quantise(oneCell(), {.positionBits = bits});
    ASSERT_FALSE(out);
    EXPECT_EQ(out.error().code, ErrorCode::kBadValue);
  }
  for (const int bits : {kMinFieldBits - 1, kMaxFieldBits + 1})
    EXPECT_FALSE(quantise(oneCell(), {.fieldBits = bits}));
  EXPECT_TRUE(quantise(oneCell(), {.positionBits = kMinPositionBits, .fieldBits = kMaxFieldBits}));
}

TEST(Quantise, extentsThatADoubleCannotHoldAreRefused) {
  TetMesh mesh = oneCell();
  mesh.points[1] = {1.7e308, 0, 0};
  mesh.points[0] = {-1.7e308, 0, 0};
  ASSERT_FALSE(quantise(mesh));
  EXPECT_EQ(quantise(mesh).error().code, ErrorCode::kBadInput);
  mesh = oneCell();
  for (Position& p : mesh.points) p = {p[0] * 1e-310, p[1] * 1e-310, p[2] * 1e-310};
  const auto tiny = quantise(mesh);
  ASSERT_FALSE(tiny);
  EXPECT_NE(tiny.error().message.find("1e-310 units large"), std::string::npos)
      << tiny.error().message;
  for (Position& p : mesh.points) p = {p[0] * 1e300, p[1] * 1e300, p[2] * 1e300};
  EXPECT_TRUE(quantise(mesh));
}

TEST(Quantise, valuesBelowTheFinestStepAreNotedWithWhatHelps) {
  TetMesh mesh = oneCell();
  mesh.fields = {{"u", 1, "float64", {0, 6e-310, 3e-310, 1e-310}, "point"}};
  const auto told = quantised(mesh).report.notes;
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NE(told[0].find("span 6e-310"), std::string::npos) << told[0];
  for (double& value : mesh.fields[0].values) value *= 1e300;
  const QuantisedMesh larger = quantised(mesh);
  EXPECT_TRUE(larger.report.notes.empty());
  EXPECT_EQ(larger.mesh.values[0][1], 4095);
}

TEST(QuantiseField, vectorsShareAStepAndHaveAMinimumEach) {
  const QuantisedField out = field({"v", 2, "float32", {1, -2, 3, 8, 2, 3}}, 4);
  EXPECT_DOUBLE_EQ(out.info.step, 10.0 / 15);
  EXPECT_EQ(out.info.minimum, (std::vector<double>{1, -2}));
  EXPECT_EQ(out.values, (std::vector<std::int32_t>{0, 0, 3, 15, 2, 8}));
  EXPECT_DOUBLE_EQ(out.info.range[0], std::sqrt(5.0));
  EXPECT_DOUBLE_EQ(out.info.range[1], std::sqrt(73.0));
}

TEST(QuantiseField, aConstantIsExact) {
  const QuantisedField out = field({"c", 1, "float64", {0.1, 0.1}}, 12);
  EXPECT_EQ(out.info.minimum[0], 0.1);
  EXPECT_GT(out.info.step, 0);
  EXPECT_EQ(out.values, (std::vector<std::int32_t>{0, 0}));
}

TEST(QuantiseField, whatIsNotFiniteIsAGap) {
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               inf = std::numeric_limits<double>::infinity();
  const QuantisedField out = field({"f", 1, "float32", {nan, 2, inf, 4, -inf}}, 8);
  EXPECT_EQ(out.nonFinite, 3u);
  EXPECT_TRUE(out.info.hasMissing);
  EXPECT_EQ(out.missing, (std::vector<std::uint8_t>{1, 0, 1, 0, 1}));
  EXPECT_EQ(out.values, (std::vector<std::int32_t>{0, 0, 0, 255, 0}));
  EXPECT_EQ(out.info.range, (std::array<double, 2>{2, 4}));
  EXPECT_EQ(field({"f", 1, "float32", {nan, nan}}, 8).info.minimum[0], 0);
}

TEST(QuantiseField, integersAreExactUpToTheLimitOfBits) {
  const double extent = std::ldexp(1.0, kMaxFieldBits) - 1;
  const QuantisedField out = field({"i", 1, "int32", {-5, extent - 5, 7}}, 4);
  EXPECT_TRUE(out.exact);
  EXPECT_EQ(out.info.bits, kMaxFieldBits);
  EXPECT_EQ(out.info.step, 1);
  EXPECT_EQ(out.values, (std::vector<std::int32_t>{0, static_cast<std::int32_t>(extent), 12}));
  const QuantisedField beyond = field({"i", 1, "int32", {-5, extent - 4, 7}}, 4);
  EXPECT_FALSE(beyond.exact);
  EXPECT_EQ(beyond.info.bits, 4);
}

TEST(QuantiseField, aSpanBeyondDoublesIsRefused) {
  const auto out = quantiseField({"f", 1, "float64", {-1.7e308, 1.7e308}}, 12);
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().code, ErrorCode::kBadInput);
}

}  // namespace
}  // namespace qtet
