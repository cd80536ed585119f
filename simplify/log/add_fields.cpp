#include "simplify/log/add_fields.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>

#include "codec/log/log_manifest.h"
#include "codec/log/manifest_field.h"
#include "codec/refine/log_file.h"
#include "simplify/clean/quantise_field.h"
#include "simplify/clean/verify.h"
#include "simplify/mesh/history_levels.h"
#include "simplify/mesh/missing_values.h"
#include "simplify/series/series.h"
#include "simplify/series/time_differences.h"

namespace qtet {
namespace {

/// The field of the mesh in the log's order.
template <class T>
std::vector<T> inLogOrder(const std::vector<T>& values, std::uint32_t components,
                          const std::vector<std::uint32_t>& logs) {
  std::vector<T> out(values.size());
  for (std::size_t i = 0; i < logs.size(); ++i)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(i * components), components,
                out.begin() + static_cast<std::ptrdiff_t>(std::size_t{logs[i]} * components));
  return out;
}

/// How many predictions a field rests on in a row, if its parents' are known.
std::size_t depthOf(const TimePrediction& prediction, const std::vector<std::size_t>& depths) {
  std::size_t out = 0;
  for (const TimePrediction::Parent& parent : prediction.all())
    out = std::max(out, 1 + depths[parent.field]);
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
  for (const Series& series : seriesOf(std::span<const FieldInfo>(all))) {
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

}  // namespace

FieldAdder::FieldAdder(const LogFile& log, AddFieldsOptions options, Manifest manifest,
                       std::unique_ptr<LogHistory> history)
    : log_(log),
      options_(std::move(options)),
      manifest_(std::move(manifest)),
      history_(std::move(history)),
      fused_(std::make_unique<FusedValues>(*history_)) {
  FusionHistory& h = history_->history;
  HistoryLevels levels(h);
  levels.moveTo(levels.finest());
  finest_.assign(h.cells.begin(), h.cells.begin() + history_->tetrahedra);
  levels.moveTo(0);
  for (std::size_t f = 0; f < manifest_.fields.size(); ++f) {
    depths_.push_back(depthOf(log_.fields()[f].prediction, depths_));
    const FieldInfo info = fieldInfoOf(manifest_.fields[f]);
    const auto name = instantName(info.name);
    const bool stays =
        !options_.kept || std::ranges::find(*options_.kept, f) != options_.kept->end();
    if (!name) continue;
    const SeriesKey key{info.association, std::string(name->series)};
    if (!stays) keepScale(key, info);
    if (!stays) continue;
    const auto at = last_.find(key);
    if (at == last_.end() || at->second.time < name->time) last_[key] = {info, name->time, f, {}};
  }
}

Result<FieldAdder> FieldAdder::make(const LogFile& log, const AddFieldsOptions& options) {
  Result<Manifest> manifest = manifestOf(log.index());
  if (!manifest) return std::unexpected(manifest.error());
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
  match_ = std::move(*match);
  matched_.points = mesh.points, matched_.tetrahedra = mesh.tetrahedra;
  return {};
}

void FieldAdder::keepScale(const SeriesKey& key, FieldInfo info) {
  // the step of a constant field means nothing
  if (!options_.scalesOfOthers || !isFloatType(info.type) || info.step == 1 ||
      info.bits >= kMaxScaleBits)
    return;
  for (double& minimum : info.minimum) minimum -= info.step * std::ldexp(1.0, info.bits);
  ++info.bits;
  scales_.try_emplace(key, std::move(info));
}

/// The scale that an instant's series has already.
const FieldInfo* FieldAdder::scaleOf(const FieldInfo& info) {
  if (const Last* const last = lastBefore(info)) return &last->info;
  const auto name = instantName(info.name);
  if (!name) return nullptr;
  const auto at = scales_.find({info.association, std::string(name->series)});
  return at == scales_.end() ? nullptr : &at->second;
}

/// The series' last instant, if the field is an instant behind it.
FieldAdder::Last* FieldAdder::lastBefore(const FieldInfo& info) {
  const auto name = instantName(info.name);
  if (!name) return nullptr;
  const auto at = last_.find({info.association, std::string(name->series)});
  return at != last_.end() && at->second.time < name->time ? &at->second : nullptr;
}

Result<std::vector<FieldAdder::Item>> FieldAdder::itemsOf(const TetMesh& mesh) {
  const std::vector<FieldExtents> extents = extentsOfAll(mesh.fields);
  std::vector<Item> out;
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    const MeshField& field = mesh.fields[f];
    FieldInfo named;
    named.name = field.name, named.association = field.association;
    const FieldInfo* const scale = scaleOf(named);
    std::optional<QuantisedField> quantised =
        scale != nullptr ? quantiseAs(*scale, field) : std::nullopt;
    if (!quantised) {
      Result<QuantisedField> own = quantiseField(field, extents[f], options_.fieldBits);
      if (!own) return std::unexpected(own.error());
      quantised = std::move(*own);
    }
    const FieldInfo& info = quantised->info;
    if (quantised->nonFinite > 0) {
      fillMissing(mesh.tetrahedra, info, quantised->missing, quantised->values);
      added_.notes.push_back("field " + info.name + ": " + std::to_string(quantised->nonFinite) +
                             " values are NaN or infinite and come back as NaN");
    }
    const std::vector<std::uint32_t>& logs = isCellField(info) ? match_.tetrahedra : match_.points;
    Item& item = out.emplace_back();
    item.values = inLogOrder(quantised->values, info.components, logs);
    if (!isCellField(info)) item.values = fused_->of(std::move(item.values), info.components);
    if (!quantised->missing.empty())
      item.missing = inLogOrder(quantised->missing, info.components, logs);
    item.info = info;
  }
  return out;
}

/// Gives each field its errors, where the log knows some of its levels. REQUIRES: the items' fields
/// are the history's last ones.
Status FieldAdder::measure(std::span<Item> items) {
  MeasureOptions measure;
  for (const ManifestLevel& level : manifest_.levels)
    measure.levels.push_back(level.error.has_value());
  if (std::ranges::count(measure.levels, 1) == 0) return {};
  measure.effort = options_.effort;
  measure.countsRounding = true;
  measure.threads = options_.threads;
  measure.progress = options_.progress;
  FusionHistory& h = history_->history;
  // the others may have missing values
  const auto others = static_cast<std::ptrdiff_t>(h.fields.size() - items.size());
  std::vector<FieldInfo> fields(h.fields.begin(), h.fields.begin() + others);
  std::vector<std::vector<std::int32_t>> values;
  std::move(h.values.begin(), h.values.begin() + others, std::back_inserter(values));
  h.fields.erase(h.fields.begin(), h.fields.begin() + others);
  h.values.erase(h.values.begin(), h.values.begin() + others);
  const Result<LevelErrors> errors = measureLevels(h, measure);
  if (!errors) return std::unexpected(errors.error());
  h.fields.insert(h.fields.begin(), fields.begin(), fields.end());
  h.values.insert(h.values.begin(), std::move_iterator(values.begin()),
                  std::move_iterator(values.end()));
  for (std::size_t f = 0; f < items.size(); ++f)
    for (const std::optional<LevelError>& level : *errors)
      items[f].errors.push_back(level ? level->fields[f] : FieldError());
  return {};
}

/// A long row of predictions would make seeking slow.
bool FieldAdder::mayBeParent(const Last& last) const {
  return depths_[last.number] < kAnchorsInARow;
}

Status FieldAdder::fetch(Last& last) {
  if (!last.values.empty()) return {};
  Result<std::vector<std::int32_t>> values =
      historyValues(log_, *history_, static_cast<std::uint32_t>(last.number));
  if (!values) return std::unexpected(values.error());
  last.values = std::move(*values);
  return {};
}

/// The history gets the log's instants that the items may be predicted from.
Status FieldAdder::addParents(const std::vector<Item>& items, Numbers& numbers) {
  FusionHistory& h = history_->history;
  for (const Item& item : items) {
    Last* const last = lastBefore(item.info);
    if (last == nullptr || !mayBeParent(*last) ||
        std::ranges::find(numbers.all, last->number) != numbers.all.end())
      continue;
    if (Status s = fetch(*last); !s) return s;
    h.fields.push_back(last->info), h.values.push_back(last->values);
    numbers.all.push_back(last->number), numbers.rows.push_back(depths_[last->number]);
  }
  return {};
}

/// The items' missing values are missing, and the items are numbered and known as last instants.
void FieldAdder::complete(std::vector<Item>& items, Numbers& numbers) {
  FusionHistory& h = history_->history;
  for (Item& item : items) {
    std::vector<std::int32_t>& values = h.values[numbers.all.size()];
    if (!item.missing.empty())
      values = withMissing(h, item.info, std::move(item.missing), std::move(values));
    numbers.all.push_back(manifest_.fields.size() + added_.fields.size());
    added_.fields.push_back({manifestFieldOf(item.info), {}, std::move(item.errors), {}});
    const auto name = instantName(item.info.name);
    if (!name) continue;
    Last& last = last_[{item.info.association, std::string(name->series)}];
    if (last.info.name.empty() || last.time < name->time)
      last = {item.info, name->time, numbers.all.back(), values};
  }
}

/// The blocks of the history's fields that the log does not have.
Status FieldAdder::encode(const Numbers& numbers) {
  const FusionHistory& h = history_->history;
  for (std::size_t i = numbers.rows.size(); i < numbers.all.size(); ++i) {
    TimePrediction prediction = h.fields[i].prediction;
    for (std::size_t p = 0; p < prediction.count; ++p)
      prediction.parents[p].field =
          static_cast<std::uint16_t>(numbers.all[prediction.parents[p].field]);
    depths_.push_back(depthOf(prediction, depths_));
    NewField& field = added_.fields[numbers.all[i] - manifest_.fields.size()];
    field.prediction = prediction;
    Result<std::vector<Bytes>> blocks = encodeFieldBlocks(*history_, h.fields[i], h.values[i]);
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
  if (Status s = measure(ordered); !s) return s;
  complete(ordered, numbers);
  toTimeDifferences(h);
  if (Status s = encode(numbers); !s) return s;
  h.fields.clear(), h.values.clear();
  return {};
}

Status FieldAdder::add(const TetMesh& mesh) {
  const std::size_t kept = options_.kept ? options_.kept->size() : manifest_.fields.size();
  if (Status s = checkFieldCount(kept + added_.fields.size() + mesh.fields.size()); !s) return s;
  if (Status s = matchTo(mesh); !s) return s;
  Result<std::vector<Item>> items = itemsOf(mesh);
  if (!items) return std::unexpected(items.error());
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
