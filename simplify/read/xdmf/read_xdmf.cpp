#include "simplify/read/xdmf/read_xdmf.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "simplify/read/options/select_fields.h"
#include "simplify/read/options/time_text.h"
#include "simplify/read/vtu/grid_parts.h"

namespace qtet {
namespace {

/// A kind of cells by its name and its number in mixed topologies. `type` is VTK's; the order of
/// the nodes is VTK's too.
struct Kind {
  std::string_view name;
  std::int64_t number;
  std::uint8_t type;
  std::uint8_t nodes;
};
constexpr std::uint8_t kNoVolume = 5;  // VTK's triangle stands for all kinds that are no volume
constexpr std::array<Kind, 19> kKinds{{
    {"triangle", 4, kNoVolume, 3},
    {"quadrilateral", 5, kNoVolume, 4},
    {"tetrahedron", 6, kTetrahedronCell, 4},
    {"pyramid", 7, kPyramidCell, 5},
    {"wedge", 8, kWedgeCell, 6},
    {"hexahedron", 9, kHexahedronCell, 8},
    {"edge_3", 34, kNoVolume, 3},
    {"quadrilateral_9", 35, kNoVolume, 9},
    {"triangle_6", 36, kNoVolume, 6},
    {"quadrilateral_8", 37, kNoVolume, 8},
    {"tetrahedron_10", 38, kQuadraticTetrahedronCell, 10},
    {"tet_10", 38, kQuadraticTetrahedronCell, 10},
    {"pyramid_13", 39, kQuadraticPyramidCell, 13},
    {"wedge_15", 40, kQuadraticWedgeCell, 15},
    {"wedge_18", 41, kBiquadraticQuadraticWedgeCell, 18},
    {"hexahedron_20", 48, kQuadraticHexahedronCell, 20},
    {"hex_20", 48, kQuadraticHexahedronCell, 20},
    {"hexahedron_27", 50, kTriquadraticHexahedronCell, 27},
    {"hex_27", 50, kTriquadraticHexahedronCell, 27},
}};
/// Points, lines and polygons: in mixed topologies their number of nodes follows.
constexpr std::int64_t kLastCounted = 3;

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

template <class T>
std::optional<T> numberIn(std::string_view text) {
  text = trimmed(text);
  T value{};
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || read.ec != std::errc{} || read.ptr != text.data() + text.size())
    return std::nullopt;
  return value;
}

std::string_view topologyType(const XmlElement& topology) {
  const std::string_view type = topology.attribute("TopologyType");
  return type.empty() ? topology.attribute("Type") : type;
}

const Kind* kindOf(std::string_view name) {
  const auto at = std::ranges::find(kKinds, lower(name), &Kind::name);
  return at == kKinds.end() ? nullptr : &*at;
}

bool isMixed(const XmlElement& topology) { return lower(topologyType(topology)) == "mixed"; }

/// As MeshField's; by default XDMF's numbers are floats of four bytes.
std::string typeOf(const XmlElement& item) {
  std::string_view kind = item.attribute("NumberType");
  if (kind.empty()) kind = item.attribute("DataType");
  const std::string name = lower(kind);
  const std::uint64_t bytes = numberIn<std::uint64_t>(item.attribute("Precision")).value_or(4);
  if (name == "char") return "int8";
  if (name == "uchar") return "uint8";
  if (name == "int" || name == "uint") {
    const bool isSize = bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8;
    return name + std::to_string(isSize ? 8 * bytes : 64);
  }
  return bytes == 8 ? "float64" : "float32";
}

bool isOfCells(const XmlElement& attribute) {
  return lower(attribute.attribute("Center")) == "cell";
}

bool isOfNodes(const XmlElement& attribute) {
  const std::string centre = lower(attribute.attribute("Center"));
  return centre.empty() || centre == "node";
}

std::set<std::string_view> attributesOf(const XmlElement& grid) {
  std::set<std::string_view> out;
  for (const auto& child : grid.children)
    if (child->name == "Attribute") out.insert(child->attribute("Name"));
  return out;
}

/// Whether a grid has an attribute that an older one of its series and time has, or both have none.
bool isWrittenAgain(const XmlElement& older, const XmlElement& grid) {
  const auto before = attributesOf(older), now = attributesOf(grid);
  return std::ranges::any_of(now, [&](std::string_view name) { return before.contains(name); }) ||
         (before.empty() && now.empty());
}

}  // namespace

std::unexpected<Error> XdmfFile::bad(const std::string& what) const {
  return fail(ErrorCode::kBadInput, path_.string() + ": " + what + "; export the mesh again");
}

Result<XdmfFile> XdmfFile::open(const std::filesystem::path& path) {
  Result<std::unique_ptr<XmlElement>> root = readXml(path);
  if (!root) return std::unexpected(root.error());
  XdmfFile out(path, std::move(*root));
  if (!out.root_ || out.root_->name != "Xdmf") return out.bad("it does not begin with <Xdmf>");
  if (Status done = out.addSteps(); !done) return std::unexpected(done.error());
  return out;
}

Status XdmfFile::addSteps() {
  const XmlElement* domain = root_->child("Domain");
  if (!domain) return bad("it has no <Domain>");
  std::map<double, Step> steps;
  std::vector<const XmlElement*> single;
  bool isSeries = false;
  for (const auto& grid : domain->children) {
    if (grid->name != "Grid") continue;
    if (lower(grid->attribute("GridType")) != "collection") {
      single.push_back(grid.get());
      continue;
    }
    if (lower(grid->attribute("CollectionType")) != "temporal") {
      isUnderstood_ = false;
      return {};
    }
    isSeries = true;
    if (Status done = addCollection(*grid, steps); !done) return done;
  }
  if (!isSeries) {
    if (single.size() != 1) {
      if (single.empty()) return bad("it has no <Grid>");
      isUnderstood_ = false;
      return {};
    }
    const Result<double> time = timeOf(*single.front(), 0);
    if (!time) return std::unexpected(time.error());
    addGrid(*single.front(), steps[*time]);
    if (!single.front()->child("Time")) {
      steps_.push_back(steps.begin()->second);
      steps.clear();
    }
  }
  if (isSeries && steps.empty()) return bad("its collection has no <Grid>");
  for (auto& [time, step] : steps) {
    times_.push_back(time);
    steps_.push_back(std::move(step));
  }
  for (const Step& step : steps_) {
    isUnderstood_ = isUnderstood_ && step.topology && isReadable(step.topology) &&
                    isReadable(step.geometry) &&
                    (isMixed(*step.topology) || kindOf(topologyType(*step.topology)));
    for (const XmlElement* attribute : step.attributes)
      isUnderstood_ = isUnderstood_ && isReadable(attribute);
  }
  return {};
}

Status XdmfFile::addCollection(const XmlElement& collection, std::map<double, Step>& steps) {
  std::map<double, std::vector<const XmlElement*>> grids;
  std::size_t number = 0, leftOut = 0;
  std::vector<double> repeated;
  for (const auto& grid : collection.children) {
    if (grid->name != "Grid") continue;
    const Result<double> time = timeOf(*grid, number++);
    if (!time) return std::unexpected(time.error());
    std::vector<const XmlElement*>& ofTime = grids[*time];
    if (std::ranges::any_of(ofTime,
                            [&](const auto* older) { return isWrittenAgain(*older, *grid); })) {
      leftOut += ofTime.size();
      ofTime.clear();
      repeated.push_back(*time);
    }
    ofTime.push_back(grid.get());
  }
  for (const auto& [time, ofTime] : grids)
    for (const XmlElement* grid : ofTime) addGrid(*grid, steps[time]);
  if (leftOut > 0)
    notes_.push_back("grids left out, because later ones of their series have the same time: " +
                     std::to_string(leftOut) + ", at time " + shownTimes(repeated));
  return {};
}

Result<double> XdmfFile::timeOf(const XmlElement& grid, std::size_t number) {
  const XmlElement* at = grid.child("Time");
  if (!at) return static_cast<double>(number);
  const auto value = at->attributes.find("Value");
  if (value == at->attributes.end()) {
    isUnderstood_ = false;
    return static_cast<double>(number);
  }
  if (const auto time = timeIn(value->second)) return *time;
  return fail(ErrorCode::kBadInput, path_.string() + ": the <Time> of its <Grid> number " +
                                        std::to_string(number) + " is \"" + value->second +
                                        "\", which is no number; give it its time, a number such "
                                        "as 0.5");
}

void XdmfFile::addGrid(const XmlElement& grid, Step& step) {
  const std::string type = lower(grid.attribute("GridType"));
  isUnderstood_ = isUnderstood_ && (type.empty() || type == "uniform");
  addParts(grid, step);
}

void XdmfFile::addParts(const XmlElement& grid, Step& step) {
  for (const auto& child : grid.children) {
    if (child->name == "Topology" && !step.topology) step.topology = child.get();
    if (child->name == "Geometry" && !step.geometry) step.geometry = child.get();
    if (child->name == "Attribute") step.attributes.push_back(child.get());
    if (child->name.ends_with("include")) include(*child, step);
  }
  const auto resolved = [&](const XmlElement* element) {
    if (!element || element->attribute("Reference").empty()) return element;
    const std::string_view reference = element->attribute("Reference");
    return firstAt(*root_, reference == "XML" ? trimmed(element->text) : reference);
  };
  step.topology = resolved(step.topology);
  step.geometry = resolved(step.geometry);
}

/// xpointer(PATH/*[self::Topology or self::Geometry]): the parts of another grid.
void XdmfFile::include(const XmlElement& element, Step& step) {
  std::string_view pointer = trimmed(element.attribute("xpointer"));
  constexpr std::string_view kCall = "xpointer(";
  const std::size_t parts = pointer.rfind("/*[");
  if (!pointer.starts_with(kCall) || !pointer.ends_with("])") || parts == std::string_view::npos) {
    isUnderstood_ = false;
    return;
  }
  const std::string_view which = pointer.substr(parts);
  const XmlElement* grid = firstAt(*root_, pointer.substr(kCall.size(), parts - kCall.size()));
  isUnderstood_ = isUnderstood_ && grid;
  if (!grid) return;
  if (which.contains("self::Topology") && !step.topology) step.topology = grid->child("Topology");
  if (which.contains("self::Geometry") && !step.geometry) step.geometry = grid->child("Geometry");
}

/// The DataItem of an element, or the one that it refers to.
const XmlElement* XdmfFile::dataOf(const XmlElement& element) const {
  const XmlElement* item = element.child("DataItem");
  if (!item || item->attribute("Reference").empty()) return item;
  const std::string_view reference = item->attribute("Reference");
  return firstAt(*root_, reference == "XML" ? trimmed(item->text) : reference);
}

bool XdmfFile::isReadable(const XmlElement* element) const {
  if (!element) return false;
  const auto items = std::ranges::count_if(
      element->children, [](const auto& child) { return child->name == "DataItem"; });
  const XmlElement* item = dataOf(*element);
  if (items != 1 || !item) return false;
  const std::string kind = lower(item->attribute("ItemType")),
                    format = lower(item->attribute("Format"));
  if (!kind.empty() && kind != "uniform") return false;
  if (element->name == "Geometry") {
    std::string_view type = element->attribute("GeometryType");
    if (type.empty()) type = element->attribute("Type");
    if (!type.empty() && lower(type) != "xyz") return false;
  }
  return format.empty() || format == "xml" || format == "hdf";
}

Result<XdmfFile::Numbers> XdmfFile::fromHdf(std::string_view place) {
  place = trimmed(place);
  const std::size_t colon = place.rfind(':');
  if (colon == std::string_view::npos)
    return bad("a DataItem names '" + std::string(place.substr(0, 80)) +
               "', which is no FILE.h5:ARRAY");
  const std::filesystem::path path = path_.parent_path() / place.substr(0, colon);
  auto file = files_.find(path);
  if (file == files_.end()) {
    std::error_code code;
    if (!std::filesystem::exists(path, code))
      return fail(ErrorCode::kNotFound, path_.string() + " names " + path.string() +
                                            ", which is not there; copy both files together");
    Result<HdfFile> opened = HdfFile::open(path);
    if (!opened) return std::unexpected(opened.error());
    file = files_.emplace(path, std::move(*opened)).first;
  }
  std::string name(place.substr(colon + 1));
  name.erase(0, name.find_first_not_of('/'));
  const auto array = file->second.array(name);
  if (!array) return std::unexpected(array.error());
  Result<std::vector<double>> values = file->second.reals(*array, 0, array->rows);
  if (!values) return std::unexpected(values.error());
  return Numbers{std::move(*values), array->type, array->rows, array->columns};
}

Result<XdmfFile::Numbers> XdmfFile::fromText(const XmlElement& item) {
  Numbers out;
  out.type = typeOf(item);
  std::string_view text = item.text;
  for (;;) {
    text = trimmed(text);
    if (text.empty()) break;
    const std::size_t end = std::min(text.find_first_of(" \t\r\n"), text.size());
    std::string_view word = text.substr(0, end);
    text.remove_prefix(end);
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto value = numberIn<double>(word);
    if (!value) return bad("'" + std::string(word.substr(0, 20)) + "' in a DataItem is no number");
    out.values.push_back(*value);
  }
  // Dimensions="12 3": the rows are the first
  const std::string_view dimensions = trimmed(item.attribute("Dimensions"));
  const auto rows = numberIn<std::uint64_t>(dimensions.substr(0, dimensions.find(' ')));
  if (!rows || (*rows == 0) != out.values.empty() || (*rows > 0 && out.values.size() % *rows != 0))
    return bad("a DataItem with Dimensions '" + std::string(dimensions.substr(0, 40)) + "' has " +
               std::to_string(out.values.size()) + " numbers");
  out.rows = *rows;
  out.columns = *rows > 0 ? out.values.size() / *rows : 1;
  return out;
}

Result<XdmfFile::Numbers> XdmfFile::numbersOf(const XmlElement& element) {
  const XmlElement* item = dataOf(element);
  if (!item) return bad("an element <" + element.name + "> has no DataItem");
  return lower(item->attribute("Format")) == "hdf" ? fromHdf(item->text) : fromText(*item);
}

Status XdmfFile::addCells(const XmlElement& topology, CellMesh& out,
                          std::vector<std::uint64_t>& rows, std::uint64_t& cells,
                          ReadReport& report) {
  const Result<Numbers> numbers = numbersOf(topology);
  if (!numbers) return std::unexpected(numbers.error());
  const std::vector<double>& values = numbers->values;
  const Kind* one = isMixed(topology) ? nullptr : kindOf(topologyType(topology));
  std::vector<VertexId> ids;
  for (std::size_t at = 0; at < values.size(); ++cells) {
    const Kind* kind = one;
    std::size_t nodes = one ? one->nodes : 0;
    if (!one) {
      const double number = values[at++];
      const auto known = std::ranges::find_if(
          kKinds, [&](const Kind& k) { return static_cast<double>(k.number) == number; });
      if (known != kKinds.end()) {
        kind = &*known, nodes = kind->nodes;
      } else if (number >= 1 && number <= kLastCounted && at < values.size() && values[at] >= 0 &&
                 values[at] <= static_cast<double>(values.size() - at)) {
        nodes = static_cast<std::size_t>(values[at++]);
      } else {
        return bad("cell " + std::to_string(cells) +
                   " is of a kind that is not read: " + std::to_string(number));
      }
    }
    if (nodes > values.size() - at) return bad("the list of cells ends within one");
    if (!kind || kind->type == kNoVolume) {
      ++report.ignoredCells;
      at += nodes;
      continue;
    }
    ids.clear();
    for (const std::size_t end = at + nodes; at < end; ++at) {
      const bool isThere = values[at] >= 0 && values[at] < static_cast<double>(out.points.size());
      ids.push_back(isThere ? static_cast<VertexId>(values[at]) : kGhost);
    }
    out.addCell(kind->type, ids);
    rows.push_back(cells);
  }
  std::string_view told = topology.attribute("NumberOfElements");
  if (told.empty()) told = topology.attribute("Dimensions");
  if (const auto count = numberIn<std::uint64_t>(told.substr(0, trimmed(told).find(' ')));
      !told.empty() && count != cells)
    return bad("its topology says " + std::string(told.substr(0, 40)) + " cells, but lists " +
               std::to_string(cells));
  return {};
}

Result<CellMesh> XdmfFile::read(std::size_t step, const FieldNames& fields, ReadReport& report) {
  const Step& from = steps_[step];
  CellMesh out;
  const Result<Numbers> points = numbersOf(*from.geometry);
  if (!points) return std::unexpected(points.error());
  // a list of numbers without columns is one of triples, too
  if (points->columns != 3 && (points->columns != 1 || points->values.size() % 3 != 0))
    return bad("its points have " + std::to_string(points->columns) + " coordinates, not 3");
  out.pointType = points->type == "float32" ? "float32" : "float64";
  out.points.resize(points->values.size() / 3);
  for (std::size_t i = 0; i < points->values.size(); ++i)
    out.points[i / 3][i % 3] = points->values[i];
  std::vector<std::uint64_t> rows;
  std::uint64_t cells = 0;
  if (Status done = addCells(*from.topology, out, rows, cells, report); !done)
    return std::unexpected(done.error());
  if (rows.size() < cells) out.cellIds = rows;

  FieldChoice choice(fields, report);
  int number = 0;
  for (const XmlElement* attribute : from.attributes) {
    const bool ofCells = isOfCells(*attribute);
    const std::string name(attribute->attribute("Name"));
    if (!ofCells && !isOfNodes(*attribute)) {
      report.ignoredFields.push_back(name);
      report.notes.push_back("field " + name + " was ignored: it is neither of nodes nor of cells");
      continue;
    }
    const char* association = ofCells ? "cell" : "point";
    if (!isMeant(fields, association, name)) {
      out.otherFields.push_back(name);
      continue;
    }
    Result<Numbers> values = numbersOf(*attribute);
    if (!values) return std::unexpected(values.error());
    const std::uint64_t tuples = ofCells ? cells : out.points.size();
    if (tuples == 0 || values->values.size() % tuples != 0 || values->values.empty())
      return bad("its field " + name + " has " + std::to_string(values->values.size()) +
                 " numbers, which are none or no equal share for each of " +
                 std::to_string(tuples) + (ofCells ? " cells" : " points"));
    const std::uint64_t components = values->values.size() / tuples;
    const auto chosen =
        choice.nameOf({name, number++, components, !values->type.empty(), false}, association, out);
    if (!chosen) continue;
    MeshField field{*chosen, static_cast<std::uint32_t>(components), values->type,
                    std::move(values->values), association};
    if (ofCells) keepRows(field, rows);
    out.fields.push_back(std::move(field));
  }
  return out;
}

}  // namespace qtet
