#include "codec/boundary_drc.h"

#include <draco/attributes/geometry_attribute.h>
#include <draco/compression/expert_encode.h>
#include <draco/core/encoder_buffer.h>
#include <draco/mesh/mesh.h>

#include <array>
#include <cassert>
#include <memory>
#include <utility>

#include "proto/limits.h"

namespace qtet {
namespace {

constexpr std::uint32_t kAbsent = 0xFFFFFFFFu;

/// The vertices that the boundary uses, numbered in slot order.
struct BoundaryVertices {
  std::vector<VertexId> slots;
  std::vector<std::uint32_t> numbers;  ///< by slot
};

BoundaryVertices collectVertices(const LatticeMesh& mesh) {
  BoundaryVertices out;
  out.numbers.assign(mesh.points.size(), kAbsent);
  for (const Triangle& triangle : mesh.boundary)
    for (const VertexId v : triangle) out.numbers[v] = 0;
  for (VertexId v = 0; v < out.numbers.size(); ++v) {
    if (out.numbers[v] == kAbsent) continue;
    out.numbers[v] = static_cast<std::uint32_t>(out.slots.size());
    out.slots.push_back(v);
  }
  return out;
}

int addFloats(draco::Mesh& target, draco::GeometryAttribute::Type type, std::uint32_t components, const std::vector<float>& values) {
  const auto count = static_cast<std::uint32_t>(values.size() / components);
  draco::GeometryAttribute description;
  description.Init(type, nullptr, static_cast<std::int8_t>(components), draco::DT_FLOAT32, false,
                   static_cast<std::int64_t>(components * sizeof(float)), 0);
  const int id = target.AddAttribute(description, true, count);
  for (std::uint32_t i = 0; i < count; ++i)
    target.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), values.data() + std::size_t{i} * components);
  return id;
}

int addPositions(draco::Mesh& target, const LatticeMesh& mesh, const std::vector<VertexId>& slots) {
  std::vector<float> values;
  values.reserve(slots.size() * 3);
  for (const VertexId v : slots)
    for (const double x : mesh.lattice.position(mesh.points[v])) values.push_back(static_cast<float>(x));
  return addFloats(target, draco::GeometryAttribute::POSITION, 3, values);
}

int addField(draco::Mesh& target, const FieldInfo& field, const std::vector<std::int32_t>& integers, const std::vector<VertexId>& slots) {
  std::vector<float> values;
  values.reserve(slots.size() * field.components);
  for (const VertexId v : slots)
    for (std::uint32_t c = 0; c < field.components; ++c)
      values.push_back(static_cast<float>(field.value(c, integers[std::size_t{v} * field.components + c])));
  const int id = addFloats(target, draco::GeometryAttribute::GENERIC, field.components, values);
  auto metadata = std::make_unique<draco::AttributeMetadata>();
  metadata->AddEntryString("name", field.name);
  target.AddAttributeMetadata(id, std::move(metadata));
  return id;
}

void addTriangles(draco::Mesh& target, const LatticeMesh& mesh, const std::vector<std::uint32_t>& numbers) {
  target.SetNumFaces(mesh.boundary.size());
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
    draco::Mesh::Face face;
    for (std::size_t k = 0; k < 3; ++k) face[k] = draco::PointIndex(numbers[mesh.boundary[i][k]]);
    target.SetFace(draco::FaceIndex(static_cast<std::uint32_t>(i)), face);
  }
}

/// Draco's grid is ours: `origin` its zero, and a range of 2^bits - 1 steps makes its step `step`.
void quantise(draco::ExpertEncoder& encoder, int attribute, int bits, double step, const std::vector<float>& origin) {
  const auto range = static_cast<float>(step * ((1 << bits) - 1));
  encoder.SetAttributeExplicitQuantization(attribute, bits, static_cast<int>(origin.size()), origin.data(), range);
}

std::vector<float> toFloats(std::span<const double> values) { return {values.begin(), values.end()}; }

/// Above this many bits a float's 24 cannot hold a value's grid point, and rounding again would only lose more.
constexpr int kMaxQuantisedFieldBits = 20;

}  // namespace

Result<Bytes> boundaryDrc(const LatticeMesh& mesh) {
  if (mesh.boundary.empty()) return fail(ErrorCode::kBadInput, "the mesh has no boundary triangle to encode");
  assert(mesh.fields.size() == mesh.values.size());
  const BoundaryVertices vertices = collectVertices(mesh);

  draco::Mesh target;
  target.set_num_points(static_cast<std::uint32_t>(vertices.slots.size()));
  const int positions = addPositions(target, mesh, vertices.slots);
  std::vector<std::pair<int, const FieldInfo*>> fields;
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    if (isCellField(mesh.fields[f])) continue;
    fields.emplace_back(addField(target, mesh.fields[f], mesh.values[f], vertices.slots), &mesh.fields[f]);
  }
  addTriangles(target, mesh, vertices.numbers);

  draco::ExpertEncoder encoder(target);
  quantise(encoder, positions, mesh.lattice.bits, mesh.lattice.step, toFloats(mesh.lattice.origin));
  for (const auto& [attribute, info] : fields)
    if (info->bits <= kMaxQuantisedFieldBits && !info->gaps) quantise(encoder, attribute, info->bits, info->step, toFloats(info->minimum));

  draco::EncoderBuffer buffer;
  if (const draco::Status status = encoder.EncodeToBuffer(&buffer); !status.ok())
    return fail(ErrorCode::kBadCodec, std::string("Draco cannot encode the boundary: ") + status.error_msg());
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(buffer.data());
  return Bytes(bytes, bytes + buffer.size());
}

}  // namespace qtet
