#include <algorithm>
#include <limits>

#include "simplify/read/text/mesh_scanner.h"
#include "simplify/read/text/plain_words.h"
#include "simplify/read/text/text_readers.h"
#include "simplify/split/cell_shapes.h"

namespace qtet {
namespace {

class Su2 {
 public:
  Su2(std::string_view text, const std::filesystem::path& path) : in_(text, path, '%') {}

  Result<CellMesh> read(std::chrono::seconds patience) {
    in_.giveUpAfter(patience);
    while (!in_.atEnd()) {
      const std::string key = upper(in_.line());
      const std::size_t equals = key.find('=');
      if (equals == std::string::npos) continue;
      section(key.substr(0, key.find_first_of(" =")), key.substr(equals + 1));
    }
    if (in_.failed()) return in_.error();
    return std::move(out_);
  }

 private:
  static std::string upper(std::string_view text) {
    return capitals(text.substr(0, text.find('%')));
  }

  void section(const std::string& key, const std::string& value) {
    if (key != "NDIME" && key != "NZONE" && key != "NELEM" && key != "NPOIN") return;
    const std::size_t begin = value.find_first_not_of(" \t");
    std::uint64_t count = 0;
    const std::string number = begin == std::string::npos ? "" : value.substr(begin);
    if (std::from_chars(number.data(), number.data() + number.size(), count).ec != std::errc{})
      return in_.fail(ErrorCode::kBadInput,
                      key + "= has no number after it; the file is damaged, export it again");
    if (key == "NDIME" && count != 3)
      in_.fail(ErrorCode::kBadInput,
               "the mesh has " + std::to_string(count) + " dimensions, not 3; give a volume mesh");
    if (key == "NZONE" && count > 1)
      in_.fail(ErrorCode::kBadInput,
               "the file has " + std::to_string(count) + " zones; save each as a file of its own");
    if (key == "NELEM") elements(count);
    if (key == "NPOIN") points(count);
  }

  void elements(std::uint64_t count) {
    if (!in_.fits(count, 5 * kMinTextBytes, "elements")) return;
    std::vector<VertexId> ids;
    for (std::uint64_t i = 0; i < count && !in_.failed(); ++i) {
      const auto type = in_.number<std::uint8_t>("an element's type");
      if (type < kTetrahedronCell || type > kPyramidCell || type == kVoxelCell) {
        if (!in_.failed())
          in_.fail(ErrorCode::kBadInput,
                   "an element has type " + std::to_string(type) +
                       "; volume elements are 10, 12, 13 and 14. Export the mesh again");
        return;
      }
      ids.clear();
      for (std::uint32_t k = 0; k < verticesOf(type); ++k)
        ids.push_back(in_.number<VertexId>("a vertex id"));
      in_.skipLine();  // the element's own number, where it has one
      out_.addCell(type, ids);
    }
    in_.endsList(count, "elements");
  }

  void points(std::uint64_t count) {
    if (!in_.fits(count, 3 * kMinTextBytes, "points")) return;
    out_.points.reserve(count);
    for (std::uint64_t i = 0; i < count && !in_.failed(); ++i) {
      Position p{};
      for (double& x : p) x = in_.number<double>("a coordinate");
      in_.skipLine();
      out_.points.push_back(p);
    }
    in_.endsList(count, "points");
  }

  MeshScanner in_;
  CellMesh out_;
};

}  // namespace

Result<CellMesh> readSu2(const std::filesystem::path& path, ReadReport&,
                         std::chrono::seconds patience) {
  const Result<std::string> text = wholeFile(path);
  if (!text) return std::unexpected(text.error());
  return Su2(*text, path).read(patience);
}

}  // namespace qtet
