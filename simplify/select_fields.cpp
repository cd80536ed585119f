#include "simplify/select_fields.h"

#include <algorithm>

#include "proto/limits.h"

namespace qtet {
namespace {

bool isCalled(const std::string& asked, const std::string& association, const std::string& name) {
  return asked == name || asked == association + ":" + name;
}

/// Whether `text` is UTF-8 as far as its leading and continuing bytes go.
bool isUtf8(const std::string& text) {
  int pending = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool continues = (byte & 0xC0) == 0x80;
    if (continues != (pending > 0) || byte >= 0xF8) return false;
    if (continues)
      --pending;
    else if (byte >= 0xC0)
      pending = byte >= 0xF0 ? 3 : byte >= 0xE0 ? 2 : 1;
  }
  return pending == 0;
}

std::string namesOf(const std::vector<MeshField>& fields, const std::vector<std::string>& others) {
  std::string out;
  for (const MeshField& field : fields) out += (out.empty() ? "" : ", ") + field.name;
  for (const std::string& name : others) out += (out.empty() ? "" : ", ") + name;
  return out.empty() ? "none" : out;
}

bool isWithin(const Threshold& threshold, const MeshField& field, std::size_t tuple) {
  const double value = field.values[tuple * field.components];
  return value >= threshold.low && value <= threshold.high;
}

/// A polyhedron's stream names counts among its vertices; everything else vertices alone.
bool allWithin(const Threshold& threshold, const MeshField& field, const CellMesh& mesh, std::size_t cell) {
  if (isCellField(field)) return isWithin(threshold, field, cell);
  const std::span<const VertexId> ids = mesh.cell(cell);
  const auto within = [&](VertexId v) { return isWithin(threshold, field, v); };
  if (mesh.types[cell] != kPolyhedronCell) return std::ranges::all_of(ids, within);
  for (std::size_t at = 1; at < ids.size(); at += ids[at] + 1) {
    if (!std::ranges::all_of(ids.subspan(at + 1, ids[at]), within)) return false;
  }
  return true;
}

}  // namespace

bool isMeant(const FieldNames& names, const std::string& association, const std::string& name) {
  return !names || std::ranges::any_of(*names, [&](const std::string& asked) { return isCalled(asked, association, name); });
}

Status selectFields(const FieldNames& names, const std::filesystem::path& path, const std::vector<std::string>& otherFields, std::vector<MeshField>& fields) {
  if (names) {
    std::vector<std::size_t> order;
    for (const std::string& asked : *names) {
      bool found = false;
      for (std::size_t f = 0; f < fields.size(); ++f) {
        if (!isCalled(asked, fields[f].association, fields[f].name)) continue;
        found = true;
        if (std::ranges::find(order, f) == order.end()) order.push_back(f);
      }
      if (!found) return fail(ErrorCode::kNotFound, path.string() + " has no field '" + asked + "'; it has: " + namesOf(fields, otherFields));
    }
    std::vector<MeshField> chosen;
    for (const std::size_t f : order) chosen.push_back(std::move(fields[f]));
    fields = std::move(chosen);
  }
  if (fields.size() <= kMaxFields) return {};
  return fail(ErrorCode::kLimitExceeded, path.string() + ": " + std::to_string(fields.size()) + " fields; choose at most " + std::to_string(kMaxFields) +
                                             " with --fields");
}

Status applyThreshold(const Threshold& threshold, const std::filesystem::path& path, CellMesh& mesh) {
  const auto field = std::ranges::find_if(mesh.fields, [&](const MeshField& f) { return isCalled(threshold.field, f.association, f.name); });
  if (field == mesh.fields.end()) {
    return fail(ErrorCode::kNotFound, path.string() + " has no field '" + threshold.field + "' for --threshold; it has: " + namesOf(mesh.fields, mesh.otherFields));
  }
  CellMesh out;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < mesh.cells(); ++i) {
    if (!allWithin(threshold, *field, mesh, i)) continue;
    out.addCell(mesh.types[i], mesh.cell(i));
    out.cellIds.push_back(mesh.cellId(i));
    kept.push_back(i);
  }
  if (kept.empty()) return fail(ErrorCode::kBadInput, path.string() + ": no cell lies within --threshold " + threshold.field + "; widen it");
  for (MeshField& other : mesh.fields) {
    if (!isCellField(other)) continue;
    for (std::size_t i = 0; i < kept.size(); ++i)
      std::copy_n(other.values.data() + kept[i] * other.components, other.components, other.values.data() + i * other.components);
    other.values.resize(kept.size() * other.components);
  }
  mesh.types = std::move(out.types);
  mesh.begins = std::move(out.begins);
  mesh.vertices = std::move(out.vertices);
  mesh.cellIds = std::move(out.cellIds);
  return {};
}

bool isStorableName(const std::string& name) { return !name.empty() && name.size() <= kMaxNameBytes && isUtf8(name); }

void nameFields(std::vector<MeshField>& fields, std::vector<std::string>& notes) {
  for (std::size_t f = 0; f < fields.size(); ++f) {
    MeshField& field = fields[f];
    const auto isTaken = [&] {
      return std::any_of(fields.begin(), fields.begin() + static_cast<std::ptrdiff_t>(f),
                         [&](const MeshField& other) { return other.name == field.name && other.association == field.association; });
    };
    const bool storable = isStorableName(field.name);
    if (storable && !isTaken()) continue;
    constexpr std::size_t kLongestEnding = 8;
    const std::string before = field.name;
    const std::string stem = storable && before.size() + kLongestEnding <= kMaxNameBytes ? before : "unnamed-" + std::to_string(f);
    field.name = stem;
    for (int again = 2; isTaken(); ++again) field.name = stem + "-" + std::to_string(again);
    notes.push_back(field.association + " field number " + std::to_string(f) + " is called " + field.name + ": " +
                    (storable ? "an earlier one has its name, " + before : "it has no name of at most " + std::to_string(kMaxNameBytes) + " bytes of UTF-8"));
  }
}

}  // namespace qtet
