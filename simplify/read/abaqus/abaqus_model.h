// The mesh of an Abaqus or CalculiX file with the file's own numbers and names.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "simplify/read/abaqus/element_numbers.h"
#include "simplify/read/abaqus/placement.h"
#include "simplify/read/process/reading_time.h"
#include "simplify/read/text/plain_numbers.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// first, first + step ... up to last.
struct NumberRange {
  std::uint32_t first = 0, last = 0, step = 1;
};

/// Elements by number, and sets by name, of one instance or of the present part.
struct AbaqusSetPiece {
  std::string instance;  ///< by abaqusName; empty: the present part
  std::vector<NumberRange> ranges;
  std::vector<std::string> names;  ///< by abaqusName
};

struct AbaqusSet {
  std::string name;         ///< as it stands
  bool isInternal = false;  ///< a program made it for itself
  std::vector<AbaqusSetPiece> pieces;
};

/// A section gives elements their material.
struct AbaqusSection {
  std::string set;       ///< by abaqusName
  std::string material;  ///< as it stands
};

/// Nodes and elements that are numbered together: a part, an instance with nodes of its own, or
/// what stands outside of parts.
struct AbaqusPart {
  std::string name;             ///< as it stands
  CellMesh mesh;                ///< whose cells have the file's numbers of nodes
  NumberTable nodes;            ///< the places of nodes in mesh.points
  ElementNumbers numbers;       ///< of the cells
  std::vector<AbaqusSet> sets;  ///< in the file's order
  std::map<std::string, std::size_t, std::less<>> setNumbers;  ///< by abaqusName
  std::vector<AbaqusSection> sections;
  AbaqusPlacement system;  ///< of nodes that follow

  /// The set of that name, a new one where there is none.
  AbaqusSet& set(const std::string& name);
};

struct AbaqusInstance {
  std::string name;  ///< as it stands
  std::size_t part = 0;
  AbaqusPlacement placement;
};

struct AbaqusModel {
  std::vector<AbaqusPart> parts{1};  ///< the first: what stands outside of parts
  std::vector<AbaqusInstance> instances;
  std::uint64_t bytes = 0;         ///< of the files, each counted once
  std::uint64_t ignoredCells = 0;  ///< elements that are no volumes
  ReadingTime time;                ///< of which the lines took a part
};

/// The most nodes, elements, and copies of them that lines may make which do not list them: *NGEN,
/// *ELGEN and instances of parts.
[[nodiscard]] inline std::uint64_t mostGenerated(std::uint64_t bytes) {
  return (std::uint64_t{1} << 20) + 16 * bytes;
}

}  // namespace qtet
