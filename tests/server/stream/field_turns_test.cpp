#include "server/stream/field_turns.h"

#include <gtest/gtest.h>

#include "proto/field_keys.h"
#include "proto/limits.h"
#include "proto/manifest.h"
#include "proto/series.h"

namespace qtet {
namespace {

using First = StreamTime::First;

/// T of points at 0, 4, 2, 1, 3 in the order of decoding, T of cells at 0 and 1, and p.
struct Log {
  Log() {
    for (const auto& [name, association] : {std::pair("T@0", "point"),
                                            {"T@4", "point"},
                                            {"T@2", "point"},
                                            {"T@1", "point"},
                                            {"T@3", "point"},
                                            {"T@0", "cell"},
                                            {"T@1", "cell"},
                                            {"p", "point"}}) {
      ManifestField& field = manifest.fields.emplace_back();
      field.name = name;
      field.association = association;
      field.components = 1;
      field.type = "float32";
      shapes.push_back(
          {.association = field.association == "cell" ? Association::kCell : Association::kPoint});
    }
    predict(2, {0, 1});
    predict(3, {0, 2});
    predict(4, {2, 1});
  }
  void predict(std::size_t field, const std::vector<std::uint16_t>& parents) {
    for (const std::uint16_t parent : parents) {
      TimePrediction& prediction = shapes[field].prediction;
      prediction.parents[prediction.count++] = {parent, 8};
    }
  }
  [[nodiscard]] std::vector<Series> series() const { return seriesOf(manifest.fields); }
  [[nodiscard]] std::expected<FieldTurns, std::string> found(
      const std::vector<std::string>& names, const std::optional<StreamTime>& time) const {
    const std::vector<Series> all = series();
    return fieldTurns(names, time, FieldKeys(manifest.fields, all), all, shapes);
  }
  [[nodiscard]] FieldTurns turns(const std::vector<std::string>& names,
                                 const std::optional<StreamTime>& time) const {
    return found(names, time).value_or(FieldTurns{});
  }

  Manifest manifest;
  std::vector<FieldShape> shapes;
};

TEST(FieldTurns, withoutATimeNamesMeanFieldsAlone) {
  const Log log;
  EXPECT_EQ(log.turns({"p", "T@2", "p"}, {}), (FieldTurns{{2, 7}}));
  EXPECT_EQ(log.turns({}, {}), FieldTurns{{}});
  EXPECT_EQ(log.found({"p", "T"}, {}).error(), "T");
}

TEST(FieldTurns, theNearestInstantComesWithItsParentsBeforeTheOnesAhead) {
  const Log log;
  EXPECT_EQ(log.turns({"T"}, StreamTime{2.9, 0, First::kSpace}), (FieldTurns{{0, 1, 2, 4}}));
  EXPECT_EQ(log.turns({"p", "T"}, StreamTime{0, 1, First::kSpace}),
            (FieldTurns{{0, 7}, {1, 2, 3}}));
  EXPECT_EQ(log.turns({"T"}, StreamTime{0, 1, First::kTime}), (FieldTurns{{0, 1, 2, 3}}));
  EXPECT_EQ(log.turns({"T"}, StreamTime{0.5, 0, First::kSpace}), FieldTurns{{0}})
      << "the earlier of two";
}

TEST(FieldTurns, instantsAheadGoRoundTheEndAndEachComesOnce) {
  const Log log;
  EXPECT_EQ(log.turns({"T"}, StreamTime{4, 9, First::kSpace}), (FieldTurns{{1}, {0}, {2, 3}, {4}}));
}

TEST(FieldTurns, seriesGoTogetherAndANameThatIsGivenTwiceCountsOnce) {
  const Log log;
  const StreamTime time{0, 1, First::kSpace};
  EXPECT_EQ(log.turns({"T", "cell:T", "T", "point:T"}, time), (FieldTurns{{0, 5}, {1, 2, 3, 6}}));
  EXPECT_EQ(log.turns({"T@2", "T"}, time), (FieldTurns{{0, 1, 2}, {3}}));
}

TEST(FieldTurns, instantsBeyondTheMostFieldsAreLeftOut) {
  Log log;
  log.manifest.fields.clear();
  log.shapes.clear();
  for (const char* name : {"T", "U"})
    for (std::uint32_t i = 0; i < kMaxRequestFields; ++i) {
      ManifestField& field = log.manifest.fields.emplace_back();
      field.name = std::string(name) + "@" + std::to_string(i);
      field.association = "point";
      field.components = 1;
      log.shapes.emplace_back();
    }
  const auto counted = [&](const std::vector<std::string>& names, std::uint32_t ahead,
                           First first) {
    std::size_t out = 0;
    for (const auto& turn : log.turns(names, StreamTime{0, ahead, first})) out += turn.size();
    return out;
  };
  for (const First first : {First::kSpace, First::kTime}) {
    EXPECT_EQ(counted({"T"}, kMaxAhead, first), kMaxRequestFields);
    EXPECT_EQ(counted({"T", "U"}, kMaxRequestFields / 2 - 2, first), kMaxRequestFields - 2);
    EXPECT_EQ(counted({"T", "U"}, kMaxRequestFields / 2 - 1, first), kMaxRequestFields);
    EXPECT_EQ(counted({"T", "U"}, kMaxRequestFields / 2, first), kMaxRequestFields);
  }
  log.predict(kMaxRequestFields + 1, {5});
  EXPECT_EQ(counted({"U"}, kMaxAhead, First::kSpace), kMaxRequestFields) << "parents count";
}

TEST(FieldTurns, aSeriesOfCellsHasItsKey) {
  const Log log;
  EXPECT_EQ(log.turns({"cell:T"}, StreamTime{1, 1, First::kSpace}), (FieldTurns{{6}, {5}}));
  EXPECT_EQ(log.turns({"point:T"}, StreamTime{0, 0, First::kSpace}), FieldTurns{{0}});
  EXPECT_EQ(log.found({"cell:U"}, StreamTime{}).error(), "cell:U");
}

}  // namespace
}  // namespace qtet
