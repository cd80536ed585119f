// Results at nodes of universal files: datasets 55 and 2414.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "simplify/read/text/mesh_scanner.h"
#include "simplify/read/text/plain_numbers.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

class UnvResults {
 public:
  /// Both must outlive it. Notes name the results that are not read.
  UnvResults(MeshScanner& in, std::vector<std::string>& notes) : in_(in), notes_(notes) {}

  /// Reads a dataset behind its number, with the -1 at its end. A result takes the place of another
  /// of its name. false: this is no dataset of results, and nothing was read.
  bool read(std::string_view dataset);
  /// Adds them as point fields. `nodes`: where the file's nodes are among the mesh's points.
  void addTo(CellMesh& mesh, const NumberTable& nodes) const;

 private:
  /// Both datasets say this of a result, in the same numbers.
  struct Head {
    std::string name;
    bool isAtNodes = true;
    std::int64_t characteristic = 0;  ///< scalar, vector, tensor
    std::int64_t kind = 0;            ///< real or complex
    std::int64_t components = 0;
  };
  /// A tuple for each of `nodes`.
  struct Values {
    std::string type;
    std::uint32_t components = 1;
    std::vector<std::uint32_t> nodes;
    std::vector<double> values;
  };

  /// The line of six numbers. `called`: what the dataset calls the result; "" or NONE: nothing.
  Head head(std::string_view called, const std::array<std::string, 5>& idLines);
  void read55();
  void read2414();
  void readValues(const Head& head);
  /// A file may have a thousand datasets of which one thing is to be said.
  void note(const std::string& text);

  MeshScanner& in_;
  std::vector<std::string>& notes_;
  std::map<std::string, Values> results_;
  std::set<std::string> noted_;
};

}  // namespace qtet
