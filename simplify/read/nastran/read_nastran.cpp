#include "simplify/read/nastran/read_nastran.h"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>

#include "simplify/read/nastran/bulk_cards.h"
#include "simplify/read/nastran/coordinate_systems.h"
#include "simplify/read/text/set_labels.h"

namespace qtet {
namespace {

constexpr std::size_t kMaxNodes = 20;

/// A volume element. `order` has the place in the card of each node in VTK's order.
struct Volume {
  std::string_view name;
  std::uint8_t linear, quadratic;
  std::size_t corners, nodes;
  std::array<std::uint8_t, kMaxNodes> order;
};
constexpr std::array<std::uint8_t, kMaxNodes> kSame{0,  1,  2,  3,  4,  5,  6,  7,  8,  9,
                                                    10, 11, 12, 13, 14, 15, 16, 17, 18, 19};
/// Nastran lists the upright edges before the upper ones.
constexpr std::array<Volume, 5> kVolumes{{
    {"CTETRA", kTetrahedronCell, kQuadraticTetrahedronCell, 4, 10, kSame},
    {"CPYRAM", kPyramidCell, kQuadraticPyramidCell, 5, 13, kSame},
    {"CPYRA", kPyramidCell, kQuadraticPyramidCell, 5, 13, kSame},
    {"CPENTA",
     kWedgeCell,
     kQuadraticWedgeCell,
     6,
     15,
     {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11}},
    {"CHEXA", kHexahedronCell, kQuadraticHexahedronCell, 8, 20, {0,  1,  2,  3,  4,  5,  6,
                                                                 7,  8,  9,  10, 11, 16, 17,
                                                                 18, 19, 12, 13, 14, 15}},
}};
/// Names of volumes that are not read begin so.
constexpr auto kOtherVolumes = std::to_array<std::string_view>(
    {"CHEX", "CTET", "CPEN", "CPYR", "CWEDGE", "CIHEX", "CIFHEX", "CIFPENT"});
/// Names of elements that are no volumes begin so.
constexpr auto kFlat = std::to_array<std::string_view>(
    {"CQUAD", "CTRI",   "CTRAX", "CSHEAR", "CBAR",  "CBEAM",  "CBEND", "CROD",   "CONROD",
     "CTUBE", "CBUSH",  "CELAS", "CDAMP",  "CMASS", "CGAP",   "CWELD", "CFAST",  "CONM",
     "CVISC", "PLOTEL", "RBE",   "RBAR",   "RROD",  "RTRPLT", "CHBDY", "CIFQDX", "CSEAM"});

bool beginsWithOneOf(std::string_view name, std::span<const std::string_view> fronts) {
  return std::ranges::any_of(fronts,
                             [&](std::string_view front) { return name.starts_with(front); });
}

std::optional<SystemCard> systemKind(std::string_view name) {
  constexpr std::string_view kLetters = "RCS";
  if (name.size() != 6 || !(name.starts_with("CORD1") || name.starts_with("CORD2")))
    return std::nullopt;
  const std::size_t kind = kLetters.find(name[5]);
  if (kind == std::string_view::npos) return std::nullopt;
  SystemCard out;
  out.kind = static_cast<SystemKind>(kind);
  out.isByGrids = name[4] == '1';
  return out;
}

class BulkMesh {
 public:
  BulkMesh(const std::filesystem::path& path, std::chrono::seconds patience)
      : path_(path), cards_(path, patience) {}

  Result<CellMesh> read(ReadReport& report) {
    while (cards_.next()) take(cards_.name());
    if (cards_.failed()) return cards_.error();
    report.ignoredCells += ignored_;
    for (const std::size_t row : ofTheDefault_) file_.grids[row].system = defaultSystem_;
    Result<std::vector<Position>> places = file_.places();
    if (!places) return fail(places.error().code, path_.string() + ": " + places.error().message);
    out_.points = std::move(*places);
    out_.pointType = "float64";
    if (Status named = nameRows(); !named) return std::unexpected(named.error());
    if (auto label = labelOf("nastran:ref", properties_, {})) out_.fields.push_back(*label);
    return std::move(out_);
  }

 private:
  void take(const std::string& name) {
    if (name == "GRID") return takeGrid();
    if (name == "GRDSET") {
      defaultSystem_ = cards_.id(1, "a coordinate system");
      return;
    }
    if (const std::optional<SystemCard> kind = systemKind(name)) return takeSystem(*kind);
    const auto volume = std::ranges::find(kVolumes, name, &Volume::name);
    if (volume != kVolumes.end()) return takeVolume(*volume);
    if (beginsWithOneOf(name, kOtherVolumes))
      return cards_.fail("elements " + name +
                         " are not read; CTETRA, CHEXA, CPENTA and CPYRAM are: export the mesh "
                         "with these");
    if (beginsWithOneOf(name, kFlat)) ++ignored_;
  }

  void takeGrid() {
    GridCard grid{cards_.id(0, "a point's number"), cards_.id(1, "a coordinate system"), {}};
    for (std::size_t a = 0; a < 3; ++a) grid.place[a] = cards_.real(2 + a, "a coordinate");
    if (cards_.failed()) return;
    const auto row = static_cast<std::uint32_t>(file_.grids.size());
    const auto [at, isNew] = file_.rows.try_emplace(grid.number, row);
    const bool hasDefault = cards_.field(1).empty();
    if (!isNew) {
      if (file_.grids[at->second] != grid)
        cards_.fail("point " + std::to_string(grid.number) +
                    " is there already at another place; number the points anew");
      return;
    }
    if (hasDefault) ofTheDefault_.push_back(row);
    file_.grids.push_back(grid);
  }

  /// A card of CORD1 has two systems at most.
  void takeSystem(SystemCard card) {
    const std::size_t step = 4, count = card.isByGrids && !cards_.field(step).empty() ? 2 : 1;
    for (std::size_t at = 0; at < count * step; at += step) {
      const std::uint32_t number = cards_.id(at, "a coordinate system's number");
      for (std::size_t k = 0; card.isByGrids && k < 3; ++k)
        card.grids[k] = cards_.id(at + 1 + k, "a point's number");
      if (!card.isByGrids) {
        card.reference = cards_.id(1, "a coordinate system");
        for (std::size_t i = 0; i < 9; ++i)
          card.points[i / 3][i % 3] = cards_.real(2 + i, "a coordinate");
      }
      if (!cards_.failed() && (number == 0 || !file_.systems.emplace(number, card).second))
        cards_.fail("coordinate system " + std::to_string(number) +
                    (number == 0 ? " is the basic one" : " is there already") +
                    "; number the systems anew");
    }
  }

  void takeVolume(const Volume& volume) {
    const std::uint32_t number = cards_.id(0, "an element's number"),
                        property = cards_.id(1, "a property's number");
    std::array<std::uint32_t, kMaxNodes> nodes{};
    std::size_t there = 0, onEdges = 0;
    for (std::size_t i = 0; i < volume.nodes; ++i) {
      if (cards_.field(2 + i) == "CORDM") break;  // a material's system follows
      nodes[i] = cards_.id(2 + i, "a point's number");
      if (nodes[i] != 0) ++(i < volume.corners ? there : onEdges);
    }
    if (cards_.failed()) return;
    const std::string element = cards_.name() + " " + std::to_string(number);
    if (there < volume.corners)
      return cards_.fail(element + " has " + std::to_string(there) + " corners, not " +
                         std::to_string(volume.corners) + "; export the file again");
    if (onEdges != 0 && onEdges != volume.nodes - volume.corners)
      return cards_.fail(element + " has nodes on " + std::to_string(onEdges) + " of its " +
                         std::to_string(volume.nodes - volume.corners) +
                         " edges, which is not read; give it all or none");
    const std::size_t count = onEdges == 0 ? volume.corners : volume.nodes;
    std::array<VertexId, kMaxNodes> ordered{};
    for (std::size_t i = 0; i < count; ++i) ordered[i] = nodes[volume.order[i]];
    addVolume(number, property, onEdges == 0 ? volume.linear : volume.quadratic,
              std::span(ordered).first(count));
  }

  /// Its nodes are numbers of points until all are known.
  void addVolume(std::uint32_t number, std::uint32_t property, std::uint8_t type,
                 std::span<const VertexId> nodes) {
    const auto [at, isNew] =
        elements_.try_emplace(number, static_cast<std::uint32_t>(out_.cells()));
    if (!isNew) {
      if (out_.types[at->second] != type || !std::ranges::equal(out_.cell(at->second), nodes))
        cards_.fail("element " + std::to_string(number) +
                    " is there already with other nodes; number the elements anew");
      return;
    }
    out_.addCell(type, nodes);
    properties_.push_back(property);
    numbers_.push_back(number);
  }

  Status nameRows() {
    for (std::size_t c = 0; c < out_.cells(); ++c)
      for (std::uint64_t i = out_.begins[c]; i < out_.begins[c + 1]; ++i) {
        const auto row = file_.rows.find(out_.vertices[i]);
        if (row == file_.rows.end())
          return fail(ErrorCode::kBadInput, path_.string() + ": element " +
                                                std::to_string(numbers_[c]) + " has the point " +
                                                std::to_string(out_.vertices[i]) +
                                                ", which is not there; export the file again");
        out_.vertices[i] = row->second;
      }
    return {};
  }

  const std::filesystem::path& path_;
  BulkCards cards_;
  PlacedGrids file_;
  std::uint32_t defaultSystem_ = 0;
  std::vector<std::uint32_t> ofTheDefault_;  ///< rows of grids whose card names no system
  NumberTable elements_;                     ///< cells by their numbers
  std::vector<std::uint32_t> properties_, numbers_;
  std::uint64_t ignored_ = 0;
  CellMesh out_;
};

}  // namespace

Result<CellMesh> readNastran(const std::filesystem::path& path, ReadReport& report,
                             std::chrono::seconds patience) {
  return BulkMesh(path, patience).read(report);
}

}  // namespace qtet
