#include "simplify/read/parts/named_files.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "simplify/read/options/bad_file.h"
#include "simplify/read/options/grid_parts.h"
#include "simplify/read/options/time_text.h"
#include "simplify/read/parts/xml_tree.h"

namespace qtet {
namespace {

/// The element of that name below the file's root. `tree` holds it.
Result<const XmlElement*> listIn(const std::filesystem::path& path, const std::string& name,
                                 std::unique_ptr<XmlElement>& tree) {
  Result<std::unique_ptr<XmlElement>> read = readXml(path);
  if (!read) return std::unexpected(read.error());
  tree = std::move(*read);
  const XmlElement* list = tree->child(name);
  if (!list) return badFile(path, "it holds no <" + name + ">; save it again");
  return list;
}

/// A file of a block with the names of the blocks around it, the outermost first.
struct NestedFile {
  std::filesystem::path path;
  std::vector<std::string> names;
};

void addBlockFiles(const XmlElement& element, const std::filesystem::path& path,
                   std::vector<std::string>& names, std::vector<NestedFile>& out,
                   std::vector<std::string>& notes) {
  constexpr std::array kVolumes{".vtu", ".vts",  ".vtr",  ".vti",  ".vtk",
                                ".vtm", ".pvtu", ".pvts", ".pvtr", ".pvti"};
  for (const auto& child : element.children) {
    const std::string name(child->attribute("name"));
    const bool isNamed = !name.empty() && (names.empty() || names.back() != name);
    if (isNamed) names.push_back(name);
    if (const std::string_view file = child->attribute("file"); !file.empty()) {
      const std::filesystem::path part = path.parent_path() / file;
      if (std::ranges::find(kVolumes, part.extension()) != kVolumes.end())
        out.push_back({part, names});
      else
        notes.push_back("its block " + part.filename().string() +
                        " was ignored: such a file holds no volume cells");
    }
    addBlockFiles(*child, path, names, out, notes);
    if (isNamed) names.pop_back();
  }
}

std::string joinedBySlash(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : "/") + name;
  return out;
}

/// Blocks by their own names, or with those around them where two of these are called alike.
std::vector<BlockFile> named(const std::vector<NestedFile>& files) {
  std::map<std::string, std::set<std::string>> whole;  // by the last name
  for (const NestedFile& file : files)
    if (!file.names.empty()) whole[file.names.back()].insert(joinedBySlash(file.names));
  std::vector<BlockFile> out;
  for (const NestedFile& file : files) {
    if (file.names.empty())
      out.push_back({file.path, ""});
    else if (whole[file.names.back()].size() == 1)
      out.push_back({file.path, file.names.back()});
    else
      out.push_back({file.path, joinedBySlash(file.names)});
  }
  return out;
}

/// A text in which the parts of one time differ.
std::string partOf(const XmlElement& dataSet) {
  std::string out;
  for (const char* key : {"part", "group", "name"})
    out += std::string(dataSet.attribute(key)) + '\n';
  return out;
}

/// The time of a list's entry. Without one it is 0 if it is `alone`: the list's only time.
Result<double> timeOf(const XmlElement& dataSet, int number, bool alone,
                      const std::filesystem::path& path) {
  const auto found = dataSet.attributes.find("timestep");
  const std::string which = "its <DataSet> number " + std::to_string(number);
  if (found == dataSet.attributes.end()) {
    if (alone) return 0.0;
    return badFile(path, which + " has no timestep; give each one its time, a number such as 0.5");
  }
  if (const auto time = timeIn(found->second)) return *time;
  return badFile(path, which + " has the timestep \"" + found->second +
                           "\", which is no number; give it its time, a number such as 0.5");
}

/// Whether no entry has a time, and each is another part: one mesh in parts.
bool isOneTime(const XmlElement& collection) {
  std::set<std::string> parts;
  return std::ranges::all_of(collection.children, [&](const auto& element) {
    return !element->attributes.contains("timestep") && parts.insert(partOf(*element)).second;
  });
}

}  // namespace

Result<std::vector<SeriesEntry>> entriesOfPvd(const std::filesystem::path& path) {
  std::unique_ptr<XmlElement> tree;
  const Result<const XmlElement*> collection = listIn(path, "Collection", tree);
  if (!collection) return std::unexpected(collection.error());
  const bool alone = isOneTime(**collection);
  std::vector<SeriesEntry> entries;
  for (const auto& element : (*collection)->children) {
    const auto number = static_cast<int>(entries.size());
    const std::string_view file = element->attribute("file");
    if (file.empty())
      return badFile(path, "its <DataSet> number " + std::to_string(number) +
                               " names no file; save the series again");
    const Result<double> time = timeOf(*element, number, alone, path);
    if (!time) return std::unexpected(time.error());
    entries.push_back({*time, number, path.parent_path() / file, partOf(*element)});
  }
  if (entries.empty()) return badFile(path, "its <Collection> is empty; save the series again");
  return entries;
}

Result<std::vector<BlockFile>> piecesOf(const std::filesystem::path& path, MeshFormat format) {
  std::unique_ptr<XmlElement> tree;
  const Result<const XmlElement*> grid = listIn(path, std::string(traitsOf(format).root), tree);
  if (!grid) return std::unexpected(grid.error());
  std::vector<BlockFile> out;
  for (const auto& element : (*grid)->children) {
    if (element->name != "Piece") continue;
    const std::string_view file = element->attribute("Source");
    if (file.empty())
      return badFile(path, "its <Piece> number " + std::to_string(out.size()) +
                               " names no file; save it again");
    out.push_back({path.parent_path() / file, ""});
  }
  if (out.empty()) return badFile(path, "it names no <Piece>; save it again");
  return out;
}

Result<std::vector<std::string>> statedArrays(const std::filesystem::path& path,
                                              MeshFormat format) {
  std::unique_ptr<XmlElement> tree;
  const Result<const XmlElement*> grid = listIn(path, std::string(traitsOf(format).root), tree);
  if (!grid) return std::unexpected(grid.error());
  std::vector<std::string> out;
  for (const char* section : {"PPointData", "PCellData"}) {
    const XmlElement* arrays = (*grid)->child(section);
    for (std::size_t i = 0; arrays && i < arrays->children.size(); ++i) {
      const std::string name(arrays->children[i]->attribute("Name"));
      const bool marksGhosts = name == kGhostTypes || name == kGhostLevels;
      if (!name.empty() && !marksGhosts && std::ranges::find(out, name) == out.end())
        out.push_back(name);
    }
  }
  return out;
}

Result<std::vector<BlockFile>> blocksOf(const std::filesystem::path& path,
                                        std::vector<std::string>& notes) {
  std::unique_ptr<XmlElement> tree;
  const Result<const XmlElement*> set = listIn(path, "vtkMultiBlockDataSet", tree);
  if (!set) return std::unexpected(set.error());
  std::vector<NestedFile> out;
  std::vector<std::string> names;
  addBlockFiles(**set, path, names, out, notes);
  return named(out);
}

}  // namespace qtet
