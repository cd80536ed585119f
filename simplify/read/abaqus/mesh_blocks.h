// The blocks of an Abaqus file that have nodes and elements. Each function begins at the block's
// keyword and ends before the next one, or at an error of `lines`.
#pragma once

#include <cstdint>

#include "simplify/read/abaqus/abaqus_lines.h"
#include "simplify/read/abaqus/abaqus_model.h"

namespace qtet {

/// After so many nodes or elements that one line makes, the clock is asked.
inline constexpr std::uint32_t kGeneratedBetweenLooks = 1 << 14;

/// The data lines of a block, by while (nextDataLine(lines)). REQUIRES: the line is the block's
/// keyword. Afterwards the line is the next keyword, if there is one.
bool nextDataLine(AbaqusLines& lines);

/// *NODE
void readNodes(AbaqusLines& lines, AbaqusPart& part);
/// *SYSTEM
void readSystem(AbaqusLines& lines, AbaqusPart& part);
/// *NGEN along straight lines. `generated` counts nodes.
void generateNodes(AbaqusLines& lines, AbaqusPart& part, std::uint64_t& generated);
/// *ELEMENT. `ignored` counts elements that are no volumes.
void readElements(AbaqusLines& lines, AbaqusPart& part, std::uint64_t& ignored);
/// *ELGEN. `generated` counts elements.
void generateElements(AbaqusLines& lines, AbaqusPart& part, std::uint64_t& generated);

}  // namespace qtet
