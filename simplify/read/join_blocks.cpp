#include "simplify/read/join_blocks.h"

#include <algorithm>
#include <limits>

namespace qtet {
namespace {

const MeshField* find(const CellMesh& mesh, const MeshField& like) {
  for (const MeshField& field : mesh.fields) {
    if (field.name == like.name && field.association == like.association) return &field;
  }
  return nullptr;
}

bool agree(const MeshField& a, const MeshField& b) {
  return a.components == b.components && a.type == b.type;
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
      const bool everywhere = std::ranges::all_of(blocks, [&](const CellMesh& other) {
        const MeshField* there = find(other, field);
        const bool lacks = !there && other.cells() > 0;
        return there ? agree(*there, field) : !lacks || isFloatType(field.type);
      });
      if (everywhere) {
        out.push_back({field.name, field.components, field.type, {}, field.association});
      } else {
        leftOut.push_back(key);
        notes.push_back(key + " was left out: it is not in every block, or not of one type");
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
  const auto shifted = [firstPoint](VertexId v) {
    return v == kGhost || v + std::uint64_t{firstPoint} >= kGhost ? kGhost : v + firstPoint;
  };
  for (std::size_t i = 0; i < block.cells(); ++i) {
    out.addCell(block.types[i], block.cell(i));
    const std::span<VertexId> ids = std::span(out.vertices).subspan(out.begins[out.cells() - 1]);
    if (block.types[i] != kPolyhedronCell) {
      for (VertexId& v : ids) v = shifted(v);
      continue;
    }
    for (std::size_t at = 1; at < ids.size(); at += ids[at] + std::size_t{1}) {
      for (VertexId& v : ids.subspan(at + 1, std::min<std::size_t>(ids[at], ids.size() - at - 1)))
        v = shifted(v);
    }
  }
}

}  // namespace

CellMesh joinBlocks(std::vector<CellMesh> blocks, std::vector<std::string>& notes) {
  std::erase_if(blocks, [](const CellMesh& block) { return block.cells() == 0; });
  if (blocks.empty()) return {};
  if (blocks.size() == 1) return std::move(blocks.front());
  CellMesh out;
  out.pointType = blocks.front().pointType;
  out.fields = commonFields(blocks, notes);
  std::uint64_t firstCell = 0;
  std::size_t apart = 0, firstPoint = 0;
  const std::vector<Position>* last = nullptr;
  for (const CellMesh& block : blocks) {
    const bool shares = last && *last == block.points;
    if (!shares) {
      firstPoint = out.points.size();
      out.points.insert(out.points.end(), block.points.begin(), block.points.end());
      ++apart;
    }
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
  if (apart > 1)
    notes.push_back("its " + std::to_string(apart) +
                    " blocks have points of their own; --weld D joins those within a distance D");
  return out;
}

Result<CellMesh> joinSteps(std::vector<TimedCells> steps, const std::filesystem::path& path) {
  CellMesh out = std::move(steps.front().cells);
  std::vector<MeshField> fields;
  for (std::size_t s = 0; s < steps.size(); ++s) {
    const CellMesh& step = s == 0 ? out : steps[s].cells;
    if (s > 0 &&
        (step.points != out.points || step.types != out.types || step.vertices != out.vertices)) {
      return fail(ErrorCode::kBadInput, path.string() + ": the mesh at time " + steps[s].time +
                                            " is not that of time " + steps[0].time +
                                            "; make a log of each step, with --time " +
                                            steps[s].time + " and so on");
    }
    for (const MeshField& field : step.fields) {
      fields.push_back(field);
      fields.back().name += "@" + steps[s].time;
    }
    if (s > 0) steps[s].cells = {};
  }
  out.fields = std::move(fields);
  return out;
}

}  // namespace qtet
