#include "simplify/read/unused_points.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

namespace qtet {
namespace {

bool liesNowhere(const Position& p) {
  return !(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]));
}

/// Calls visit(v) for every vertex that the cell names, whatever damage a polyhedron's stream has.
template <class Visit>
void eachVertex(std::uint8_t type, std::span<const VertexId> ids, const Visit& visit) {
  if (type != kPolyhedronCell) {
    std::ranges::for_each(ids, visit);
    return;
  }
  for (std::size_t at = 1; at < ids.size(); at += ids[at] + std::size_t{1})
    std::ranges::for_each(ids.subspan(at + 1, std::min<std::size_t>(ids[at], ids.size() - at - 1)),
                          visit);
}

bool usesOneOf(const CellMesh& mesh, const std::vector<bool>& points) {
  bool found = false;
  for (std::size_t i = 0; i < mesh.cells() && !found; ++i)
    eachVertex(mesh.types[i], mesh.cell(i),
               [&](VertexId v) { found = found || (v < points.size() && points[v]); });
  return found;
}

/// Leaves the tuples whose point stays.
template <class T>
void keep(std::vector<T>& values, std::size_t components, const std::vector<bool>& goes) {
  assert(values.size() == goes.size() * components);
  std::size_t to = 0;
  for (std::size_t i = 0; i < goes.size(); ++i)
    for (std::size_t c = 0; c < components && !goes[i]; ++c)
      values[to++] = values[i * components + c];
  values.resize(to);
}

void drop(CellMesh& mesh, const std::vector<bool>& goes) {
  std::vector<VertexId> names(goes.size());
  VertexId next = 0;
  for (std::size_t i = 0; i < goes.size(); ++i) names[i] = goes[i] ? kGhost : next++;
  keep(mesh.points, 1, goes);
  if (!mesh.pointIds.empty()) keep(mesh.pointIds, 1, goes);
  for (MeshField& field : mesh.fields)
    if (!isCellField(field)) keep(field.values, field.components, goes);
  mesh.renamePoints(names);
}

/// Whether renamePoints may be called: counts are damaged elsewhere, and refused later.
bool isSound(const CellMesh& mesh) {
  const std::size_t points = mesh.points.size();
  if (points >= kGhost) return false;
  bool sound = true;
  for (std::size_t i = 0; i < mesh.cells() && sound; ++i)
    eachVertex(mesh.types[i], mesh.cell(i),
               [&](VertexId v) { sound = sound && (v < points || v == kGhost); });
  return sound && std::ranges::all_of(mesh.fields, [&](const MeshField& field) {
           return isCellField(field) || field.values.size() == points * field.components;
         });
}

}  // namespace

void dropUnusedPoints(CellMesh& mesh, std::vector<std::string>& notes) {
  const auto count = std::ranges::count_if(mesh.points, liesNowhere);
  if (count == 0 || !isSound(mesh)) return;
  std::vector<bool> goes(mesh.points.size());
  for (std::size_t i = 0; i < goes.size(); ++i) goes[i] = liesNowhere(mesh.points[i]);
  if (usesOneOf(mesh, goes)) return;
  drop(mesh, goes);
  notes.push_back(std::to_string(count) +
                  " points that no cell uses have a coordinate that is NaN or infinite, and were "
                  "dropped");
}

}  // namespace qtet
