// Numbers of universal files, whose datasets stand between lines of -1.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "codec/mesh/mesh.h"
#include "simplify/read/text/mesh_scanner.h"
#include "simplify/read/text/plain_numbers.h"

namespace qtet {

/// The next word as a label, or -1 where the dataset ends.
[[nodiscard]] inline std::int64_t unvLabel(MeshScanner& in) {
  return in.number<std::int64_t>("a label or -1");
}

[[nodiscard]] inline double unvReal(MeshScanner& in) {
  const std::string_view word = in.word();
  const std::optional<double> value = fortranReal(word);
  if (!value)
    in.fail(ErrorCode::kBadInput, "'" + std::string(word.substr(0, 20)) +
                                      "' is no number; the file is damaged, export it again");
  return value.value_or(0);
}

/// Whether it can be the number of a node; an error if not.
[[nodiscard]] inline bool isUnvNode(MeshScanner& in, std::int64_t node) {
  if (node >= 0 && node < std::int64_t{kGhost}) return true;
  in.fail(ErrorCode::kBadInput, std::to_string(node) +
                                    " is no number of a node; the file is damaged, export it "
                                    "again");
  return false;
}

/// Passes the rest of a dataset, with the -1 at its end.
inline void skipUnvDataset(MeshScanner& in) {
  while (!in.atEnd() && in.line() != "-1") {
  }
}

}  // namespace qtet
