#include "simplify/series/time_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "proto/limits.h"

namespace qtet {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

MeshField instant(const std::string& name, std::vector<double> values,
                  const std::string& type = "float64", std::uint32_t components = 1,
                  const std::string& association = "point") {
  return {name, components, type, std::move(values), association};
}

/// The statistics of these fields, in one call.
std::vector<MeshField> statisticsOf(const std::vector<MeshField>& fields) {
  TimeStatistics statistics;
  EXPECT_TRUE(statistics.add(fields));
  return statistics.take();
}

void expectSame(const std::vector<MeshField>& some, const std::vector<MeshField>& others) {
  ASSERT_EQ(some.size(), others.size());
  for (std::size_t f = 0; f < some.size(); ++f) {
    EXPECT_EQ(some[f].name, others[f].name);
    EXPECT_EQ(some[f].values, others[f].values) << some[f].name << ", to the last bit";
  }
}

TEST(TimeStatistics, areTheMeanBothEndsAndTheDeviationOfEachComponent) {
  const std::vector<MeshField> out =
      statisticsOf({instant("U@0", {1, 10, 7, 0}, "float64", 2, "cell"),
                    instant("U@1", {2, 30, 7, 4}, "float64", 2, "cell"),
                    instant("U@5", {6, 20, 7, 8}, "float64", 2, "cell"), instant("p", {1, 2})});
  ASSERT_EQ(out.size(), 4u);
  for (std::size_t f = 0; f < out.size(); ++f) {
    EXPECT_EQ(out[f].name, statisticsNames("U")[f]);
    EXPECT_EQ(out[f].components, 2u);
    EXPECT_EQ(out[f].association, "cell");
    EXPECT_EQ(out[f].type, "float64");
  }
  EXPECT_EQ(out[0].name, "U_average");
  EXPECT_EQ(out[0].values, (std::vector<double>{3, 20, 7, 4})) << "times are no weights";
  EXPECT_EQ(out[1].name, "U_minimum");
  EXPECT_EQ(out[1].values, (std::vector<double>{1, 10, 7, 0}));
  EXPECT_EQ(out[2].name, "U_maximum");
  EXPECT_EQ(out[2].values, (std::vector<double>{6, 30, 7, 8}));
  EXPECT_EQ(out[3].name, "U_stddev");
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_DOUBLE_EQ(out[3].values[i], std::sqrt(std::vector<double>{14, 200, 0, 32}[i] / 3));
}

TEST(TimeStatistics, missingValuesDoNotCount) {
  const double infinite = std::numeric_limits<double>::infinity();
  const std::vector<MeshField> out =
      statisticsOf({instant("T@0", {kNan, 1, kNan, infinite}), instant("T@1", {4, 3, kNan, 2}),
                    instant("T@2", {6, kNan, kNan, -infinite})});
  ASSERT_EQ(out.size(), 4u);
  for (const MeshField& field : out) EXPECT_TRUE(std::isnan(field.values[2])) << field.name;
  const std::vector<std::vector<double>> expected{{5, 2, 2}, {4, 1, 2}, {6, 3, 2}, {1, 1, 0}};
  for (std::size_t f = 0; f < out.size(); ++f) {
    EXPECT_EQ(out[f].values[0], expected[f][0]) << out[f].name;
    EXPECT_EQ(out[f].values[1], expected[f][1]) << out[f].name;
    EXPECT_EQ(out[f].values[3], expected[f][2]) << out[f].name;
  }
}

TEST(TimeStatistics, integersKeepTheirTypeAtBothEndsOnly) {
  const std::vector<MeshField> out =
      statisticsOf({instant("n@0", {1}, "uint8"), instant("n@1", {4}, "uint8")});
  ASSERT_EQ(out.size(), 4u);
  const std::vector<std::string> types{"float64", "uint8", "uint8", "float64"};
  for (std::size_t f = 0; f < out.size(); ++f) EXPECT_EQ(out[f].type, types[f]) << out[f].name;
  EXPECT_EQ(out[0].values, std::vector<double>{2.5});
  EXPECT_EQ(out[3].values, std::vector<double>{1.5});
}

TEST(TimeStatistics, valuesAreThoseThatTheirTypeHolds) {
  const float third = 1.0F / 3;
  const std::vector<MeshField> out =
      statisticsOf({instant("T@0", {third}, "float32"), instant("T@1", {1}, "float32"),
                    instant("T@2", {0}, "float32")});
  for (const MeshField& field : out) {
    EXPECT_EQ(field.type, "float32");
    EXPECT_EQ(field.values[0], static_cast<double>(static_cast<float>(field.values[0])));
  }
}

TEST(TimeStatistics, aSmallDeviationFromALargeMeanIsKept) {
  std::vector<MeshField> fields;
  for (int i = 0; i < 1000; ++i)
    fields.push_back(instant("T@" + std::to_string(i), {1e9 + (i % 2 == 0 ? 1e-3 : -1e-3), 0.1}));
  const std::vector<MeshField> out = statisticsOf(fields);
  EXPECT_NEAR(out[3].values[0], 1e-3, 1e-6) << "a sum of squares would lose all digits";
  EXPECT_EQ(out[0].values[1], 0.1) << "a constant comes back to the bit";
  EXPECT_EQ(out[3].values[1], 0);
}

TEST(TimeStatistics, theSameInstantsInPartsGiveTheSameBits) {
  std::vector<MeshField> fields;
  for (int i = 0; i < 20; ++i)
    for (const char* name : {"T@", "U@"})
      fields.push_back(instant(name + std::to_string(i),
                               {std::sin(i) * 1e3, i % 7 == 3 ? kNan : 1.0 / (i + 1)}));
  const std::vector<MeshField> once = statisticsOf(fields);
  std::vector<MeshField> reversed(fields.rbegin(), fields.rend());
  TimeStatistics parts;
  for (std::size_t at = 0; at < fields.size(); at += 6)
    ASSERT_TRUE(parts.add(std::span(fields).subspan(at, std::min<std::size_t>(6, 40 - at))));
  expectSame(parts.take(), once);
  for (const MeshField& field : statisticsOf(reversed))
    EXPECT_EQ(field.values[0], std::ranges::find(once, field.name, &MeshField::name)->values[0]);
}

TEST(TimeStatistics, aLoneInstantIsNoSeriesAndATimeCountsOnce) {
  EXPECT_TRUE(statisticsOf({instant("T@0", {1}), instant("p", {2})}).empty());
  const std::vector<MeshField> out =
      statisticsOf({instant("T@0", {1}), instant("T@1", {3}), instant("T@1.0", {50})});
  ASSERT_EQ(out.size(), 4u);
  EXPECT_EQ(out[0].values, std::vector<double>{2});
}

TEST(TimeStatistics, refuseAnInstantOfAnotherLength) {
  TimeStatistics statistics;
  ASSERT_TRUE(statistics.add(std::vector{instant("T@0", {1, 2})}));
  const Status added = statistics.add(std::vector{instant("T@1", {1})});
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().code, ErrorCode::kBadInput);
}

void expectRefused(std::vector<MeshField> fields, ErrorCode code, const std::string& words) {
  const std::size_t before = fields.size();
  const Status added = addTimeStatistics(fields);
  ASSERT_FALSE(added) << words;
  EXPECT_EQ(added.error().code, code) << added.error().message;
  EXPECT_NE(added.error().message.find(words), std::string::npos) << added.error().message;
  EXPECT_EQ(fields.size(), before);
}

TEST(AddTimeStatistics, putsThemBehindTheFields) {
  std::vector<MeshField> fields{instant("T_average", {1}, "float64", 1, "cell"),
                                instant("T@0", {1}), instant("T@1", {3})};
  ASSERT_TRUE(addTimeStatistics(fields));
  ASSERT_EQ(fields.size(), 7u) << "a name of the other association is free";
  EXPECT_EQ(fields[3].name, "T_average");
  EXPECT_EQ(fields[3].values, std::vector<double>{2});
}

TEST(AddTimeStatistics, needsASeriesAndFreeNames) {
  const std::vector<MeshField> series{instant("T@0", {1}), instant("T@1", {3})};
  const auto with = [&](std::vector<MeshField> more) {
    more.insert(more.begin(), series.begin(), series.end());
    return more;
  };
  expectRefused({instant("T@0", {1}), instant("p", {1})}, ErrorCode::kBadValue, "needs a series");
  expectRefused(with({instant("T_stddev", {1})}), ErrorCode::kBadValue, "point field T_stddev");
  expectRefused(with({instant("T_minimum@3", {1})}), ErrorCode::kBadValue, "T_minimum");
  expectRefused(with({instant("T@2", {1}, "int8"), instant("T@3", {1}, "int8")}),
                ErrorCode::kBadValue, "changes its type");
  const std::string longest(kMaxNameBytes - 8, 'n'), longer = longest + "n";
  std::vector<MeshField> fields{instant(longest + "@0", {1}), instant(longest + "@1", {1})};
  EXPECT_TRUE(addTimeStatistics(fields));
  expectRefused({instant(longer + "@0", {1}), instant(longer + "@1", {1})},
                ErrorCode::kLimitExceeded, "257 bytes");
}

TEST(AddTimeStatistics, fourFieldsASeriesMustFit) {
  const std::vector<MeshField> series{instant("T@0", {1}), instant("T@1", {3})};
  EXPECT_TRUE(checkTimeStatistics(series, kMaxFields - 5));
  EXPECT_TRUE(checkTimeStatistics(series, kMaxFields - 4));
  const Status checked = checkTimeStatistics(series, kMaxFields - 3);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, ErrorCode::kLimitExceeded);
}

}  // namespace
}  // namespace qtet
