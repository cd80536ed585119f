#include "codec/log/log_manifest.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <iterator>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "codec/coding/error_figure.h"
#include "codec/coding/level_columns.h"
#include "codec/log/log_index.h"
#include "proto/limits.h"
#include "proto/series.h"
#include "proto/utf8.h"

namespace qtet {
namespace {

// ---- texts and numbers

void writeText(ByteWriter& w, const std::string& text) {
  w.writeVarint(static_cast<std::uint32_t>(text.size()));
  w.append(ByteView(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

std::string readText(ByteReader& r) {
  const std::uint32_t size = r.readVarint();
  if (size > kMaxNameBytes)
    return r.fail(ErrorCode::kBadValue,
                  "a name in the manifest is longer than 256 bytes; build the log again"),
           std::string();
  const ByteView bytes = r.take(size);
  std::string text(bytes.begin(), bytes.end());
  if (!isUtf8(text))
    return r.fail(ErrorCode::kBadValue, "a text in the manifest is not UTF-8; build the log again"),
           std::string();
  return text;
}

void writeNumber(ByteWriter& w, double number) { w.write(std::bit_cast<std::uint64_t>(number)); }

double readNumber(ByteReader& r) {
  const auto number = std::bit_cast<double>(r.read<std::uint64_t>());
  if (std::isfinite(number)) return number;
  r.fail(ErrorCode::kBadValue, "a number in the manifest is not finite; build the log again");
  return 0;
}

double readStep(ByteReader& r) {
  const double step = readNumber(r);
  if (!(step > 0))
    r.fail(ErrorCode::kBadValue, "a step in the manifest is not above 0; build the log again");
  return step;
}

// ---- fields

// Beside a field's type, as beside its association in the chunk table: with one of the two changed,
// other integers would come out.
constexpr unsigned kMissingTypeFlag = 0x80;

void writeField(ByteWriter& w, const ManifestField& field) {
  writeText(w, field.name);
  const auto type =
      static_cast<unsigned>(std::ranges::find(kFieldTypes, field.type) - kFieldTypes.begin());
  w.write(static_cast<std::uint8_t>(type | (field.hasMissing ? kMissingTypeFlag : 0)));
  w.write(static_cast<std::uint8_t>(field.bits));
  writeNumber(w, field.step);
  for (const double value : field.minimum) writeNumber(w, value);
  for (const double value : field.range) writeNumber(w, value);
}

ManifestField readField(ByteReader& r, const FieldShape& shape) {
  ManifestField out;
  out.name = readText(r);
  if (out.name.empty()) r.fail(ErrorCode::kBadValue, "a field without a name; build the log again");
  const auto typeAndMissing = r.read<std::uint8_t>();
  out.hasMissing = (typeAndMissing & kMissingTypeFlag) != 0;
  if (out.hasMissing != shape.hasMissing)
    r.fail(ErrorCode::kBadValue,
           "manifest and chunk table contradict each other in whether a field has missing values; "
           "fetch or build the log again");
  const unsigned type = typeAndMissing & ~kMissingTypeFlag;
  if (type >= kFieldTypes.size())
    r.fail(ErrorCode::kBadValue, "a field of an unknown type; use a newer qtet");
  out.type = kFieldTypes[std::min<std::size_t>(type, kFieldTypes.size() - 1)];
  out.bits = r.read<std::uint8_t>();
  if (out.bits < kMinFieldBits || out.bits > kMaxFieldBits)
    r.fail(ErrorCode::kBadValue, "a field's bits are outside 1..28; build the log again");
  out.components = shape.components;
  out.association = shape.association == Association::kCell ? "cell" : "point";
  out.step = readStep(r);
  for (std::uint32_t c = 0; c < out.components; ++c) out.minimum.push_back(readNumber(r));
  for (double& value : out.range) value = readNumber(r);
  return out;
}

// ---- what follows the fields

constexpr unsigned kErrorsFollow = 1, kFocusFollows = 2, kOpeningFollows = 4, kUnitsFollow = 8,
                   kLabelsFollow = 16, kOriginalFollows = 32;
constexpr unsigned kKnownFlags = 2 * kOriginalFollows - 1;
constexpr std::uint8_t kNoCut = 3;

unsigned flagsOf(const Manifest& manifest) {
  return (manifest.levels.front().error ? kErrorsFollow : 0) |
         (manifest.focus ? kFocusFollows : 0) | (manifest.opening ? kOpeningFollows : 0) |
         (manifest.units.empty() ? 0 : kUnitsFollow) |
         (manifest.labels.empty() ? 0 : kLabelsFollow) | (manifest.original ? kOriginalFollows : 0);
}

void writeUnits(ByteWriter& w, const Units& units) {
  w.writeVarint(static_cast<std::uint32_t>(units.size()));
  for (const auto& [name, unit] : units) writeText(w, name), writeText(w, unit);
}

void writeLabels(ByteWriter& w, const Labels& labels) {
  w.writeVarint(static_cast<std::uint32_t>(labels.size()));
  for (const auto& [field, names] : labels) {
    writeText(w, field);
    w.writeVarint(static_cast<std::uint32_t>(names.size()));
    for (const auto& [value, name] : names)
      w.write(static_cast<std::uint32_t>(value)), writeText(w, name);
  }
}

void writeBehindFields(ByteWriter& w, const Manifest& manifest) {
  w.write(static_cast<std::uint8_t>(flagsOf(manifest)));
  if (manifest.focus)
    for (const std::uint16_t end : *manifest.focus) w.write(end);
  if (manifest.opening) {
    w.write(manifest.opening->field);
    w.write(manifest.opening->cut.value_or(kNoCut));
  }
  if (!manifest.units.empty()) writeUnits(w, manifest.units);
  if (!manifest.labels.empty()) writeLabels(w, manifest.labels);
  if (!manifest.original) return;
  writeNumber(w, static_cast<double>(manifest.original->tetrahedra));
  writeNumber(w, static_cast<double>(manifest.original->vertices));
}

Units readUnits(ByteReader& r) {
  Units out;
  const std::uint32_t count = r.readVarint();
  for (std::uint32_t i = 0; i < count && !r.failed(); ++i) {
    std::string name = readText(r), unit = readText(r);
    const bool isBehind = out.empty() || out.rbegin()->first < name;
    if (!isBehind || unit.empty() || unit.size() > kMaxUnitBytes)
      r.fail(ErrorCode::kBadValue,
             "the manifest's units are not in the order of their names, or one is empty or longer "
             "than 64 bytes; build the log again");
    out.emplace_hint(out.end(), std::move(name), std::move(unit));
  }
  return out;
}

LabelNames readLabelNames(ByteReader& r) {
  LabelNames out;
  const std::uint32_t count = r.readVarint();
  for (std::uint32_t i = 0; i < count && !r.failed(); ++i) {
    const auto value = static_cast<std::int32_t>(r.read<std::uint32_t>());
    std::string name = readText(r);
    if ((!out.empty() && value <= out.rbegin()->first) || name.empty() || i == kMaxLabelNames)
      r.fail(ErrorCode::kBadValue,
             "the names of a label's values are not in the order of these, one is empty, or there "
             "are more than 4,096; build the log again");
    out.emplace_hint(out.end(), value, std::move(name));
  }
  return out;
}

/// Later fields may be labels, too, so that a name may be of no field yet.
Labels readLabels(ByteReader& r) {
  Labels out;
  const std::uint32_t count = r.readVarint();
  for (std::uint32_t i = 0; i < count && !r.failed(); ++i) {
    std::string name = readText(r);
    if ((!out.empty() && name <= out.rbegin()->first) || name.empty())
      r.fail(ErrorCode::kBadValue,
             "the manifest's labels are not in the order of their names, or one has none; build "
             "the log again");
    out.emplace_hint(out.end(), std::move(name), readLabelNames(r));
  }
  return out;
}

Focus readFocus(ByteReader& r) {
  Focus focus{};
  for (std::uint16_t& end : focus) end = r.read<std::uint16_t>();
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (focus[axis] >= focus[axis + 3])
      r.fail(ErrorCode::kBadValue, "the manifest's focus is an empty box; build the log again");
  return focus;
}

Opening readOpening(ByteReader& r, std::size_t fields) {
  Opening opening{r.read<std::uint8_t>()};
  if (const auto cut = r.read<std::uint8_t>(); cut != kNoCut) opening.cut = cut;
  if (opening.field >= fields || opening.cut.value_or(0) > kNoCut)
    r.fail(
        ErrorCode::kBadValue,
        "the manifest's opening names a field or an axis that is not there; build the log again");
  return opening;
}

/// A whole number of 2^53 at most.
std::uint64_t readCount(ByteReader& r) {
  constexpr double kMost = 9007199254740992.0;
  const double number = readNumber(r);
  if (number >= 0 && number <= kMost && std::floor(number) == number)
    return static_cast<std::uint64_t>(number);
  r.fail(ErrorCode::kBadValue,
         "a count of the original's cells or vertices is no whole number; build the log again");
  return 0;
}

Status checkOriginal(const Manifest& manifest) {
  if (!manifest.original) return {};
  const ManifestLevel& last = manifest.levels.back();
  if (manifest.original->tetrahedra >= last.tetrahedra &&
      manifest.original->vertices >= last.vertices)
    return {};
  return fail(ErrorCode::kBadValue,
              "the last level has more cells or vertices than its original; build the log again");
}

KnownErrors readBehindFields(ByteReader& r, Manifest& out) {
  const unsigned flags = r.read<std::uint8_t>();
  if (flags > kKnownFlags)
    r.fail(ErrorCode::kBadValue,
           "the manifest's flags say what this build does not know; use a newer qtet");
  if ((flags & kFocusFollows) != 0) out.focus = readFocus(r);
  if ((flags & kOpeningFollows) != 0) out.opening = readOpening(r, out.fields.size());
  if ((flags & kUnitsFollow) != 0) out.units = readUnits(r);
  if ((flags & kLabelsFollow) != 0) out.labels = readLabels(r);
  if ((flags & kOriginalFollows) != 0) {
    const std::uint64_t tetrahedra = readCount(r);
    out.original = {tetrahedra, readCount(r)};
  }
  return (flags & kErrorsFollow) != 0 ? KnownErrors::kSome : KnownErrors::kNone;
}

// ---- levels

std::vector<double> pairsOf(const LevelError& error) {
  std::vector<double> out{error.toLevel.mean, error.toLevel.max, error.toOriginal.mean,
                          error.toOriginal.max};
  for (const FieldError& field : error.fields) out.insert(out.end(), {field.rms, field.max});
  return out;
}

Status checkErrors(const Manifest& manifest) {
  const bool hasErrors = std::ranges::any_of(
      manifest.levels, [](const ManifestLevel& level) { return level.error.has_value(); });
  for (const ManifestLevel& level : manifest.levels) {
    const auto bad = [&](const char* what) {
      return fail(ErrorCode::kBadValue,
                  "the known error of level " + std::to_string(level.level) + " " + what);
    };
    const bool isEnd = level.level == 0 || level.level + 1 == manifest.levels.size();
    if (hasErrors && isEnd && !level.error) return bad("is not there; measure first and last");
    if (!level.error) continue;
    if (level.error->fields.size() != manifest.fields.size())
      return bad("has another number of fields than the manifest");
    const auto outside = [](double most) {
      return [most](double number) { return !(number >= 0 && number <= most); };
    };
    const auto outsideVolume = outside(static_cast<double>(kMaxVolumeFigure) / kVolumeFigure);
    if (outsideVolume(level.error->volumeLost) || outsideVolume(level.error->volumeGained) ||
        std::ranges::any_of(pairsOf(*level.error), outside(errorOfFigure(kMaxErrorFigure))))
      return bad("holds what is no number, below 0 or beyond what a log can hold; measure again");
  }
  return {};
}

std::uint32_t volumeFigure(double share) {
  return static_cast<std::uint32_t>(std::llround(share * kVolumeFigure));
}

LevelColumns columnsOf(const std::vector<ManifestLevel>& all, KnownErrors errors) {
  const std::size_t levels = all.size();
  const std::size_t fields = all.front().error ? all.front().error->fields.size() : 0;
  LevelColumns out(levels * levelColumnCount(static_cast<std::uint32_t>(fields), errors));
  for (std::size_t l = 0; l < levels; ++l) {
    const ManifestLevel& level = all[l];
    std::size_t at = l;
    const auto put = [&](std::uint32_t number) { out[at] = number, at += levels; };
    for (const std::uint32_t count : {level.tetrahedra, level.vertices, level.boundaryTriangles})
      put(count);
    if (!level.error) continue;
    put(1);
    put(volumeFigure(level.error->volumeLost));
    put(volumeFigure(level.error->volumeGained));
    for (const double error : pairsOf(*level.error)) put(figureOfError(error));
  }
  return out;
}

/// The levels without the errors of the last `count` fields.
std::vector<ManifestLevel> levelsOfFront(const Manifest& manifest, std::size_t count) {
  std::vector<ManifestLevel> out = manifest.levels;
  for (ManifestLevel& level : out)
    if (level.error) level.error->fields.resize(manifest.fields.size() - count);
  return out;
}

/// The errors of the last `count` fields, and nothing else of the levels.
std::vector<ManifestLevel> levelsOfLater(const Manifest& manifest, std::size_t count) {
  std::vector<ManifestLevel> out(manifest.levels.size());
  for (std::size_t l = 0; l < out.size(); ++l) {
    const std::optional<LevelError>& from = manifest.levels[l].error;
    if (!from) continue;
    const auto last = std::span(from->fields).last(count);
    out[l].error.emplace().fields.assign(last.begin(), last.end());
  }
  return out;
}

/// Takes one level's numbers out of the columns.
class LevelReader {
 public:
  LevelReader(const LevelColumns& columns, std::size_t levels, std::size_t level)
      : columns_(columns), levels_(levels), at_(level) {}

  std::uint32_t next() { return columns_[std::exchange(at_, at_ + levels_)]; }
  double error() { return errorOfFigure(next()); }
  double volume() { return next() / static_cast<double>(kVolumeFigure); }

 private:
  const LevelColumns& columns_;
  std::size_t levels_, at_;
};

std::optional<LevelError> readError(LevelReader& reader, std::size_t fields, KnownErrors errors) {
  if (errors == KnownErrors::kNone || reader.next() == 0) return std::nullopt;
  LevelError out;
  out.volumeLost = reader.volume();
  out.volumeGained = reader.volume();
  for (OneSidedDistance* side : {&out.toLevel, &out.toOriginal})
    side->mean = reader.error(), side->max = reader.error();
  out.fields.resize(fields);
  for (FieldError& field : out.fields) field.rms = reader.error(), field.max = reader.error();
  return out;
}

/// The chunk with which each level is complete: the last one that begins with this level or a
/// coarser one.
std::vector<std::uint32_t> completingChunks(const LogIndex& index) {
  std::vector<std::uint32_t> out(std::size_t{index.chunks.back().lastLevel} + 1);
  for (std::uint32_t chunk = 0; chunk < index.chunks.size(); ++chunk)
    if (const std::uint32_t first = index.chunks[chunk].firstLevel; first < out.size())
      out[first] = chunk;
  for (std::size_t level = 1; level < out.size(); ++level)
    out[level] = std::max(out[level], out[level - 1]);
  return out;
}

using FieldNamesSeen = std::set<std::pair<std::string, std::string>>;

Status readFields(ByteReader& r, std::span<const FieldShape> shapes, FieldNamesSeen& names,
                  Manifest& out) {
  for (const FieldShape& shape : shapes) {
    const ManifestField& field = out.fields.emplace_back(readField(r, shape));
    if (r.failed()) return std::unexpected(r.error());
    if (!names.emplace(field.association, field.name).second)
      return fail(ErrorCode::kBadValue,
                  "the manifest has two " + field.association + " fields '" + field.name +
                      "'; a field is asked for by its name",
                  r.offset());
  }
  return {};
}

/// Before anything is allocated for them.
Status checkFigures(std::size_t levels, std::size_t fields) {
  if (levels * fields <= kMaxFieldFigures) return {};
  return fail(ErrorCode::kLimitExceeded, "errors of " + std::to_string(fields) + " fields at " +
                                             std::to_string(levels) +
                                             " levels; a log holds 4,194,304 of them");
}

/// The errors of later fields, where the levels have errors.
Status readLaterErrors(ByteReader& r, std::uint32_t fields, Manifest& out) {
  const ByteView bytes = r.take(r.remaining());
  const auto levels = static_cast<std::uint32_t>(out.levels.size());
  if (!out.levels.front().error)
    return bytes.empty() ? Status{}
                         : fail(ErrorCode::kBadValue,
                                "bytes behind the last later field; fetch or build the log again");
  if (Status s = checkFigures(levels, out.fields.size()); !s) return s;
  const Result<LevelColumns> numbers =
      decodeLevelColumns(bytes, levels, fields, KnownErrors::kSome);
  if (!numbers) return std::unexpected(numbers.error());
  for (std::uint32_t l = 0; l < levels; ++l) {
    LevelReader reader(*numbers, levels, l);
    for (std::uint32_t c = 0; c < kCountColumns; ++c) (void)reader.next();
    const std::optional<LevelError> error = readError(reader, fields, KnownErrors::kSome);
    if (error.has_value() != out.levels[l].error.has_value())
      return fail(
          ErrorCode::kBadValue,
          "the later instants have errors of other levels than the manifest; fetch or build "
          "the log again");
    if (error)
      out.levels[l].error->fields.insert(out.levels[l].error->fields.end(), error->fields.begin(),
                                         error->fields.end());
  }
  return {};
}

Status readLevels(ByteReader& r, const LogIndex& index, Manifest& out) {
  const KnownErrors errors = readBehindFields(r, out);
  const ByteView bytes = r.take(r.remaining());
  if (r.failed()) return std::unexpected(r.error());
  const std::vector<std::uint32_t> chunks = completingChunks(index);
  const auto levels = static_cast<std::uint32_t>(chunks.size());
  const auto fields = static_cast<std::uint32_t>(out.fields.size());
  if (Status s = checkFigures(levels, errors == KnownErrors::kNone ? 0 : fields); !s) return s;
  const Result<LevelColumns> numbers = decodeLevelColumns(bytes, levels, fields, errors);
  if (!numbers) return std::unexpected(numbers.error());
  for (std::uint32_t l = 0; l < levels; ++l) {
    LevelReader reader(*numbers, levels, l);
    const std::uint32_t tetrahedra = reader.next(), vertices = reader.next(),
                        triangles = reader.next();
    out.levels.push_back({l, tetrahedra, vertices, triangles, chunks[l], std::nullopt});
    out.levels.back().error = readError(reader, fields, errors);
  }
  return checkOriginal(out);
}

}  // namespace

Result<Bytes> manifestBlock(const Manifest& manifest, std::size_t later) {
  assert(!manifest.levels.empty() && later <= manifest.fields.size());
  if (Status s = checkErrors(manifest); !s) return std::unexpected(s.error());
  ByteWriter w;
  writeText(w, manifest.generator);
  writeText(w, soundUtf8(manifest.source));
  writeNumber(w, manifest.latticeStep);
  for (const double value : manifest.latticeOrigin) writeNumber(w, value);
  for (const ManifestField& field :
       std::span(manifest.fields).first(manifest.fields.size() - later))
    writeField(w, field);
  writeBehindFields(w, manifest);
  const KnownErrors errors =
      manifest.levels.front().error ? KnownErrors::kSome : KnownErrors::kNone;
  w.append(encodeLevelColumns(columnsOf(levelsOfFront(manifest, later), errors),
                              static_cast<std::uint32_t>(manifest.levels.size()), errors));
  if (w.bytes().size() > kMaxManifestBytes)
    return fail(ErrorCode::kLimitExceeded,
                "the manifest is above 8 MiB; choose some fields with `fields`");
  return w.take();
}

Bytes laterManifestBlock(const Manifest& manifest, std::size_t later) {
  assert(!manifest.levels.empty() && later <= manifest.fields.size());
  ByteWriter w;
  for (const ManifestField& field : std::span(manifest.fields).last(later)) writeField(w, field);
  if (manifest.levels.front().error)
    w.append(encodeLevelColumns(columnsOf(levelsOfLater(manifest, later), KnownErrors::kSome),
                                static_cast<std::uint32_t>(manifest.levels.size()),
                                KnownErrors::kSome));
  return w.take();
}

Status setManifest(LogIndex& index, Manifest manifest) {
  assert(!manifest.levels.empty() && manifest.fields.size() == index.fields.size());
  if (manifest.levels.front().error)
    if (Status s = checkFigures(manifest.levels.size(), manifest.fields.size()); !s) return s;
  const std::vector<bool> isLater =
      laterInstants(seriesOf(manifest.fields), manifest.fields.size());
  const auto first = std::ranges::find(isLater, true);
  index.laterFields = index.hasSeries() ? static_cast<std::uint32_t>(isLater.end() - first) : 0;
  if (manifest.opening && manifest.opening->field >= manifest.fields.size() - index.laterFields)
    manifest.opening.reset();
  const auto isOfNone = [&](const std::string& name, const auto& isMeant) {
    return std::ranges::none_of(manifest.fields, [&](const ManifestField& field) {
      return isMeant(field) && field.name.withoutTime() == name;
    });
  };
  std::erase_if(manifest.units, [&](const auto& entry) {
    const auto any = [](const ManifestField&) { return true; };
    return !entry.first.empty() && isOfNone(entry.first, any);
  });
  std::erase_if(manifest.labels,
                [&](const auto& entry) { return isOfNone(entry.first, mayBeLabel); });
  for (auto& [name, values] : manifest.labels)
    while (values.size() > kMaxLabelNames) values.erase(std::prev(values.end()));
  Result<Bytes> front = manifestBlock(manifest, index.laterFields);
  if (!front) return std::unexpected(front.error());
  index.manifest = std::move(*front);
  index.laterManifest =
      index.laterFields > 0 ? laterManifestBlock(manifest, index.laterFields) : Bytes{};
  if (index.laterManifest.size() > kMaxManifestBytes)
    return fail(ErrorCode::kLimitExceeded,
                "the manifest of later instants is above 8 MiB; choose some with `time`");
  return {};
}

Result<Bytes> laterPart(const LogIndex& index) {
  Bytes part = index.encodeLater();
  if (part.size() <= kMaxLaterBytes) return part;
  return fail(ErrorCode::kLimitExceeded,
              "the later instants take more than 256 MiB; choose some with `time`");
}

Result<Manifest> manifestOf(const LogIndex& index) {
  Manifest out;
  ByteReader r(index.manifest, LogIndex::kHeaderBytes);
  out.generator = readText(r);
  out.source = readText(r);
  out.latticeBits = index.positionBits;
  out.latticeStep = readStep(r);
  for (double& value : out.latticeOrigin) value = readNumber(r);
  FieldNamesSeen names;
  const std::span shapes(index.fields);
  const auto front = shapes.first(shapes.size() - index.laterFields);
  if (Status s = readFields(r, front, names, out); !s) return std::unexpected(s.error());
  if (Status s = readLevels(r, index, out); !s) return std::unexpected(s.error());
  if (index.laterFields > 0) {
    ByteReader later(index.laterManifest, index.laterOffset);
    if (Status s = readFields(later, shapes.subspan(front.size()), names, out); !s)
      return std::unexpected(s.error());
    if (Status s = readLaterErrors(later, index.laterFields, out); !s)
      return std::unexpected(s.error());
  }
  out.series = seriesOf(out.fields);
  return out;
}

}  // namespace qtet
