#include "simplify/log/add_fields.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <numeric>
#include <ranges>
#include <set>
#include <span>

#include "codec/log/field_blocks.h"
#include "codec/log/log_manifest.h"
#include "codec/log/manifest_field.h"
#include "codec/refine/log_file.h"
#include "proto/rounding_error.h"
#include "simplify/clean/quantise_field.h"
#include "simplify/clean/verify.h"
#include "simplify/cost/label_fields.h"
#include "simplify/log/whole_log.h"
#include "simplify/mesh/history_levels.h"
#include "simplify/mesh/missing_values.h"
#include "simplify/series/time_differences.h"

namespace qtet {
namespace {

/// The field of the mesh in the log's order.
template <class T>
std::vector<T> inLogOrder(const std::vector<T>& values, std::uint32_t components,
                          const std::vector<std::uint32_t>& logs) {
  assert(values.size() == logs.size() * components);
  std::vector<T> out(values.size());
  for (std::size_t i = 0; i < logs.size(); ++i)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(i * components), components,
                out.begin() + static_cast<std::ptrdiff_t>(std::size_t{logs[i]} * components));
  return out;
}

/// How many predictions a field rests on in a row, if its parents' are known.
std::size_t depthOf(const TimePrediction& prediction, const std::vector<std::size_t>& depths) {
  std::size_t out = 0;
  for (const TimePrediction::Parent& parent : prediction.all()) {
    assert(parent.field < depths.size());
    out = std::max(out, 1 + depths[parent.field]);
  }
  return out;
}

/// Places of `items` in the order of decoding, behind the instants `before`.
template <class Item>
std::vector<std::size_t> decodingOrderOf(const std::vector<FieldInfo>& before,
                                         const std::vector<Item>& items) {
  std::vector<FieldInfo> all = before;
  for (const Item& item : items) all.push_back(item.info);
  std::vector<std::size_t> out(items.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  for (const Series& series : seriesOf(all)) {
    std::vector<std::size_t> places, ordered;  // of the series' items
    for (const InstantStep& step : decodingOrder(series.fields.size()))
      if (const std::size_t f = series.fields[step.instant]; f >= before.size())
        ordered.push_back(f - before.size());
    places = ordered;
    std::ranges::sort(places);
    for (std::size_t i = 0; i < places.size(); ++i) out[places[i]] = ordered[i];
  }
  return out;
}

/// The same step, and whole ranges of room below, one at least and as many as the box needs.
FieldInfo withRoomBelow(FieldInfo scale, const FieldExtents& box) {
  assert(box.minimum.size() == scale.components && scale.minimum.size() == scale.components);
  assert(scale.bits < kMaxScaleBits);
  const auto isBelow = [&] {
    for (std::size_t c = 0; c < scale.components; ++c)
      if (box.minimum[c] < scale.minimum[c]) return true;
    return false;
  };
  do {
    for (double& minimum : scale.minimum) minimum -= scale.step * std::ldexp(1.0, scale.bits);
    ++scale.bits;
  } while (isBelow() && scale.bits < kMaxScaleBits);
  return scale;
}

}  // namespace

FieldAdder::FieldAdder(const LogFile& log, AddFieldsOptions options, Manifest manifest,
                       std::unique_ptr<LogHistory> history)
    : log_(log),
      options_(std::move(options)),
      manifest_(std::move(manifest)),
      history_(std::move(history)) {
  for (const auto& [name, values] : manifest_.labels) labels_.insert(name);
  FusionHistory& h = history_->history;
  HistoryLevels levels(h);
  levels.moveTo(levels.finest());
  finest_.assign(h.cells.begin(), h.cells.begin() + history_->tetrahedra);
  levels.moveTo(0);
  if (options_.kept) {
    added_.kept = *options_.kept;
  } else {
    added_.kept.resize(manifest_.fields.size());
    std::iota(added_.kept.begin(), added_.kept.end(), 0U);
  }
  for (std::size_t f = 0; f < manifest_.fields.size(); ++f) {
    depths_.push_back(depthOf(log_.fields()[f].prediction, depths_));
    const FieldInfo info = fieldInfoOf(manifest_.fields[f]);
    const auto name = info.name.instant();
    if (!name) continue;
    const bool stays = std::ranges::find(added_.kept, f) != added_.kept.end();
    if (stays || options_.scalesOfOthers) keepScale(info, stays);
    if (stays && !options_.scalesOfOthers) keepInstant(info, name->time, f);
  }
}

Result<FieldAdder> FieldAdder::make(const LogFile& log, const AddFieldsOptions& options) {
  Result<Manifest> manifest = manifestOf(log.index());
  if (!manifest) return std::unexpected(manifest.error());
  if (Status whole = checkWhole(*manifest); !whole) return std::unexpected(whole.error());
  Result<LogHistory> history = historyOf(log, options.progress);
  if (!history) return std::unexpected(history.error());
  return FieldAdder(log, options, std::move(*manifest),
                    std::make_unique<LogHistory>(std::move(*history)));
}

Status FieldAdder::matchTo(const TetMesh& mesh) {
  if (!match_.points.empty() && mesh.points == matched_.points &&
      mesh.tetrahedra == matched_.tetrahedra)
    return {};
  const FusionHistory& h = history_->history;
  const Result<OnLattice> placed = putOnLattice(mesh, h.lattice, {});
  if (!placed) return std::unexpected(placed.error());
  Result<MeshMatch> match =
      matchMesh(placed->mesh, std::span(h.points).first(history_->vertices), finest_);
  if (!match) return std::unexpected(match.error());
  assert(match->points.size() == mesh.points.size());
  assert(match->tetrahedra.size() == mesh.tetrahedra.size());
  match_ = std::move(*match);
  matched_.points = mesh.points, matched_.tetrahedra = mesh.tetrahedra;
  return {};
}

/// The series of an instant; nullptr of another field.
FieldAdder::SeriesState* FieldAdder::seriesOf(std::string_view association, const FieldName& name) {
  const auto instant = name.instant();
  return instant ? &series_[{std::string(association), std::string(instant->series)}] : nullptr;
}

void FieldAdder::keepScale(FieldInfo info, bool stays) {
  if (!stays) {
    // the step of a constant field means nothing
    if (!isFloatType(info.type) || info.step == 1 || info.bits >= kMaxScaleBits) return;
    info = withRoomBelow(info, extentsOf(info));
  }
  std::vector<Scale>& scales = seriesOf(info.association, info.name)->scales;
  const auto same = std::ranges::find_if(
      scales, [&](const Scale& scale) { return haveOneScale(scale.info, info); });
  if (same == scales.end()) {
    scales.push_back({std::move(info), 1});
    return;
  }
  ++same->instants;
  if (info.bits < same->info.bits) same->info = std::move(info);
}

void FieldAdder::keepInstant(const FieldInfo& info, double time, std::size_t number) {
  std::vector<Instant>& instants = seriesOf(info.association, info.name)->instants;
  const auto behind = std::ranges::upper_bound(instants, time, {}, &Instant::time);
  instants.insert(behind, {time, number, info});
}

/// The last instant before this one that has its scale.
const FieldAdder::Instant* FieldAdder::parentOf(const FieldInfo& info) {
  SeriesState* const series = seriesOf(info.association, info.name);
  if (series == nullptr) return nullptr;
  const double time = info.name.instant()->time;
  const auto behind = std::ranges::lower_bound(series->instants, time, {}, &Instant::time);
  const auto rest = std::ranges::subrange(series->instants.begin(), behind);
  for (const Instant& instant : std::views::reverse(rest))
    if (haveOneScale(instant.info, info)) return &instant;
  return nullptr;
}

/// The scale that a series goes on with: the last instant's, or that of most where it is far away
/// from it. nullptr: it has none.
const FieldInfo* FieldAdder::scaleOf(const SeriesState& series) {
  if (series.scales.empty()) return nullptr;
  const FieldInfo& usual = std::ranges::max_element(series.scales, {}, &Scale::instants)->info;
  if (series.instants.empty()) return &usual;
  const FieldInfo& last = series.instants.back().info;
  const auto same = std::ranges::find_if(
      series.scales, [&](const Scale& scale) { return haveOneScale(scale.info, last); });
  if (same == series.scales.end() || !isFloatType(last.type)) return &usual;
  if (last.step == usual.step) return &same->info;
  const FieldExtents here = extentsOf(same->info), there = extentsOf(usual);
  return isOutlying(here, there) || isOutlying(there, here) ? &usual : &same->info;
}

/// The scale for the instants of a series in a mesh: the one that the series goes on with. Where
/// values lie below it, it gets room for more of them.
std::optional<FieldInfo> FieldAdder::commonScale(const SeriesState& series,
                                                 std::span<const MeshField* const> fields) {
  const FieldInfo* const scale = scaleOf(series);
  if (scale == nullptr) return std::nullopt;
  const FieldExtents there = extentsOf(*scale);
  FieldExtents box = there;
  for (const MeshField* const field : fields) {
    if (field->components != scale->components || field->type != scale->type ||
        !isFloatType(field->type))
      return *scale;
    if (const FieldExtents own = extentsOf(*field); !isOutlying(own, there)) box.include(own);
  }
  const auto isBelow = [&](std::size_t c) {
    return box.minimum[c] < scale->minimum[c] - 0.5 * scale->step;
  };
  const auto components = std::views::iota(std::size_t{0}, std::size_t{scale->components});
  return std::ranges::any_of(components, isBelow) ? withRoomBelow(*scale, box) : *scale;
}

/// The largest extent of the instants that have the scale, and of those that come. Where there are
/// components, the log does not say theirs, and only those that come count.
double FieldAdder::rangeOfSeries(const MeshField& field, const FieldScale& own,
                                 const FieldInfo& scale) {
  if (field.components > 1) return own.extents.largest();
  FieldExtents all = own.extents;
  for (const Instant& instant : seriesOf(field.association, field.name)->instants) {
    const std::array<double, 2>& range = instant.info.range;
    const bool hasNone = instant.info.hasMissing && range[0] == range[1];
    if (!hasNone && haveOneScale(instant.info, scale)) all.include({{range[0]}, {range[1]}});
  }
  return all.largest();
}

/// By `own` where there is no scale, or where that leaves the bound.
Result<QuantisedField> FieldAdder::quantised(const MeshField& field, const FieldScale& own,
                                             const std::optional<FieldInfo>& scale,
                                             const std::optional<ValueBound>& bound) {
  if (!scale) return quantiseBy(own, field, options_.fieldBits, bound);
  Result<QuantisedField> there = quantisedBeside(field, own, *scale, bound);
  if (!there || !bound) return there;
  const double most =
      bound->isOfRange()
          ? bound->value / 100 * bound->range.value_or(rangeOfSeries(field, own, *scale))
          : bound->value;
  if (largestRoundingError(there->info) <= most) return there;
  return quantiseBy(own, field, options_.fieldBits, bound);
}

/// The field by the scale of its series, if its values are of that size; else by `own`.
Result<QuantisedField> FieldAdder::quantisedBeside(const MeshField& field, const FieldScale& own,
                                                   const FieldInfo& scale,
                                                   const std::optional<ValueBound>& bound) {
  const bool isComparable =
      isFloatType(field.type) && scale.components == field.components && scale.type == field.type;
  const FieldExtents extents = extentsOf(field), others = extentsOf(scale);
  const bool isFar = isComparable && isOutlying(extents, others);
  const bool areFew = isFar && areFewOutlying(field, others);
  if (isFar) outlying_.add(field, extents, others);
  // integers that lose nothing by themselves do not take a step of more than 1
  const bool isCoarse = !isFloatType(field.type) && scale.step != 1 && extents.fitsExactly();
  if ((!isFar || areFew) && !isCoarse)
    if (std::optional<QuantisedField> there = quantiseAs(scale, field)) return std::move(*there);
  if (areFew) return quantiseFiner(field, others, FieldPrecision{.bits = scale.bits});
  if (!isFar) return quantiseBy(own, field, options_.fieldBits, bound);
  for (const Scale& other : seriesOf(field.association, field.name)->scales) {
    const FieldExtents box = extentsOf(other.info);
    if (isOutlying(extents, box) || isOutlying(box, extents)) continue;
    if (std::optional<QuantisedField> there = quantiseAs(other.info, field))
      return std::move(*there);
  }
  return quantiseBy({extents}, field, options_.fieldBits, bound);
}

/// The scales of the mesh's series.
std::map<const FieldAdder::SeriesState*, std::optional<FieldInfo>> FieldAdder::commonScales(
    const TetMesh& mesh) {
  std::map<const SeriesState*, std::vector<const MeshField*>> fields;
  for (const MeshField& field : mesh.fields)
    if (const SeriesState* const series = seriesOf(field.association, field.name))
      fields[series].push_back(&field);
  std::map<const SeriesState*, std::optional<FieldInfo>> out;
  for (const auto& [series, all] : fields) out[series] = commonScale(*series, all);
  return out;
}

/// A label of the log, or one that was added.
bool FieldAdder::isKnownLabel(const FieldInfo& info) const {
  return isOneInteger(info) && labels_.contains(info.name.withoutTime());
}

/// A known label, or one by labelsOf.
bool FieldAdder::isLabel(const std::vector<Tetrahedron>& tetrahedra, const FieldInfo& info,
                         const std::vector<std::int32_t>& values) const {
  if (!isOneInteger(info)) return false;
  if (isKnownLabel(info)) return true;
  LatticeMesh alone;
  alone.tetrahedra = tetrahedra;
  alone.fields = {info};
  alone.values = {values};
  return !labelsOf(alone).empty();
}

Result<std::vector<FieldAdder::Item>> FieldAdder::itemsOf(const TetMesh& mesh) {
  const FieldScales all = scalesOf(mesh.fields);
  const auto common = commonScales(mesh);
  const std::vector<std::optional<ValueBound>> bounds = valueBoundsOf(mesh.fields, options_.errors);
  std::vector<Item> out;
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    const MeshField& field = mesh.fields[f];
    const auto scale = common.find(seriesOf(field.association, field.name));
    Result<QuantisedField> quantised = this->quantised(
        field, all.scales[f], scale == common.end() ? std::nullopt : scale->second, bounds[f]);
    if (!quantised) return std::unexpected(quantised.error());
    const FieldInfo& info = quantised->info;
    if (quantised->nonFinite > 0) {
      fillMissing(mesh.tetrahedra, info, quantised->missing, quantised->values);
      added_.notes.push_back("field " + info.name + ": " + std::to_string(quantised->nonFinite) +
                             " values are NaN or infinite and come back as NaN");
    }
    const std::vector<std::uint32_t>& logs = isCellField(info) ? match_.tetrahedra : match_.points;
    Item& item = out.emplace_back();
    item.isLabel = isLabel(mesh.tetrahedra, info, quantised->values);
    quantised->info.labelNames = namesOfValues(info, quantised->values);
    item.values = inLogOrder(quantised->values, info.components, logs);
    if (!isCellField(info))
      item.values = fusedValues(*history_, finest_, std::move(item.values), info.components);
    if (!quantised->missing.empty())
      item.missing = inLogOrder(quantised->missing, info.components, logs);
    item.info = info;
  }
  return out;
}

/// The errors of the items, where the log knows some of its levels. REQUIRES: the items' fields are
/// the history's last ones.
Result<LevelErrors> FieldAdder::measure(std::span<const Item> items, FieldReplay& replay) {
  MeasureOptions measure;
  if (history_->valueCodec == CodecId::kLifted) measure.replay = &replay;
  for (const ManifestLevel& level : manifest_.levels)
    measure.levels.push_back(level.error.has_value());
  if (std::ranges::count(measure.levels, 1) == 0) return LevelErrors{};
  measure.effort = options_.effort;
  measure.countsRounding = true;
  measure.threads = options_.threads;
  measure.progress = options_.progress;
  for (std::uint32_t f = 0; f < items.size(); ++f)
    if (items[f].isLabel) measure.labels.push_back(f);
  FusionHistory& h = history_->history;
  // the others may have missing values
  assert(items.size() <= h.fields.size() && h.values.size() == h.fields.size());
  const auto others = static_cast<std::ptrdiff_t>(h.fields.size() - items.size());
  std::vector<FieldInfo> fields(h.fields.begin(), h.fields.begin() + others);
  std::vector<std::vector<std::int32_t>> values;
  std::move(h.values.begin(), h.values.begin() + others, std::back_inserter(values));
  h.fields.erase(h.fields.begin(), h.fields.begin() + others);
  h.values.erase(h.values.begin(), h.values.begin() + others);
  Result<LevelErrors> errors = measureLevels(h, measure);
  if (!errors) return errors;
  h.fields.insert(h.fields.begin(), fields.begin(), fields.end());
  h.values.insert(h.values.begin(), std::move_iterator(values.begin()),
                  std::move_iterator(values.end()));
  return errors;
}

/// Measures the items and moves their fused values. The rules of all fields of the history, none of
/// those that the log has. REQUIRES: as measure.
Result<std::vector<LiftingRules>> FieldAdder::lift(std::span<Item> items) {
  FusionHistory& h = history_->history;
  FieldReplay replay;
  Result<LevelErrors> errors = measure(items, replay);
  if (!errors) return std::unexpected(errors.error());
  Result<std::vector<LiftingRules>> rules = history_->valueCodec == CodecId::kLifted
                                                ? liftMeasured(items, *errors, replay)
                                                : std::vector<LiftingRules>(h.fields.size());
  assert(!rules || rules->size() == h.fields.size());
  if (!rules) return rules;
  for (std::size_t f = 0; f < items.size(); ++f)
    for (const std::optional<LevelError>& level : *errors)
      items[f].errors.push_back(level ? level->fields[f] : FieldError());
  return rules;
}

Result<std::vector<LiftingRules>> FieldAdder::liftMeasured(std::span<const Item> items,
                                                           LevelErrors& errors,
                                                           const FieldReplay& replay) {
  FusionHistory& h = history_->history;
  std::vector<std::vector<std::uint8_t>> missing;
  for (const Item& item : items) missing.push_back(item.missing);
  LiftOptions options;
  assert(items.size() <= h.fields.size());
  options.firstField = h.fields.size() - items.size();
  options.missing = missing;
  options.unmeasuredShift = LiftingRule::kNoCorrection;
  if (!errors.empty()) options.replay = &replay;
  return liftFields(h, history_->order, errors, options);
}

/// The history gets the log's instants that the items may be predicted from. A long row of
/// predictions would make seeking slow.
Status FieldAdder::addParents(const std::vector<Item>& items, Numbers& numbers) {
  FusionHistory& h = history_->history;
  for (const Item& item : items) {
    const Instant* const parent = parentOf(item.info);
    if (parent == nullptr || depths_[parent->number] >= kAnchorsInARow ||
        std::ranges::find(numbers.all, parent->number) != numbers.all.end())
      continue;
    // an added instant that others lie behind, whose values are gone
    if (parent->number >= manifest_.fields.size() && !values_.contains(parent->number)) continue;
    std::vector<std::int32_t>& values = values_[parent->number];
    if (values.empty()) {
      auto fetched = historyValues(log_, *history_, static_cast<std::uint32_t>(parent->number));
      if (!fetched) return std::unexpected(fetched.error());
      values = std::move(*fetched);
    }
    h.fields.push_back(parent->info), h.values.push_back(values);
    numbers.all.push_back(parent->number), numbers.rows.push_back(depths_[parent->number]);
  }
  return {};
}

/// An instant of the log as if it came.
Result<FieldAdder::Item> FieldAdder::itemOf(const Instant& instant) const {
  assert(instant.number < manifest_.fields.size());
  Result<std::vector<std::int32_t>> values =
      historyValues(log_, *history_, static_cast<std::uint32_t>(instant.number));
  if (!values) return std::unexpected(values.error());
  Item out{instant.info, std::move(*values), {}, {}, true};
  out.isLabel = isKnownLabel(instant.info);
  if (!instant.info.hasMissing) return out;
  const std::size_t n = instant.info.components;
  const std::size_t finest =
      n * (isCellField(instant.info) ? history_->tetrahedra : history_->vertices);
  std::vector<std::int32_t> filled(out.values.begin(),
                                   out.values.begin() + static_cast<std::ptrdiff_t>(finest));
  for (std::int32_t& value : filled) {
    out.missing.push_back(value == kMissing);
    if (value == kMissing) value = 0;
  }
  fillMissing(finest_, instant.info, out.missing, filled);
  std::ranges::copy(filled, out.values.begin());
  if (isCellField(instant.info)) return out;
  for (const Fusion& fusion : history_->history.fusions)
    for (std::size_t c = 0; c < n; ++c)
      if (std::int32_t& value = out.values[fusion.fused * n + c]; value == kMissing)
        value = out.values[fusion.prey[0] * n + c];
  return out;
}

/// Takes instants out of the log, to code them again. Leaves them where another field rests on one.
Status FieldAdder::takeBack(std::span<const Instant> instants, std::vector<Item>& items) {
  const auto isOne = [&](std::size_t number) {
    return std::ranges::find(instants, number, &Instant::number) != instants.end();
  };
  for (const std::uint32_t f : added_.kept)
    for (const TimePrediction::Parent& parent : log_.fields()[f].prediction.all())
      if (isOne(parent.field) && !isOne(f)) return {};
  for (const Instant& instant : instants) {
    Result<Item> item = itemOf(instant);
    if (!item) return std::unexpected(item.error());
    items.push_back(std::move(*item));
  }
  std::erase_if(added_.kept, isOne);
  return {};
}

/// Adds the instants of windows that the items make full.
Status FieldAdder::takeUnfinished(std::vector<Item>& items) {
  std::map<SeriesKey, std::size_t> come;
  for (const Item& item : items) {
    const auto name = item.info.name.instant();
    if (!name) continue;
    const SeriesKey key{item.info.association, std::string(name->series)};
    SeriesState& series = series_[key];
    // at first all instants that are there are the log's own
    const bool isFirst = !std::exchange(series.isExtended, true) || come.contains(key);
    if (isFirst && !series.instants.empty()) come[key] += series.instants.back().time < name->time;
  }
  for (const auto& [key, count] : come) {
    std::vector<Instant>& all = series_[key].instants;
    assert(!all.empty());
    const std::size_t unfinished = (all.size() - 1) % kWindow;
    if (unfinished == 0 || unfinished + count < kWindow) continue;
    const std::size_t before = items.size();
    if (Status s = takeBack(std::span(all).last(unfinished), items); !s) return s;
    if (items.size() > before) all.resize(all.size() - unfinished);
  }
  return {};
}

/// The items' missing values are missing, and the items are numbered and known as instants.
void FieldAdder::complete(std::vector<Item>& items, Numbers& numbers) {
  FusionHistory& h = history_->history;
  for (Item& item : items) {
    assert(numbers.all.size() < h.values.size());
    std::vector<std::int32_t>& values = h.values[numbers.all.size()];
    if (!item.missing.empty())
      values = withMissing(h, item.info, std::move(item.missing), std::move(values));
    const std::size_t number = manifest_.fields.size() + added_.fields.size();
    numbers.all.push_back(number);
    if (item.wasThere) added_.again.push_back(added_.fields.size());
    added_.fields.push_back({manifestFieldOf(item.info), {}, std::move(item.errors), {}});
    if (item.isLabel) {
      labels_.emplace(item.info.name.withoutTime());
      added_.fields.back().labelNames = item.info.labelNames;
    }
    const auto name = item.info.name.instant();
    if (!name) continue;
    keepScale(item.info, true);
    keepInstant(item.info, name->time, number);
    values_[number] = values;
  }
  forgetValues();
}

/// Leaves the values of the last instant of each scale.
void FieldAdder::forgetValues() {
  std::set<std::size_t> last;
  for (const auto& [key, series] : series_)
    for (const Scale& scale : series.scales) {
      const auto place = std::ranges::find_if(
          series.instants.rbegin(), series.instants.rend(),
          [&](const Instant& instant) { return haveOneScale(instant.info, scale.info); });
      if (place != series.instants.rend()) last.insert(place->number);
    }
  std::erase_if(values_, [&](const auto& entry) { return !last.contains(entry.first); });
}

std::size_t FieldAdder::roomInWindow() const {
  std::size_t most = 0;
  for (const auto& [key, series] : series_) most = std::max(most, series.instants.size());
  return most == 0 ? kWindow + 1 : kWindow - (most - 1) % kWindow;
}

AddedFields FieldAdder::take() {
  added_.warnings = outlying_.warnings();
  return std::move(added_);
}

/// The blocks of the history's fields that the log does not have.
Status FieldAdder::encode(const Numbers& numbers, std::span<const LiftingRules> rules) {
  assert(numbers.rows.size() <= numbers.all.size() && rules.size() == numbers.all.size());
  const FusionHistory& h = history_->history;
  for (std::size_t i = numbers.rows.size(); i < numbers.all.size(); ++i) {
    assert(numbers.all[i] >= manifest_.fields.size());
    TimePrediction prediction = h.fields[i].prediction;
    for (std::size_t p = 0; p < prediction.count; ++p)
      prediction.parents[p].field =
          static_cast<std::uint16_t>(numbers.all[prediction.parents[p].field]);
    assert(depths_.size() == numbers.all[i]);
    depths_.push_back(depthOf(prediction, depths_));
    NewField& field = added_.fields[numbers.all[i] - manifest_.fields.size()];
    field.prediction = prediction;
    Result<std::vector<Bytes>> blocks = encodeFieldBlocks(history_->order, h.fields[i], h.values[i],
                                                          history_->valueCodec, rules[i]);
    if (!blocks) return std::unexpected(blocks.error());
    field.blocks = std::move(*blocks);
  }
  return {};
}

Status FieldAdder::code(std::vector<Item> items) {
  FusionHistory& h = history_->history;
  Numbers numbers;
  if (Status s = addParents(items, numbers); !s) return s;
  std::vector<Item> ordered;
  for (const std::size_t place : decodingOrderOf(h.fields, items))
    ordered.push_back(std::move(items[place]));
  for (Item& item : ordered)
    h.fields.push_back(item.info), h.values.push_back(std::move(item.values));
  const Result<std::size_t> predicted = predictInTime(h, {}, {}, numbers.rows);
  if (!predicted) return std::unexpected(predicted.error());
  const Result<std::vector<LiftingRules>> rules = lift(ordered);
  if (!rules) return std::unexpected(rules.error());
  complete(ordered, numbers);
  toTimeDifferences(h);
  assert(numbers.all.size() == h.fields.size());
  if (Status s = encode(numbers, *rules); !s) return s;
  h.fields.clear(), h.values.clear();
  return {};
}

Status FieldAdder::add(const TetMesh& mesh) {
  const std::size_t there = added_.kept.size() + added_.fields.size();
  if (Status s = checkFieldCount(there + mesh.fields.size()); !s) return s;
  if (Status s = matchTo(mesh); !s) return s;
  Result<std::vector<Item>> items = itemsOf(mesh);
  if (!items) return std::unexpected(items.error());
  if (Status s = takeUnfinished(*items); !s) return s;
  return code(std::move(*items));
}

Result<AddedFields> addFields(const LogFile& log, const TetMesh& mesh,
                              const AddFieldsOptions& options) {
  AddFieldsOptions halves = options;
  double from = 0;
  if (options.progress)
    halves.progress = [&](double fraction) { options.progress(from + fraction / 2); };
  Result<FieldAdder> adder = FieldAdder::make(log, halves);
  if (!adder) return std::unexpected(adder.error());
  from = 0.5;
  if (Status s = adder->add(mesh); !s) return std::unexpected(s.error());
  return adder->take();
}

}  // namespace qtet
