#include <algorithm>
#include <cassert>
#include <cmath>

#include "codec/mesh/boundary.h"
#include "proto/limits.h"
#include "proto/number_text.h"
#include "proto/rounding_error.h"
#include "simplify/clean/verify.h"

namespace qtet {
namespace {

/// Half a step, and what double arithmetic may add to it.
constexpr double kHalfAStep = 0.5 + 1e-9;

/// The nearest integer to `steps` in [0, 2^bits), and how far off it is.
struct Nearest {
  std::int32_t integer;
  double error;
};

Nearest nearest(double steps, int bits) {
  assert(bits > 0 && bits < 32);
  const double integer = std::clamp(std::floor(steps + 0.5), 0.0, std::ldexp(1.0, bits) - 1);
  return {static_cast<std::int32_t>(integer), std::abs(steps - integer)};
}

Status putPoints(const TetMesh& mesh, OnLattice& out) {
  assert(out.mesh.lattice.step > 0 && out.mesh.lattice.bits <= kMaxPositionBits);
  const Lattice& lattice = out.mesh.lattice;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    LatticePoint point{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Nearest found =
          nearest((mesh.points[v][k] - lattice.origin[k]) / lattice.step, lattice.bits);
      if (!(found.error <= kHalfAStep)) {
        return fail(ErrorCode::kBadValue, "point " + std::to_string(v) +
                                              " of the cleaned input lies " +
                                              std::to_string(found.error) +
                                              " lattice steps off the log's lattice on axis " +
                                              "xyz"[k] + "; the log was made from another mesh");
      }
      point[k] = found.integer;
      out.largestPositionError = std::max(out.largestPositionError, found.error);
    }
    out.mesh.points.push_back(point);
  }
  return {};
}

/// The number that a reader of the field's type gets.
double asDecoded(const FieldInfo& info, std::size_t component, std::int32_t integer) {
  const double value = info.value(component, integer);
  if (info.type == "float32") return static_cast<float>(value);
  return isFloatType(info.type) ? value : std::floor(value + 0.5);
}

/// "field T at point 7 of the cleaned input"
std::string placeOf(const FieldInfo& info, std::size_t i) {
  return "field " + info.name + " at " + info.association + " " +
         std::to_string(i / info.components) + " of the cleaned input";
}

Status putField(const MeshField& field, const FieldInfo& info, OnLattice& out) {
  if (field.components != info.components) {
    return fail(ErrorCode::kBadValue, "field " + info.name + " has " +
                                          std::to_string(info.components) +
                                          " components in the log and " +
                                          std::to_string(field.components) + " in the input");
  }
  std::vector<std::int32_t> integers;
  integers.reserve(field.values.size());
  const double bound = largestRoundingError(info);
  double largest = 0, largestValue = 0;
  for (std::size_t i = 0; i < field.values.size(); ++i) {
    if (!std::isfinite(field.values[i]) && !info.hasMissing)
      return fail(ErrorCode::kBadValue, placeOf(info, i) +
                                            " is not finite, and the log's field has no missing "
                                            "values; the log was made from another mesh");
    const Nearest found =
        std::isfinite(field.values[i])
            ? nearest((field.values[i] - info.minimum[i % info.components]) / info.step, info.bits)
            : Nearest{kMissing, 0};
    if (!(found.error <= kHalfAStep)) {
      return fail(ErrorCode::kBadValue,
                  placeOf(info, i) + " is " + std::to_string(found.error) +
                      " field steps off what the log can hold; the log was made from another mesh");
    }
    if (found.integer != kMissing) {
      const double error =
          std::abs(asDecoded(info, i % info.components, found.integer) - field.values[i]);
      if (!(error <= bound))
        return fail(ErrorCode::kBadValue, placeOf(info, i) + " is " + shortestText(error) +
                                              " off what the log holds, and the most is " +
                                              shortestText(bound) +
                                              "; the log was made from another mesh");
      largestValue = std::max(largestValue, error);
    }
    integers.push_back(found.integer);
    largest = std::max(largest, found.error);
  }
  assert(integers.size() == field.values.size());
  out.mesh.fields.push_back(info);
  out.mesh.values.push_back(std::move(integers));
  out.largestFieldErrors.push_back(largest);
  out.largestValueErrors.push_back(largestValue);
  return {};
}

}  // namespace

Result<OnLattice> putOnLattice(const TetMesh& mesh, const Lattice& lattice,
                               const std::vector<FieldInfo>& fields) {
  OnLattice out;
  out.mesh.lattice = lattice;
  if (Status put = putPoints(mesh, out); !put) return std::unexpected(put.error());
  for (const FieldInfo& info : fields) {
    const auto field =
        std::find_if(mesh.fields.begin(), mesh.fields.end(), [&](const MeshField& candidate) {
          return candidate.name == info.name && candidate.association == info.association;
        });
    if (field == mesh.fields.end())
      return fail(ErrorCode::kNotFound, "the input has no " + info.association + " field '" +
                                            info.name +
                                            "', which the log holds; it is not the log's input");
    if (Status put = putField(*field, info, out); !put) return std::unexpected(put.error());
  }
  out.mesh.tetrahedra = mesh.tetrahedra;
  out.mesh.boundary = boundaryOf(mesh.tetrahedra);
  return out;
}

}  // namespace qtet
