#include "simplify/write_mesh.h"

#include <algorithm>

#include "codec/float_rounding.h"
#include "codec/vtu_writer.h"

namespace qtet {

Bytes vtuBytes(const TetMesh& mesh) {
  const auto isFloat = [](double x) { return roundedToFloat(x) == x; };
  VtuMesh out{mesh.points, mesh.tetrahedra, true};
  out.doublePoints = mesh.pointType == "float64" || !std::all_of(mesh.points.begin(), mesh.points.end(),
                                  [&](const Position& p) { return isFloat(p[0]) && isFloat(p[1]) && isFloat(p[2]); });
  for (const MeshField& field : mesh.fields)
    (isCellField(field) ? out.cellFields : out.pointFields).push_back({field.name, field.type, field.components, field.values});
  return vtuBytes(out);
}

}  // namespace qtet
