#include "simplify/read/parts/named_files.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "simplify/read/options/bad_file.h"
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

void addBlockFiles(const XmlElement& element, const std::filesystem::path& path,
                   std::vector<std::filesystem::path>& out, std::vector<std::string>& notes) {
  constexpr std::array kVolumes{".vtu", ".vts",  ".vtr",  ".vti",  ".vtk",
                                ".vtm", ".pvtu", ".pvts", ".pvtr", ".pvti"};
  for (const auto& child : element.children) {
    if (const std::string_view file = child->attribute("file"); !file.empty()) {
      const std::filesystem::path part = path.parent_path() / file;
      if (std::ranges::find(kVolumes, part.extension()) != kVolumes.end())
        out.push_back(part);
      else
        notes.push_back("its block " + part.filename().string() +
                        " was ignored: such a file holds no volume cells");
    }
    addBlockFiles(*child, path, out, notes);
  }
}

}  // namespace

Result<std::vector<SeriesEntry>> entriesOfPvd(const std::filesystem::path& path) {
  std::unique_ptr<XmlElement> tree;
  const Result<const XmlElement*> collection = listIn(path, "Collection", tree);
  if (!collection) return std::unexpected(collection.error());
  std::vector<SeriesEntry> entries;
  for (const auto& element : (*collection)->children) {
    const auto number = static_cast<int>(entries.size());
    const std::string_view file = element->attribute("file"), time = element->attribute("timestep");
    if (file.empty())
      return badFile(path, "its <DataSet> number " + std::to_string(number) +
                               " names no file; save the series again");
    SeriesEntry entry{0, number, path.parent_path() / file};
    std::from_chars(time.data(), time.data() + time.size(), entry.time);
    entries.push_back(std::move(entry));
  }
  if (entries.empty()) return badFile(path, "its <Collection> is empty; save the series again");
  sortByTime(entries);
  return entries;
}

Result<std::vector<std::filesystem::path>> piecesOf(const std::filesystem::path& path,
                                                    MeshFormat format) {
  std::unique_ptr<XmlElement> tree;
  const Result<const XmlElement*> grid = listIn(path, std::string(rootType(format)), tree);
  if (!grid) return std::unexpected(grid.error());
  std::vector<std::filesystem::path> out;
  for (const auto& element : (*grid)->children) {
    if (element->name != "Piece") continue;
    const std::string_view file = element->attribute("Source");
    if (file.empty())
      return badFile(path, "its <Piece> number " + std::to_string(out.size()) +
                               " names no file; save it again");
    out.push_back(path.parent_path() / file);
  }
  if (out.empty()) return badFile(path, "it names no <Piece>; save it again");
  return out;
}

Result<std::vector<std::filesystem::path>> blocksOf(const std::filesystem::path& path,
                                                    std::vector<std::string>& notes) {
  std::unique_ptr<XmlElement> tree;
  const Result<const XmlElement*> set = listIn(path, "vtkMultiBlockDataSet", tree);
  if (!set) return std::unexpected(set.error());
  std::vector<std::filesystem::path> out;
  addBlockFiles(**set, path, out, notes);
  return out;
}

}  // namespace qtet
