#include "simplify/series/series.h"

#include <gtest/gtest.h>

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
  const std::vector<Series> series = seriesOf(std::span(fields));
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

TEST(Series, otherFieldsKeepTheirPlaces) {
  std::vector<MeshField> fields{field("p"), field("T@3"), field("T@1"), field("q"), field("T@2")};
  orderSeries(fields);
  std::vector<std::string> names;
  for (const MeshField& f : fields) names.push_back(f.name);
  EXPECT_EQ(names, (std::vector<std::string>{"p", "T@1", "T@3", "q", "T@2"}));
}

TEST(Series, instantsHaveOneScale) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  mesh.fields = {field("T@0"), field("T@1"), field("p")};
  mesh.fields[0].values = {0, 1, 2, 3};
  mesh.fields[1].values = {5, 6, 7, 10};
  mesh.fields[2].values = {0, 1, 2, 3};
  const Result<QuantisedMesh> out = quantise(mesh);
  ASSERT_TRUE(out) << out.error().text();
  const std::vector<FieldInfo>& fields = out->mesh.fields;
  EXPECT_EQ(fields[0].step, fields[1].step);
  EXPECT_EQ(fields[0].minimum, fields[1].minimum);
  EXPECT_DOUBLE_EQ(fields[0].step * 4095, 10);
  EXPECT_DOUBLE_EQ(fields[2].step * 4095, 3);
  EXPECT_EQ(fields[0].range, (std::array<double, 2>{0, 3})) << "the instant's own";
  EXPECT_EQ(out->mesh.values[1].back(), 4095);
}

}  // namespace
}  // namespace qtet
