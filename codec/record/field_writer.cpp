#include "codec/record/field_writer.h"

#include <algorithm>
#include <cassert>

namespace qtet {

FieldWriter::FieldWriter(const FusionHistory& history, const MirrorMesh& mirror)
    : history_(history),
      mirror_(mirror),
      pointAncestry_(!std::ranges::all_of(history.fields, isCellField)),
      values_(history.fields.size()) {
  if (std::ranges::any_of(history.fields, isCellField)) cellAncestry_.emplace();
}

void FieldWriter::base(std::span<const BaseBirth> births, std::span<Values> out) {
  assert(pointAncestry_.births().empty() && births.size() == mirror_.vertices().size());
  if (cellAncestry_) cellAncestry_->addBase(mirror_.mesh().tetrahedra);
  for (std::size_t f = 0; f < history_.fields.size(); ++f)
    if (isCellField(history_.fields[f]))
      cells(f, 0, out[f]);
    else
      basePoints(f, births, out[f]);
}

void FieldWriter::basePoints(std::size_t f, std::span<const BaseBirth> births, Values& out) {
  const std::uint32_t n = history_.fields[f].components;
  const bool hasMissing = history_.fields[f].hasMissing;
  std::vector<std::int32_t>& values = values_[f];
  for (const VertexId vertex : mirror_.vertices())
    for (const std::int32_t value : truth(f, vertex)) values.push_back(value);
  const auto at = [&](VertexId u, std::uint32_t c) { return values[std::size_t{u} * n + c]; };
  for (VertexId v = 0; v < births.size(); ++v)
    for (std::uint32_t c = 0; c < n; ++c)
      out.codeField<true>(hasMissing, predictBaseField(births[v], v, c, hasMissing, at), at(v, c));
}

void FieldWriter::beforeSplit(VertexId v, const Link& link, const Split& split) {
  const GrowingMesh& mesh = mirror_.mesh();
  assert(link.triangles().size() == mesh.star(v).size());
  pointAncestry_.add(v, mesh, link, split);
  if (cellAncestry_)
    cellAncestry_->addRestored(mesh.star(v), link, split.deleted, mesh.next().tetrahedra);
}

void FieldWriter::afterSplit(const Fusion& fusion, CellId first, std::span<Values> out) {
  assert(mirror_.vertices()[pointAncestry_.births().back().slot] == fusion.prey[0]);
  for (std::size_t f = 0; f < history_.fields.size(); ++f)
    if (isCellField(history_.fields[f]))
      cells(f, first, out[f]);
    else
      points(f, fusion, out[f]);
}

void FieldWriter::points(std::size_t f, const Fusion& fusion, Values& out) {
  const std::uint32_t n = history_.fields[f].components;
  std::vector<std::int32_t>& values = values_[f];
  values.resize(mirror_.mesh().points.size() * n);
  pointAncestry_.code<true>(
      pointAncestry_.births().back(), out, n,
      [&](VertexId v, std::uint32_t c) -> std::int32_t& { return values[std::size_t{v} * n + c]; },
      [&](std::size_t i, std::uint32_t c) { return truth(f, fusion.prey[i])[c]; },
      history_.fields[f].hasMissing);
}

void FieldWriter::cells(std::size_t f, CellId first, Values& out) const {
  const std::size_t n = history_.fields[f].components;
  for (CellId t = first; t < mirror_.tetrahedra().size(); ++t)
    for (std::size_t c = 0; c < n; ++c) {
      const auto at = [&](CellId u) { return history_.values[f][mirror_.tetrahedra()[u] * n + c]; };
      out.codeField<true>(history_.fields[f].hasMissing, cellAncestry_->predict(t, at), at(t));
    }
}

}  // namespace qtet
