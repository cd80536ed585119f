#include "simplify/series/series.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "simplify/clean/quantise.h"

namespace qtet {
namespace {

MeshField field(const std::string& name, std::uint32_t components = 1,
                const std::string& association = "point") {
  return {name, components, "float32", {}, association};
}

TEST(Series, instantsAreFieldsOfOneKindWhoseNamesEndInATime) {
  const std::vector<MeshField> fields{field("T@1"),    field("p@x"),
                                      field("T@-0.5"), field("T@2", 3),
                                      field("T@2e-1"), field("T@1", 1, "cell"),
                                      field("@3"),     field("T@1", 1, "cell"),
                                      field("a@b@7"),  field("a@b@6.5"),
                                      field("T"),      field("T@nan")};
  const std::vector<Series> series = seriesOf(fields);
  ASSERT_EQ(series.size(), 2u);
  EXPECT_EQ(series[0].name, "T");
  EXPECT_EQ(series[0].fields, (std::vector<std::size_t>{2, 4, 0}));
  EXPECT_EQ(series[0].times, (std::vector<double>{-0.5, 0.2, 1}));
  EXPECT_EQ(series[1].name, "a@b");
  EXPECT_EQ(series[1].fields, (std::vector<std::size_t>{9, 8}));
}

TEST(Series, everyInstantIsDecodedOnceBehindThoseAroundIt) {
  for (const std::size_t instants : {0u, 1u, 2u, 3u, 8u, 9u, 10u, 16u, 17u, 100u}) {
    std::set<std::size_t> known;
    for (const InstantStep& step : decodingOrder(instants)) {
      EXPECT_LE(step.around.size(), 4u);
      for (const std::size_t i : step.around) EXPECT_TRUE(known.contains(i)) << instants;
      EXPECT_TRUE(std::ranges::is_sorted(step.around));
      if (!step.isAnchor) {
        EXPECT_LT(step.around.front(), step.instant);
        EXPECT_GT(step.around.back(), step.instant);
        EXPECT_EQ(step.around.front() / kWindow, (step.around.back() - 1) / kWindow)
            << "no instant of another window is needed";
      }
      EXPECT_TRUE(known.insert(step.instant).second);
    }
    EXPECT_EQ(known.size(), instants);
  }
}

/// The names in the order of seriesOrder.
std::vector<std::string> ordered(std::vector<std::string> names,
                                 std::optional<double> opening = std::nullopt) {
  std::vector<MeshField> fields;
  for (const std::string& name : names) fields.push_back(field(name));
  putInOrder(seriesOrder(fields, opening), names);
  return names;
}

TEST(Series, otherFieldsAndFirstInstantsComeFirst) {
  EXPECT_EQ(ordered({"p", "T@3", "T@1", "q", "T@2"}),
            (std::vector<std::string>{"p", "T@1", "q", "T@3", "T@2"}));
}

TEST(Series, theOpeningsInstantsComeBeforeTheFirstOnes) {
  EXPECT_EQ(ordered({"p", "T@3", "T@1", "v@1", "v@3", "q", "T@2"}, 2),
            (std::vector<std::string>{"p", "T@2", "v@1", "q", "T@1", "v@3", "T@3"}))
      << "the nearest one where that time is missing, the earlier one of two";
  EXPECT_EQ(ordered({"T@1", "v@1", "T@2", "v@2", "T@3", "v@3"}, 3),
            (std::vector<std::string>{"T@3", "v@3", "T@1", "v@1", "T@2", "v@2"}));
}

TEST(Series, anOrderThatIsThereStays) {
  const std::vector<std::string> names = ordered({"p", "T@3", "T@1", "T@2", "T@0"}, 2);
  EXPECT_EQ(ordered(names, 2), names);
}

TEST(Series, allInstantsButTheOneOfTheLowestNumberAreLater) {
  const std::vector<MeshField> fields{field("p"), field("T@3"), field("T@1"), field("T@2")};
  EXPECT_EQ(laterInstants(seriesOf(fields), fields.size()),
            (std::vector<bool>{false, false, true, true}));
}

/// A cell of four points with these fields; each has four values.
QuantisedMesh quantised(std::vector<MeshField> fields) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  mesh.fields = std::move(fields);
  return quantise(mesh).value();
}

MeshField valued(const std::string& name, std::vector<double> values,
                 const std::string& type = "float32") {
  return {name, 1, type, std::move(values), "point"};
}

TEST(Series, instantsHaveOneScale) {
  const QuantisedMesh out = quantised(
      {valued("T@0", {0, 1, 2, 3}), valued("T@1", {5, 6, 7, 10}), valued("p", {0, 1, 2, 3})});
  const std::vector<FieldInfo>& fields = out.mesh.fields;
  EXPECT_EQ(fields[0].step, fields[1].step);
  EXPECT_EQ(fields[0].minimum, fields[1].minimum);
  EXPECT_DOUBLE_EQ(fields[0].step * 4095, 10);
  EXPECT_DOUBLE_EQ(fields[2].step * 4095, 3);
  EXPECT_EQ(fields[0].range, (std::array<double, 2>{0, 3})) << "the instant's own";
  EXPECT_EQ(out.mesh.values[1].back(), 4095);
}

TEST(Series, anInstantWithoutValuesDoesNotWidenTheScale) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const QuantisedMesh out =
      quantised({valued("T@0", {300, 301, 302, 310}), valued("T@1", {nan, nan, nan, nan})});
  for (const FieldInfo& field : out.mesh.fields) {
    EXPECT_DOUBLE_EQ(field.step * 4095, 10);
    EXPECT_EQ(field.minimum, (std::vector<double>{300}));
  }
}

TEST(Series, integersStayExactWhereTheSeriesSpansTooMuch) {
  const double most = std::ldexp(1.0, 28) - 1;  // the largest extent that is stored exactly
  const auto of = [&](double highest) {
    return quantised({valued("n@0", {0, 1, 2, 3}, "int64"),
                      valued("n@1", {highest - 3, highest - 2, highest - 1, highest}, "int64")});
  };
  for (const double highest : {most - 1, most, most + 1}) {
    const QuantisedMesh out = of(highest);
    EXPECT_EQ(out.mesh.fields[0].minimum == out.mesh.fields[1].minimum, highest <= most);
    for (std::size_t f = 0; f < 2; ++f)
      for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(out.mesh.fields[f].value(0, out.mesh.values[f][i]),
                  (f == 0 ? 0 : highest - 3) + static_cast<double>(i));
  }
}

}  // namespace
}  // namespace qtet
