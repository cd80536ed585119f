#include "simplify/api/input_arrays.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "codec/coding/float_bits.h"
#include "proto/limits.h"
#include "proto/manifest.h"

namespace qtet {
namespace {

std::unexpected<Error> bad(std::string what) { return fail(ErrorCode::kBadInput, std::move(what)); }

/// Calls visit with a zero of the type; false if there is no such type.
template <class Visit>
bool withType(std::uint32_t type, const Visit& visit) {
  switch (type) {
    case QTET_FLOAT32: visit(float{}); return true;
    case QTET_FLOAT64: visit(double{}); return true;
    case QTET_INT8: visit(std::int8_t{}); return true;
    case QTET_INT16: visit(std::int16_t{}); return true;
    case QTET_INT32: visit(std::int32_t{}); return true;
    case QTET_INT64: visit(std::int64_t{}); return true;
    case QTET_UINT8: visit(std::uint8_t{}); return true;
    case QTET_UINT16: visit(std::uint16_t{}); return true;
    case QTET_UINT32: visit(std::uint32_t{}); return true;
    case QTET_UINT64: visit(std::uint64_t{}); return true;
    default: return false;
  }
}

static_assert(kFieldTypes[QTET_FLOAT32 - 1] == "float32" && kFieldTypes[QTET_INT8 - 1] == "int8" &&
              kFieldTypes[QTET_UINT64 - 1] == "uint64");

std::vector<Position> pointsOf(const qtet_input_mesh& mesh) {
  std::vector<Position> out(mesh.pointCount);
  if (mesh.pointType == QTET_FLOAT64) {
    if (!out.empty()) std::memcpy(out.data(), mesh.points, out.size() * sizeof(Position));
  } else {
    const auto* from = static_cast<const float*>(mesh.points);
    for (Position& p : out)
      for (double& x : p) x = *from++;
  }
  return out;
}

std::vector<Tetrahedron> tetrahedraOf(const qtet_input_mesh& mesh) {
  std::vector<Tetrahedron> out(mesh.tetrahedronCount);
  withType(mesh.idType, [&]<class T>(T) {
    const T* from = static_cast<const T*>(mesh.tetrahedra);
    for (Tetrahedron& cell : out)
      for (VertexId& v : cell) {
        const auto id = static_cast<std::uint64_t>(*from++);  // a negative one is beyond all
        v = id < mesh.pointCount ? static_cast<VertexId>(id) : kGhost;
      }
  });
  return out;
}

Result<MeshField> fieldOf(const qtet_input_field& field, std::uint32_t number,
                          const qtet_input_mesh& mesh) {
  const std::string which = "field " + std::to_string(number) + " ";
  if (field.name == nullptr || field.values == nullptr)
    return bad(which + "has a name or values that are null");
  if (field.association != QTET_POINT && field.association != QTET_CELL)
    return bad(which + "has the unknown association " + std::to_string(field.association));
  if (field.components < 1 || field.components > kMaxFieldComponents)
    return bad(which + "has " + std::to_string(field.components) + " components, not 1 to " +
               std::to_string(kMaxFieldComponents));
  const bool isOfCells = field.association == QTET_CELL;
  MeshField out{field.name, field.components, {}, {}, isOfCells ? "cell" : "point"};
  const std::size_t count =
      field.components * (isOfCells ? mesh.tetrahedronCount : mesh.pointCount);
  const bool isKnown = withType(field.type, [&]<class T>(T) {
    const T* from = static_cast<const T*>(field.values);
    out.values.reserve(count);
    std::transform(from, from + count, std::back_inserter(out.values), [](T value) {
      if constexpr (std::is_same_v<T, float>)
        return widened(value);
      else
        return static_cast<double>(value);
    });
  });
  if (!isKnown) return bad(which + "has the unknown type " + std::to_string(field.type));
  out.type = kFieldTypes[field.type - 1];
  return out;
}

Status checkMesh(const qtet_input_mesh& mesh) {
  if (mesh.pointCount > kMaxElements || mesh.tetrahedronCount > kMaxElements)
    return fail(ErrorCode::kLimitExceeded, "more than 2^29 points or tetrahedra");
  if (mesh.fieldCount > kMaxFields)
    return fail(ErrorCode::kLimitExceeded, "more than " + std::to_string(kMaxFields) + " fields");
  if ((mesh.pointCount > 0 && mesh.points == nullptr) ||
      (mesh.tetrahedronCount > 0 && mesh.tetrahedra == nullptr) ||
      (mesh.fieldCount > 0 && mesh.fields == nullptr))
    return bad("an array of the mesh is null");
  if (mesh.pointType != QTET_FLOAT32 && mesh.pointType != QTET_FLOAT64)
    return bad("points are of type " + std::to_string(mesh.pointType) +
               "; give QTET_FLOAT32 or QTET_FLOAT64");
  const auto isId = [](std::uint32_t type) {
    return type == QTET_INT32 || type == QTET_INT64 || type == QTET_UINT32 || type == QTET_UINT64;
  };
  if (!isId(mesh.idType))
    return bad("tetrahedra are of type " + std::to_string(mesh.idType) +
               "; give QTET_INT32, QTET_INT64, QTET_UINT32 or QTET_UINT64");
  if (mesh.fieldCount > 0 && mesh.fieldBytes < sizeof(qtet_input_field))
    return bad("fieldBytes is " + std::to_string(mesh.fieldBytes) +
               "; give sizeof(qtet_input_field)");
  return {};
}

}  // namespace

Result<TetMesh> meshOfArrays(const qtet_input_mesh& mesh) {
  if (Status checked = checkMesh(mesh); !checked) return std::unexpected(checked.error());
  TetMesh out{pointsOf(mesh),
              tetrahedraOf(mesh),
              {},
              mesh.pointType == QTET_FLOAT32 ? "float32" : "float64"};
  const auto* at = reinterpret_cast<const std::uint8_t*>(mesh.fields);
  for (std::uint32_t f = 0; f < mesh.fieldCount; ++f, at += mesh.fieldBytes) {
    Result<MeshField> field = fieldOf(*reinterpret_cast<const qtet_input_field*>(at), f, mesh);
    if (!field) return std::unexpected(field.error());
    out.fields.push_back(std::move(*field));
  }
  return out;
}

}  // namespace qtet
