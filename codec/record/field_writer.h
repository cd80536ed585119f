// The values of a history's fields, coded as their vertices and tetrahedra come.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/record/base_coder.h"
#include "codec/record/cell_values.h"
#include "codec/record/fusion_history.h"
#include "codec/record/mirror_mesh.h"
#include "codec/record/point_values.h"
#include "codec/record/values.h"

namespace qtet {

/// `out` is one for each field of the history.
class FieldWriter {
 public:
  /// Both must outlive it.
  FieldWriter(const FusionHistory& history, const MirrorMesh& mirror);

  /// The values of the base mesh, which the mirror holds. REQUIRES: called once and first.
  void base(std::span<const BaseBirth> births, std::span<Values> out);
  /// Notes the split of v. REQUIRES: link built and labelled, the split not yet applied.
  void beforeSplit(VertexId v, const Link& link, const Split& split);
  /// The values of what the split of `fusion` brought: its prey, numbered as the record does, and
  /// the tetrahedra from slot `first` on. REQUIRES: beforeSplit(), and the split applied.
  void afterSplit(const Fusion& fusion, CellId first, std::span<Values> out);

 private:
  void basePoints(std::size_t f, std::span<const BaseBirth> births, Values& out);
  void points(std::size_t f, const Fusion& fusion, Values& out);
  void cells(std::size_t f, CellId first, Values& out) const;
  // The history's values of the field at a vertex.
  [[nodiscard]] std::span<const std::int32_t> truth(std::size_t f, VertexId vertex) const {
    const std::size_t n = history_.fields[f].components;
    return std::span(history_.values[f]).subspan(vertex * n, n);
  }

  const FusionHistory& history_;
  const MirrorMesh& mirror_;
  PointAncestry pointAncestry_;
  std::optional<CellAncestry> cellAncestry_;       // where there is a cell field
  std::vector<std::vector<std::int32_t>> values_;  // of each point field, by slot
};

}  // namespace qtet
