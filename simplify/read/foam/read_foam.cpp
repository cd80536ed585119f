#include "simplify/read/foam/read_foam.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "simplify/read/foam/field_files.h"
#include "simplify/read/foam/foam_fields.h"
#include "simplify/read/foam/foam_list.h"
#include "simplify/read/foam/poly_mesh.h"
#include "simplify/read/options/time_text.h"
#include "simplify/read/parts/piece_files.h"
#include "simplify/read/process/inflate_file.h"
#include "simplify/read/steps/cell_labels.h"
#include "simplify/read/steps/step_reports.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// OpenFOAM's name of the region that has no folder of its own.
constexpr std::string_view kDefaultRegion = "region0";

/// The folders of a case that have fields: those of times, ascending. Without one it is constant,
/// at time 0.
struct Instants {
  std::vector<double> times;
  std::vector<fs::path> folders;
};

Instants instantsIn(const fs::path& folder, std::vector<std::string>& notes) {
  std::set<std::pair<double, std::string>> found;
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
    const std::string name = entry.path().filename().string();
    const auto time = plainTime(name);
    if (time && name[0] != '.' && entry.is_directory(code)) found.emplace(*time, name);
  }
  if (found.empty()) found.emplace(0, "constant");
  Instants out;
  for (const auto& [time, name] : found) {
    if (!out.times.empty() && out.times.back() == time) {
      notes.push_back((folder / name).string() + " has the time of " + out.folders.back().string() +
                      ", and was ignored");
      continue;
    }
    out.times.push_back(time);
    out.folders.push_back(folder / name);
  }
  return out;
}

bool hasFile(const fs::path& folder, const char* name) {
  return FoamList::isThere(folder / "polyMesh" / name);
}

/// A folder polyMesh that has points alone says where a mesh has moved.
bool hasCells(const fs::path& folder) {
  return hasFile(folder, "faces") || hasFile(folder, "owner") || hasFile(folder, "neighbour");
}

/// The mesh of one region ("": that of the case itself) at each time. Keeps the mesh of the step
/// that it has read last.
class Region {
 public:
  Region(const fs::path& folder, const Instants& instants, std::string name)
      : instants_(instants), name_(std::move(name)) {
    fs::path cells, points;
    const auto look = [&](const fs::path& place) {
      if (hasCells(place)) cells = points = place / "polyMesh";
      if (hasFile(place, "points")) points = place / "polyMesh";
    };
    look(folder / "constant" / name_);
    for (const fs::path& instant : instants_.folders) {
      look(instant / name_);
      places_.emplace_back(cells, points);
    }
  }

  Result<CellMesh> at(std::size_t step, const ReadOptions& options, ReadReport& report) {
    const auto& [cells, points] = places_[step];
    const fs::path fields = instants_.folders[step] / name_;
    if (cells.empty())
      return fail(ErrorCode::kNotFound,
                  fields.string() + " has no mesh, nor has an earlier time; copy the case whole");
    if (Status done = readMesh(cells, points, options, report); !done)
      return std::unexpected(done.error());
    CellMesh out = mesh_;
    if (Status done = addFoamFields(fields, options.fields, options.patience, room_, out, report);
        !done)
      return std::unexpected(done.error());
    return out;
  }

 private:
  Status readMesh(const fs::path& cells, const fs::path& points, const ReadOptions& options,
                  ReadReport& report) {
    if (std::pair(cells, points) == read_) return {};
    const bool isMoved = cells == read_.first;
    const std::size_t before = mesh_.points.size();
    read_ = decltype(read_)();
    if (!isMoved) mesh_ = {};
    if (Status done = readFoamPoints(points, options.patience, mesh_); !done) return done;
    if (isMoved && mesh_.points.size() != before)
      return fail(ErrorCode::kBadInput, (points / "points").string() + ": it has " +
                                            std::to_string(mesh_.points.size()) +
                                            " points, but the mesh of " + cells.string() + " has " +
                                            std::to_string(before) + "; write the case again");
    if (Status done = isMoved ? Status{} : readPolyMesh(cells, options.patience, mesh_); !done)
      return done;
    if (!isMoved) addCellZones(cells, options.patience, mesh_, report.notes);
    read_ = {cells, points};
    return {};
  }

  const Instants& instants_;
  std::string name_;
  std::vector<std::pair<fs::path, fs::path>> places_;  ///< by step: the folders of cells and points
  std::pair<fs::path, fs::path> read_;                 ///< those of mesh_
  CellMesh mesh_;
  std::uint64_t room_ = maxInflatedBytes();  ///< for the values of all steps
};

/// The names of the regions that have a mesh at some time, the case itself first.
std::set<std::string> regionsIn(const fs::path& folder, const Instants& instants) {
  std::set<std::string> out;
  std::vector<fs::path> places = instants.folders;
  places.push_back(folder / "constant");
  std::error_code code;
  for (const fs::path& place : places) {
    if (hasCells(place)) out.insert("");
    for (const fs::directory_entry& entry : fs::directory_iterator(place, code))
      if (entry.is_directory(code) && hasCells(entry.path()))
        out.insert(entry.path().filename().string());
  }
  return out;
}

/// The steps of each region, by its name.
using RegionSteps = std::map<std::string, std::vector<TimedCells>>;

/// A case of OpenFOAM in one folder.
Result<RegionSteps> readFoamCase(const fs::path& folder, const ReadOptions& options,
                                 ReadReport& report) {
  const Instants instants = instantsIn(folder, report.notes);
  RegionSteps out;
  for (const std::string& name : regionsIn(folder, instants)) {
    Region region(folder, instants, name);
    ReadReport ofOne;
    Result<std::vector<TimedCells>> steps = readChosen(
        instants.times, folder, options, ofOne,
        [&](std::size_t step, ReadReport& ofStep) { return region.at(step, options, ofStep); });
    if (!steps) return std::unexpected(steps.error());
    addPiece(std::move(ofOne), report);
    out.emplace(name, std::move(*steps));
  }
  if (out.empty())
    return fail(
        ErrorCode::kNotFound,
        folder.string() + " has no mesh: its constant/polyMesh is missing; copy the case whole");
  return out;
}

/// A decomposed case of OpenFOAM: each processor's folder is read as a case of its own.
Result<RegionSteps> readProcessors(const std::vector<fs::path>& processors, const fs::path& path,
                                   const ReadOptions& options, ReadReport& report) {
  std::map<std::string, std::vector<std::vector<TimedCells>>> pieces;
  for (const fs::path& processor : processors) {
    ReadReport ofOne;
    Result<RegionSteps> regions = readFoamCase(processor, options, ofOne);
    if (!regions) return regions;
    addPiece(std::move(ofOne), report);
    for (auto& [name, steps] : *regions) pieces[name].push_back(std::move(steps));
  }
  report.notes.push_back("the case was read from the folders of its " +
                         std::to_string(processors.size()) + " processors");
  RegionSteps out;
  for (auto& [name, ofRegion] : pieces) {
    Result<std::vector<TimedCells>> steps =
        joinedPieces(std::move(ofRegion), path, options, report);
    if (!steps) return std::unexpected(steps.error());
    out.emplace(name, std::move(*steps));
  }
  return out;
}

/// The regions in one mesh, as blocks with their names.
Result<std::vector<TimedCells>> joinedRegions(RegionSteps regions, const fs::path& path,
                                              const ReadOptions& options, ReadReport& report) {
  if (regions.size() == 1) return std::move(regions.begin()->second);
  std::vector<std::vector<TimedCells>> blocks;
  for (auto& [name, steps] : regions) {
    for (TimedCells& step : steps)
      nameBlock(name.empty() ? kDefaultRegion : std::string_view(name),
                static_cast<std::int32_t>(blocks.size() + 1), step.cells);
    blocks.push_back(std::move(steps));
  }
  const std::uint64_t joinedBefore = report.joinedPoints;  // those of processors
  Result<std::vector<TimedCells>> out = joinedPieces(std::move(blocks), path, options, report);
  report.joinedPoints += joinedBefore;
  return out;
}

}  // namespace

Result<std::vector<TimedCells>> readFoam(const fs::path& path, const ReadOptions& options,
                                         ReadReport& report) {
  const auto processors = processorFolders(path);
  if (!processors) return std::unexpected(processors.error());
  ReadOptions ofCells = options;
  ofCells.fields = foamFieldsToRead(options.fields);
  const fs::path folder = path.parent_path().empty() ? "." : path.parent_path();
  Result<RegionSteps> regions = processors->empty()
                                    ? readFoamCase(folder, ofCells, report)
                                    : readProcessors(*processors, path, ofCells, report);
  if (!regions) return std::unexpected(regions.error());
  // of each region alone: a mean across two of them is a value of neither
  std::string mean;
  for (auto& [name, ofRegion] : *regions)
    for (TimedCells& step : ofRegion)
      if (const std::string made = foamFieldsAtPoints(options.fields, step.cells); mean.empty())
        mean = made;
  Result<std::vector<TimedCells>> steps = joinedRegions(std::move(*regions), path, options, report);
  if (steps && !options.fields && !mean.empty())
    report.notes.push_back(noteOfMeans(steps->front().cells, mean));
  return steps;
}

}  // namespace qtet
