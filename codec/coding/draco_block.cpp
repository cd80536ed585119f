#include "codec/coding/draco_block.h"

#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/point_cloud/point_cloud.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <string>

#include "proto/limits.h"

namespace qtet {
namespace {

constexpr int kNoPrediction = -2;  // draco::PREDICTION_NONE: the values are residuals already
constexpr int kSlowest = 0;        // encoding and decoding speed 0: the smallest output

Result<Bytes> encode(std::span<const std::int32_t> values, std::uint32_t components) {
  const auto tuples = static_cast<std::uint32_t>(values.size() / components);
  draco::PointCloud cloud;
  cloud.set_num_points(tuples);
  draco::GeometryAttribute attribute;
  attribute.Init(draco::GeometryAttribute::GENERIC, nullptr, static_cast<std::uint8_t>(components),
                 draco::DT_INT32, false,
                 static_cast<std::int64_t>(sizeof(std::int32_t) * components), 0);
  const int id = cloud.AddAttribute(attribute, true, tuples);
  for (std::uint32_t i = 0; i < tuples; ++i)
    cloud.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                           values.data() + std::size_t{i} * components);
  draco::ExpertEncoder encoder(cloud);
  encoder.SetEncodingMethod(draco::POINT_CLOUD_SEQUENTIAL_ENCODING);
  encoder.SetSpeedOptions(kSlowest, kSlowest);
  if (const draco::Status s = encoder.SetAttributePredictionScheme(id, kNoPrediction); !s.ok())
    return fail(ErrorCode::kBadCodec, "Draco: " + s.error_msg_string());
  draco::EncoderBuffer buffer;
  if (const draco::Status s = encoder.EncodeToBuffer(&buffer); !s.ok())
    return fail(ErrorCode::kBadCodec, "Draco: " + s.error_msg_string());
  return Bytes(buffer.data(), buffer.data() + buffer.size());
}

// The start of a Draco point cloud holds "DRACO", version (2 bytes), geometry type, method, flags
// (u16) and number of points (i32). Then come the numbers of attribute decoders and of attributes,
// and the attribute's type, data type and components (u8 each). A constant costs Draco no bits and
// an attribute a few bytes, so only these fields show how much a block would allocate.
bool announces(ByteView bytes, std::uint32_t components, std::uint32_t tuples) {
  constexpr std::size_t kMajorAt = 5, kTypeAt = 7, kMethodAt = 8, kMetadataAt = 10, kPointsAt = 11,
                        kAttributesAt = 15;
  const std::array<std::uint8_t, 5> attributes{1, 1, draco::GeometryAttribute::GENERIC,
                                               draco::DT_INT32,
                                               static_cast<std::uint8_t>(components)};
  return bytes.size() >= kAttributesAt + attributes.size() && bytes[kMajorAt] == 2 &&
         bytes[kTypeAt] == draco::POINT_CLOUD &&
         bytes[kMethodAt] == draco::POINT_CLOUD_SEQUENTIAL_ENCODING &&
         (bytes[kMetadataAt] & 0x80) == 0 &&
         ByteReader(bytes.subspan(kPointsAt)).read<std::uint32_t>() == tuples &&
         std::ranges::equal(bytes.subspan(kAttributesAt, attributes.size()), attributes);
}

Result<std::vector<std::int32_t>> decode(ByteView bytes, std::uint32_t components,
                                         std::uint32_t tuples) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto type = draco::Decoder::GetEncodedGeometryType(&buffer);
  if (!type.ok() || type.value() != draco::POINT_CLOUD)
    return fail(ErrorCode::kBadCodec, "the block is not a Draco point cloud");
  if (!announces(bytes, components, tuples))
    return fail(ErrorCode::kBadValue,
                "a value block is not sequential, or holds another number of tuples or components "
                "than the chunk table says");
  draco::Decoder decoder;
  const auto cloud = decoder.DecodePointCloudFromBuffer(&buffer);
  if (!cloud.ok()) return fail(ErrorCode::kBadCodec, "Draco: " + cloud.status().error_msg_string());
  const draco::PointAttribute* attribute =
      cloud.value()->num_attributes() == 1 ? cloud.value()->attribute(0) : nullptr;
  if (attribute == nullptr || attribute->data_type() != draco::DT_INT32 ||
      static_cast<std::uint32_t>(attribute->num_components()) != components ||
      cloud.value()->num_points() != tuples || attribute->size() < tuples ||
      !attribute->is_mapping_identity() ||
      attribute->byte_stride() != static_cast<std::int64_t>(sizeof(std::int32_t) * components))
    return fail(
        ErrorCode::kBadValue,
        "a value block holds another number of tuples or components than the chunk table says");
  std::vector<std::int32_t> values(std::size_t{tuples} * components);
  std::memcpy(values.data(), attribute->GetAddress(draco::AttributeValueIndex(0)),
              sizeof(std::int32_t) * values.size());
  return values;
}

// Draco throws from inside the standard library when asked for what does not fit.
template <class Work>
auto guarded(const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::exception& e) {
    return fail(ErrorCode::kBadCodec, std::string("Draco: ") + e.what());
  }
}

}  // namespace

Result<Bytes> encodeDracoBlock(std::span<const std::int32_t> values, std::uint32_t components) {
  if (values.empty()) return Bytes{};
  for (const std::int32_t v : values)
    if (v < -kMaxDracoMagnitude || v > kMaxDracoMagnitude)
      return fail(ErrorCode::kLimitExceeded,
                  "the value " + std::to_string(v) +
                      " is beyond 2^30, which Draco would lose; use fewer bits");
  Result<Bytes> bytes = guarded([&] { return encode(values, components); });
  if (!bytes) return bytes;
  const auto back =
      decodeDracoBlock(*bytes, components, static_cast<std::uint32_t>(values.size() / components));
  if (!back || !std::ranges::equal(*back, values))
    return fail(ErrorCode::kBadCodec, "Draco did not give the same values back");
  return bytes;
}

Result<std::vector<std::int32_t>> decodeDracoBlock(ByteView bytes, std::uint32_t components,
                                                   std::uint32_t tuples) {
  if (tuples == 0)
    return bytes.empty() ? Result<std::vector<std::int32_t>>{}
                         : fail(ErrorCode::kBadValue, "a value block of no values has bytes");
  return guarded([&] { return decode(bytes, components, tuples); });
}

}  // namespace qtet
