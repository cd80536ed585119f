#include "simplify/read/steps/join_blocks.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "simplify/read/options/bad_file.h"
#include "simplify/read/options/select_fields.h"
#include "simplify/read/options/time_text.h"
#include "simplify/read/parts/join_pieces.h"
#include "simplify/read/parts/near_points.h"
#include "simplify/read/steps/cell_labels.h"
#include "simplify/read/steps/common_type.h"
#include "simplify/read/steps/moving_points.h"
#include "simplify/read/steps/series_notes.h"
#include "simplify/read/steps/step_order.h"

namespace qtet {
namespace {

const MeshField* find(const CellMesh& mesh, const MeshField& like) {
  for (const MeshField& field : mesh.fields) {
    if (field.name == like.name && field.association == like.association) return &field;
  }
  return nullptr;
}

/// The field of all blocks, without values. Its name is empty if blocks differ in its components,
/// or if some block lacks a field of integers: NaN stands for missing values.
MeshField commonField(const MeshField& field, const std::vector<CellMesh>& blocks) {
  MeshField out{field.name, field.components, field.type, {}, field.association};
  bool isInAll = true;
  std::set<std::int32_t> ambiguous;  // values to which blocks give different names
  for (const CellMesh& block : blocks) {
    const MeshField* there = find(block, field);
    isInAll = isInAll && there;
    if (!there) continue;
    if (there->components != out.components) return {};
    for (const auto& named : there->labelNames)
      if (out.labelNames.insert(named).first->second != named.second) ambiguous.insert(named.first);
    out.type = commonType(out.type, there->type);
  }
  for (const std::int32_t value : ambiguous) out.labelNames.erase(value);
  return isInAll || isFloatType(out.type) ? out : MeshField{};
}

/// Says of a field in how many blocks its values are missing.
void noteMissing(const MeshField& field, const std::vector<CellMesh>& blocks,
                 std::vector<std::string>& notes) {
  const auto lacks = [&](const CellMesh& block) { return !find(block, field); };
  const auto count = std::ranges::count_if(blocks, lacks);
  if (count == 0) return;
  notes.push_back(
      field.association + " field " + field.name + " is not in " + std::to_string(count) + " of " +
      std::to_string(blocks.size()) + " blocks, where its values are missing; block " +
      std::to_string(std::ranges::find_if(blocks, lacks) - blocks.begin()) + " is the first");
}

/// The fields that the joined mesh has, without values.
std::vector<MeshField> commonFields(const std::vector<CellMesh>& blocks,
                                    std::vector<std::string>& notes) {
  std::vector<MeshField> out;
  std::vector<std::string> leftOut;
  for (const CellMesh& block : blocks) {
    for (const MeshField& field : block.fields) {
      const std::string key = field.association + " field " + field.name;
      const bool known = std::ranges::any_of(out, [&](const MeshField& f) {
        return f.name == field.name && f.association == field.association;
      });
      if (known || std::ranges::find(leftOut, key) != leftOut.end()) continue;
      MeshField common = commonField(field, blocks);
      if (!common.name.empty()) {
        noteMissing(common, blocks, notes);
        out.push_back(std::move(common));
      } else {
        leftOut.push_back(key);
        notes.push_back(key +
                        " was left out: it is not in every block, or its components differ "
                        "between blocks");
      }
    }
  }
  return out;
}

void appendValues(MeshField& field, const CellMesh& block, std::size_t tuples) {
  if (const MeshField* there = find(block, field)) {
    field.values.insert(field.values.end(), there->values.begin(), there->values.end());
  } else {
    field.values.resize(field.values.size() + tuples * field.components,
                        std::numeric_limits<double>::quiet_NaN());
  }
}

void appendCells(CellMesh& out, const CellMesh& block, VertexId firstPoint) {
  const auto shift = [&](VertexId& v) {
    v = v >= block.points.size() || v + std::uint64_t{firstPoint} >= kGhost ? kGhost
                                                                            : v + firstPoint;
  };
  for (std::size_t i = 0; i < block.cells(); ++i) {
    out.addCell(block.types[i], block.cell(i));
    forEachId(block.types[i], std::span(out.vertices).subspan(out.begins[out.cells() - 1]), shift);
  }
}

/// "1 % of their shortest edge"
std::string shareOfEdges() {
  return std::to_string(std::lround(100 * kNearShare)) + " % of their shortest edge";
}

std::string howJoined(const JoinedPieces& joined) {
  if (joined.byIds) return ", by their global ids";
  if (joined.nearPoints == 0) return {};
  return ", " + std::to_string(joined.nearPoints) + " of them apart by at most " + shareOfEdges();
}

/// Blocks have numbers in the mesh, and names in the options and the report. The names are those of
/// all steps, with whatever fields.
class BlockNames {
 public:
  explicit BlockNames(const CellMesh& mesh) {
    const auto label = std::ranges::find(mesh.labels, kBlockLabel, &CellLabel::name);
    if (label != mesh.labels.end()) names_ = &label->names;
  }
  [[nodiscard]] BlockPairs named(const NumberPairs& pairs) const {
    BlockPairs out;
    for (const auto& [a, b] : pairs) out.insert(ordered(nameOf(a), nameOf(b)));
    return out;
  }
  /// The pairs of `blocks` that have these names.
  [[nodiscard]] NumberPairs numbered(const BlockPairs& pairs,
                                     const std::vector<std::int32_t>& blocks) const {
    std::map<std::string, std::int32_t> numbers;
    for (const std::int32_t block : std::set(blocks.begin(), blocks.end()))
      numbers.emplace(nameOf(block), block);
    NumberPairs out;
    for (const auto& [name, other] : pairs) {
      const auto a = numbers.find(name), b = numbers.find(other);
      if (a != numbers.end() && b != numbers.end()) out.insert(ordered(a->second, b->second));
    }
    return out;
  }

 private:
  template <class T>
  static std::pair<T, T> ordered(T a, T b) {
    return b < a ? std::pair(std::move(b), std::move(a)) : std::pair(std::move(a), std::move(b));
  }
  [[nodiscard]] std::string nameOf(std::int32_t block) const {
    if (names_)
      if (const auto name = names_->find(block); name != names_->end()) return name->second;
    return std::to_string(block);
  }

  const LabelNames* names_ = nullptr;
};

/// "16 points lie at the place of another block's point, ..."
void noteBlocks(const JoinedPieces& joined, std::vector<std::string>& notes) {
  const std::string share = "by more than a thousandth of a field's range";
  if (joined.blockPoints > 0)
    notes.push_back(std::to_string(joined.blockPoints) +
                    " points lie at the place of another block's point and stay apart, because "
                    "values of the two blocks differ " +
                    share +
                    " at the file's first step; `weld` 0 joins them, with the values of the "
                    "earlier block");
  if (joined.differingPoints > 0)
    notes.push_back(std::to_string(joined.differingPoints) +
                    " points were joined with another block's point, though values differ " +
                    share +
                    ", because those blocks agree at the file's first step; they took the values "
                    "of the earlier block; `weld` none keeps the blocks apart, with their values");
}

/// "its 8 pieces were joined at 1234 points that they share"
void join(CellMesh& mesh, std::span<const VertexId> ends, const ReadOptions& options,
          ReadReport& report) {
  report.pieces = ends.size();
  if (ends.size() < 2) return;
  const std::string pieces = "its " + std::to_string(ends.size()) + " pieces ";
  // More points than ids can name: checkCellMesh refuses them.
  const bool canBeNamed = mesh.points.size() < kGhost;
  if (!options.joinPieces || !canBeNamed) {
    report.notes.push_back(pieces + "stay apart (`weld` none)");
    return;
  }
  BlocksOfPoints blocks{blocksOfPoints(mesh)};
  const BlockNames names(mesh);
  if (options.apartBlocks) blocks.apart = names.numbered(*options.apartBlocks, blocks.block);
  const JoinedPieces joined = joinPieces(mesh, ends, blocks);
  report.joinedPoints = joined.points;
  report.joinedByIds = joined.byIds;
  report.blocksMeet = report.blocksMeet || joined.blocksMeet;
  report.differingBlocks.merge(names.named(joined.differing));
  noteBlocks(joined, report.notes);
  if (joined.points == 0 && joined.blockPoints > 0) return;
  if (joined.points == 0)
    report.notes.push_back(
        pieces + "have no points in common, and stay apart; `weld` D joins points within D");
  else
    report.notes.push_back(pieces + "were joined at " + std::to_string(joined.points) +
                           " points that they share" + howJoined(joined) +
                           "; `weld` none would keep them apart");
  if (joined.apartPoints > 0)
    report.notes.push_back(std::to_string(joined.apartPoints) + " points lie within " +
                           shareOfEdges() +
                           " of a point of another piece, and were not joined with it: no faces "
                           "fit together there; `weld` D joins points within D");
}

/// "9 points and 12 cells"
std::string sizeOf(const CellMesh& mesh) {
  return std::to_string(mesh.points.size()) + " points and " + std::to_string(mesh.cells()) +
         " cells";
}

double timeOf(const TimedCells& step) { return plainTime(step.time).value_or(0); }

/// Refuses a step whose cells are not those of the first one.
Status checkSameCells(const TimedCells& first, const TimedCells& step,
                      const std::filesystem::path& path, const ReadReport& report) {
  const CellMesh &rest = first.cells, &mesh = step.cells;
  if (haveSameCells(mesh, rest)) return {};
  const std::string there = sizeOf(mesh), here = sizeOf(rest);
  return fail(ErrorCode::kBadInput,
              path.string() + ": the mesh at time " + step.time + " is not that of time " +
                  first.time +
                  (there == here ? ": its cells have other points"
                                 : ": it has " + there + ", not " + here) +
                  "; 'qtet simplify -o NAME.json' makes a log of each run of steps with the same "
                  "cells, and a list of these logs" +
                  (report.joinedPoints > 0
                       ? ", or keep pieces apart, which part or meet as they move, with `weld` none"
                       : ""));
}

/// Puts a step into the order of the first one. Refuses one with other cells.
Status putInOrder(const TimedCells& first, TimedCells& step, const std::filesystem::path& path,
                  StepOrder& order, ReadReport& report) {
  if (!haveSameCells(step.cells, first.cells) && order.restore(step.cells))
    report.series.reordered.insert(timeOf(step));
  if (Status same = checkSameCells(first, step, path, report); !same) return same;
  if (!areSamePoints(first.cells.points, step.cells.points) && order.isTorn(step.cells))
    return badFile(path, "the points at time " + step.time + " are those of time " + first.time +
                             " in another order, but its cells name the same numbers, so they "
                             "would be torn; write points and cells of all steps in one order");
  return {};
}

/// Makes fields of points that move over the steps of a file.
class Motion {
 public:
  /// REQUIRES: steps of the same cells.
  Motion(std::span<const TimedCells> steps, const FieldNames& names, bool moves) {
    assert(!steps.empty());
    const CellMesh& rest = steps.front().cells;
    for (const TimedCells& step : steps)
      if (!areSamePoints(rest.points, step.cells.points)) report_.moved.insert(timeOf(step));
    moves_ = moves || !report_.moved.empty();
    if (!moves_) return;
    report_.field = displacementName(rest);
    report_.rest = timeOf(steps.front());
    type_ = "float32";
    for (const TimedCells& step : steps)
      if (displacementType(rest, step.cells) != type_) type_ = "float64";
    report_.isRead = std::ranges::any_of(steps, [&](const TimedCells& step) {
      return isMeant(names, "point", report_.field + "@" + step.time);
    });
  }

  /// Adds the step's field without a time.
  Status addTo(std::vector<MeshField>& fields, const CellMesh& rest, const CellMesh& step) {
    if (!moves_ || !report_.isRead) return {};
    Result<MeshField> field = displacementOf(rest, step.points, type_);
    if (!field) return std::unexpected(field.error());
    field->name = report_.field;
    report_.largest = std::max(report_.largest, largestDisplacement(*field));
    fields.push_back(std::move(*field));
    return {};
  }

  void tell(ReadReport& report) const {
    if (!moves_) return;
    report.series.motion = report_;
    if (report_.isRead) report.motion = report_.field;
  }

 private:
  bool moves_ = false;
  std::string type_;
  MotionReport report_;
};

}  // namespace

bool haveSameCells(const CellMesh& a, const CellMesh& b) {
  return a.points.size() == b.points.size() && a.types == b.types && a.vertices == b.vertices;
}

CellMesh joinBlocks(std::vector<CellMesh> blocks, const ReadOptions& options, ReadReport& report) {
  std::erase_if(blocks, [](const CellMesh& block) { return block.cells() == 0; });
  if (blocks.empty()) return {};
  if (blocks.size() == 1) return std::move(blocks.front());
  CellMesh out;
  out.labels = joinedLabels(blocks);
  out.pointType = blocks.front().pointType;
  out.fields = commonFields(blocks, report.notes);
  const bool haveIds = std::ranges::all_of(
      blocks, [](const CellMesh& b) { return b.pointIds.size() == b.points.size(); });
  std::uint64_t firstCell = 0;
  std::size_t firstPoint = 0;
  std::vector<VertexId> ends;
  const std::vector<Position>* last = nullptr;
  for (const CellMesh& block : blocks) {
    const bool shares = last && *last == block.points;
    if (!shares) {
      firstPoint = out.points.size();
      out.points.insert(out.points.end(), block.points.begin(), block.points.end());
      if (haveIds)
        out.pointIds.insert(out.pointIds.end(), block.pointIds.begin(), block.pointIds.end());
      ends.emplace_back();
    }
    assert(!ends.empty() && firstPoint <= out.points.size());
    ends.back() = static_cast<VertexId>(std::min<std::size_t>(out.points.size(), kGhost));
    last = &block.points;
    appendCells(out, block, static_cast<VertexId>(std::min<std::size_t>(firstPoint, kGhost)));
    for (std::size_t i = 0; i < block.cells(); ++i)
      out.cellIds.push_back(firstCell + block.cellId(i));
    firstCell = out.cellIds.back() + 1;
    for (MeshField& field : out.fields) {
      if (isCellField(field) || !shares)
        appendValues(field, block, isCellField(field) ? block.cells() : block.points.size());
    }
    if (block.pointType != out.pointType) out.pointType = "float64";
    out.otherFields.insert(out.otherFields.end(), block.otherFields.begin(),
                           block.otherFields.end());
  }
  assert(out.cellIds.size() == out.cells() &&
         (!haveIds || out.pointIds.size() == out.points.size()));
  join(out, ends, options, report);
  return out;
}

Result<CellMesh> joinSteps(std::vector<TimedCells> steps, const std::filesystem::path& path,
                           const FieldNames& names, ReadReport& report, bool moves) {
  assert(!steps.empty());
  StepOrder order(steps.front().cells);
  for (TimedCells& step : steps) {
    report.series.times.insert(timeOf(step));
    if (Status ordered = putInOrder(steps.front(), step, path, order, report); !ordered)
      return std::unexpected(ordered.error());
  }
  Motion motion(steps, names, moves);
  CellMesh& rest = steps.front().cells;
  std::vector<MeshField> fields;
  for (TimedCells& step : steps) {
    std::vector<MeshField> own = std::move(step.cells.fields);
    if (Status added = motion.addTo(own, rest, step.cells); !added)
      return fail(added.error().code,
                  path.string() + ": at time " + step.time + " " + added.error().message);
    for (MeshField& field : own) {
      field.name = field.name.at(step.time);
      fields.push_back(std::move(field));
    }
    if (&step != &steps.front()) step.cells = {};
  }
  motion.tell(report);
  if (Status added = addInstants(fields, path, report.series); !added)
    return std::unexpected(added.error());
  setTypes(report.series, fields);
  std::ranges::move(seriesNotes(report.series), std::back_inserter(report.notes));
  rest.fields = std::move(fields);
  return std::move(rest);
}

}  // namespace qtet
