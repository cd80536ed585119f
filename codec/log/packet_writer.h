// The bands of the layout `regions`: one packet for each node of the tree, behind a head of level
// runs (FORMAT.md, "Packets").
#pragma once

#include <cstdint>
#include <vector>

#include "codec/log/log_writer.h"
#include "codec/log/record_writer.h"
#include "codec/mesh/node_cells.h"
#include "codec/record/child_coder.h"

namespace qtet {

/// The levels that keep to the nodes at one depth.
struct Band {
  std::uint32_t firstLevel = 0, lastLevel = 0, depth = 0;
};

/// The history's bands as levels of the log, coarsest first; none: the layout is `stream`. Errors:
/// bad-value (bands that contradict the history).
[[nodiscard]] Result<std::vector<Band>> bandsOf(const FusionHistory& history);

class PacketWriter {
 public:
  /// All must outlive it. REQUIRES: bands, which bandsOf() gave.
  PacketWriter(const FusionHistory& history, const std::vector<Band>& bands, RecordWriter& writer);

  /// Writes the end of the head, whose last chunk is open, and closes it: which of the first band's
  /// nodes each cell belongs to.
  Status endHead();
  /// Writes the packets of a band. REQUIRES: endHead(), and the bands before.
  Status write(const Band& band);
  /// Fills in the boxes of the packets' rows. REQUIRES: all bands written.
  void findBoxes();
  /// The bytes of all nodes' child bits, accurate to a byte a node.
  [[nodiscard]] std::uint64_t childBytes() const { return childBytes_; }

 private:
  /// The models as the head left them: what every packet starts from.
  struct HeadModels {
    RecordModels records;
    ChildModels children;
  };

  Status packet(const Band& band, std::uint32_t node);
  Status level(std::uint32_t level, std::vector<VertexId>& inner);
  Status children(std::uint32_t node, const NodeCells& cells);
  [[nodiscard]] bool inNode(const NodeCells& cells, std::uint32_t node) const;
  [[nodiscard]] std::uint32_t nodeOf(CellRef cell, std::uint32_t depth) const {
    return 1u << depth | history_.bands.node(writer_.mirror().cellOf(cell), depth);
  }

  const FusionHistory& history_;
  const std::vector<Band>& bands_;
  RecordWriter& writer_;
  ChildModels models_;
  HeadModels head_;
  std::vector<NodeCells> waiting_;  // by node
  VertexCounts counts_;
  std::uint64_t childBytes_ = 0;
};

}  // namespace qtet
