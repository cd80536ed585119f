// How good a mesh somebody asks for (STREAM.md, "Target"): a stream, a level of the HTTP API, and
// the tool's options choose by the same words.
#pragma once

#include <cstdint>
#include <string>
#include <variant>

namespace qtet {

struct EverythingTarget {};
struct LevelTarget {
  std::uint32_t level = 0;
};
struct BytesTarget {
  std::uint64_t bytes = 0;
};
struct TetrahedraTarget {
  std::uint64_t tetrahedra = 0;
};
struct FieldErrorTarget {
  double error = 0;     ///< rms, as a fraction of the field's range
  std::string field{};  ///< its key (field_key.h)
};
struct BoundaryErrorTarget {
  double error = 0;  ///< as a fraction of the diagonal
};
using Target = std::variant<EverythingTarget, LevelTarget, BytesTarget, TetrahedraTarget,
                            FieldErrorTarget, BoundaryErrorTarget>;

}  // namespace qtet
