// *ELEMENT and *ELGEN.
#include <algorithm>
#include <array>

#include "simplify/read/abaqus/element_shape.h"
#include "simplify/read/abaqus/mesh_blocks.h"

namespace qtet {
namespace {

constexpr std::size_t kMaxNodes = 27;

/// Adds numbers to a set; numbers that follow each other take one range.
class SetWriter {
 public:
  SetWriter(AbaqusLines& lines, AbaqusPart& part) {
    const std::string* name = lines.keyword().find("ELSET");
    if (!name || name->empty()) return;
    AbaqusSet& set = part.set(*name);
    set.pieces.emplace_back();
    ranges_ = &set.pieces.back().ranges;
  }
  void add(std::uint32_t number) {
    if (!ranges_) return;
    if (!ranges_->empty() && ranges_->back().last + 1 == number)
      ranges_->back().last = number;
    else
      ranges_->push_back({number, number, 1});
  }

 private:
  std::vector<NumberRange>* ranges_ = nullptr;
};

/// An element that is there already with the same nodes is not added again.
void addCell(AbaqusLines& lines, AbaqusPart& part, std::uint8_t type, std::uint32_t number,
             std::span<const VertexId> nodes) {
  const CellMesh& mesh = part.mesh;
  const std::optional<std::uint32_t> there = part.numbers.cellOf(number);
  if (there && mesh.types[*there] == type && std::ranges::equal(mesh.cell(*there), nodes)) return;
  if (there)
    return lines.fail("element " + std::to_string(number) +
                      " is there already, with other nodes or of another shape; number the "
                      "elements anew");
  part.mesh.addCell(type, nodes);
  part.numbers.add(number);
}

void addCell(AbaqusLines& lines, AbaqusPart& part, const AbaqusElement& kind, std::uint32_t number,
             std::span<const VertexId> nodes) {
  std::array<VertexId, kMaxNodes> ordered{};
  for (std::size_t i = 0; i < kind.nodes; ++i)
    ordered[i] = nodes[kind.order.empty() ? i : kind.order[i]];
  addCell(lines, part, kind.type, number, std::span(ordered).first(kind.nodes));
}

std::optional<AbaqusElement> kindOf(AbaqusLines& lines) {
  const std::string* type = lines.keyword().find("TYPE");
  if (!type) {
    lines.fail("*ELEMENT has no TYPE");
    return std::nullopt;
  }
  const std::optional<AbaqusElement> kind = abaqusElement(abaqusName(*type));
  // two programs call different things so
  if (abaqusName(*type) == "F3D4")
    lines.fail(
        "elements of type F3D4 are tetrahedra in CalculiX and flat in Abaqus; give "
        "tetrahedra the type C3D4, and take flat ones out");
  else if (!kind)
    lines.fail("elements of type " + abaqusName(*type) +
               " are not known: whether they are volumes and of what shape; give them another "
               "type such as C3D8");
  return kind;
}

/// Elements that are no volumes: a new one begins where the line before does not go on.
std::uint64_t countElements(AbaqusLines& lines) {
  std::uint64_t count = 0;
  bool goesOn = false;
  while (nextDataLine(lines)) {
    if (!goesOn) ++count;
    goesOn = lines.goesOn();
  }
  return count;
}

/// A row's number of elements, and what to add to nodes and elements from one to the next.
struct Row {
  std::uint32_t count = 1, nodes = 0, elements = 0;
};

/// An increment that is not there is 1.
std::uint32_t increment(AbaqusLines& lines, std::size_t field, const char* what) {
  const bool isThere = field < lines.fields().size() && !lines.fields()[field].empty();
  return isThere ? lines.id(field, what) : 1;
}

Row rowOf(AbaqusLines& lines, std::size_t field) {
  return {std::max(1U, lines.id(field, "a number of elements")),
          increment(lines, field + 1, "an increment of nodes"),
          increment(lines, field + 2, "an increment of elements")};
}

}  // namespace

void readElements(AbaqusLines& lines, AbaqusPart& part, std::uint64_t& ignored) {
  const std::optional<AbaqusElement> kind = kindOf(lines);
  if (!kind) return;
  const std::string type = *lines.keyword().find("TYPE");
  SetWriter set(lines, part);
  if (const std::string* input = lines.keyword().find("INPUT")) lines.include(*input);
  if (kind->type == 0) {
    ignored += countElements(lines);
    return;
  }
  std::array<VertexId, kMaxNodes> nodes{};
  std::size_t found = 0;
  std::uint32_t number = 0;
  bool hasNumber = false, goesOn = false;
  while (nextDataLine(lines)) {
    // nodes on faces may follow on a line of their own
    const bool isMore = found == kind->nodes && goesOn && kind->mayHaveMore;
    if (found == kind->nodes && !isMore) hasNumber = false;
    std::size_t at = 0;
    if (!hasNumber) {
      number = lines.id(at++, "an element's number");
      hasNumber = true;
      found = 0;
    }
    goesOn = lines.goesOn();
    if (isMore) continue;
    for (; at < lines.fields().size() && found < kind->nodes; ++at)
      nodes[found++] = lines.id(at, "a node's number");
    if (lines.failed()) return;
    if (at < lines.fields().size() && !kind->mayHaveMore)
      return lines.fail("element " + std::to_string(number) + " of type " + type + " has " +
                        std::to_string(found + lines.fields().size() - at) +
                        " nodes; it should have " + std::to_string(kind->nodes));
    if (found < kind->nodes) continue;
    addCell(lines, part, *kind, number, nodes);
    set.add(number);
  }
  if (hasNumber && found < kind->nodes)
    lines.fail("element " + std::to_string(number) + " of type " + type + " ends after " +
               std::to_string(found) + " nodes; it should have " + std::to_string(kind->nodes));
}

void generateElements(AbaqusLines& lines, AbaqusPart& part, std::uint64_t& generated) {
  SetWriter set(lines, part);
  while (nextDataLine(lines)) {
    const std::uint32_t master = lines.id(0, "an element's number");
    const std::array<Row, 3> rows{rowOf(lines, 1), rowOf(lines, 4), rowOf(lines, 7)};
    if (lines.failed()) return;
    const std::optional<std::uint32_t> cell = part.numbers.cellOf(master);
    // a shell or the like
    if (!cell) continue;
    std::uint64_t count = 1;
    for (const Row& row : rows) count = std::min(count * row.count, std::uint64_t{kGhost});
    generated += count;
    if (generated > mostGenerated(lines.bytes()))
      return lines.fail(ErrorCode::kLimitExceeded,
                        "*ELGEN makes too many elements for so small a file; write them "
                        "themselves");
    const std::uint8_t type = part.mesh.types[*cell];
    const std::vector<VertexId> nodes(part.mesh.cell(*cell).begin(), part.mesh.cell(*cell).end());
    std::vector<VertexId> moved(nodes.size());
    for (std::uint64_t i = 0; i < count; ++i) {
      if (i % kGeneratedBetweenLooks == 0) lines.look();
      if (lines.failed()) return;
      const std::array<std::uint64_t, 3> steps{i % rows[0].count, i / rows[0].count % rows[1].count,
                                               i / rows[0].count / rows[1].count};
      std::uint64_t number = master, shift = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        number += steps[k] * rows[k].elements;
        shift += steps[k] * rows[k].nodes;
      }
      if (number >= kGhost || *std::ranges::max_element(nodes) + shift >= kGhost)
        return lines.fail("*ELGEN makes numbers that are too large");
      set.add(static_cast<std::uint32_t>(number));
      if (i == 0) continue;
      std::ranges::transform(nodes, moved.begin(),
                             [&](VertexId node) { return static_cast<VertexId>(node + shift); });
      addCell(lines, part, type, static_cast<std::uint32_t>(number), moved);
    }
  }
}

}  // namespace qtet
