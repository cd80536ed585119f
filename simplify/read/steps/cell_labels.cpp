#include "simplify/read/steps/cell_labels.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "proto/field_name.h"
#include "proto/limits.h"
#include "simplify/read/options/select_fields.h"

namespace qtet {
namespace {

// Names in lower case that VTK and finite element programs give to the numbers of blocks.
constexpr std::array<std::string_view, 4> kBlockFields{"blockid", "blockids", "elementblockids",
                                                       "objectid"};

bool isBlockName(const FieldName& name) {
  std::string lower;
  for (const char c : name.withoutTime())
    lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::ranges::find(kBlockFields, lower) != kBlockFields.end();
}

CellLabel* find(std::string_view name, std::vector<CellLabel>& labels) {
  const auto at = std::ranges::find(labels, name, &CellLabel::name);
  return at == labels.end() ? nullptr : &*at;
}

/// One label of several blocks.
class JoinedLabel {
 public:
  explicit JoinedLabel(std::string name) { out_.name = std::move(name); }

  void add(const CellLabel* label, std::size_t cells) {
    if (!label || label->values.size() != cells) {
      out_.values.resize(out_.values.size() + cells);
      return;
    }
    std::map<std::int32_t, std::int32_t> numbers;
    for (const auto& [value, name] : label->names) numbers[value] = numberOf(value, name);
    for (const std::int32_t value : label->values) {
      const auto [known, isNew] = numbers.try_emplace(value, 0);
      if (isNew) known->second = numberOf(value);
      out_.values.push_back(known->second);
    }
  }
  [[nodiscard]] CellLabel take() && { return std::move(out_); }

 private:
  std::int32_t numberOf(std::int32_t value, const std::string& name) {
    const auto [known, isNew] = numbers_.try_emplace(name, 0);
    if (!isNew) return known->second;
    known->second = freeNumber(value);
    if (out_.names.size() < kMaxLabelNames) out_.names.emplace(known->second, name);
    return known->second;
  }
  /// That of a value without a name, which is the same in all blocks.
  std::int32_t numberOf(std::int32_t value) {
    const auto [known, isNew] = unnamed_.try_emplace(value, 0);
    if (isNew && value != 0) known->second = freeNumber(value);
    return known->second;
  }
  std::int32_t freeNumber(std::int32_t wanted) {
    while (!taken_.insert(wanted).second) wanted = next_++;
    return wanted;
  }

  CellLabel out_;
  std::map<std::string, std::int32_t> numbers_;
  std::map<std::int32_t, std::int32_t> unnamed_;
  std::set<std::int32_t> taken_{0};  // 0 is that of cells without a label
  std::int32_t next_ = 1;
};

bool haveTwoValues(const CellLabel& label) {
  return std::ranges::any_of(label.values,
                             [&](std::int32_t value) { return value != label.values.front(); });
}

bool isInt32(double value) {
  using Limits = std::numeric_limits<std::int32_t>;
  return value >= Limits::min() && value <= Limits::max();
}

/// The field's value in each block. nullopt: it is no number of blocks.
std::optional<LabelNames> namesByField(const MeshField& field, const CellLabel& blocks) {
  if (field.components != 1 || isFloatType(field.type) ||
      field.values.size() != blocks.values.size())
    return std::nullopt;
  std::map<std::int32_t, double> valueOf;
  for (std::size_t c = 0; c < field.values.size(); ++c) {
    const double value = field.values[c];
    if (valueOf.try_emplace(blocks.values[c], value).first->second != value) return std::nullopt;
  }
  LabelNames out;
  std::set<double> taken;
  for (const auto& [block, value] : valueOf) {
    const auto name = blocks.names.find(block);
    if (!taken.insert(value).second || !isInt32(value)) return std::nullopt;
    if (name != blocks.names.end()) out.emplace(static_cast<std::int32_t>(value), name->second);
  }
  return out;
}

/// Whether the file has numbers of blocks of its own. Gives these the blocks' names if they fit.
bool isInFile(const CellLabel& blocks, CellMesh& mesh) {
  bool isThere = std::ranges::any_of(mesh.otherFields, isBlockName);
  for (MeshField& field : mesh.fields) {
    if (!isCellField(field) || !isBlockName(field.name)) continue;
    isThere = true;
    if (const auto names = namesByField(field, blocks))
      field.labelNames.insert(names->begin(), names->end());
  }
  return isThere;
}

bool isCellFieldCalled(const MeshField& field, std::string_view name) {
  return isCellField(field) && field.name.withoutTime() == name;
}

}  // namespace

void nameNewCells(std::string_view name, std::int32_t number, CellMesh& mesh) {
  assert(number > 0);
  CellLabel* known = find(kBlockLabel, mesh.labels);
  if (!known) known = &mesh.labels.emplace_back(std::string(kBlockLabel));
  assert(known->values.size() <= mesh.cells());
  known->values.resize(mesh.cells(), name.empty() ? 0 : number);
  if (!name.empty() && known->names.size() < kMaxLabelNames) known->names.emplace(number, name);
}

void nameBlock(std::string_view name, std::int32_t number, CellMesh& mesh) {
  assert(number > 0);
  if (name.empty()) return;
  CellLabel* known = find(kBlockLabel, mesh.labels);
  if (!known) return nameNewCells(name, number, mesh);
  for (auto& [value, inner] : known->names) inner = std::string(name) + "/" + inner;
}

std::vector<CellLabel> joinedLabels(const std::vector<CellMesh>& blocks) {
  std::set<std::string> names;
  for (const CellMesh& block : blocks)
    for (const CellLabel& label : block.labels) names.insert(label.name);
  std::vector<CellLabel> out;
  for (const std::string& name : names) {
    JoinedLabel joined(name);
    for (const CellMesh& block : blocks) {
      const auto at = std::ranges::find(block.labels, name, &CellLabel::name);
      joined.add(at == block.labels.end() ? nullptr : &*at, block.cells());
    }
    out.push_back(std::move(joined).take());
  }
  return out;
}

std::vector<std::int32_t> blocksOfPoints(const CellMesh& mesh) {
  const auto label = std::ranges::find(mesh.labels, kBlockLabel, &CellLabel::name);
  if (label == mesh.labels.end() || label->values.size() != mesh.cells() || !haveTwoValues(*label))
    return {};
  std::vector<std::int32_t> out(mesh.points.size());
  for (std::size_t c = 0; c < mesh.cells(); ++c)
    forEachId(mesh.types[c], mesh.cell(c), [&](VertexId v) {
      if (v < out.size() && out[v] == 0) out[v] = label->values[c];
    });
  return out;
}

void addLabelFields(const FieldNames& wanted, CellMesh& mesh, ReadReport& report) {
  const bool wantsBlocks = wanted && isMeant(wanted, "cell", std::string(kBlockLabel));
  for (CellLabel& label : std::exchange(mesh.labels, {})) {
    if (label.values.size() != mesh.cells() || label.values.empty() || !haveTwoValues(label))
      continue;
    if (label.name == kBlockLabel && isInFile(label, mesh) && !wantsBlocks) continue;
    if (std::ranges::any_of(mesh.fields, [&](const MeshField& field) {
          return isCellFieldCalled(field, label.name);
        }))
      continue;
    report.labels.push_back(label.name);
    mesh.fields.push_back({std::move(label.name), 1, "int32",
                           std::vector<double>(label.values.begin(), label.values.end()), "cell",
                           std::move(label.names)});
  }
}

void eraseLabelFields(const ReadReport& report, std::vector<MeshField>& fields) {
  std::erase_if(fields, [&](const MeshField& field) {
    return isCellField(field) &&
           std::ranges::find(report.labels, field.name.text()) != report.labels.end();
  });
}

}  // namespace qtet
