#include "simplify/cost/label_fields.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "codec/mesh/boundary.h"
#include "codec/mesh/face_groups.h"
#include "proto/field_name.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {
namespace {

// As VTK, ParaView, Exodus, Gmsh, MED, MFEM, OpenFOAM's converters and finite element programs name
// them, in lower case.
constexpr std::array<std::string_view, 18> kLabelNames{
    "materialids",     "materialid", "material",      "mat",       "blockids", "blockid",
    "elementblockids", "objectid",   "physicalids",   "regionids", "regionid", "region",
    "gmsh:physical",   "cell_tags",  "cellentityids", "attribute", "zoneid",   "partid"};
// Which process had a cell is nothing that the mesh should keep.
constexpr std::array<std::string_view, 8> kProcessNames{
    "procid", "processid", "vtkprocessid", "processorid",
    "rank",   "mpirank",   "partition",    "celldecomposition"};

bool isAmong(std::span<const std::string_view> names, const FieldName& name) {
  std::string lower;
  for (const char c : name.withoutTime())
    lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::ranges::find(names, lower) != names.end();
}

/// Calls visit(first, second) with the sides of each face inside, the lower cell first.
template <class Visit>
void forEachFaceInside(const LatticeMesh& mesh, const Visit& visit) {
  FaceGroups(mesh.tetrahedra).forEach([&](std::span<const FaceSide> sides) {
    if (sides.size() == 2) visit(sides[0], sides[1]);
  });
}

/// All instants of a series are labels if one is, or none if some is no integer.
std::vector<std::size_t> wholeSeries(const LatticeMesh& mesh, std::vector<std::size_t> labels) {
  std::map<std::string_view, bool> series;  // whether all can be
  for (const std::size_t f : labels)
    if (const auto name = mesh.fields[f].name.instant()) series.emplace(name->series, true);
  std::set<std::size_t> out(labels.begin(), labels.end());
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    const FieldName& name = mesh.fields[f].name;
    const auto at = name.isInstant() ? series.find(name.withoutTime()) : series.end();
    if (at == series.end() || !isCellField(mesh.fields[f])) continue;
    at->second &= isOneInteger(mesh.fields[f]);
    out.insert(f);
  }
  std::erase_if(out, [&](std::size_t f) {
    const auto name = mesh.fields[f].name.instant();
    return name && !series.at(name->series);
  });
  return {out.begin(), out.end()};
}

}  // namespace

bool isOneInteger(const FieldInfo& field) {
  return isCellField(field) && !isFloatType(field.type) && field.components == 1 && field.step == 1;
}

bool canBeLabel(const LatticeMesh& mesh, std::size_t field) {
  assert(field < mesh.fields.size());
  const FieldInfo& info = mesh.fields[field];
  if (!isOneInteger(info)) return false;
  std::vector<std::int32_t> values = mesh.values[field];
  std::ranges::sort(values);
  const auto repeated = std::ranges::unique(values);
  const std::size_t different = values.size() - repeated.size();
  return different >= 2 && different <= kMaxLabelValues;
}

std::vector<std::size_t> labelsOf(const LatticeMesh& mesh) {
  std::vector<std::size_t> labels, asked;
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    const FieldName& name = mesh.fields[f].name;
    if (!canBeLabel(mesh, f) || isAmong(kProcessNames, name)) continue;
    const bool isKnown = isAmong(kLabelNames, name) || !mesh.fields[f].labelNames.empty();
    (isKnown ? labels : asked).push_back(f);
  }
  if (asked.empty()) return wholeSeries(mesh, std::move(labels));
  std::size_t faces = 0;
  std::vector<std::size_t> equal(asked.size());
  forEachFaceInside(mesh, [&](FaceSide first, FaceSide second) {
    ++faces;
    for (std::size_t i = 0; i < asked.size(); ++i)
      equal[i] +=
          mesh.values[asked[i]][cellOf(first)] == mesh.values[asked[i]][cellOf(second)] ? 1 : 0;
  });
  for (std::size_t i = 0; i < asked.size(); ++i)
    if (static_cast<double>(equal[i]) > kLabelNeighbours * static_cast<double>(faces))
      labels.push_back(asked[i]);
  return wholeSeries(mesh, std::move(labels));
}

LabelNames namesOfValues(const FieldInfo& info, const std::vector<std::int32_t>& integers) {
  LabelNames out;
  if (info.labelNames.empty()) return out;
  std::set<double> values;
  for (const std::int32_t integer : integers) values.insert(info.value(0, integer));
  for (const auto& named : info.labelNames)
    if (values.contains(named.first)) out.insert(named);
  return out;
}

std::vector<Triangle> interfacesOf(const LatticeMesh& mesh, std::size_t field) {
  assert(field < mesh.fields.size() && isOneInteger(mesh.fields[field]));
  assert(mesh.values[field].size() == mesh.tetrahedra.size());
  const std::vector<std::int32_t>& labels = mesh.values[field];
  std::vector<Triangle> out;
  forEachFaceInside(mesh, [&](FaceSide first, FaceSide second) {
    if (labels[cellOf(first)] == labels[cellOf(second)]) return;
    if (labels[cellOf(first)] > labels[cellOf(second)]) std::swap(first, second);
    out.push_back(cellFace(mesh.tetrahedra[cellOf(first)], oppositeCornerOf(first)));
  });
  return out;
}

}  // namespace qtet
