// Bounds that the user states: which fields they mean, and the steps that hold them.
#include "simplify/clean/value_bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include "proto/limits.h"
#include "proto/rounding_error.h"
#include "simplify/clean/field_scales.h"
#include "simplify/clean/quantise.h"
#include "simplify/clean/verify.h"
#include "tests/simplify/mesh/tet_meshes.h"

namespace qtet {
namespace {

/// A ramp of 1,001 values.
MeshField ramp(const std::string& name, double low, double high,
               const std::string& type = "float64") {
  MeshField out{name, 1, type, {}, "point"};
  for (int i = 0; i <= 1000; ++i) {
    const double value = low + (high - low) * i / 1000;
    out.values.push_back(type == "float32" ? static_cast<float>(value) : value);
  }
  return out;
}

Result<QuantisedField> within(const MeshField& field, double bound) {
  return quantiseField(field, extentsOf(field), FieldPrecision{.largestError = bound});
}

/// The largest difference of values in the field's type to those of the input.
double largestErrorOf(const MeshField& field, const QuantisedField& quantised) {
  double out = 0;
  for (std::size_t i = 0; i < field.values.size(); ++i) {
    if (!std::isfinite(field.values[i])) continue;
    double value = quantised.info.value(i % field.components, quantised.values[i]);
    if (field.type == "float32") value = static_cast<float>(value);
    out = std::max(out, std::abs(value - field.values[i]));
  }
  return out;
}

TEST(ValueBounds, meanAFieldAllInstantsOfASeriesOrTheOthers) {
  const std::vector<MeshField> fields{ramp("T@0", 0, 1), ramp("T@1", 0, 1), ramp("p", 0, 1),
                                      ramp("i", 0, 1000, "int32")};
  const auto values = [&](const ValueBounds& bounds) {
    std::vector<double> out;
    for (const auto& bound : valueBoundsOf(fields, bounds)) out.push_back(bound ? bound->value : 0);
    return out;
  };
  EXPECT_EQ(values({{"T", {2}}}), (std::vector<double>{2, 2, 0, 0}));
  EXPECT_EQ(values({{"all", {1, "%"}}, {"T", {2}}, {"T@1", {3}}}),
            (std::vector<double>{2, 3, 1, 0}));
  EXPECT_EQ(values({{"point:p", {2}}, {"p", {4}}, {"all", {1}}}),
            (std::vector<double>{1, 1, 4, 0}));
  EXPECT_EQ(values({{"i", {2}}}), (std::vector<double>{0, 0, 0, 2}));
  const std::vector<MeshField> called{ramp("all", 0, 1), ramp("p", 0, 1)};
  EXPECT_FALSE(valueBoundsOf(called, {{"all", {1}}})[1]) << "a field has the name";
}

TEST(ValueBounds, thatAreNoneAndOtherUnitsAreRefused) {
  const std::vector<MeshField> fields{ramp("T@0", 0, 1), ramp("T@1", 0, 1), ramp("U [m/s]", 0, 1),
                                      ramp("p", 0, 1)};
  const Units units{{"T", "K"}};
  const auto code = [&](const std::string& name, const ValueBound& bound) {
    const Status checked = checkValueBounds(fields, {{name, bound}}, units);
    return checked ? ErrorCode::kCancelled : checked.error().code;  // none
  };
  for (const ValueBound& bound : {ValueBound{1}, {1, "K"}, {1, "%"}})
    EXPECT_EQ(code("T", bound), ErrorCode::kCancelled) << bound.unit;
  EXPECT_EQ(code("U [m/s]", {1, "m/s"}), ErrorCode::kCancelled);
  EXPECT_EQ(code("all", {1, "%"}), ErrorCode::kCancelled);
  EXPECT_EQ(code("T", {1, "C"}), ErrorCode::kBadValue);
  EXPECT_EQ(code("p", {1, "Pa"}), ErrorCode::kBadValue);
  EXPECT_EQ(code("all", {1, "K"}), ErrorCode::kBadValue);
  EXPECT_EQ(code("q", {1}), ErrorCode::kNotFound);
  for (const double value : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(code("T", {value}), ErrorCode::kBadValue) << value;
}

TEST(QuantiseField, aBoundTakesTheLargestStepThatHoldsItAndDividesTheRange) {
  const MeshField field = ramp("T", 300, 400);
  const QuantisedField out = within(field, 0.5).value();
  EXPECT_EQ(out.info.step, 100.0 / 101) << "a hundred steps would leave no room for rounding";
  EXPECT_EQ(out.info.bits, 7);
  EXPECT_LE(largestErrorOf(field, out), 0.5);
  EXPECT_EQ(std::ranges::max(out.values), 101);
  const QuantisedField two = within(field, 60).value();
  EXPECT_EQ(two.info.bits, kMinFieldBits);
  EXPECT_EQ(two.info.step, 100);
}

TEST(QuantiseField, aBoundOfHalfAStepAndItsRoundingIsAtTheEdge) {
  const MeshField field = ramp("T", 0, 255);
  const double rounding = typeRounding("float64", 510);  // of twice the range
  EXPECT_EQ(within(field, 0.5 + rounding).value().info.step, 1);
  EXPECT_EQ(within(field, 0.5 + rounding).value().info.bits, 8);
  EXPECT_EQ(within(field, 0.5).value().info.bits, 9);
  EXPECT_EQ(within(field, 0.5).value().info.step, 255.0 / 256);
}

TEST(QuantiseField, valuesOfFloat32HoldTheirBoundAfterRounding) {
  std::mt19937 random(7);
  for (const double offset : {0.0, 300.0, -1e5}) {
    MeshField field{"v", 3, "float32", {}, "point"};
    for (int i = 0; i < 3000; ++i)
      field.values.push_back(static_cast<float>(offset + std::ldexp(random(), -31)));
    const double finest = typeRounding("float32", std::abs(offset) + 4);
    for (const double bound : {1.0, 0.01, 2 * finest, 1.1 * finest}) {
      const Result<QuantisedField> out = within(field, bound);
      ASSERT_TRUE(out) << offset << " " << bound << out.error().text();
      EXPECT_LE(largestRoundingError(out->info), bound);
      EXPECT_LE(largestErrorOf(field, *out), bound) << offset;
    }
  }
}

TEST(QuantiseField, aBoundBeyondTheBitsOrTheTypeIsRefusedByNameWithWhatIsPossible) {
  const MeshField field = ramp("T", 0, 1);
  const double finest = 0.5 / (std::ldexp(1.0, kMaxFieldBits) - 1) + typeRounding("float64", 2);
  EXPECT_EQ(within(field, 1.0001 * finest).value().info.bits, kMaxFieldBits);
  for (const MeshField& each : {field, ramp("T", 1000, 1001, "float32")}) {
    const Result<QuantisedField> out = within(each, 0.999 * finest);
    ASSERT_FALSE(out);
    EXPECT_EQ(out.error().code, ErrorCode::kBadValue);
    EXPECT_TRUE(out.error().message.starts_with("field T cannot be within 1.8"))
        << out.error().text();
  }
  const std::string text = within(field, 1e-12).error().message;
  const double told = std::stod(text.substr(text.find("an error of ") + 12));
  EXPECT_TRUE(within(field, told)) << text;
}

TEST(QuantiseField, theErrorThatIsToldAsPossibleIsPossibleOfTheSmallestDoubles) {
  for (const double largest : {5e-324, 6e-310, 3e-308, 1e-300}) {
    const MeshField field = ramp("T", 0, largest);
    const Result<QuantisedField> out = within(field, 1e-320);
    ASSERT_FALSE(out) << largest;
    const std::string& text = out.error().message;
    const double told = std::strtod(text.c_str() + text.find("an error of ") + 12, nullptr);
    EXPECT_TRUE(within(field, told)) << text;
  }
}

TEST(QuantiseField, aBoundOfWhatIsExactOrConstantHolds) {
  const MeshField integers = ramp("i", 0, 1000, "int32");
  EXPECT_TRUE(within(integers, 1e-9).value().exact);
  const MeshField wide = ramp("i", -1e12, 1e12, "int64");
  EXPECT_LE(largestErrorOf(wide, within(wide, 1e5).value()), 1e5);
  const MeshField constant = ramp("c", 0.1, 0.1, "float32");
  EXPECT_EQ(largestRoundingError(within(constant, 1e-30).value().info), 0);
  const MeshField vectors{"v", 2, "float64", {1, 2, 1, 2}, "point"};
  EXPECT_LE(largestRoundingError(within(vectors, 1e-9).value().info), 1e-9);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(within({"n", 1, "float32", {nan, nan}}, 1e-9));
}

TEST(QuantiseField, instantsOfOneBoundShareAStepAndThoseThatLeadAwayHoldIt) {
  std::vector<MeshField> fields;
  for (int i = 0; i < 5; ++i)
    fields.push_back(ramp("T@" + std::to_string(i), 300, 310 + i, "float32"));
  fields.push_back(fields.back());
  fields.back().name = "T@5", fields.back().values[3] = 1e6;
  const FieldScales all = scalesOf(fields);
  ASSERT_TRUE(all.scales[5].isExceeded);
  for (const ValueBound& bound : {ValueBound{0.01}, {0.1, "%"}}) {
    std::vector<QuantisedField> out;
    for (std::size_t f = 0; f < 5; ++f)
      out.push_back(quantiseBy(all.scales[f], fields[f], 12, bound).value());
    for (std::size_t f = 0; f < 5; ++f) {
      EXPECT_TRUE(haveOneScale(out[f].info, out[0].info)) << f;
      EXPECT_LE(largestErrorOf(fields[f], out[f]), bound.isOfRange() ? 0.014 : 0.01) << f;
    }
    EXPECT_EQ(out[0].info.bits, 10 - (bound.isOfRange() ? 1 : 0));
  }
  // a float32 of a million is a multiple of a sixteenth
  const Result<QuantisedField> away = quantiseBy(all.scales[5], fields[5], 12, ValueBound{0.2});
  ASSERT_TRUE(away) << away.error().text();
  EXPECT_LE(largestErrorOf(fields[5], *away), 0.2);
  EXPECT_FALSE(quantiseBy(all.scales[5], fields[5], 12, ValueBound{0.01}));
  const QuantisedField ofOwn =
      quantiseBy(all.scales[5], fields[5], 12, ValueBound{0.1, "%"}).value();
  EXPECT_LE(largestErrorOf(fields[5], ofOwn), 1e3) << "of the million";
}

TEST(Quantise, fieldsWithoutABoundKeepTheirBits) {
  TetMesh mesh = finSample();
  const QuantisedMesh plain = quantise(mesh).value();
  const QuantisedMesh out = quantise(mesh, {.errors = {{mesh.fields[0].name, {0.1, "%"}}}}).value();
  EXPECT_EQ(out.mesh.fields[0].bits, 9);
  for (std::size_t f = 1; f < mesh.fields.size(); ++f) {
    EXPECT_EQ(out.mesh.fields[f].step, plain.mesh.fields[f].step);
    EXPECT_EQ(out.mesh.values[f], plain.mesh.values[f]);
  }
  const OnLattice put = putOnLattice(mesh, out.mesh.lattice, out.mesh.fields).value();
  EXPECT_EQ(put.mesh.values, out.mesh.values);
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    EXPECT_LE(put.largestValueErrors[f], largestRoundingError(out.mesh.fields[f]));
    EXPECT_GT(put.largestValueErrors[f], 0.4 * out.mesh.fields[f].step);
  }
}

}  // namespace
}  // namespace qtet
