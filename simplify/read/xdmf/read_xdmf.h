// XDMF as meshio and FEniCS write it (xdmf.org, "XDMF Model and Format", versions 2 and 3). It has
// one grid of cells or a series of time steps, with numbers in the XML or in files of HDF5.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "simplify/read/hdf/hdf_file.h"
#include "simplify/read/options/read_options.h"
#include "simplify/read/parts/xml_tree.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

class XdmfFile {
 public:
  /// Errors: those of readXml; bad-input (no root Xdmf, no grid; a time that is no number).
  [[nodiscard]] static Result<XdmfFile> open(const std::filesystem::path& path);

  /// Whether the file has only parts that are read here. Others are for meshio: hyperslabs,
  /// functions, binary files, structured and spatial collections of grids.
  [[nodiscard]] bool isUnderstood() const { return isUnderstood_; }
  /// The times of its steps, ascending; empty: its one grid has no time.
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  /// Says which grids were left out.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  /// The mesh of a step (0 if there are no times) with the fields meant by `fields`. Errors:
  /// bad-input (counts that contradict each other; numbers that are missing), not-found (a file of
  /// HDF5). Throws as HdfFile does. REQUIRES isUnderstood().
  [[nodiscard]] Result<CellMesh> read(std::size_t step, const FieldNames& fields,
                                      ReadReport& report);

 private:
  /// The elements of a step. Several series of one file may each have fields of the same times.
  struct Step {
    const XmlElement* topology = nullptr;
    const XmlElement* geometry = nullptr;
    std::vector<const XmlElement*> attributes;
  };
  /// The numbers of a DataItem.
  struct Numbers {
    std::vector<double> values;
    std::string type;
    std::uint64_t rows = 0, columns = 1;
  };

  XdmfFile(std::filesystem::path path, std::unique_ptr<XmlElement> root)
      : path_(std::move(path)), root_(std::move(root)) {}

  Status addSteps();
  /// The grids of a series. A later one of the same time and attribute counts in place of an older.
  Status addCollection(const XmlElement& collection, std::map<double, Step>& steps);
  [[nodiscard]] Result<double> timeOf(const XmlElement& grid, std::size_t number);
  void addGrid(const XmlElement& grid, Step& step);
  void addParts(const XmlElement& grid, Step& step);
  void include(const XmlElement& element, Step& step);
  [[nodiscard]] const XmlElement* dataOf(const XmlElement& element) const;
  [[nodiscard]] bool isReadable(const XmlElement* element) const;
  [[nodiscard]] Result<Numbers> numbersOf(const XmlElement& element);
  [[nodiscard]] Result<Numbers> fromHdf(std::string_view place);
  [[nodiscard]] Result<Numbers> fromText(const XmlElement& item);
  [[nodiscard]] Status addCells(const XmlElement& topology, CellMesh& out,
                                std::vector<std::uint64_t>& rows, std::uint64_t& cells,
                                ReadReport& report);
  [[nodiscard]] std::unexpected<Error> bad(const std::string& what) const;

  std::filesystem::path path_;
  std::unique_ptr<XmlElement> root_;
  bool isUnderstood_ = true;
  std::vector<double> times_;
  std::vector<std::string> notes_;
  std::vector<Step> steps_;
  std::map<std::filesystem::path, HdfFile> files_;
};

}  // namespace qtet
