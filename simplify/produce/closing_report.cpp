#include "simplify/produce/closing_report.h"

#include <algorithm>
#include <bit>
#include <string>

#include "codec/refine/log_file.h"
#include "proto/manifest.h"
#include "simplify/log/kept_input.h"
#include "simplify/log/match_mesh.h"

namespace qtet {
namespace {

std::unexpected<Error> differs(const std::string& what) {
  return fail(ErrorCode::kBadValue, what +
                                        "; the log does not hold this file: build it again from "
                                        "it, and report it if it stays so");
}

Status sameOrder(const RestoredInput& restored, const LatticeMesh& placed, const TetMesh& input) {
  for (std::size_t v = 0; v < placed.points.size(); ++v)
    if (restored.lattice.points[v] != placed.points[v])
      return differs("point " + std::to_string(v) + " is another one in the log's numbering");
  for (std::size_t t = 0; t < input.tetrahedra.size(); ++t)
    if (restored.order->tetrahedra[t] != input.tetrahedra[t])
      return differs(
          "cell " + std::to_string(t) +
          " is another one in the log's numbering, or has its vertices in another order");
  for (std::size_t f = 0; f < placed.fields.size(); ++f)
    for (std::size_t i = 0; i < placed.values[f].size(); ++i)
      if (restored.lattice.values[f][i] != placed.values[f][i])
        return differs(
            "field " + placed.fields[f].name + " has another value in the log's numbering at " +
            placed.fields[f].association + " " + std::to_string(i / placed.fields[f].components));
  return {};
}

Status sameOriginalCells(const std::vector<std::uint32_t>& restored,
                         const std::optional<std::vector<std::uint32_t>>& cells) {
  if (!cells) return differs("no cell of the file was split, but the log says so");
  const auto [mine, theirs] = std::ranges::mismatch(restored, *cells);
  if (mine == restored.end()) return {};
  return differs("cell " + std::to_string(mine - restored.begin()) +
                 " comes from another cell of the file");
}

bool sameBits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace

nlohmann::ordered_json closingJson(std::span<const ClosingBlock> blocks, const Manifest& manifest) {
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  for (const ClosingBlock& c : blocks) switch (c.kind) {
      case ClosingKind::kPointOrder: out["point order"] = c.block.size; break;
      case ClosingKind::kCellOrder: out["cell order"] = c.block.size; break;
      case ClosingKind::kOriginalCells: out["original cells"] = c.block.size; break;
      case ClosingKind::kExactPositions: out["exact positions"] = c.block.size; break;
      case ClosingKind::kExactField:
        out["exact " + fieldKey(manifest, c.field)] = c.block.size;
        break;
      default: out["unknown " + std::to_string(static_cast<int>(c.kind))] = c.block.size;
    }
  return out;
}

Result<nlohmann::ordered_json> compareKept(const LogFile& log, const LatticeMesh& finest,
                                           const LatticeMesh& placed, const TetMesh& input,
                                           const std::optional<std::vector<std::uint32_t>>& cells) {
  nlohmann::ordered_json out = {
      {"order", false}, {"positions", false}, {"fields", nlohmann::ordered_json::object()}};
  if (log.closingBlocks().empty()) return out;
  const Result<RestoredInput> restored = restoreInput(log, finest);
  if (!restored) return std::unexpected(restored.error());
  if (restored->order)
    if (Status s = sameOrder(*restored, placed, input); !s) return std::unexpected(s.error());
  out["order"] = restored->order.has_value();
  if (restored->originalCells) {
    if (Status s = sameOriginalCells(*restored->originalCells, cells); !s)
      return std::unexpected(s.error());
    out["originalCells"] = true;
  }
  MeshMatch match;  // where each of the input's points and cells stands in what was restored
  if (restored->order) {
    for (VertexId v = 0; v < input.points.size(); ++v) match.points.push_back(v);
    for (CellId t = 0; t < input.tetrahedra.size(); ++t) match.tetrahedra.push_back(t);
  } else {
    Result<MeshMatch> found = matchMesh(placed, finest.points, finest.tetrahedra);
    if (!found) return std::unexpected(found.error());
    match = std::move(*found);
  }
  if (restored->exactPositions)
    for (std::size_t v = 0; v < input.points.size(); ++v)
      for (std::size_t a = 0; a < 3; ++a)
        if (!sameBits(input.points[v][a], restored->mesh.points[match.points[v]][a]))
          return differs("point " + std::to_string(v) + " has another coordinate " + "xyz"[a]);
  out["positions"] = restored->exactPositions;
  for (std::size_t f = 0; f < finest.fields.size(); ++f) {
    const FieldInfo& info = finest.fields[f];
    const auto field = std::ranges::find_if(input.fields, [&](const MeshField& m) {
      return m.name == info.name && m.association == info.association;
    });
    if (field == input.fields.end()) return differs("field " + info.name + " is not there");
    const std::vector<std::uint32_t>& at = isCellField(info) ? match.tetrahedra : match.points;
    for (std::size_t i = 0; restored->exactFields[f] && i < field->values.size(); ++i)
      if (!sameBits(field->values[i],
                    restored->mesh.fields[f]
                        .values[at[i / info.components] * info.components + i % info.components]))
        return differs("field " + info.name + " has another value at " + info.association + " " +
                       std::to_string(i / info.components));
    out["fields"][info.association + ":" + info.name] = static_cast<bool>(restored->exactFields[f]);
  }
  return out;
}

}  // namespace qtet
