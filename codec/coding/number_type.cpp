#include "codec/coding/number_type.h"

#include <algorithm>
#include <span>
#include <type_traits>

#include "codec/coding/float_bits.h"
#include "codec/coding/nearest_integer.h"

namespace qtet {
namespace {

template <class T>
T nearest(double value) {
  if constexpr (std::is_same_v<T, float>) {
    return narrowed(value);
  } else if constexpr (std::is_floating_point_v<T>) {
    return value;
  } else {
    // The limits of 64-bit integers are no doubles: compare with the powers of two around them.
    if (std::isnan(value)) return 0;
    const double rounded = nearestInteger(value);
    if (rounded <= static_cast<double>(std::numeric_limits<T>::min()))
      return std::numeric_limits<T>::min();
    if (rounded >= static_cast<double>(std::numeric_limits<T>::max()))
      return std::numeric_limits<T>::max();
    return static_cast<T>(rounded);
  }
}

template <class T, std::endian order>
void appendAll(Bytes& out, std::span<const double> values) {
  for (const double value : values) appendNumber<order>(out, nearest<T>(value));
}

template <class T>
constexpr NumberType typeOf(std::string_view name, std::string_view xmlName,
                            std::string_view legacyName, std::string_view numpyName) {
  return {name,
          xmlName,
          legacyName,
          numpyName,
          sizeof(T),
          appendAll<T, std::endian::little>,
          appendAll<T, std::endian::big>};
}

constexpr std::array<NumberType, 10> kNumberTypes{{
    typeOf<double>("float64", "Float64", "double", "<f8"),
    typeOf<float>("float32", "Float32", "float", "<f4"),
    typeOf<std::int8_t>("int8", "Int8", "signed_char", "|i1"),
    typeOf<std::uint8_t>("uint8", "UInt8", "unsigned_char", "|u1"),
    typeOf<std::int16_t>("int16", "Int16", "short", "<i2"),
    typeOf<std::uint16_t>("uint16", "UInt16", "unsigned_short", "<u2"),
    typeOf<std::int32_t>("int32", "Int32", "int", "<i4"),
    typeOf<std::uint32_t>("uint32", "UInt32", "unsigned_int", "<u4"),
    typeOf<std::int64_t>("int64", "Int64", "vtktypeint64", "<i8"),
    typeOf<std::uint64_t>("uint64", "UInt64", "vtktypeuint64", "<u8"),
}};

}  // namespace

const NumberType& numberType(std::string_view name) {
  const std::span types(kNumberTypes);
  const auto found = std::ranges::find(types, name, &NumberType::name);
  return found == types.end() ? types.front() : *found;
}

}  // namespace qtet
