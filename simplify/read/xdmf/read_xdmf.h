// XDMF as meshio and FEniCS write it (xdmf.org, "XDMF Model and Format", versions 2 and 3). It has
// one grid of cells or a series of time steps, with numbers in the XML or in files of HDF5.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "simplify/read/options/read_options.h"
#include "simplify/read/parts/xml_tree.h"
#include "simplify/read/xdmf/xdmf_items.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

class XdmfFile {
 public:
  /// Errors: those of readXml; bad-input (no root Xdmf, no grid; a time that is no number; what
  /// neither this reader nor meshio reads right, named).
  [[nodiscard]] static Result<XdmfFile> open(const std::filesystem::path& path);

  /// Whether the file has only parts that are read here. Others are for meshio, such as binary
  /// files.
  [[nodiscard]] bool isUnderstood() const { return isUnderstood_; }
  /// The times of its steps, ascending; empty: its one grid has no time.
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  /// Says which grids were left out.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  /// The mesh of a step (0 if there are no times) with the fields that the options mean. Grids of a
  /// spatial collection are blocks, with names where all differ (joinBlocks). Errors: bad-input
  /// (counts that contradict each other; numbers that are missing), not-found (a file of HDF5).
  /// Throws as HdfFile does. REQUIRES isUnderstood().
  [[nodiscard]] Result<CellMesh> read(std::size_t step, const ReadOptions& options,
                                      ReadReport& report);

 private:
  /// The elements of a grid. Several series of one file may each have fields of the same times.
  struct Part {
    std::string name;
    const XmlElement* topology = nullptr;
    const XmlElement* geometry = nullptr;
    std::vector<const XmlElement*> attributes;
  };
  using Step = std::vector<Part>;

  XdmfFile(std::filesystem::path path, std::unique_ptr<XmlElement> root)
      : path_(std::move(path)), root_(std::move(root)), items_(path_, *root_) {}

  Status addSteps();
  Status look(const Part& part);
  /// The times that a collection states for its grids; empty: it states none.
  [[nodiscard]] Result<std::vector<double>> timesOf(const XmlElement& collection,
                                                    std::size_t grids);
  /// The grids of a series. A later one of the same time and attribute counts in place of an older.
  Status addCollection(const XmlElement& collection, std::map<double, Step>& steps);
  Status merge(Step&& parts, Step& into);
  [[nodiscard]] Result<double> timeOf(const XmlElement& grid, std::size_t number,
                                      std::optional<double> listed) const;
  Status addGrid(const XmlElement& grid, Step& step);
  [[nodiscard]] Part partOf(const XmlElement& grid);
  void include(const XmlElement& element, Part& part);
  [[nodiscard]] Result<XdmfNumbers> numbersOf(const XmlElement& element);
  [[nodiscard]] Result<XdmfNumbers> coordinatesOf(const XmlElement& geometry);
  [[nodiscard]] Status addCells(const XmlElement& topology, CellMesh& out,
                                std::vector<std::uint64_t>& rows, std::uint64_t& cells,
                                ReadReport& report);
  [[nodiscard]] Result<CellMesh> read(const Part& from, const FieldNames& fields,
                                      ReadReport& report);

  std::filesystem::path path_;
  std::unique_ptr<XmlElement> root_;
  XdmfItems items_;
  bool isUnderstood_ = true;
  std::vector<double> times_;
  std::vector<std::string> notes_;
  std::vector<Step> steps_;
};

}  // namespace qtet
