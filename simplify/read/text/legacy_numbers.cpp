#include "simplify/read/text/legacy_numbers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <span>
#include <type_traits>

#include "codec/coding/float_bits.h"

namespace qtet {
namespace {

/// VTK writes vtkIdType with 32 bits, and keeps it with 64.
constexpr std::array<LegacyType, 14> kTypes{{{"char", VtuNumber::kInt8, "int8"},
                                             {"signed_char", VtuNumber::kInt8, "int8"},
                                             {"unsigned_char", VtuNumber::kUInt8, "uint8"},
                                             {"short", VtuNumber::kInt16, "int16"},
                                             {"unsigned_short", VtuNumber::kUInt16, "uint16"},
                                             {"int", VtuNumber::kInt32, "int32"},
                                             {"unsigned_int", VtuNumber::kUInt32, "uint32"},
                                             {"long", VtuNumber::kInt64, "int64"},
                                             {"vtktypeint64", VtuNumber::kInt64, "int64"},
                                             {"unsigned_long", VtuNumber::kUInt64, "uint64"},
                                             {"vtktypeuint64", VtuNumber::kUInt64, "uint64"},
                                             {"vtkidtype", VtuNumber::kInt32, "int64"},
                                             {"float", VtuNumber::kFloat32, "float32"},
                                             {"double", VtuNumber::kFloat64, "float64"}}};

template <class Out, class T>
Out converted(T number) {
  if constexpr (std::is_same_v<Out, std::int64_t>)
    return std::is_floating_point_v<T> ? -1 : static_cast<std::int64_t>(number);
  else if constexpr (std::is_same_v<T, float>)
    return widened(number);
  else
    return static_cast<double>(number);
}

template <class T>
T textNumber(MeshScanner& in, const char* what) {
  if constexpr (sizeof(T) == 1)  // as a number, not as a letter
    return static_cast<T>(in.number<std::int16_t>(what));
  else
    return in.number<T>(what);
}

template <class T>
T byteNumber(MeshScanner& in, const char* what) {
  auto digits = in.raw<std::array<std::uint8_t, sizeof(T)>>(what);
  std::ranges::reverse(digits);
  return std::bit_cast<T>(digits);
}

template <class Out, class T>
std::vector<Out> numbersOf(MeshScanner& in, bool areBytes, const LegacyRun& run) {
  std::vector<Out> out;
  if (areBytes) in.skipLine();
  if (!in.fits(run.count, areBytes ? sizeof(T) : kMinTextBytes, run.what)) return out;
  out.reserve(run.count);
  for (std::uint64_t i = 0; i < run.count && !in.failed(); ++i)
    out.push_back(
        converted<Out>(areBytes ? byteNumber<T>(in, run.what) : textNumber<T>(in, run.what)));
  return out;
}

template <class Out>
std::vector<Out> numbers(MeshScanner& in, bool areBytes, const LegacyRun& run) {
  switch (run.type) {
    case VtuNumber::kInt8: return numbersOf<Out, std::int8_t>(in, areBytes, run);
    case VtuNumber::kUInt8: return numbersOf<Out, std::uint8_t>(in, areBytes, run);
    case VtuNumber::kInt16: return numbersOf<Out, std::int16_t>(in, areBytes, run);
    case VtuNumber::kUInt16: return numbersOf<Out, std::uint16_t>(in, areBytes, run);
    case VtuNumber::kInt32: return numbersOf<Out, std::int32_t>(in, areBytes, run);
    case VtuNumber::kUInt32: return numbersOf<Out, std::uint32_t>(in, areBytes, run);
    case VtuNumber::kInt64: return numbersOf<Out, std::int64_t>(in, areBytes, run);
    case VtuNumber::kUInt64: return numbersOf<Out, std::uint64_t>(in, areBytes, run);
    case VtuNumber::kFloat32: return numbersOf<Out, float>(in, areBytes, run);
    case VtuNumber::kFloat64: return numbersOf<Out, double>(in, areBytes, run);
    default: return {};
  }
}

}  // namespace

const LegacyType* legacyType(std::string_view word) {
  const std::span types(kTypes);
  const auto at = std::ranges::find(types, lowered(word), &LegacyType::word);
  return at == types.end() ? nullptr : &*at;
}

std::vector<double> legacyReals(MeshScanner& in, bool areBytes, const LegacyRun& run) {
  return numbers<double>(in, areBytes, run);
}

std::vector<std::int64_t> legacyIntegers(MeshScanner& in, bool areBytes, const LegacyRun& run) {
  return numbers<std::int64_t>(in, areBytes, run);
}

std::string lowered(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

}  // namespace qtet
