#include "simplify/read/foam/foam_fields.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>

#include "proto/field_name.h"
#include "simplify/mesh/vector3.h"
#include "simplify/split/each_face.h"

namespace qtet {
namespace {

constexpr std::string_view kPointKey = "point:", kCellKey = "cell:";

/// Whether KEY:NAME, or that of one of its steps, is among the names.
bool isAskedAs(std::string_view key, const FieldNames& names, const std::string& name) {
  const std::string wanted = std::string(key) + name;
  return names && std::ranges::any_of(*names, [&](const FieldName& asked) {
           return asked == wanted || asked.withoutTime() == wanted;
         });
}

/// The volume of a cell as the sum of the pyramids over its faces from the mean of its corners.
double volumeOf(const CellMesh& mesh, std::size_t cell) {
  Vector3 middle{};
  double corners = 0;
  forEachFace(mesh, cell, [&](std::span<const VertexId> face) {
    for (const VertexId v : face) middle = middle + mesh.points[v], ++corners;
  });
  middle = (1 / std::max(corners, 1.0)) * middle;
  double volume = 0;
  forEachFace(mesh, cell, [&](std::span<const VertexId> face) {
    double pyramid = 0;
    for (std::size_t k = 1; k + 1 < face.size(); ++k) {
      const Vector3 a = mesh.points[face[0]] - middle, b = mesh.points[face[k]] - middle,
                    c = mesh.points[face[k + 1]] - middle;
      pyramid += dot(cross(a, b), c) / 6;
    }
    volume += std::abs(pyramid);
  });
  return volume;
}

/// The corners of each cell, each once, with the cell's volume.
class Corners {
 public:
  explicit Corners(const CellMesh& mesh) {
    std::vector<VertexId> ids;
    for (std::size_t c = 0; c < mesh.cells(); ++c) {
      ids.clear();
      forEachFace(mesh, c, [&](std::span<const VertexId> face) {
        ids.insert(ids.end(), face.begin(), face.end());
      });
      std::ranges::sort(ids);
      ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
      corners_.insert(corners_.end(), ids.begin(), ids.end());
      ends_.push_back(corners_.size());
      volumes_.push_back(volumeOf(mesh, c));
    }
  }

  /// The means at points of one field of cells; NaN where no cell has a value.
  [[nodiscard]] MeshField meansOf(const MeshField& cells, std::size_t points) const {
    const std::size_t n = cells.components;
    MeshField out{cells.name, cells.components, cells.type, std::vector<double>(points * n),
                  "point"};
    std::vector<double> weights(points * n);
    std::size_t at = 0;
    for (std::size_t c = 0; c < ends_.size(); ++c)
      for (; at < ends_[c]; ++at)
        for (std::size_t k = 0; k < n; ++k) {
          const double value = cells.values[c * n + k];
          if (!std::isfinite(value)) continue;
          // a flat cell counts where there is no other
          const double weight = std::max(volumes_[c], std::numeric_limits<double>::min());
          out.values[corners_[at] * n + k] += weight * value;
          weights[corners_[at] * n + k] += weight;
        }
    for (std::size_t i = 0; i < weights.size(); ++i)
      out.values[i] =
          weights[i] > 0 ? out.values[i] / weights[i] : std::numeric_limits<double>::quiet_NaN();
    return out;
  }

 private:
  std::vector<VertexId> corners_;
  std::vector<std::size_t> ends_;  ///< of each cell's corners
  std::vector<double> volumes_;
};

}  // namespace

FieldNames foamFieldsToRead(const FieldNames& names) {
  FieldNames out = names;
  if (!names) return out;
  for (const std::string& name : *names)
    if (name.starts_with(kPointKey))
      out->push_back(std::string(kCellKey) + name.substr(kPointKey.size()));
  return out;
}

std::string foamFieldsAtPoints(const FieldNames& names, CellMesh& mesh) {
  std::vector<MeshField> fields = std::move(mesh.fields), cells;
  mesh.fields.clear();
  for (MeshField& field : fields)
    (isCellField(field) ? cells : mesh.fields).push_back(std::move(field));
  const Corners corners(mesh);
  const std::size_t own = mesh.fields.size();
  for (const MeshField& field : cells) {
    const auto isCalledSo = [&](const MeshField& other) { return other.name == field.name; };
    const bool isWanted =
        !names || isAskedAs("", names, field.name) || isAskedAs(kPointKey, names, field.name);
    if (isFloatType(field.type) && isWanted && std::ranges::none_of(mesh.fields, isCalledSo))
      mesh.fields.push_back(corners.meansOf(field, mesh.points.size()));
  }
  const std::string first = mesh.fields.size() > own ? mesh.fields[own].name : "";
  std::erase_if(cells, [&](const MeshField& field) {
    return isFloatType(field.type) && !isAskedAs(kCellKey, names, field.name);
  });
  std::ranges::move(cells, std::back_inserter(mesh.fields));
  return first;
}

std::string noteOfMeans(const CellMesh& mesh, const std::string& field) {
  return "fields are means at the " + std::to_string(mesh.points.size()) +
         " points of OpenFOAM's values of " + std::to_string(mesh.cells()) +
         " cells, weighted by volume; `fields` cell:" + field +
         " keeps those of cells, at about twice the bytes";
}

}  // namespace qtet
