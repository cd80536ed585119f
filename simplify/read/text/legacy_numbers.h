// The numbers of legacy VTK files: as text, or as big-endian bytes behind the line that announces
// them.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "simplify/read/text/mesh_scanner.h"
#include "simplify/read/vtu/vtu_document.h"

namespace qtet {

struct LegacyType {
  std::string_view word;  ///< in the file, in small letters
  VtuNumber number;       ///< one with numbers
  const char* name;       ///< as MeshField's
  [[nodiscard]] bool isFloat() const {
    return number == VtuNumber::kFloat32 || number == VtuNumber::kFloat64;
  }
};

/// Null for bits, texts and unknown words. `word` may have capitals.
[[nodiscard]] const LegacyType* legacyType(std::string_view word);

/// Numbers that follow in the file.
struct LegacyRun {
  std::uint64_t count;
  VtuNumber type;
  const char* what;  ///< "cell types", for errors
};

/// Reads the numbers; nothing is allocated before the bytes that they need are there. Floats become
/// doubles with every bit of a NaN. The scanner has the error.
[[nodiscard]] std::vector<double> legacyReals(MeshScanner& in, bool areBytes, const LegacyRun& run);
/// The same as integers; a float becomes -1.
[[nodiscard]] std::vector<std::int64_t> legacyIntegers(MeshScanner& in, bool areBytes,
                                                       const LegacyRun& run);

/// In small letters.
[[nodiscard]] std::string lowered(std::string_view text);

}  // namespace qtet
