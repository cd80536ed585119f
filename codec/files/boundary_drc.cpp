#include "codec/files/boundary_drc.h"

#include <draco/attributes/geometry_attribute.h>
#include <draco/compression/expert_encode.h>
#include <draco/core/encoder_buffer.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include "codec/files/field_limits.h"
#include "codec/mesh/boundary.h"
#include "proto/limits.h"

namespace qtet {
namespace {

// Draco crashes on values that float32 cannot hold, and on quantised values far outside their
// range.
constexpr double kLargestFloat = std::numeric_limits<float>::max();
// bits of an integer whose grid point fits a float's 24 bits; another rounding would only lose more
constexpr int kMaxQuantisedBits = 20;
constexpr std::int32_t kLargestQuantised = 1 << kMaxQuantisedBits;

// NaN stays
float toFloat(double x) { return static_cast<float>(std::clamp(x, -kLargestFloat, kLargestFloat)); }

int addFloats(draco::Mesh& target, draco::GeometryAttribute::Type type, std::uint32_t components,
              const std::vector<float>& values) {
  const auto count = static_cast<std::uint32_t>(values.size() / components);
  draco::GeometryAttribute description;
  description.Init(type, nullptr, static_cast<std::int8_t>(components), draco::DT_FLOAT32, false,
                   static_cast<std::int64_t>(components * sizeof(float)), 0);
  const int id = target.AddAttribute(description, true, count);
  for (std::uint32_t i = 0; i < count; ++i)
    target.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                            values.data() + std::size_t{i} * components);
  return id;
}

void addColours(draco::Mesh& target, std::span<const std::array<std::uint8_t, 3>> colours,
                const std::vector<VertexId>& slots) {
  draco::GeometryAttribute description;
  description.Init(draco::GeometryAttribute::COLOR, nullptr, 3, draco::DT_UINT8, true, 3, 0);
  const int id = target.AddAttribute(description, true, static_cast<std::uint32_t>(slots.size()));
  for (std::uint32_t i = 0; i < slots.size(); ++i)
    target.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                            colours[slots[i]].data());
}

int addPositions(draco::Mesh& target, const Lattice& lattice,
                 const std::vector<LatticePoint>& points, const std::vector<VertexId>& slots) {
  std::vector<float> values;
  values.reserve(slots.size() * 3);
  for (const VertexId v : slots)
    for (const double x : lattice.position(points[v])) values.push_back(toFloat(x));
  return addFloats(target, draco::GeometryAttribute::POSITION, 3, values);
}

int addField(draco::Mesh& target, const FieldInfo& field, const std::vector<std::int32_t>& integers,
             const std::vector<VertexId>& slots) {
  std::vector<float> values;
  values.reserve(slots.size() * field.components);
  for (const VertexId v : slots)
    for (std::uint32_t c = 0; c < field.components; ++c)
      values.push_back(toFloat(field.value(c, integers[std::size_t{v} * field.components + c])));
  const int id = addFloats(target, draco::GeometryAttribute::GENERIC, field.components, values);
  auto metadata = std::make_unique<draco::AttributeMetadata>();
  metadata->AddEntryString("name", field.name);
  target.AddAttributeMetadata(id, std::move(metadata));
  return id;
}

void addTriangles(draco::Mesh& target, const std::vector<Triangle>& triangles) {
  target.SetNumFaces(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    draco::Mesh::Face face;
    for (std::size_t k = 0; k < 3; ++k) face[k] = draco::PointIndex(triangles[i][k]);
    target.SetFace(draco::FaceIndex(static_cast<std::uint32_t>(i)), face);
  }
}

/// Draco's grid is ours: `origin` its zero, and a range of 2^bits - 1 steps makes its step `step`.
void quantise(draco::ExpertEncoder& encoder, int attribute, int bits, double step,
              const std::vector<float>& origin) {
  const auto range = static_cast<float>(step * ((1 << bits) - 1));
  encoder.SetAttributeExplicitQuantization(attribute, bits, static_cast<int>(origin.size()),
                                           origin.data(), range);
}

std::vector<float> toFloats(std::span<const double> values) {
  std::vector<float> out;
  for (const double x : values) out.push_back(toFloat(x));
  return out;
}

/// Whether Draco's grid of `bits` from each origin on lies within float32, and its differences,
/// too.
bool fitsFloats(std::span<const double> origin, int bits, double step) {
  const double range = step * ((1 << bits) - 1);
  return range < kLargestFloat / 4 &&
         std::ranges::all_of(origin, [](double x) { return std::abs(x) < kLargestFloat / 4; });
}

/// A coarse level's integers may leave the field's range.
bool isQuantisable(const FieldInfo& field, std::span<const std::int32_t> integers) {
  return !field.hasMissing && field.bits <= kMaxQuantisedBits &&
         fitsFloats(field.minimum, kMaxQuantisedBits, field.step) &&
         std::ranges::all_of(integers, [](std::int32_t x) {
           return x >= -kLargestQuantised && x <= kLargestQuantised;
         });
}

}  // namespace

Result<Bytes> boundaryDrc(const LatticeMesh& mesh, const DrcOptions& options) {
  if (mesh.boundary.empty())
    return fail(ErrorCode::kBadInput, "the mesh has no boundary triangle to encode");
  // only a .glb has colours
  if (Status checked = canHold(options.colours.empty() ? ".drc" : ".glb", outlinesOf(mesh));
      !checked)
    return std::unexpected(checked.error());
  Lattice lattice = mesh.lattice;
  for (std::size_t a = 0; a < 3; ++a) lattice.origin[a] -= options.from[a];
  if (!fitsFloats(mesh.lattice.origin, lattice.bits, lattice.step))
    return fail(ErrorCode::kBadInput,
                "the mesh's coordinates are beyond what float32 holds, and Draco knows no other; "
                "take the level as .vtu");
  assert(mesh.lattice.bits > 0 && mesh.lattice.bits <= kMaxPositionBits);
  assert(mesh.fields.size() == mesh.values.size());
  const CompactTriangles surface = compactTriangles(mesh.boundary, mesh.points.size());

  draco::Mesh target;
  target.set_num_points(static_cast<std::uint32_t>(surface.vertices.size()));
  const int positions = addPositions(target, lattice, mesh.points, surface.vertices);
  std::vector<std::pair<int, std::size_t>> fields;
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    if (isCellField(mesh.fields[f])) continue;
    assert(mesh.values[f].size() == mesh.points.size() * mesh.fields[f].components);
    assert(mesh.fields[f].bits >= kMinFieldBits && mesh.fields[f].bits <= kMaxFieldBits);
    fields.emplace_back(addField(target, mesh.fields[f], mesh.values[f], surface.vertices), f);
  }
  if (!options.colours.empty()) addColours(target, options.colours, surface.vertices);
  addTriangles(target, surface.triangles);
  assert(static_cast<std::size_t>(target.num_attributes()) <= 1 + kMaxDracoAttributes);

  draco::ExpertEncoder encoder(target);
  quantise(encoder, positions, lattice.bits, lattice.step, toFloats(lattice.origin));
  for (const auto& [attribute, f] : fields)
    if (const FieldInfo& info = mesh.fields[f]; isQuantisable(info, mesh.values[f]))
      quantise(encoder, attribute, info.bits, info.step, toFloats(info.minimum));

  draco::EncoderBuffer buffer;
  if (const draco::Status status = encoder.EncodeToBuffer(&buffer); !status.ok())
    return fail(ErrorCode::kBadCodec,
                std::string("Draco cannot encode the boundary: ") + status.error_msg());
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(buffer.data());
  return Bytes(bytes, bytes + buffer.size());
}

bool floatsHold(const Lattice& lattice) {
  constexpr double kMaxSteps = 1 << 19;
  return std::ranges::all_of(lattice.origin, [&](double x) {
    return std::abs(x / lattice.step) + std::ldexp(1.0, lattice.bits) <= kMaxSteps;
  });
}

}  // namespace qtet
