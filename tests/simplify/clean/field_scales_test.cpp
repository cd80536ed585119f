// The scales of a series whose instants are not all of one size.
#include "simplify/clean/field_scales.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "proto/number_text.h"

namespace qtet {
namespace {

/// An instant of T: a ramp of 101 values from `low` to `high`.
MeshField instant(double time, double low, double high) {
  MeshField out{"T@" + shortestText(time), 1, "float64", {}, "point"};
  for (int i = 0; i <= 100; ++i) out.values.push_back(low + (high - low) * i / 100);
  return out;
}

/// The distance of the values from their integers.
double errorOf(const MeshField& field, const QuantisedField& quantised) {
  double out = 0;
  for (std::size_t i = 0; i < field.values.size(); ++i)
    out = std::max(out, std::abs(quantised.info.value(0, quantised.values[i]) - field.values[i]));
  return out;
}

std::vector<QuantisedField> quantiseAll(const std::vector<MeshField>& fields) {
  const FieldScales all = scalesOf(fields);
  std::vector<QuantisedField> out;
  for (std::size_t f = 0; f < fields.size(); ++f)
    out.push_back(quantiseBy(all.scales[f], fields[f], 12).value());
  return out;
}

TEST(FieldScales, aDivergedInstantLeavesTheOthersTheirStep) {
  std::vector<MeshField> fields;
  for (int i = 0; i < 5; ++i) fields.push_back(instant(0.1 * i, 300, 320 + i));
  fields.push_back(instant(0.5, 3e8, 3.2e8));
  const std::vector<QuantisedField> out = quantiseAll(fields);
  for (std::size_t f = 0; f < 5; ++f) {
    EXPECT_TRUE(haveOneScale(out[f].info, out[0].info)) << f;
    EXPECT_LE(errorOf(fields[f], out[f]), 0.5 * 24 / 4095 * 1.001) << f;
  }
  EXPECT_LE(errorOf(fields[5], out[5]), 0.5 * 2e7 / 4095 * 1.001);
  const std::vector<std::string> warnings = scalesOf(fields).outlying.warnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(
      warnings[0].starts_with("point field T: its values at time 0.5 span 3e+08 to 3.2e+08, "
                              "and those of its other instants 300 to 324; "))
      << warnings[0];
}

TEST(FieldScales, halfOfTheInstantsMayDiverge) {
  std::vector<MeshField> fields;
  for (int i = 0; i < 3; ++i) fields.push_back(instant(i, 0, 1));
  for (int i = 3; i < 6; ++i) fields.push_back(instant(i, 0, 1e6));
  const std::vector<QuantisedField> out = quantiseAll(fields);
  EXPECT_LE(errorOf(fields[0], out[0]), 1.001 * 0.5 / 4095);
  EXPECT_TRUE(haveOneScale(out[3].info, out[5].info)) << "those beyond share theirs";
}

TEST(FieldScales, theRangeMayGrowByFour) {
  for (const double most : {3.99, 4.0, 4.01}) {
    const std::vector<QuantisedField> out =
        quantiseAll({instant(0, 0, 1), instant(1, 0, 1), instant(2, 0, most)});
    EXPECT_EQ(haveOneScale(out[0].info, out[2].info), most <= kOutlyingRange) << most;
  }
}

TEST(FieldScales, instantsAtRestShareTheScaleOfTheRun) {
  const std::vector<MeshField> fields{instant(0, 0, 0), instant(1, 0, 0), instant(2, 0, 1)};
  const std::vector<QuantisedField> out = quantiseAll(fields);
  EXPECT_TRUE(haveOneScale(out[0].info, out[2].info));
  EXPECT_TRUE(scalesOf(fields).outlying.warnings().empty());
}

TEST(FieldScales, aPointThatDivergesTakesBitsFromNoOther) {
  for (const double far : {1e4, 1e9, -1e4}) {
    std::vector<MeshField> fields{instant(0, 0, 1), instant(1, 0, 1), instant(2, 0, 1)};
    fields[2].values[7] = far;
    const std::vector<QuantisedField> out = quantiseAll(fields);
    EXPECT_LE(errorOf(fields[0], out[0]), 1.001 * 0.5 / 4095) << far;
    // 28 bits are the most: with them a step is 1e9 / 2^28
    const double allowed = std::max(0.5 / 4095, 0.5 * std::abs(far) / (std::ldexp(1.0, 28) - 1));
    EXPECT_LE(errorOf(fields[2], out[2]), 1.001 * allowed) << far;
    EXPECT_EQ(scalesOf(fields).outlying.warnings().size(), 1u);
  }
}

TEST(FieldScales, severalSizesHaveSeveralScales) {
  std::vector<MeshField> fields;
  for (int i = 0; i < 8; ++i) fields.push_back(instant(i, 0, std::pow(10.0, i)));
  const std::vector<QuantisedField> out = quantiseAll(fields);
  EXPECT_TRUE(haveOneScale(out[0].info, out[3].info));
  EXPECT_TRUE(haveOneScale(out[4].info, out[5].info)) << "the nearer half of those beyond";
  for (std::size_t f = 5; f < 8; ++f)
    EXPECT_LE(errorOf(fields[f], out[f]), 0.501 * std::pow(10.0, f) / 4095) << f;
  EXPECT_NE(scalesOf(fields).outlying.warnings()[0].find("at time 4, 5, 6, 7 span"),
            std::string::npos);
}

TEST(FieldScales, integersKeepTheirOwnScaleWhereTheSeriesIsTooLarge) {
  std::vector<MeshField> fields{instant(0, 0, 100), instant(1, 1e12, 1e12 + 100)};
  for (MeshField& field : fields) field.type = "int64";
  for (const QuantisedField& out : quantiseAll(fields)) EXPECT_TRUE(out.exact);
  EXPECT_TRUE(scalesOf(fields).outlying.warnings().empty());
}

TEST(FieldScales, whatIsNotFiniteCountsNowhere) {
  std::vector<MeshField> fields{instant(0, 0, 1), instant(1, 0, 1)};
  std::ranges::fill(fields[0].values, std::nan(""));
  fields[1].values[0] = std::nan("");
  EXPECT_LE(errorOf(instant(1, 0, 1), quantiseAll({instant(1, 0, 1), fields[0]})[0]), 2e-4);
  EXPECT_TRUE(scalesOf(fields).outlying.warnings().empty());
}

}  // namespace
}  // namespace qtet
