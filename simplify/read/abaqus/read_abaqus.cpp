#include "simplify/read/abaqus/read_abaqus.h"

#include <algorithm>

#include "simplify/read/abaqus/abaqus_lines.h"
#include "simplify/read/abaqus/read_model.h"
#include "simplify/read/abaqus/set_members.h"
#include "simplify/read/text/set_labels.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// Parts are placed after all lines are read.
class Assembly {
 public:
  Assembly(AbaqusModel model, const fs::path& path, ReadReport& report)
      : model_(std::move(model)), path_(path), report_(report), time_(model_.time) {}

  Result<CellMesh> build() {
    report_.ignoredCells += model_.ignoredCells;
    for (AbaqusPart& part : model_.parts)
      if (Status done = findNodes(part); !done) return std::unexpected(done.error());
    if (Status done = chooseCopies(); !done) return std::unexpected(done.error());
    for (const AbaqusCopy& copy : copies_) place(copy);
    if (Status done = addLabels(); !done) return std::unexpected(done.error());
    return std::move(out_);
  }

 private:
  std::unexpected<Error> refuse(const std::string& what,
                                ErrorCode code = ErrorCode::kBadInput) const {
    return fail(code, path_.string() + ": " + what);
  }

  static std::string within(const AbaqusPart& part) {
    return part.name.empty() ? "" : " of part " + part.name;
  }

  /// Cells name places of points in place of the file's numbers.
  Status findNodes(AbaqusPart& part) const {
    CellMesh& mesh = part.mesh;
    for (std::size_t cell = 0; cell < mesh.cells(); ++cell) {
      for (std::uint64_t at = mesh.begins[cell]; at < mesh.begins[cell + 1]; ++at) {
        const auto node = part.nodes.find(mesh.vertices[at]);
        if (node == part.nodes.end())
          return refuse("element " + std::to_string(part.numbers.all()[cell]) + within(part) +
                        " names node " + std::to_string(mesh.vertices[at]) +
                        ", which the file does not have; export it again");
        mesh.vertices[at] = node->second;
      }
    }
    part.nodes.clear();
    return time_.check(path_);
  }

  Status chooseCopies() {
    std::vector<bool> isPlaced(model_.parts.size());
    std::uint64_t points = 0, cells = 0, again = 0;
    const auto add = [&](std::size_t part, const AbaqusInstance* instance) {
      const CellMesh& mesh = model_.parts[part].mesh;
      if (mesh.cells() == 0) return;
      copies_.push_back({part, instance, static_cast<std::uint32_t>(cells)});
      points += mesh.points.size();
      cells += mesh.cells();
      if (isPlaced[part]) again += mesh.points.size() + mesh.cells();
      isPlaced[part] = true;
    };
    const bool hasInstances = !model_.instances.empty();
    for (std::size_t p = 0; p < (hasInstances ? 1 : model_.parts.size()); ++p) add(p, nullptr);
    for (const AbaqusInstance& instance : model_.instances) add(instance.part, &instance);
    if (!hasInstances && model_.parts.size() > 1)
      report_.notes.emplace_back("the file has no instances: its parts stand as they are");
    if (points >= kGhost || cells >= kGhost || again > mostGenerated(model_.bytes))
      return refuse("the instances have " + std::to_string(points) + " nodes and " +
                        std::to_string(cells) + " elements together, which is too much",
                    ErrorCode::kLimitExceeded);
    return {};
  }

  void place(const AbaqusCopy& copy) {
    CellMesh& mesh = model_.parts[copy.part].mesh;
    if (copies_.size() == 1 && !copy.instance) {
      out_ = std::move(mesh);
      return;
    }
    const auto firstPoint = static_cast<VertexId>(out_.points.size());
    for (const Position& p : mesh.points)
      out_.points.push_back(copy.instance ? copy.instance->placement(p) : p);
    std::vector<VertexId> ids;
    for (std::size_t cell = 0; cell < mesh.cells(); ++cell) {
      ids.assign(mesh.cell(cell).begin(), mesh.cell(cell).end());
      for (VertexId& id : ids) id += firstPoint;
      out_.addCell(mesh.types[cell], ids);
    }
  }

  Status addLabels() {
    SetMembers members(model_, copies_, out_.cells(), time_);
    add(materials(members));
    add(elementSets(members));
    add(instances());
    if (members.isOver()) return refuse(time_.text());
    return {};
  }

  void add(std::optional<MeshField> field) {
    if (field) out_.fields.push_back(std::move(*field));
  }

  std::optional<MeshField> materials(SetMembers& members) const {
    std::map<std::string, std::uint32_t> numbers;
    LabelNames names;
    std::vector<std::uint32_t> values(out_.cells()), cells;
    for (std::size_t p = 0; p < model_.parts.size(); ++p) {
      for (const AbaqusSection& section : model_.parts[p].sections) {
        const auto [at, isNew] = numbers.try_emplace(
            abaqusName(section.material), static_cast<std::uint32_t>(numbers.size() + 1));
        if (isNew) names.emplace(static_cast<std::int32_t>(at->second), section.material);
        cells.clear();
        members.add(p, section.set, cells);
        for (const std::uint32_t cell : cells) values[cell] = at->second;
      }
    }
    return labelOf("Material", values, std::move(names));
  }

  /// Sets of the same name in different parts are called PART.SET.
  std::optional<MeshField> elementSets(SetMembers& members) {
    struct Place {
      std::size_t part;
      std::string name;
    };
    std::map<std::string, int> uses;
    for (const AbaqusPart& part : model_.parts)
      for (const auto& [name, number] : part.setNumbers) ++uses[name];
    std::vector<Place> places;
    CellSets sets;
    for (std::size_t p = 0; p < model_.parts.size(); ++p) {
      const AbaqusPart& part = model_.parts[p];
      for (const AbaqusSet& set : part.sets) {
        if (set.isInternal) continue;
        places.push_back({p, abaqusName(set.name)});
        const bool isShared = uses[places.back().name] > 1 && !part.name.empty();
        sets.names.push_back(isShared ? part.name + "." + set.name : set.name);
      }
    }
    sets.cellsOf = [&](std::size_t set, std::vector<std::uint32_t>& cells) {
      members.add(places[set].part, places[set].name, cells);
    };
    return labelOfSets("ElementSet", out_.cells(), sets, report_.notes);
  }

  std::optional<MeshField> instances() const {
    std::vector<std::uint32_t> values(out_.cells());
    LabelNames names;
    std::uint32_t number = 0;
    for (const AbaqusCopy& copy : copies_) {
      if (!copy.instance) continue;
      ++number;
      names.emplace(static_cast<std::int32_t>(number), copy.instance->name);
      std::fill_n(values.begin() + copy.firstCell, model_.parts[copy.part].mesh.cells(), number);
    }
    return labelOf("Instance", values, std::move(names));
  }

  AbaqusModel model_;
  const fs::path& path_;
  ReadReport& report_;
  ReadingTime time_;
  std::vector<AbaqusCopy> copies_;
  CellMesh out_;
};

}  // namespace

Result<CellMesh> readAbaqus(const fs::path& path, ReadReport& report,
                            std::chrono::seconds patience) {
  Result<AbaqusModel> model = readAbaqusModel(path, patience);
  if (!model) return std::unexpected(model.error());
  return Assembly(std::move(*model), path, report).build();
}

}  // namespace qtet
