#include "codec/log/packet_writer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <string>
#include <utility>

namespace qtet {
namespace {

// Twice as many packets as leaves stay below kMaxChunks.
constexpr std::uint32_t kMaxDepth = 18;

Status failBeyondNode() {
  return fail(
      ErrorCode::kBadValue,
      "the history's bands: a fusion reaches beyond a node of the tree; simplify the mesh again");
}

void grow(PacketBox& box, const PacketBox& by) {
  for (std::size_t a = 0; a < 3; ++a) {
    box.least[a] = std::min(box.least[a], by.least[a]);
    box.most[a] = std::max(box.most[a], by.most[a]);
  }
}

}  // namespace

// The history may have lost its coarsest levels since it was made: bands are what is left of them.
Result<std::vector<Band>> bandsOf(const FusionHistory& history) {
  const Bands& bands = history.bands;
  if (bands.ends.empty()) return {};
  const auto bad = [](const char* what) {
    return fail(ErrorCode::kBadValue,
                std::string("the history's bands: ") + what + "; simplify the mesh again");
  };
  if (bands.depth > kMaxDepth || bands.ends.size() > bands.depth)
    return bad("more than the tree has depths, or a tree too deep");
  if (bands.leaf.size() != history.cells.size()) return bad("not every cell has a leaf");
  if (std::ranges::any_of(bands.leaf, [&](std::uint32_t leaf) { return leaf >> bands.depth != 0; }))
    return bad("a leaf that the tree does not have");
  std::vector<Band> out;
  for (std::uint32_t b = 0, first = 0; b < bands.ends.size() && first < history.levels; ++b) {
    if (bands.ends[b] <= first) return bad("one without a level");
    const std::uint32_t end = std::min(bands.ends[b], history.levels);
    out.push_back({history.levels - end + 1, history.levels - first, bands.depth - b});
    first = end;
  }
  std::ranges::reverse(out);
  return out;
}

PacketWriter::PacketWriter(const FusionHistory& history, const std::vector<Band>& bands,
                           RecordWriter& writer)
    : history_(history),
      bands_(bands),
      writer_(writer),
      waiting_(std::size_t{2} << history.bands.depth) {
  assert(!bands.empty() && bands.back().depth <= history.bands.depth);
}

Status PacketWriter::endHead() {
  waiting_[1].add({}, writer_.mesh().next());
  for (std::uint32_t node = 1; node < 1u << bands_.front().depth; ++node)
    if (Status s = children(node, std::exchange(waiting_[node], {})); !s) return s;
  head_.records = writer_.models();
  head_.children = models_;
  return writer_.closeChunk(bands_.front().firstLevel - 1, kLevelEnd);
}

Status PacketWriter::children(std::uint32_t node, const NodeCells& cells) {
  const auto depth = static_cast<std::uint32_t>(std::bit_width(node));  // of the children
  bool inNode = true;
  const auto truth = [&](CellRef cell) {
    const std::uint32_t child = nodeOf(cell, depth);
    inNode &= child / 2 == node;
    return static_cast<int>(child & 1u);
  };
  std::array<NodeCells, 2> halves;
  RangeEncoder& structure = writer_.chunks().structure();
  const std::size_t before = structure.size();
  writer_.meter().spend(cells.size());
  ChildCoder<RangeEncoder> coder(structure, models_, writer_.mesh(), history_.lattice.bits,
                                 counts_);
  if (!coder.code(cells, truth, halves) || !inNode) return failBeyondNode();
  childBytes_ += structure.size() - before;
  for (std::uint32_t i = 0; i < 2; ++i) waiting_[2 * node + i] = std::move(halves[i]);
  return {};
}

Status PacketWriter::write(const Band& band) {
  [[maybe_unused]] const std::uint32_t last = writer_.chunks().rows().back().node;
  assert(last == (band.depth == bands_.front().depth ? 0 : (1u << band.depth) - 1));
  for (std::uint32_t node = 1u << band.depth; node < 2u << band.depth; ++node)
    if (Status s = packet(band, node); !s) return s;
  return {};
}

// The mirror of PacketReader::read.
Status PacketWriter::packet(const Band& band, std::uint32_t node) {
  writer_.models() = head_.records;
  models_ = head_.children;
  writer_.chunks().begin(band.firstLevel, node);
  NodeCells cells = std::exchange(waiting_[node], {});
  const Slots first = writer_.mesh().next();
  std::vector<VertexId> inner = innerVertices(writer_.mesh(), cells, counts_);
  for (std::uint32_t l = band.firstLevel; l <= band.lastLevel; ++l)
    if (Status s = level(l, inner); !s) return s;
  cells.add(first, writer_.mesh().next());
  if (band.depth < history_.bands.depth) {
    if (Status s = children(node, cells); !s) return s;
  } else if (!inNode(cells, node)) {
    return failBeyondNode();
  }
  return writer_.closeChunk(band.lastLevel, kLevelEnd);
}

Status PacketWriter::level(std::uint32_t level, std::vector<VertexId>& inner) {
  GrowingMesh& mesh = writer_.mesh();
  mesh.beginLevel(level);
  writer_.meter().spend(1);
  const VertexId firstNew = mesh.next().vertices;
  const std::size_t vertices = inner.size();
  for (std::size_t i = 0; i < vertices; ++i) {
    if (!mesh.maysplit(inner[i])) continue;
    const Fusion* fusion = writer_.flag(inner[i]);
    if (fusion == nullptr) continue;
    if (Status s = writer_.record(inner[i], *fusion); !s) return s;
  }
  for (VertexId v = firstNew; v < mesh.next().vertices; ++v) inner.push_back(v);
  return {};
}

bool PacketWriter::inNode(const NodeCells& cells, std::uint32_t node) const {
  const auto depth = static_cast<std::uint32_t>(std::bit_width(node)) - 1;
  bool all = true;
  cells.forEach([&](CellRef cell) { all &= nodeOf(cell, depth) == node; });
  return all;
}

// A leaf's box is that of its cells, which are all there now. The box of any other node is that of
// its children.
void PacketWriter::findBoxes() {
  std::vector<ChunkEntry>& rows = writer_.chunks().rows();
  const auto first =
      std::ranges::find_if(rows, [](const ChunkEntry& row) { return row.node != 0; });
  const std::uint32_t firstNode = 1u << bands_.front().depth;
  const auto boxOf = [&](std::uint32_t node) -> PacketBox& { return first[node - firstNode].box; };
  for (auto row = first; row != rows.end(); ++row) row->box = {{255, 255, 255}, {0, 0, 0}};
  const GrowingMesh& mesh = writer_.mesh();
  const std::uint32_t depth = bands_.back().depth;
  assert(rows.back().node == (2u << depth) - 1);
  for (CellId t = 0; t < mesh.tetrahedra.size(); ++t)
    for (const VertexId v : mesh.tetrahedra[t]) {
      std::array<std::uint8_t, 3> at{};
      for (std::size_t a = 0; a < 3; ++a)
        at[a] = static_cast<std::uint8_t>((std::int64_t{mesh.points[v][a]} << 8) >>
                                          history_.lattice.bits);
      grow(boxOf(nodeOf(CellRef{t}, depth)), {at, at});
    }
  for (std::uint32_t node = (2u << depth) - 1; node >= 2 * firstNode; --node)
    grow(boxOf(node / 2), boxOf(node));
}

}  // namespace qtet
