#include "simplify/read/vtk/foam_fields.h"

#include <algorithm>
#include <string_view>

#include "proto/field_key.h"

namespace qtet {
namespace {

constexpr std::string_view kPointKey = "point:";

/// Whether "point:NAME", or that of one of its steps, is among the names.
bool isAskedAtPoints(const FieldNames& names, const std::string& name) {
  const std::string key = std::string(kPointKey) + name;
  return names && std::ranges::any_of(*names, [&](const std::string& asked) {
           return asked == key || nameWithoutStep(asked) == key;
         });
}

}  // namespace

bool asksForPointFields(const FieldNames& names) {
  return names && std::ranges::any_of(
                      *names, [](const std::string& name) { return name.starts_with(kPointKey); });
}

void keepFoamFields(const FieldNames& names, CellMesh& mesh, std::vector<std::string>& notes) {
  const auto isOfCells = [&](const std::string& name) {
    return std::ranges::any_of(mesh.fields, [&](const MeshField& other) {
      return isCellField(other) && other.name == name;
    });
  };
  std::erase_if(mesh.fields, [&](const MeshField& field) {
    return !isCellField(field) && isOfCells(field.name) && !isAskedAtPoints(names, field.name);
  });
  const auto first =
      std::ranges::find_if(mesh.fields, [](const MeshField& field) { return isCellField(field); });
  if (!names && first != mesh.fields.end())
    notes.push_back("fields are those of cells, as OpenFOAM wrote them; `fields` " + first->name +
                    ",point:" + first->name + " adds the means at points");
}

}  // namespace qtet
