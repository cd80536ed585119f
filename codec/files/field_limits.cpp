#include "codec/files/field_limits.h"

#include <algorithm>
#include <string>

#include "codec/files/file_names.h"

namespace qtet {
namespace {

/// The first point field of a .glb is a colour, too.
Status holdsAttributes(std::string_view ending, const std::vector<FieldOutline>& fields) {
  const auto points =
      static_cast<std::size_t>(std::ranges::count(fields, false, &FieldOutline::ofCells));
  const std::size_t most = kMaxDracoAttributes - (ending == ".glb" ? 1 : 0);
  if (points <= most) return {};
  return fail(ErrorCode::kBadInput,
              "there are " + std::to_string(points) + " point fields, and a " +
                  std::string(ending) + " file takes at most " + std::to_string(most) +
                  "; choose fewer with `fields`, or one instant of each series with `time`, or "
                  "take .vtu");
}

std::unexpected<Error> tooLarge(const FieldOutline& field, const std::string& what,
                                std::string_view ending, std::size_t most) {
  return fail(ErrorCode::kBadInput, "field '" + std::string(field.name) + "' has " + what + ", a " +
                                        std::string(ending) + " file takes at most " +
                                        std::to_string(most) +
                                        "; leave it out with `fields`, or take .vtu");
}

Status gmshHolds(const std::vector<FieldOutline>& fields) {
  for (const FieldOutline& field : fields) {
    if (field.components > kMaxGmshComponents)
      return tooLarge(field, std::to_string(field.components) + " components", ".msh",
                      kMaxGmshComponents);
    if (field.name.size() > kMaxGmshNameBytes)
      return tooLarge(field, "a name of " + std::to_string(field.name.size()) + " bytes", ".msh",
                      kMaxGmshNameBytes);
  }
  return {};
}

Status legacyVtkHolds(const std::vector<FieldOutline>& fields) {
  for (const FieldOutline& field : fields)
    if (const std::size_t bytes = vtkName(field.name).size(); bytes > kMaxVtkNameBytes)
      return tooLarge(field, "a name of " + std::to_string(bytes) + " bytes as VTK encodes it",
                      ".vtk", kMaxVtkNameBytes);
  return {};
}

}  // namespace

std::vector<FieldOutline> outlinesOf(const LatticeMesh& mesh) {
  std::vector<FieldOutline> out;
  for (const FieldInfo& field : mesh.fields)
    out.push_back({field.name, field.components, isCellField(field)});
  return out;
}

std::vector<FieldOutline> outlinesOf(const FileMesh& mesh) {
  std::vector<FieldOutline> out;
  for (const FileField& field : mesh.pointFields)
    out.push_back({field.name, field.components, false});
  for (const FileField& field : mesh.cellFields)
    out.push_back({field.name, field.components, true});
  return out;
}

Status canHold(std::string_view ending, const std::vector<FieldOutline>& fields) {
  if (ending == ".glb" || ending == ".drc") return holdsAttributes(ending, fields);
  if (ending == ".msh") return gmshHolds(fields);
  if (ending == ".vtk") return legacyVtkHolds(fields);
  return {};
}

}  // namespace qtet
