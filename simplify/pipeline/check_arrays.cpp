#include <algorithm>
#include <cmath>
#include <set>

#include "proto/limits.h"
#include "proto/utf8.h"
#include "simplify/pipeline/pipeline.h"

namespace qtet {
namespace {

/// Doubles do not distinguish larger integers from their neighbours.
constexpr double kMaxExactInteger = 9007199254740992.0;

std::unexpected<Error> bad(std::string what) { return fail(ErrorCode::kBadInput, std::move(what)); }

Status checkPoints(const TetMesh& mesh) {
  if (mesh.points.empty()) return bad("the mesh has no points");
  if (mesh.points.size() > kMaxElements || mesh.tetrahedra.size() > kMaxElements)
    return fail(ErrorCode::kLimitExceeded, "more than 2^29 points or tetrahedra");
  const auto isFinite = [](const Position& p) {
    return std::ranges::all_of(p, [](double x) { return std::isfinite(x); });
  };
  const auto wrong = std::ranges::find_if_not(mesh.points, isFinite);
  if (wrong == mesh.points.end()) return {};
  return bad("point " + std::to_string(wrong - mesh.points.begin()) +
             " has a coordinate that is not finite");
}

Status checkTetrahedra(const TetMesh& mesh) {
  if (mesh.tetrahedra.empty()) return bad("the mesh has no tetrahedra");
  const auto isWithin = [&](const Tetrahedron& cell) {
    return std::ranges::all_of(cell, [&](VertexId v) { return v < mesh.points.size(); });
  };
  const auto wrong = std::ranges::find_if_not(mesh.tetrahedra, isWithin);
  if (wrong == mesh.tetrahedra.end()) return {};
  return bad("tetrahedron " + std::to_string(wrong - mesh.tetrahedra.begin()) +
             " names a point outside the " + std::to_string(mesh.points.size()) + " there are");
}

Status checkField(const MeshField& field, std::size_t number, const TetMesh& mesh) {
  const std::string which = "field " + std::to_string(number) + " ";
  if (field.name.empty() || field.name.size() > kMaxNameBytes || !isUtf8(field.name))
    return bad(which + "needs a name of 1 to " + std::to_string(kMaxNameBytes) + " bytes of UTF-8");
  const std::string called = which + "(" + field.name + ") ";
  if (field.association != "point" && field.association != "cell")
    return bad(called + "belongs neither to points nor to cells");
  if (std::ranges::find(kFieldTypes, field.type) == kFieldTypes.end())
    return bad(called + "has the unknown type " + field.type);
  if (field.components < 1 || field.components > kMaxFieldComponents)
    return bad(called + "has " + std::to_string(field.components) + " components, not 1 to " +
               std::to_string(kMaxFieldComponents));
  const std::size_t wanted =
      field.components * (isCellField(field) ? mesh.tetrahedra.size() : mesh.points.size());
  if (field.values.size() != wanted)
    return bad(called + "has " + std::to_string(field.values.size()) + " numbers, not " +
               std::to_string(wanted));
  const auto isExact = [](double value) { return std::abs(value) < kMaxExactInteger; };
  if (!isFloatType(field.type) && !std::ranges::all_of(field.values, isExact))
    return bad(called + "holds an integer of 2^53 or more in magnitude");
  return {};
}

Status checkFields(const TetMesh& mesh) {
  if (mesh.fields.size() > kMaxFields)
    return fail(ErrorCode::kLimitExceeded, "more than " + std::to_string(kMaxFields) + " fields");
  std::set<std::pair<std::string, std::string>> names;
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    const MeshField& field = mesh.fields[f];
    if (Status checked = checkField(field, f, mesh); !checked) return checked;
    if (!names.emplace(field.association, field.name).second)
      return bad("two " + field.association + " fields are called " + field.name);
  }
  return {};
}

}  // namespace

Status checkArrays(const TetMesh& mesh) {
  if (Status checked = checkPoints(mesh); !checked) return checked;
  if (Status checked = checkTetrahedra(mesh); !checked) return checked;
  return checkFields(mesh);
}

Status checkRoom(std::uint64_t cells, std::uint64_t most) {
  if (cells <= most / kLeastBytesACell) return {};
  constexpr std::uint64_t kGigabyte = 1'000'000'000;
  return fail(ErrorCode::kLimitExceeded,
              "simplifying " + std::to_string(cells) + " tetrahedra takes over " +
                  std::to_string(cells * kLeastBytesACell / kGigabyte) +
                  " GB, and this program has " + std::to_string(most / kGigabyte) +
                  " GB at most; use the tool of the Python or Debian package");
}

}  // namespace qtet
