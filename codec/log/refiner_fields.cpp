// A refiner's fields: blocks that follow the chunks of the mesh, at once or later.
#include "codec/log/refiner_state.h"

namespace qtet {

// What chunk `chunk` brought carries a stand-in until the field's own block arrives: a cell its
// prediction, a vertex its fused vertex's value.
void Refiner::State::inherit(Field& field, const FieldShape& shape, std::uint32_t chunk) const {
  if (shape.association == Association::kPoint)
    inheritPoints(field, shape.components, brought[chunk].firstBirth);
  else
    inheritCells(field, shape, slots[chunk].tetrahedra, brought[chunk].end.tetrahedra);
}

void Refiner::State::inheritCells(Field& field, const FieldShape& shape, CellId first,
                                  CellId end) const {
  const std::size_t n = shape.components;
  field.values.resize(mesh.tetrahedra.size() * n);
  for (CellId t = first; t < end; ++t)
    for (std::size_t c = 0; c < n; ++c) {
      const auto at = [&](CellId u) { return field.values[u * n + c]; };
      field.values[t * n + c] = shape.hasMissing && ancestry.onlyMissing(t, at)
                                    ? kMissing
                                    : static_cast<std::int32_t>(ancestry.predict(t, at));
    }
}

void Refiner::State::inheritPoints(Field& field, std::uint32_t components,
                                   std::size_t firstBirth) const {
  const std::size_t n = components;
  field.values.resize(mesh.points.size() * n);
  for (const Birth& b : births.births().subspan(firstBirth))
    for (std::size_t j = 0; j + 1 < b.k; ++j)
      for (std::size_t c = 0; c < n; ++c)
        field.values[(b.firstNew + j) * n + c] = field.values[b.slot * n + c];
}

Status Refiner::applyField(std::uint32_t field, std::uint32_t chunk,
                           std::span<const std::int32_t> values) {
  State& s = *state_;
  if (field >= s.fields.size())
    return refuseChunk(ErrorCode::kNotFound, chunk, "there is no such field");
  State::Field& f = s.fields[field];
  if (f.broken)
    return refuseChunk(ErrorCode::kBadOrder, chunk,
                       "an earlier block of this field failed; start again from chunk 0");
  if (chunk >= s.brought.size() || !s.brought[chunk].applied)
    return refuseChunk(ErrorCode::kBadOrder, chunk, "a field cannot run ahead of the mesh");
  if (f.applied[chunk]) return refuseChunk(ErrorCode::kBadOrder, chunk, "the field has it already");
  if (chunk > 0 && !f.applied[s.dependencyOf(chunk)])
    return refuseChunk(ErrorCode::kBadOrder, chunk,
                       "the field needs chunk " + std::to_string(s.dependencyOf(chunk)) + " first");
  const FieldShape shape = s.index.fields[field];
  if (values.size() !=
      std::size_t{s.index.tuples(chunk, kFirstFieldPart + field)} * shape.components)
    return refuseChunk(ErrorCode::kBadValue, chunk, "wrong number of field values");
  Values coded(values);
  if (shape.association == Association::kPoint)
    s.codePoints(f, shape, chunk, coded);
  else
    s.codeCells(f, shape, chunk, coded);
  f.broken = coded.bad() || !(coded.atEnd() || s.brought[chunk].cut);
  if (f.broken)
    return refuseChunk(ErrorCode::kBadValue, chunk, "field values out of range or left over");
  f.applied[chunk] = true;
  ++f.chunks;
  return {};
}

void Refiner::State::codePoints(Field& f, const FieldShape& shape, std::uint32_t chunk,
                                Values& residuals) const {
  const std::uint32_t n = shape.components;
  if (chunk == 0) {
    f.values.assign(mesh.points.size() * n, 0);
    const auto at = [&](VertexId u, std::uint32_t c) { return f.values[std::size_t{u} * n + c]; };
    for (std::uint32_t v = 0; v < baseBirths.size(); ++v)
      for (std::uint32_t c = 0; c < n; ++c)
        f.values[std::size_t{v} * n + c] = residuals.codeField<false>(
            shape.hasMissing, predictBaseField(baseBirths[v], v, c, shape.hasMissing, at), 0);
    inheritPoints(f, n, 0);
  }
  const auto at = [&](VertexId v, std::uint32_t c) -> std::int32_t& {
    return f.values[std::size_t{v} * n + c];
  };
  const Brought& b = brought[chunk];
  for (const Birth& birth : births.births().subspan(b.firstBirth, b.endBirth - b.firstBirth))
    births.code<false>(
        birth, residuals, n, at, [](std::size_t, std::uint32_t) { return 0; }, shape.hasMissing);
}

void Refiner::State::codeCells(Field& f, const FieldShape& shape, std::uint32_t chunk,
                               Values& residuals) const {
  const std::size_t n = shape.components;
  f.values.resize(mesh.tetrahedra.size() * n);
  for (CellId t = slots[chunk].tetrahedra; t < brought[chunk].end.tetrahedra; ++t)
    for (std::size_t c = 0; c < n; ++c)
      f.values[t * n + c] = residuals.codeField<false>(
          shape.hasMissing, ancestry.predict(t, [&](CellId u) { return f.values[u * n + c]; }), 0);
  if (chunk == 0)
    inheritCells(f, shape, slots[1].tetrahedra, static_cast<CellId>(mesh.tetrahedra.size()));
}

}  // namespace qtet
