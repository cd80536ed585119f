// FieldKeys answers as the functions of field_key.h, series.h and manifest.h do, with less work.
#include "proto/field_keys.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "proto/limits.h"
#include "proto/manifest.h"

namespace qtet {
namespace {

using Names = std::vector<std::string>;
using Listed = std::vector<ListedKey>;

Manifest manifestOfFields(const std::vector<std::pair<std::string, std::string>>& fields) {
  Manifest out;
  for (const auto& [association, name] : fields) {
    ManifestField& field = out.fields.emplace_back();
    field.association = association;
    field.name = name;
  }
  return out;
}

/// Every rule has a case: names twice, names that look like keys, series of both kinds.
const Manifest kMixed = manifestOfFields({{"cell", "T"},
                                          {"point", "U"},
                                          {"point", "T"},
                                          {"point", "P@0"},
                                          {"point", "P@0.5"},
                                          {"cell", "P@0.5"},
                                          {"cell", "P@1"},
                                          {"point", "cell:T"},
                                          {"point", "cell:Q@1"},
                                          {"point", "cell:Q@2"},
                                          {"cell", "Q@1"},
                                          {"cell", "Q@3"},
                                          {"point", "inlet@left"},
                                          {"point", "@1"},
                                          {"point", "U@1"},
                                          {"point", "U@2"},
                                          {"cell", "W@7"}});

const Series* seriesOfKey(const std::vector<Series>& all, const std::string& key) {
  const Series* out = nullptr;
  for (const Series& series : all) {
    if (!isCalled(series.association, series.name, key)) continue;
    if (series.association == "point") return &series;
    if (out == nullptr) out = &series;
  }
  return out;
}

TEST(FieldKeys, everyNameMeansWhatItMeansToASearch) {
  const std::vector<Series> series = seriesOf(kMixed.fields);
  const FieldKeys keys(kMixed.fields, series);
  Names asked = {"", "none", "point", "point:", "cell:", ":", ":T", "point:cell:T", "P", "Q", "W"};
  for (const ManifestField& field : kMixed.fields)
    for (const std::string& kind : {"", "point:", "cell:", "other:"}) {
      asked.push_back(kind + field.name);
      if (const auto name = field.name.instant()) asked.push_back(kind + std::string(name->series));
    }
  for (const std::string& key : asked) {
    SCOPED_TRACE(key);
    EXPECT_EQ(keys.fieldOfKey(key), fieldOfKey(kMixed, key));
    EXPECT_EQ(keys.fieldsOfName(key), fieldsOfName(kMixed.fields, key));
    EXPECT_EQ(keys.fieldsOfKey(key), fieldsOfKey(kMixed.fields, key));
    const auto place = keys.seriesOfKey(key);
    EXPECT_EQ(place ? &series[*place] : nullptr, seriesOfKey(series, key));
  }
  for (std::size_t f = 0; f < kMixed.fields.size(); ++f)
    EXPECT_EQ(keys.keyOf(f), fieldKey(kMixed, f));
}

TEST(FieldKeys, aListNamesASeriesOnce) {
  EXPECT_EQ(FieldKeys(manifestOfFields({{"point", "p"},
                                        {"point", "T@1"},
                                        {"cell", "T@0"},
                                        {"point", "T@0"},
                                        {"cell", "T@1"},
                                        {"cell", "q@2"},
                                        {"cell", "q@3"},
                                        {"point", "alone@2"}})
                          .fields)
                .listed(),
            (Listed{{"p"}, {"T", true}, {"cell:T", true}, {"q", true}, {"alone@2"}}));
}

TEST(FieldKeys, instantsWhoseSeriesHasTheNameOfAFieldAreListedThemselves) {
  EXPECT_EQ(FieldKeys(manifestOfFields({{"point", "U"}, {"point", "U@1"}, {"point", "U@2"}}).fields)
                .listed(),
            (Listed{{"U"}, {"U@1"}, {"U@2"}}));
}

#ifndef NDEBUG
TEST(FieldKeys, manyFieldsAreNotWalkedForEachKey) {
  Manifest many;
  many.fields.resize(kMaxFields);
  for (std::size_t f = 0; f < many.fields.size(); ++f)
    many.fields[f].name = "T@" + std::to_string(f);
  const std::vector<Series> series = seriesOf(many.fields);
  const std::uint64_t before = namesCompared;
  const FieldKeys keys(many.fields, series);
  EXPECT_EQ(keys.keyOf(kMaxFields - 1), "T@" + std::to_string(kMaxFields - 1));
  for (std::size_t f = 0; f < many.fields.size(); ++f) EXPECT_EQ(keys.keyOf(f)[0], 'T');
  EXPECT_EQ(keys.fieldsOfKey("T").size(), kMaxFields);
  EXPECT_EQ(keys.listed(), (Listed{{"T", true}}));
  (void)noSuchField(many, "none");
  constexpr std::uint64_t kOfOneField = 200;  // 13 a search, and some searches
  EXPECT_LT(namesCompared - before, kMaxFields * kOfOneField);
}
#endif

}  // namespace
}  // namespace qtet
