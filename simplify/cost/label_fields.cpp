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

/// Whether its names say that it is a label, if it can be.
bool isKnownLabel(const FieldInfo& field) {
  return isAmong(kLabelNames, field.name) || !field.labelNames.empty();
}

/// All instants of a series are labels if one is, or none if some is no integer.
std::vector<std::size_t> wholeSeries(std::span<const FieldInfo> fields,
                                     const std::vector<std::size_t>& labels) {
  std::map<std::string_view, bool> series;  // whether all can be
  for (const std::size_t f : labels)
    if (const auto name = fields[f].name.instant()) series.emplace(name->series, true);
  std::set<std::size_t> out(labels.begin(), labels.end());
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const FieldName& name = fields[f].name;
    const auto at = name.isInstant() ? series.find(name.withoutTime()) : series.end();
    if (at == series.end() || !isCellField(fields[f])) continue;
    at->second &= isOneInteger(fields[f]);
    out.insert(f);
  }
  std::erase_if(out, [&](std::size_t f) {
    const auto name = fields[f].name.instant();
    return name && !series.at(name->series);
  });
  return {out.begin(), out.end()};
}

}  // namespace

bool isOneInteger(const FieldInfo& field) {
  return isCellField(field) && !isFloatType(field.type) && field.components == 1 && field.step == 1;
}

LabelFinder::LabelFinder(std::vector<FieldInfo> fields)
    : fields_(std::move(fields)), values_(fields_.size()), equal_(fields_.size()) {}

void LabelFinder::add(const LatticeMesh& piece) {
  bool asks = false;
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    if (!isOneInteger(fields_[f])) continue;
    for (const std::int32_t value : piece.values[f])
      if (values_[f].size() <= kMaxLabelValues) values_[f].insert(value);
    asks |= values_[f].size() <= kMaxLabelValues && !isKnownLabel(fields_[f]) &&
            !isAmong(kProcessNames, fields_[f].name);
  }
  if (!asks) return;
  forEachFaceInside(piece, [&](FaceSide first, FaceSide second) {
    ++faces_;
    for (std::size_t f = 0; f < fields_.size(); ++f)
      if (isOneInteger(fields_[f]))
        equal_[f] += piece.values[f][cellOf(first)] == piece.values[f][cellOf(second)] ? 1 : 0;
  });
}

bool LabelFinder::canBe(std::size_t field) const {
  assert(field < fields_.size());
  return values_[field].size() >= 2 && values_[field].size() <= kMaxLabelValues;
}

std::vector<std::size_t> LabelFinder::labels() const {
  std::vector<std::size_t> out;
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    if (!canBe(f) || isAmong(kProcessNames, fields_[f].name)) continue;
    if (isKnownLabel(fields_[f]) ||
        static_cast<double>(equal_[f]) > kLabelNeighbours * static_cast<double>(faces_))
      out.push_back(f);
  }
  return wholeSeries(fields_, out);
}

bool canBeLabel(const LatticeMesh& mesh, std::size_t field) {
  LabelFinder finder(mesh.fields);
  finder.add(mesh);
  return finder.canBe(field);
}

std::vector<std::size_t> labelsOf(const LatticeMesh& mesh) {
  LabelFinder finder(mesh.fields);
  finder.add(mesh);
  return finder.labels();
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
