#include "simplify/log/kept_input.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <span>
#include <utility>

#include "codec/log/exact_values.h"
#include "codec/mesh/boundary.h"
#include "codec/mesh/original_cells.h"
#include "codec/mesh/time_prediction.h"
#include "codec/refine/log_file.h"
#include "simplify/split/split_cells.h"

namespace qtet {
namespace {

Approximation positionsOf(const Lattice& lattice, std::span<const std::int32_t> integers,
                          std::string type) {
  return {
      integers, 3, {lattice.origin.begin(), lattice.origin.end()}, lattice.step, std::move(type)};
}

Approximation fieldOf(const FieldInfo& info, std::span<const std::int32_t> integers) {
  return {integers, info.components, info.minimum, info.step, info.type};
}

std::vector<std::int32_t> flat(std::span<const LatticePoint> points) {
  std::vector<std::int32_t> out;
  out.reserve(points.size() * 3);
  for (const LatticePoint& p : points) out.insert(out.end(), p.begin(), p.end());
  return out;
}

/// An integer field that its own integers restore: step 1, values below 2^28.
bool losesNothing(const FieldInfo& field) { return !isFloatType(field.type) && field.step == 1; }

std::vector<std::uint32_t> inverse(std::span<const std::uint32_t> permutation) {
  std::vector<std::uint32_t> out(permutation.size());
  for (std::uint32_t i = 0; i < permutation.size(); ++i) out[permutation[i]] = i;
  return out;
}

/// Tuple i of the result is tuple `from[i]`.
template <class T>
std::vector<T> gathered(const std::vector<T>& values, std::size_t components,
                        std::span<const std::uint32_t> from) {
  std::vector<T> out;
  out.reserve(values.size());
  for (const std::uint32_t i : from)
    for (std::size_t c = 0; c < components; ++c) out.push_back(values[i * components + c]);
  return out;
}

/// The values of the last level's elements, which a decoder has, field by field.
class FinestValues {
 public:
  FinestValues(const FusionHistory& history, const FinestMesh& finest)
      : history_(history), finest_(finest) {}

  /// The next field's.
  const std::vector<std::int32_t>& next() {
    const std::size_t f = values_.size();
    assert(f < history_.fields.size());
    const FieldInfo& info = history_.fields[f];
    std::vector<std::int32_t> values =
        gathered(history_.values[f], info.components, historyElements(info));
    for (std::size_t i = 0; !info.prediction.isNone() && i < values.size(); ++i)
      if (values[i] != kMissing)
        values[i] = restoreInTime(
            info.prediction, values[i], [&](std::uint16_t parent) { return values_[parent][i]; },
            kMissing);
    return values_.emplace_back(std::move(values));
  }
  [[nodiscard]] std::span<const std::uint32_t> historyElements(const FieldInfo& info) const {
    return isCellField(info) ? finest_.historyCells : finest_.historyVertices;
  }

 private:
  const FusionHistory& history_;
  const FinestMesh& finest_;
  std::vector<std::vector<std::int32_t>> values_;
};

Status giveOrder(const FinestMesh& finest, const KeptInput& input, const ClosingSink& give) {
  assert(finest.historyVertices.size() == input.mesh.points.size());
  assert(finest.historyCells.size() == input.mesh.tetrahedra.size());
  const DecodedMesh decoded{finest.points, finest.tetrahedra};
  const InputOrder order{inverse(finest.historyVertices), inverse(finest.historyCells),
                         input.mesh.tetrahedra};
  if (Status s = give(ClosingKind::kPointOrder, 0, encodePointOrder(decoded, order.points)); !s)
    return s;
  if (Status s = give(ClosingKind::kCellOrder, 0, encodeCellOrder(decoded, order)); !s) return s;
  if (!input.originalCells) return {};
  return give(ClosingKind::kOriginalCells, 0, encodeOriginalCells(*input.originalCells));
}

Status giveExact(const FusionHistory& history, const FinestMesh& finest, const TetMesh& input,
                 const std::stop_token& stop, const ClosingSink& give) {
  assert(input.fields.size() == history.fields.size());
  std::vector<double> positions;
  for (const VertexId v : finest.historyVertices)
    positions.insert(positions.end(), input.points[v].begin(), input.points[v].end());
  const std::vector<std::int32_t> integers = flat(finest.points);
  const bool wide = input.pointType != "float32";
  Bytes block{static_cast<std::uint8_t>(wide)};
  const Bytes stream =
      encodeExact(positionsOf(history.lattice, integers, wide ? "float64" : "float32"), positions);
  block.insert(block.end(), stream.begin(), stream.end());
  if (Status s = give(ClosingKind::kExactPositions, 0, block); !s) return s;
  FinestValues values(history, finest);
  for (std::uint32_t f = 0; f < history.fields.size(); ++f) {
    if (stop.stop_requested()) return cancelled();
    const FieldInfo& info = history.fields[f];
    const std::vector<std::int32_t>& known = values.next();
    if (losesNothing(info)) continue;
    const std::vector<double> exact =
        gathered(input.fields[f].values, info.components, values.historyElements(info));
    if (Status s = give(ClosingKind::kExactField, f, encodeExact(fieldOf(info, known), exact)); !s)
      return s;
  }
  return {};
}

/// Without the input's order it means nothing.
Status restoreOriginalCells(const LogFile& log, RestoredInput& out) {
  if (!out.order || !log.hasClosing(ClosingKind::kOriginalCells)) return {};
  const Result<ByteView> bytes = log.closing(ClosingKind::kOriginalCells);
  if (!bytes) return std::unexpected(bytes.error());
  Result<std::vector<std::uint32_t>> ids = decodeOriginalCells(*bytes, out.cells.size());
  if (!ids) return std::unexpected(ids.error());
  FieldInfo info;
  info.name = kOriginalCellField, info.type = "int32", info.association = "cell";
  info.minimum = {0};
  out.lattice.fields.push_back(info);
  out.lattice.values.emplace_back(ids->begin(), ids->end());
  out.mesh.fields.push_back(
      {info.name, 1, info.type, std::vector<double>(ids->begin(), ids->end()), info.association});
  out.originalCells = std::move(*ids);
  return {};
}

}  // namespace

std::optional<std::vector<std::uint32_t>> takeOriginalCells(TetMesh& mesh) {
  const auto field = std::ranges::find_if(mesh.fields, [](const MeshField& f) {
    return isCellField(f) && f.name == kOriginalCellField;
  });
  if (field == mesh.fields.end() || field->type != "int32" || field->components != 1 ||
      std::ranges::any_of(field->values, [](double value) { return value < 0; }))
    return std::nullopt;
  assert(field->values.size() == mesh.tetrahedra.size());
  std::vector<std::uint32_t> out(field->values.begin(), field->values.end());
  mesh.fields.erase(field);
  return out;
}

TetMesh asRead(const TetMesh& cleaned, const std::vector<Tetrahedron>& before,
               const CleanReport& report) {
  TetMesh out = cleaned;
  if (report.repeatedVertexCells.count + report.duplicateCells.count + report.unusedPoints.count ==
      0)
    out.tetrahedra = before;
  return out;
}

Status giveInput(const FusionHistory& history, const FinestMesh& finest, const KeptInput& input,
                 const std::stop_token& stop, const ClosingSink& give) {
  if (stop.stop_requested()) return cancelled();
  if (input.options.keepsOrder())
    if (Status s = giveOrder(finest, input, give); !s) return s;
  return input.options.exact ? giveExact(history, finest, input.mesh, stop, give) : Status{};
}

Result<RestoredInput> restoreInput(const LogFile& log, const LatticeMesh& finest) {
  RestoredInput out;
  out.points.resize(finest.points.size());
  std::iota(out.points.begin(), out.points.end(), 0u);
  out.cells.resize(finest.tetrahedra.size());
  std::iota(out.cells.begin(), out.cells.end(), 0u);
  const DecodedMesh decoded{finest.points, finest.tetrahedra};
  if (log.hasClosing(ClosingKind::kPointOrder) && log.hasClosing(ClosingKind::kCellOrder)) {
    const Result<ByteView> pointBytes = log.closing(ClosingKind::kPointOrder),
                           cellBytes = log.closing(ClosingKind::kCellOrder);
    if (!pointBytes) return std::unexpected(pointBytes.error());
    if (!cellBytes) return std::unexpected(cellBytes.error());
    Result<std::vector<VertexId>> points = decodePointOrder(decoded, *pointBytes);
    if (!points) return std::unexpected(points.error());
    out.order.emplace().points = std::move(*points);
    if (Status s = decodeCellOrder(decoded, *cellBytes, *out.order); !s)
      return std::unexpected(s.error());
    out.points = out.order->points;
    out.cells = out.order->cells;
  }
  out.lattice = finest;
  for (std::size_t i = 0; i < out.points.size(); ++i)
    out.lattice.points[i] = finest.points[out.points[i]];
  if (out.order) {
    out.lattice.tetrahedra = out.order->tetrahedra;
    out.lattice.boundary = boundaryOf(out.lattice.tetrahedra);
  }
  out.mesh.tetrahedra = out.lattice.tetrahedra;

  std::vector<double> positions;
  if (log.hasClosing(ClosingKind::kExactPositions)) {
    const Result<ByteView> bytes = log.closing(ClosingKind::kExactPositions);
    if (!bytes) return std::unexpected(bytes.error());
    if (bytes->empty() || (*bytes)[0] > 1)
      return fail(ErrorCode::kBadValue, "exact positions of an unknown type; use a newer qtet");
    out.mesh.pointType = (*bytes)[0] == 1 ? "float64" : "float32";
    const std::vector<std::int32_t> integers = flat(finest.points);
    Result<std::vector<double>> exact =
        decodeExact(positionsOf(finest.lattice, integers, out.mesh.pointType), bytes->subspan(1));
    if (!exact) return std::unexpected(exact.error());
    positions = std::move(*exact);
    out.exactPositions = true;
  }
  for (std::size_t i = 0; i < out.points.size(); ++i) {
    const std::size_t slot = out.points[i];
    out.mesh.points.push_back(
        out.exactPositions
            ? Position{positions[3 * slot], positions[3 * slot + 1], positions[3 * slot + 2]}
            : finest.lattice.position(finest.points[slot]));
  }
  for (std::uint32_t f = 0; f < finest.fields.size(); ++f) {
    const FieldInfo& info = finest.fields[f];
    const std::vector<std::uint32_t>& from = isCellField(info) ? out.cells : out.points;
    std::vector<double> values;
    out.exactFields.push_back(losesNothing(info));
    if (log.hasClosing(ClosingKind::kExactField, f)) {
      const Result<ByteView> bytes = log.closing(ClosingKind::kExactField, f);
      if (!bytes) return std::unexpected(bytes.error());
      Result<std::vector<double>> exact = decodeExact(fieldOf(info, finest.values[f]), *bytes);
      if (!exact) return std::unexpected(exact.error());
      values = std::move(*exact);
      out.exactFields.back() = true;
    } else {
      for (std::size_t i = 0; i < finest.values[f].size(); ++i)
        values.push_back(info.value(i % info.components, finest.values[f][i]));
    }
    out.lattice.values[f] = gathered(finest.values[f], info.components, from);
    out.mesh.fields.push_back({info.name, info.components, info.type,
                               gathered(values, info.components, from), info.association,
                               info.labelNames});
  }
  if (Status s = restoreOriginalCells(log, out); !s) return std::unexpected(s.error());
  return out;
}

}  // namespace qtet
