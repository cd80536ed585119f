#include "simplify/read/steps/common_type.h"

#include <algorithm>
#include <cstdint>

#include "codec/coding/number_type.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

std::string commonType(const std::string& a, const std::string& b) {
  const std::uint64_t bytesOfA = numberType(a).sizeBytes, bytesOfB = numberType(b).sizeBytes;
  const bool isFloatA = isFloatType(a), isFloatB = isFloatType(b);
  if (isFloatA != isFloatB) {
    const std::uint64_t bytesOfInteger = isFloatA ? bytesOfB : bytesOfA;
    return bytesOfInteger > 2 ? "float64" : isFloatA ? a : b;
  }
  const bool isUnsignedA = a.starts_with('u'), isUnsignedB = b.starts_with('u');
  if (isUnsignedA == isUnsignedB) return bytesOfA >= bytesOfB ? a : b;
  const std::uint64_t bytes =
      isUnsignedA ? std::max(2 * bytesOfA, bytesOfB) : std::max(bytesOfA, 2 * bytesOfB);
  return "int" + std::to_string(8 * std::min<std::uint64_t>(bytes, 8));
}

}  // namespace qtet
