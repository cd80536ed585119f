#include "codec/refine/refiner_fields.h"

#include <algorithm>
#include <cassert>

#include "codec/mesh/time_prediction.h"
#include "codec/record/lifted_values.h"
#include "codec/refine/chunk_plan.h"

namespace qtet {

RefinerFields::RefinerFields(const ChunkPlan& plan, const RecordReader& records,
                             const std::vector<BaseBirth>& base,
                             const std::vector<AddedElements>& added)
    : plan_(plan),
      records_(records),
      base_(base),
      added_(added),
      fields_(plan.index.fields.size()) {}

void RefinerFields::planHasGrown() { fields_.resize(plan_.index.fields.size()); }

// A cell stands in with its prediction, a vertex with its fused vertex's value.
void RefinerFields::inherit(std::uint32_t chunk) {
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const FieldShape& shape = plan_.index.fields[f];
    if (fields_[f].chunks == 0) continue;
    if (shape.association == Association::kPoint)
      inheritPoints(fields_[f], shape.components, added_[chunk].firstBirth);
    else
      inheritCells(fields_[f], shape, plan_.slots[chunk].tetrahedra, added_[chunk].endTetrahedron);
  }
}

void RefinerFields::inheritCells(Field& field, const FieldShape& shape, CellId first,
                                 CellId end) const {
  const std::size_t n = shape.components;
  const CellAncestry& ancestry = *records_.ancestry().cells;
  field.values.resize(records_.mesh().tetrahedra.size() * n);
  for (CellId t = first; t < end; ++t)
    for (std::size_t c = 0; c < n; ++c) {
      const auto at = [&](CellId u) { return field.values[u * n + c]; };
      field.values[t * n + c] = shape.hasMissing && ancestry.onlyMissing(t, at)
                                    ? kMissing
                                    : static_cast<std::int32_t>(ancestry.predict(t, at));
    }
}

void RefinerFields::inheritPoints(Field& field, std::uint32_t components,
                                  std::size_t firstBirth) const {
  const std::size_t n = components;
  field.values.resize(records_.mesh().points.size() * n);
  for (const Birth& b : records_.ancestry().points.births().subspan(firstBirth))
    for (std::size_t j = 0; j + 1 < b.k; ++j)
      for (std::size_t c = 0; c < n; ++c)
        field.values[(b.firstNew + j) * n + c] = field.values[b.slot * n + c];
}

Status RefinerFields::mayCome(std::uint32_t field, std::uint32_t chunk) const {
  if (field >= fields_.size())
    return refuseChunk(ErrorCode::kNotFound, chunk, "there is no such field");
  const Field& f = fields_[field];
  if (f.broken)
    return refuseChunk(ErrorCode::kBadOrder, chunk,
                       "an earlier block of this field failed; start again from chunk 0");
  if (chunk >= added_.size())
    return refuseChunk(ErrorCode::kBadOrder, chunk, "a field cannot run ahead of the mesh");
  if (chunk < f.chunks) return refuseChunk(ErrorCode::kBadOrder, chunk, "the field has it already");
  if (chunk > f.chunks)
    return refuseChunk(ErrorCode::kBadOrder, chunk,
                       "the field needs chunk " + std::to_string(f.chunks) + " first");
  for (const TimePrediction::Parent& parent : plan_.index.fields[field].prediction.all())
    if (fields_[parent.field].chunks <= chunk)
      return refuseChunk(ErrorCode::kBadOrder, chunk,
                         "field " + std::to_string(field) + " is predicted from field " +
                             std::to_string(parent.field) + ", which needs the chunk first");
  return {};
}

Status RefinerFields::apply(std::uint32_t field, std::uint32_t chunk,
                            std::span<const std::int32_t> values) {
  if (Status order = mayCome(field, chunk); !order) return order;
  assert(plan_.index.blockCodec(chunk, kFirstFieldPart + field) != CodecId::kLifted);
  Field& f = fields_[field];
  const FieldShape shape = plan_.index.fields[field];
  if (values.size() !=
      std::size_t{plan_.index.tuples(chunk, kFirstFieldPart + field)} * shape.components)
    return refuseChunk(ErrorCode::kBadValue, chunk, "wrong number of field values");
  Values coded(values);
  if (isNeededAlone(shape))
    codeNeeded(f, shape, chunk, coded);
  else if (shape.association == Association::kPoint)
    codePoints(f, shape, chunk, coded);
  else
    codeCells(f, shape, chunk, coded);
  const bool isPart = isNeededAlone(shape) || added_[chunk].extent == Extent::kPartial;
  f.broken = coded.bad() || !(coded.atEnd() || isPart);
  if (f.broken)
    return refuseChunk(ErrorCode::kBadValue, chunk, "field values out of range or left over");
  ++f.chunks;
  return {};
}

Status RefinerFields::apply(std::uint32_t field, std::uint32_t chunk, ByteView block) {
  if (Status order = mayCome(field, chunk); !order) return order;
  assert(plan_.index.blockCodec(chunk, kFirstFieldPart + field) == CodecId::kLifted);
  Field& f = fields_[field];
  const FieldShape shape = plan_.index.fields[field];
  const std::uint64_t values =
      std::uint64_t{plan_.index.tuples(chunk, kFirstFieldPart + field)} * shape.components;
  if (values > mostValuesIn(block))
    return refuseChunk(ErrorCode::kLimitExceeded, chunk,
                       "a value block promises more than its bytes can hold");
  f.broken = true;  // until the block has gone in whole
  if (Status coded = codeLifted(f, shape, chunk, block); !coded) return coded;
  f.broken = false;
  ++f.chunks;
  return {};
}

// All of it, also where few elements are needed: what a value takes depends on those round it.
Status RefinerFields::codeLifted(Field& f, const FieldShape& shape, std::uint32_t chunk,
                                 ByteView bytes) const {
  const bool isPredicted = !shape.prediction.isNone();
  std::vector<std::int32_t>& coded = isPredicted ? f.differences : f.values;
  f.values.resize(records_.mesh().points.size() * shape.components);
  coded.resize(f.values.size());
  f.sizes.resize(f.values.size());
  const AddedElements& added = added_[chunk];
  const std::size_t baseVertices = chunk == 0 ? base_.size() : 0;
  if (baseVertices == 0 && added.firstBirth == added.endBirth)
    return bytes.empty() || added.extent == Extent::kPartial
               ? Status{}
               : refuseChunk(ErrorCode::kBadValue, chunk, "a value block of no values has bytes");
  RangeDecoder decoder(bytes);
  LiftedBlock<RangeDecoder> block(decoder, {coded, f.sizes}, shape.components, shape.hasMissing);
  for (VertexId v = 0; v < baseVertices; ++v) block.base(v, base_[v]);
  for (VertexId v = 0; isPredicted && v < baseVertices; ++v) restore(f, shape, v);
  if (chunk == 0) inheritPoints(f, shape.components, 0);
  const PointAncestry& ancestry = records_.ancestry().points;
  const std::span<const std::uint32_t> starts = ancestry.levelStarts();
  auto nextLevel = std::ranges::upper_bound(starts, added.firstBirth);
  LiftingRule rule;
  for (std::size_t b = added.firstBirth; !kBaseOnly && b < added.endBirth; ++b) {
    const bool isLevel = nextLevel != starts.end() && b == *nextLevel;
    if (isLevel) ++nextLevel;
    if (isLevel || b == added.firstBirth) rule = block.rule({});
    const Birth& birth = ancestry.births()[b];
    block.record(rule, birth, ancestry.slopesAt(birth), {});
    if (!isPredicted) continue;
    restore(f, shape, birth.slot);
    for (std::size_t j = 0; j + 1 < birth.k; ++j) restore(f, shape, birth.firstNew + j);
  }
  if (decoder.overrun())
    return refuseChunk(ErrorCode::kTruncated, chunk, "a value block ends before its values do");
  const bool isWhole = decoder.atEnd() || added.extent == Extent::kPartial;
  if (block.bad() || !isWhole)
    return refuseChunk(ErrorCode::kBadValue, chunk, "field values out of range or left over");
  return {};
}

void RefinerFields::restore(Field& f, const FieldShape& shape, std::size_t element) const {
  for (std::size_t i = element * shape.components; i < (element + 1) * shape.components; ++i) {
    if (f.differences[i] == kMissing) {
      f.values[i] = kMissing;
      continue;
    }
    f.values[i] = restoreInTime(
        shape.prediction, f.differences[i],
        [&](std::uint16_t parent) { return fields_[parent].values[i]; }, kMissing);
  }
}

void RefinerFields::codePoints(Field& f, const FieldShape& shape, std::uint32_t chunk,
                               Values& residuals) const {
  const bool isPredicted = !shape.prediction.isNone();
  std::vector<std::int32_t>& coded = isPredicted ? f.differences : f.values;
  const std::size_t n = shape.components;
  f.values.resize(records_.mesh().points.size() * n);
  coded.resize(f.values.size());
  if (chunk == 0) codeBase(coded, shape, residuals);
  const PointAncestry& ancestry = records_.ancestry().points;
  const AddedElements& b = added_[chunk];
  const std::size_t baseVertices = chunk == 0 ? base_.size() : 0;
  for (VertexId v = 0; isPredicted && v < baseVertices; ++v) restore(f, shape, v);
  if (chunk == 0) inheritPoints(f, shape.components, 0);
  for (const Birth& birth : ancestry.births().subspan(b.firstBirth, b.endBirth - b.firstBirth)) {
    codeRecord(coded, shape, birth, residuals);
    if (!isPredicted) continue;
    restore(f, shape, birth.slot);
    for (std::size_t j = 0; j + 1 < birth.k; ++j) restore(f, shape, birth.firstNew + j);
  }
}

void RefinerFields::codeRecord(std::vector<std::int32_t>& coded, const FieldShape& shape,
                               const Birth& birth, Values& residuals) const {
  const std::size_t n = shape.components;
  records_.ancestry().points.code<false>(
      birth, residuals, shape.components,
      [&](VertexId v, std::uint32_t c) -> std::int32_t& { return coded[v * n + c]; },
      [](std::size_t, std::uint32_t) { return 0; }, shape.hasMissing);
}

void RefinerFields::codeCell(std::vector<std::int32_t>& coded, const FieldShape& shape, CellId cell,
                             Values& residuals) const {
  const std::size_t n = shape.components;
  for (std::size_t c = 0; c < n; ++c)
    coded[cell * n + c] = residuals.codeField<false>(
        shape.hasMissing,
        records_.ancestry().cells->predict(cell, [&](CellId u) { return coded[u * n + c]; }), 0);
}

void RefinerFields::onlyAt(Association association, std::span<const std::uint32_t> elements) {
  const bool ofPoints = association == Association::kPoint;
  const std::vector<bool> isNeeded = ofPoints ? neededRecords(elements) : neededCells(elements);
  Needed needed{association, {elements.begin(), elements.end()}, {}};
  for (std::uint32_t chunk = 0; chunk < added_.size(); ++chunk) {
    const AddedElements& added = added_[chunk];
    const std::size_t first = ofPoints ? added.firstBirth : plan_.slots[chunk].tetrahedra;
    const std::size_t end = ofPoints ? added.endBirth : added.endTetrahedron;
    std::size_t place = ofPoints && chunk == 0 ? base_.size() : 0;
    std::vector<Coded>& coded = needed.chunks.emplace_back();
    for (std::size_t i = first; i < end; ++i) {
      if (isNeeded[i])
        coded.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(place)});
      place += ofPoints ? records_.ancestry().points.births()[i].k : 1;
    }
  }
  needed_ = std::move(needed);
}

// From the last record to the first: `before` are the vertices whose values before it count.
std::vector<bool> RefinerFields::neededRecords(std::span<const std::uint32_t> vertices) const {
  const PointAncestry& ancestry = records_.ancestry().points;
  std::vector<bool> out(ancestry.births().size()), before(records_.mesh().points.size());
  for (const VertexId v : vertices) before[v] = true;
  for (std::size_t b = out.size(); b-- > 0;) {
    const Birth& birth = ancestry.births()[b];
    out[b] = before[birth.slot];
    for (VertexId v = birth.firstNew; v + 1 < birth.firstNew + birth.k; ++v)
      if (before[v]) out[b] = true, before[v] = false;
    if (!out[b]) continue;
    before[birth.slot] = true;
    for (const Slope& slope : ancestry.slopesAt(birth))
      for (std::size_t i = 0; i < slope.vertex.size(); ++i)
        if (slope.weight[i] != 0) before[slope.vertex[i]] = true;
  }
  return out;
}

std::vector<bool> RefinerFields::neededCells(std::span<const std::uint32_t> cells) const {
  std::vector<bool> out(records_.mesh().tetrahedra.size());
  for (const CellId t : cells) out[t] = true;
  for (CellId t = static_cast<CellId>(out.size()); t-- > 0;)
    if (out[t])
      for (const CellId parent : records_.ancestry().cells->parents(t)) out[parent] = true;
  return out;
}

void RefinerFields::codeNeeded(Field& f, const FieldShape& shape, std::uint32_t chunk,
                               Values& residuals) const {
  const bool ofPoints = shape.association == Association::kPoint;
  const bool isPredicted = !shape.prediction.isNone();
  std::vector<std::int32_t>& coded = isPredicted ? f.differences : f.values;
  const std::size_t elements =
      ofPoints ? records_.mesh().points.size() : records_.mesh().tetrahedra.size();
  f.values.resize(elements * shape.components);
  coded.resize(f.values.size());
  if (ofPoints && chunk == 0) codeBase(coded, shape, residuals);
  for (const Coded& next : needed_->chunks[chunk]) {
    residuals.seek(std::size_t{next.place} * shape.components);
    if (ofPoints)
      codeRecord(coded, shape, records_.ancestry().points.births()[next.number], residuals);
    else
      codeCell(coded, shape, next.number, residuals);
  }
  if (isPredicted)
    for (const std::uint32_t element : needed_->elements) restore(f, shape, element);
}

void RefinerFields::codeBase(std::vector<std::int32_t>& coded, const FieldShape& shape,
                             Values& residuals) const {
  const std::size_t n = shape.components;
  const auto at = [&](VertexId u, std::uint32_t c) { return coded[u * n + c]; };
  for (VertexId v = 0; v < base_.size(); ++v)
    for (std::uint32_t c = 0; c < n; ++c)
      coded[v * n + c] = residuals.codeField<false>(
          shape.hasMissing, predictBaseField(base_[v], v, c, shape.hasMissing, at), 0);
}

void RefinerFields::codeCells(Field& f, const FieldShape& shape, std::uint32_t chunk,
                              Values& residuals) const {
  const bool isPredicted = !shape.prediction.isNone();
  std::vector<std::int32_t>& coded = isPredicted ? f.differences : f.values;
  const std::size_t n = shape.components;
  f.values.resize(records_.mesh().tetrahedra.size() * n);
  coded.resize(f.values.size());
  for (CellId t = plan_.slots[chunk].tetrahedra; t < added_[chunk].endTetrahedron; ++t) {
    codeCell(coded, shape, t, residuals);
    if (isPredicted) restore(f, shape, t);
  }
  if (chunk == 0)
    inheritCells(f, shape, plan_.slots[1].tetrahedra,
                 static_cast<CellId>(records_.mesh().tetrahedra.size()));
}

}  // namespace qtet
