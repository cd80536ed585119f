#include "tests/same_bytes/meshes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "codec/coding/float_rounding.h"
#include "simplify/samples/samples.h"

namespace qtet::testing {
namespace {

constexpr VertexId kUnused = std::numeric_limits<VertexId>::max();
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// The cells whose middles `keep` accepts, and the points that they use.
template <class Keep>
TetMesh partOf(const TetMesh& mesh, const Keep& keep) {
  TetMesh out;
  out.pointType = mesh.pointType;
  std::vector<VertexId> newOf(mesh.points.size(), kUnused);
  std::vector<std::size_t> points, cells;
  for (std::size_t c = 0; c < mesh.tetrahedra.size(); ++c) {
    Position middle{};
    for (const VertexId v : mesh.tetrahedra[c])
      for (std::size_t a = 0; a < 3; ++a) middle[a] += 0.25 * mesh.points[v][a];
    if (!keep(middle)) continue;
    cells.push_back(c);
    Tetrahedron cell = mesh.tetrahedra[c];
    for (VertexId& v : cell) {
      if (newOf[v] == kUnused) {
        newOf[v] = static_cast<VertexId>(points.size());
        points.push_back(v);
        out.points.push_back(mesh.points[v]);
      }
      v = newOf[v];
    }
    out.tetrahedra.push_back(cell);
  }
  for (const MeshField& field : mesh.fields) {
    MeshField part{field.name, field.components, field.type, {}, field.association};
    for (const std::size_t i : isCellField(field) ? cells : points)
      for (std::size_t k = 0; k < field.components; ++k)
        part.values.push_back(field.values[i * field.components + k]);
    out.fields.push_back(std::move(part));
  }
  return out;
}

/// With a label a cell under the name of the point field, and a float.
TetMesh boxWithCellFields() {
  TetMesh mesh = boxSample();
  MeshField labels{"Scalar", 1, "int32", {}, "cell"}, heights{"Height", 1, "float32", {}, "cell"};
  for (const Tetrahedron& t : mesh.tetrahedra) {
    labels.values.push_back(mesh.points[t[0]][0] > 0.5 ? 1000000 : -7);
    heights.values.push_back(roundedToFloat(mesh.points[t[1]][2]));
  }
  mesh.fields.push_back(std::move(labels)), mesh.fields.push_back(std::move(heights));
  return mesh;
}

/// Two fields with missing values at places of their own, one of vectors in doubles.
TetMesh boxWithMissingValues() {
  TetMesh mesh = boxSample();
  MeshField flow{"Flow", 3, "float64", {}};
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const Position& p = mesh.points[i];
    const bool outside = p[0] + p[1] < 0.3;
    for (std::size_t a = 0; a < 3; ++a)
      flow.values.push_back(outside ? kMissing : p[a] / (3 + p[(a + 1) % 3]));
    if (p[2] > 0.7 && p[0] > 0.4) mesh.fields[0].values[i] = kMissing;
  }
  mesh.fields.push_back(std::move(flow));
  return mesh;
}

/// A tunnel through it, a hollow in it, and two parts that touch along an edge.
TetMesh boxWithHoles() {
  return partOf(boxSample(), [](const Position& p) {
    const bool tunnel = p[0] > 0.25 && p[0] < 0.375 && p[1] > 0.25 && p[1] < 0.5;
    const bool hollow = std::ranges::all_of(p, [](double x) { return x > 0.625 && x < 0.75; });
    const bool corner = p[0] > 0.875 && p[1] > 0.875;
    const bool beside = p[0] > 0.75 && p[1] > 0.75 && !corner && (p[0] > 0.875 || p[1] > 0.875);
    return !tunnel && !hollow && !beside;
  });
}

TetMesh finPart() {
  return partOf(finSample(), [](const Position& p) {
    return p[0] > -1.3 && p[0] < 0.2 && p[1] > 0 && p[1] < 0.5 && p[2] < 0.5;
  });
}

/// It moves: a series of displacements, by which no cell may flip.
TetMesh beamPart() {
  return partOf(beamSeries(5), [](const Position& p) { return p[0] > 7 && p[1] > 0.1; });
}

TetMesh ballPart() {
  return partOf(ballSample(), [](const Position& p) { return p[0] > 0 && p[1] > 0 && p[2] > 0.2; });
}

TetMesh springPart() {
  return partOf(springSample(), [](const Position& p) { return p[0] > 0 && p[1] > 0 && p[2] < 2; });
}

TetMesh elbowPart() {
  return partOf(elbowSample(), [](const Position& p) { return p[0] > 0 && p[1] < 1 && p[2] > 0; });
}

constexpr std::array kMeshes{
    SameBytesMesh{"box", boxSample},
    SameBytesMesh{"cells", boxWithCellFields},
    SameBytesMesh{"missing", boxWithMissingValues},
    SameBytesMesh{"holes", boxWithHoles},
    SameBytesMesh{"fin", finPart},
    SameBytesMesh{"beam", beamPart},
    SameBytesMesh{"ball", ballPart},
    SameBytesMesh{"spring", springPart},
    SameBytesMesh{"elbow", elbowPart},
};

}  // namespace

std::span<const SameBytesMesh> sameBytesMeshes() { return kMeshes; }

TetMesh sameBytesMesh(std::string_view name) {
  const auto found = std::ranges::find(kMeshes, name, &SameBytesMesh::name);
  assert(found != kMeshes.end());
  TetMesh mesh = found->make();
  mesh.pointType = "float32";  // as its file has it, which --lossless keeps
  return mesh;
}

Result<TetMesh> sameBytesInstants(std::span<const std::size_t> steps) {
  TetMesh mesh = boxSample();
  for (const std::size_t step : steps) {
    const auto time = static_cast<double>(step);
    MeshField heat{"Heat@" + std::to_string(step), 1, "float32", {}};
    MeshField count{"Count@" + std::to_string(step), 1, "int32", {}, "cell"};
    for (const Position& p : mesh.points)
      heat.values.push_back(roundedToFloat(p[0] + p[1] * p[1] * time / (1 + p[2])));
    for (std::size_t c = 0; c < mesh.tetrahedra.size(); ++c)
      count.values.push_back(static_cast<double>(c % 7 + step));
    mesh.fields.push_back(std::move(heat)), mesh.fields.push_back(std::move(count));
  }
  return mesh;
}

}  // namespace qtet::testing
