// Everything that is unusual or wrong about a mesh file, found in one go, with what simplifying
// would do about it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "simplify/clean/clean_mesh.h"
#include "simplify/read/options/read_options.h"

namespace qtet {

enum class Verdict {
  kRefused,   ///< `qtet simplify` would end with an error
  kRepaired,  ///< it changes the mesh so that this is gone
  kKept,      ///< it takes it as it is
};
[[nodiscard]] const char* verdictName(Verdict verdict);

struct Finding {
  std::string kind;  ///< "invertedCells": stable, for scripts
  Verdict verdict = Verdict::kKept;
  std::string text;  ///< what it is, for people
  std::string what;  ///< the kind of the numbers: "cell", "point", "value", ""
  /// Cells as numbered in the file, points too; empty where a sentence is all there is.
  Occurrences found;
  std::string advice;  ///< what to do, or empty
};

struct CheckReport {
  /// After splitting; 0 where the file could not be read.
  std::uint64_t points = 0, tetrahedra = 0;
  ReadReport read;
  std::vector<std::string> fields;  ///< "point NAME (float32 x 3)"
  std::uint64_t components = 0;
  CleanReport clean;              ///< empty where the mesh is refused
  std::vector<Finding> findings;  ///< the refused first
  [[nodiscard]] bool refused() const;
};

/// Reads the file as the options say, splits its cells and looks at everything. A file that cannot
/// be read is a finding too, so nothing fails.
[[nodiscard]] CheckReport checkMesh(const std::filesystem::path& path, const ReadOptions& options);

}  // namespace qtet
