#include "codec/log/log_manifest.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "codec/coding/error_figure.h"
#include "codec/coding/level_columns.h"
#include "codec/log/log_index.h"
#include "proto/limits.h"
#include "tests/support/allocation_meter.h"
#include "tests/support/sample_manifest.h"

namespace qtet {
namespace {

constexpr std::uint32_t kLevels = 40;

Manifest sample(bool withErrors = true) {
  Manifest m = testing::manifestWithoutLevels();
  m.fields.push_back({"density", 3, "uint64", "cell", 28, 1.0 / 3, {-1, -2, -3}, {0, 7}, true});
  for (std::uint32_t l = 0; l < kLevels; ++l) {
    const auto tetrahedra = static_cast<std::uint32_t>(2000 * std::pow(1.06, l));
    m.levels.push_back({l, tetrahedra, tetrahedra / 5, tetrahedra / 2,
                        l < 10            ? 1u
                        : l < kLevels - 1 ? 2u
                                          : 3u,
                        std::nullopt});
    if (l == 0) m.levels[0].chunk = 0;
    const double e = roundedUp(0.02 * std::pow(0.9, l)), half = roundedUp(e / 2);
    if (withErrors)
      m.levels.back().error =
          LevelError{{half, e}, {0, 1e-12}, (900'000 - l) / 1e6, 0.5, {{half, 0.676}, {3e-7, 2.5}}};
  }
  return m;
}

/// An index that goes with `manifest`: four chunks, of levels 0, 1 to 9 and a bit of 10, on to 38,
/// 39.
LogIndex indexOf(const Manifest& manifest) {
  LogIndex index;
  index.positionBits = static_cast<std::uint8_t>(manifest.latticeBits);
  for (const ManifestField& f : manifest.fields)
    index.fields.push_back({f.components,
                            f.association == "cell" ? Association::kCell : Association::kPoint,
                            f.hasMissing});
  index.chunks.resize(4);
  index.chunks[1].firstLevel = 1, index.chunks[1].lastLevel = 10, index.chunks[1].endSlot = 77;
  index.chunks[2].firstLevel = 10, index.chunks[2].lastLevel = kLevels - 2;
  index.chunks[3].firstLevel = index.chunks[3].lastLevel = kLevels - 1;
  index.manifest = manifestBlock(manifest).value();
  return index;
}

void expectRefused(const LogIndex& index, ErrorCode code, const std::string& word) {
  const Result<Manifest> read = manifestOf(index);
  ASSERT_FALSE(read) << "accepted, instead of: " << word;
  EXPECT_EQ(read.error().code, code) << read.error().text();
  EXPECT_NE(read.error().message.find(word), std::string::npos) << read.error().message;
}

void expectRefused(ErrorCode code, const std::string& word,
                   const std::function<void(Manifest&)>& change) {
  Manifest m = sample();
  change(m);
  expectRefused(indexOf(m), code, word);
}

TEST(LogManifest, comesBackToTheBit) {
  for (const bool withErrors : {true, false}) {
    const Manifest m = sample(withErrors);
    const Result<Manifest> read = manifestOf(indexOf(m));
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(manifestToJson(*read), manifestToJson(m));
    EXPECT_EQ(read->levels[10].chunk, 2u)
        << "a level that goes on in the next chunk is complete there";
    EXPECT_EQ(manifestBlock(*read).value(), manifestBlock(m).value());
  }
}

TEST(LogManifest, itsFocusComesBack) {
  Manifest m = sample();
  m.focus = {0, 1, 2, 1, 0x8000, 0xffff};
  LogIndex index = indexOf(m);
  const Result<Manifest> read = manifestOf(index);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->focus, m.focus);
  // half of 2^16 steps of 0.3 each from 1e-17 on
  EXPECT_DOUBLE_EQ(focusCorners(*read)[4], 0.5 * 65536 * (0.1 + 0.2));
}

TEST(LogManifest, itsOpeningComesBack) {
  Manifest m = sample();
  for (const Opening& opening : {Opening{1, 2}, Opening{0, 0}, Opening{1}}) {
    m.opening = opening;
    LogIndex index = indexOf(m);
    const Result<Manifest> read = manifestOf(index);
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(read->opening, m.opening);
    EXPECT_EQ(read->levels.size(), m.levels.size());
  }
  EXPECT_NE(manifestToJson(m).find(R"("opening":{"field":"cell:density"})"), std::string::npos)
      << manifestToJson(m);
  for (const Opening& wrong : {Opening{2}, Opening{0, 4}}) {
    m.opening = wrong;
    LogIndex index = indexOf(m);
    expectRefused(index, ErrorCode::kBadValue, "opening");
  }
}

TEST(LogManifest, itsUnitsComeBack) {
  Manifest m = sample();
  m.fields[0].name = "T@0.5", m.fields[1].name = "U [m/s]";
  m.units = {{"", "s"}, {"T", "K"}};
  LogIndex index = indexOf(m);
  const Result<Manifest> read = manifestOf(index);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->units, m.units);
  EXPECT_EQ(timeUnit(*read), "s");
  EXPECT_EQ(unitOf(*read, "T@0.5"), "K");
  EXPECT_EQ(unitOf(*read, "U [m/s]"), "m/s");
  for (const char* name : {"V", "[K]", " [K]", "T[K]", "T [K] ", "T ]"})
    EXPECT_EQ(unitOf(*read, name), "") << name;
  EXPECT_NE(manifestToJson(m).find(R"("unit":"K")"), std::string::npos) << manifestToJson(m);
  for (const std::size_t bytes :
       {std::size_t{0}, kMaxUnitBytes + std::size_t{0}, kMaxUnitBytes + std::size_t{1}}) {
    m.units = {{"T", std::string(bytes, 'K')}};
    index = indexOf(m);
    if (bytes == kMaxUnitBytes)
      EXPECT_TRUE(manifestOf(index));
    else
      expectRefused(index, ErrorCode::kBadValue, "units");
  }
}

TEST(LogManifest, itsLabelsComeBackWithTheNamesOfTheirValues) {
  Manifest m = sample();
  m.fields[1] = {"Part@1", 1, "int32", "cell", 4, 1, {-7}, {-7, 4}};
  m.labels = {{"Part", {{-7, "air"}, {4, "oil"}}}};
  LogIndex index = indexOf(m);
  const Result<Manifest> read = manifestOf(index);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->labels, m.labels);
  EXPECT_EQ(labelNamesOf(*read, 0), nullptr);
  ASSERT_NE(labelNamesOf(*read, 1), nullptr);
  EXPECT_EQ(labelNamesOf(*read, 1)->at(4), "oil");
  const std::string json = manifestToJson(m);
  EXPECT_NE(json.find(R"("labels":{"Part":{"-7":"air","4":"oil"}})"), std::string::npos) << json;
  EXPECT_NE(json.find(R"("wrong":)"), std::string::npos) << json;
  LabelNames names;
  for (std::uint32_t i = 0; i < kMaxLabelNames; ++i) names[static_cast<std::int32_t>(i)] = "x";
  m.labels = {{"Part", names}};
  EXPECT_TRUE(manifestOf(indexOf(m)));
  names[-1] = "x";
  m.labels = {{"Part", names}};
  expectRefused(indexOf(m), ErrorCode::kBadValue, "4,096");
  m.labels = {{"Part", {{1, ""}}}};
  expectRefused(indexOf(m), ErrorCode::kBadValue, "empty");
  m.labels = {{"", {}}};
  expectRefused(indexOf(m), ErrorCode::kBadValue, "has none");
  m.labels = {{"density", {}}};
  EXPECT_EQ(labelNamesOf(manifestOf(indexOf(m)).value(), 0), nullptr) << "it has components";
}

TEST(LogManifest, itsOriginalHasAtLeastTheCellsOfTheLastLevel) {
  Manifest m = sample();
  EXPECT_EQ(manifestToJson(m).find("original"), std::string::npos);
  const ManifestLevel last = m.levels.back();
  for (const OriginalSize& size :
       {OriginalSize{5'000'000'000, 900'000'000}, OriginalSize{last.tetrahedra, last.vertices},
        OriginalSize{std::uint64_t{1} << 53, std::uint64_t{1} << 53}}) {
    m.original = size;
    const Result<Manifest> read = manifestOf(indexOf(m));
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(read->original, size);
  }
  m.original = {5'000'000'000, 900'000'000};
  EXPECT_NE(manifestToJson(m).find(R"("original":{"tetrahedra":5000000000,"vertices":900000000})"),
            std::string::npos)
      << manifestToJson(m);
  m.original = {last.tetrahedra - 1u, last.vertices};
  expectRefused(indexOf(m), ErrorCode::kBadValue, "than its original");
  m.original = {last.tetrahedra, last.vertices - 1u};
  expectRefused(indexOf(m), ErrorCode::kBadValue, "than its original");
  m.original = {(std::uint64_t{1} << 53) + 2, last.vertices};
  expectRefused(indexOf(m), ErrorCode::kBadValue, "no whole number");
}

TEST(LogManifest, aFocusIsABox) {
  Manifest m = sample(false);
  m.focus = {0, 1, 2, 1, 0x8000, 0xffff};
  m.focus->at(4) = m.focus->at(1);
  LogIndex index = indexOf(m);
  expectRefused(index, ErrorCode::kBadValue, "empty box");
  m.focus.reset();
  index = indexOf(m);
  EXPECT_TRUE(manifestOf(index)) << "it has neither";
}

/// `m` without the errors of the levels that are not multiples of `step`, nor the last.
void keepErrors(Manifest& m, std::uint32_t step) {
  for (ManifestLevel& level : m.levels)
    if (level.level % step != 0 && level.level + 1 < m.levels.size()) level.error.reset();
}

TEST(LogManifest, errorsOfSomeLevelsComeBack) {
  for (const std::uint32_t step : {1u, 2u, 7u, kLevels}) {
    Manifest m = sample();
    keepErrors(m, step);
    LogIndex index = indexOf(m);
    const Result<Manifest> read = manifestOf(index);
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(manifestToJson(*read), manifestToJson(m));
  }
}

TEST(LogManifest, takesAFewBytesALevel) {
  Manifest m = sample();
  m.fields.pop_back();
  for (ManifestLevel& level : m.levels) level.error->fields.pop_back();
  EXPECT_LT(manifestBlock(m)->size(), 120 + 12 * kLevels);
}

TEST(LogManifest, anErrorIsNeverUnderstated) {
  Manifest m = sample();
  m.levels[3].error->toLevel = {0.0123401, 0.0999001};
  m.levels[3].error->fields[1] = {1e-300, std::nextafter(0.01, 1)};
  const LevelError error = *manifestOf(indexOf(m))->levels[3].error;
  EXPECT_EQ(error.toLevel.mean, 0.0124);
  EXPECT_EQ(error.toLevel.max, 0.1);
  EXPECT_EQ(error.fields[1].rms, 1e-12);
  EXPECT_EQ(error.fields[1].max, 0.0101);
}

TEST(LogManifest, whatIsOutOfRangeIsRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  expectRefused(ErrorCode::kBadValue, "longer than",
                [](Manifest& m) { m.source = std::string(kMaxNameBytes + 1, 'n'); });
  expectRefused(ErrorCode::kBadValue, "not UTF-8",
                [](Manifest& m) { m.fields[1].name = "caf\xE9"; });
  expectRefused(ErrorCode::kBadValue, "step", [](Manifest& m) { m.latticeStep = 0; });
  expectRefused(ErrorCode::kBadValue, "step", [](Manifest& m) { m.fields[1].step = -1; });
  expectRefused(ErrorCode::kBadValue, "finite", [](Manifest& m) { m.latticeOrigin[2] = kNan; });
  expectRefused(ErrorCode::kBadValue, "finite",
                [](Manifest& m) { m.fields[0].range[1] = INFINITY; });
  expectRefused(ErrorCode::kBadValue, "finite",
                [](Manifest& m) { m.fields[1].minimum[1] = -INFINITY; });
  expectRefused(ErrorCode::kBadValue, "bits", [](Manifest& m) { m.fields[0].bits = 0; });
  expectRefused(ErrorCode::kBadValue, "bits",
                [](Manifest& m) { m.fields[0].bits = kMaxFieldBits + 1; });
  expectRefused(ErrorCode::kBadValue, "unknown type",
                [](Manifest& m) { m.fields[0].type = "complex"; });
  expectRefused(ErrorCode::kBadValue, "without a name", [](Manifest& m) { m.fields[1].name = ""; });
  expectRefused(ErrorCode::kBadValue, "level 7",
                [](Manifest& m) { m.levels[7].tetrahedra = kMaxElements + 1; });
  expectRefused(ErrorCode::kBadValue, "level 8",
                [](Manifest& m) { m.levels[8].error->fields[1] = {0.2, 0.1}; });
  expectRefused(ErrorCode::kBadValue, "level 9",
                [](Manifest& m) { m.levels[9].error->toOriginal = {0.2, 0.1}; });
  LogIndex twice = indexOf(sample());
  twice.fields[1].association = Association::kPoint;
  expectRefused(twice, ErrorCode::kBadValue, "two point fields 'density'");
}

TEST(LogManifest, limitsThemselvesAreAllowed) {
  Manifest m = sample();
  m.source = std::string(kMaxNameBytes, 'n');
  m.fields[0].bits = kMaxFieldBits;
  m.levels[7].vertices = kMaxElements;
  m.levels[7].error->toLevel.max = errorOfFigure(kMaxErrorFigure);
  m.levels[7].error->volumeLost = m.levels[7].error->volumeGained = 10;
  const Result<Manifest> read = manifestOf(indexOf(m));
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(manifestToJson(*read), manifestToJson(m));
}

TEST(LogManifest, errorsThatNoLogCanTellAreNotWritten) {
  const auto refusal = [](const std::function<void(ManifestLevel&)>& change) {
    Manifest m = sample();
    change(m.levels[5]);
    const Result<Bytes> block = manifestBlock(m);
    EXPECT_FALSE(block);
    return block ? std::string() : block.error().message;
  };
  for (const double bad : {-1e-9, std::numeric_limits<double>::quiet_NaN(), 1e7}) {
    EXPECT_NE(refusal([bad](ManifestLevel& l) { l.error->fields[0].max = bad; }).find("level 5"),
              std::string::npos);
    for (const auto volume : {&LevelError::volumeLost, &LevelError::volumeGained})
      EXPECT_NE(refusal([&](ManifestLevel& l) { (*l.error).*volume = bad; }).find("level 5"),
                std::string::npos);
  }
  EXPECT_NE(refusal([](ManifestLevel& l) { l.error->fields.pop_back(); }).find("level 5"),
            std::string::npos);
}

TEST(LogManifest, theErrorsOfTheEndsAreNotLeftOut) {
  for (const std::uint32_t end : {0u, kLevels - 1}) {
    Manifest m = sample();
    m.levels[end].error.reset();
    const Result<Bytes> block = manifestBlock(m);
    ASSERT_FALSE(block);
    EXPECT_NE(block.error().message.find("level " + std::to_string(end)), std::string::npos);
  }
}

TEST(LogManifest, everyTruncationAndEveryByteMoreIsRefused) {
  const LogIndex good = indexOf(sample());
  for (std::size_t n = 0; n < good.manifest.size(); ++n) {
    LogIndex cut = good;
    cut.manifest.resize(n);
    const Result<Manifest> read = manifestOf(cut);
    ASSERT_FALSE(read) << n;
    ASSERT_TRUE(read.error().code == ErrorCode::kTruncated ||
                read.error().code == ErrorCode::kLimitExceeded)
        << n << ": " << read.error().text();
  }
  LogIndex longer = good;
  longer.manifest.push_back(0);
  expectRefused(longer, ErrorCode::kBadValue, "behind");
}

TEST(LevelColumns, numbersThatTheBytesCannotHoldAreRefusedBeforeAllocating) {
  // A byte of the range coder holds at most kMaxDecisionsPerByte numbers.
  const Bytes few(4, 0);
  constexpr std::uint32_t kFields = 4;
  const auto levels = static_cast<std::uint32_t>(4 * kMaxDecisionsPerByte /
                                                 levelColumnCount(kFields, KnownErrors::kSome));
  const auto refusal = [&](std::uint32_t count) {
    return decodeLevelColumns(few, count, kFields, KnownErrors::kSome).error().code;
  };
  const std::size_t peak =
      testing::peakBytesOf([&] { EXPECT_EQ(refusal(levels + 1), ErrorCode::kLimitExceeded); });
  EXPECT_LT(peak, 4096u);
  EXPECT_NE(refusal(levels), ErrorCode::kLimitExceeded);
}

TEST(LevelColumns, anyNumberFollowsAnyOther) {
  const LevelColumns numbers{0, kMaxElements, 1, kMaxElements, 0, 0, kMaxElements, kMaxElements, 5};
  const Result<LevelColumns> read = decodeLevelColumns(
      encodeLevelColumns(numbers, 3, KnownErrors::kNone), 3, 2, KnownErrors::kNone);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(*read, numbers);
}

TEST(LevelColumns, aLevelIsKnownOrNotAndTheEndsAre) {
  constexpr std::uint32_t kThree = 3;
  LevelColumns numbers(kThree * levelColumnCount(0, KnownErrors::kSome), 0);
  const auto isRead = [&](std::uint32_t first, std::uint32_t second, std::uint32_t last) {
    for (const auto& [level, known] : {std::pair(0u, first), {1u, second}, {2u, last}})
      numbers[kKnownColumn * kThree + level] = known;
    return decodeLevelColumns(encodeLevelColumns(numbers, kThree, KnownErrors::kSome), kThree, 0,
                              KnownErrors::kSome)
        .has_value();
  };
  EXPECT_TRUE(isRead(1, 1, 1));
  EXPECT_TRUE(isRead(1, 0, 1));
  EXPECT_FALSE(isRead(0, 1, 1));
  EXPECT_FALSE(isRead(1, 1, 0));
  EXPECT_FALSE(isRead(1, 2, 1));
}

TEST(ErrorFigure, growsWithTheErrorAndComesBack) {
  for (std::uint32_t figure = 0; figure <= kMaxErrorFigure; ++figure) {
    ASSERT_EQ(figureOfError(errorOfFigure(figure)), figure);
    if (figure > 0) {
      ASSERT_LT(errorOfFigure(figure - 1), errorOfFigure(figure));
      ASSERT_EQ(figureOfError(std::nextafter(errorOfFigure(figure - 1), 1e9)), figure);
    }
  }
  EXPECT_EQ(errorOfFigure(0), 0);
  EXPECT_EQ(errorOfFigure(1), 1e-12);
  EXPECT_EQ(errorOfFigure(1 + 900 * 10 + 23), 0.0123);
  EXPECT_EQ(errorOfFigure(kMaxErrorFigure), 9.99e6);
}

}  // namespace
}  // namespace qtet
