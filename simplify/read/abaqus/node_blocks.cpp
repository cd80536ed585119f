// *NODE, *SYSTEM and *NGEN.
#include <algorithm>

#include "simplify/read/abaqus/mesh_blocks.h"

namespace qtet {
namespace {

constexpr std::size_t kMostNodes = kGhost;

void addNode(AbaqusLines& lines, AbaqusPart& part, std::uint32_t number, const Position& p) {
  if (lines.failed()) return;
  if (part.mesh.points.size() >= kMostNodes)
    return lines.fail(ErrorCode::kLimitExceeded, "there are more nodes than a mesh may have");
  const auto [at, isNew] =
      part.nodes.try_emplace(number, static_cast<std::uint32_t>(part.mesh.points.size()));
  if (isNew)
    part.mesh.points.push_back(p);
  else if (part.mesh.points[at->second] != p)
    lines.fail("node " + std::to_string(number) +
               " is there already, at another place; number the nodes anew");
}

/// The letter of SYSTEM=R, C or S.
char systemOfNodes(AbaqusLines& lines) {
  const std::string* system = lines.keyword().find("SYSTEM");
  const std::string name = system ? abaqusName(*system) : "R";
  const char letter = name.empty() ? '?' : name[0];
  if (letter != 'R' && letter != 'C' && letter != 'S')
    lines.fail("SYSTEM=" + name + " is not known; R, C and S are");
  return letter;
}

const Position* nodeAt(AbaqusLines& lines, const AbaqusPart& part, std::uint32_t number) {
  const auto at = part.nodes.find(number);
  if (at != part.nodes.end()) return &part.mesh.points[at->second];
  lines.fail("*NGEN names node " + std::to_string(number) + ", which does not stand before it");
  return nullptr;
}

}  // namespace

bool nextDataLine(AbaqusLines& lines) { return lines.next() && !lines.isKeyword(); }

void readNodes(AbaqusLines& lines, AbaqusPart& part) {
  const char system = systemOfNodes(lines);
  if (const std::string* input = lines.keyword().find("INPUT")) lines.include(*input);
  while (nextDataLine(lines)) {
    if (lines.fields().empty()) continue;
    const std::uint32_t number = lines.id(0, "a node's number");
    Position p{};
    for (std::size_t k = 0; k < 3; ++k) p[k] = lines.real(k + 1, "a coordinate");
    if (system == 'C') p = fromCylindrical(p);
    if (system == 'S') p = fromSpherical(p);
    addNode(lines, part, number, part.system(p));
  }
}

void readSystem(AbaqusLines& lines, AbaqusPart& part) {
  std::vector<double> numbers;
  while (nextDataLine(lines)) {
    const std::size_t count = lines.fields().size() > 3 ? 6 : 3;
    // a second line of one more point follows two points
    if (!numbers.empty() && (numbers.size() != 6 || count != 3))
      return lines.fail("*SYSTEM has one point, two, or two and a third in a second line");
    for (std::size_t k = 0; k < count; ++k) numbers.push_back(lines.real(k, "a coordinate"));
  }
  if (lines.failed()) return;
  const auto system = systemOf(numbers);
  if (!system) return lines.fail("the points of the *SYSTEM above define no axes");
  part.system = *system;
}

void generateNodes(AbaqusLines& lines, AbaqusPart& part, std::uint64_t& generated) {
  if (const std::string* line = lines.keyword().find("LINE"))
    return lines.fail("*NGEN with LINE=" + *line +
                      " is not read, but straight lines are; write the nodes themselves");
  if (const std::string* system = lines.keyword().find("SYSTEM");
      system && !abaqusName(*system).starts_with('R'))
    return lines.fail("*NGEN with SYSTEM=" + *system + " is not read; write the nodes themselves");
  while (nextDataLine(lines)) {
    const std::uint32_t first = lines.id(0, "a node's number"),
                        last = lines.id(1, "a node's number"),
                        step = std::max(1U, lines.id(2, "an increment"));
    if (lines.failed()) return;
    const std::uint32_t distance = std::max(first, last) - std::min(first, last),
                        steps = distance / step;
    if (distance % step != 0)
      return lines.fail("*NGEN from node " + std::to_string(first) + " does not come to node " +
                        std::to_string(last) + " by increments of " + std::to_string(step) +
                        "; write the nodes themselves");
    const Position *a = nodeAt(lines, part, first), *b = nodeAt(lines, part, last);
    if (!a || !b) return;
    const Position from = *a, to = *b;
    generated += steps;
    if (generated > mostGenerated(lines.bytes()))
      return lines.fail(ErrorCode::kLimitExceeded,
                        "*NGEN makes too many nodes for so small a file; write them themselves");
    for (std::uint32_t i = 1; i < steps && !lines.failed(); ++i) {
      if (i % kGeneratedBetweenLooks == 0) lines.look();
      Position p{};
      for (std::size_t k = 0; k < 3; ++k) p[k] = from[k] + (to[k] - from[k]) * i / steps;
      addNode(lines, part, first < last ? first + i * step : first - i * step, p);
    }
  }
}

}  // namespace qtet
