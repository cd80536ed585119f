// The numbers of XDMF's DataItems: in the XML, in files of HDF5, or a part of another item.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"
#include "simplify/read/hdf/hdf_file.h"
#include "simplify/read/parts/xml_tree.h"

namespace qtet {

/// In small letters: names in XDMF are compared so.
[[nodiscard]] std::string xdmfLower(std::string_view text);
/// Without blanks at its ends.
[[nodiscard]] std::string_view xdmfTrimmed(std::string_view text);

struct XdmfNumbers {
  std::vector<double> values;
  std::string type;  ///< as MeshField's
  std::uint64_t rows = 0, columns = 1;
};

/// The items of one file. Keeps the files of HDF5 open that they name.
class XdmfItems {
 public:
  /// Dimensions of an array of which a hyperslab is a part.
  static constexpr std::size_t kMaxRank = 8;

  /// `root` must outlive it.
  XdmfItems(std::filesystem::path path, const XmlElement& root)
      : path_(std::move(path)), root_(&root) {}

  /// The element, or the one that it refers to; nullptr: that is not there.
  [[nodiscard]] const XmlElement* resolved(const XmlElement& element) const;
  /// All DataItems of an element, resolved; nullptr for one that is not there.
  [[nodiscard]] std::vector<const XmlElement*> itemsOf(const XmlElement& element) const;
  /// Whether the item and those within it are of kinds that are read here.
  [[nodiscard]] bool isReadable(const XmlElement* item) const { return isReadable(item, 0); }
  /// Why no program reads the item here, "a DataItem of type Function"; empty: meshio may.
  [[nodiscard]] std::string refusalOf(const XmlElement* item) const;

  /// Errors: bad-input (counts that contradict each other; no numbers), not-found (a file of HDF5).
  /// Throws as HdfFile does. REQUIRES isReadable().
  [[nodiscard]] Result<XdmfNumbers> numbersOf(const XmlElement& item);
  /// As numbersOf, of an item with its numbers in the XML.
  [[nodiscard]] Result<XdmfNumbers> fromText(const XmlElement& item) const;

  [[nodiscard]] std::unexpected<Error> bad(const std::string& what) const;

 private:
  /// Rows of an array.
  struct Rows {
    std::uint64_t first = 0, count = 0;
  };

  [[nodiscard]] bool isReadable(const XmlElement* item, int depth) const;
  /// The whole array, or of an array of `rows` rows those between.
  [[nodiscard]] Result<XdmfNumbers> fromHdf(std::string_view place, const Rows* rows,
                                            std::uint64_t ofRows);
  [[nodiscard]] Result<XdmfNumbers> slabOf(const XmlElement& item);

  std::filesystem::path path_;
  const XmlElement* root_;
  std::map<std::filesystem::path, HdfFile> files_;
};

}  // namespace qtet
