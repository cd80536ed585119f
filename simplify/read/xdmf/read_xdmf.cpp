#include "simplify/read/xdmf/read_xdmf.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "simplify/read/options/grid_parts.h"
#include "simplify/read/options/select_fields.h"
#include "simplify/read/options/time_text.h"
#include "simplify/read/steps/cell_labels.h"
#include "simplify/read/steps/join_blocks.h"

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

template <class T>
std::optional<T> numberIn(std::string_view text) {
  text = xdmfTrimmed(text);
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
  const auto at = std::ranges::find(kKinds, xdmfLower(name), &Kind::name);
  return at == kKinds.end() ? nullptr : &*at;
}

bool isMixed(const XmlElement& topology) { return xdmfLower(topologyType(topology)) == "mixed"; }

bool isOfCells(const XmlElement& attribute) {
  return xdmfLower(attribute.attribute("Center")) == "cell";
}

bool isOfNodes(const XmlElement& attribute) {
  const std::string centre = xdmfLower(attribute.attribute("Center"));
  return centre.empty() || centre == "node";
}

std::set<std::string_view> attributesOf(const XmlElement& grid) {
  std::set<std::string_view> out;
  for (const auto& child : grid.children)
    if (child->name == "Attribute") out.insert(child->attribute("Name"));
  return out;
}

std::string geometryType(const XmlElement& geometry) {
  std::string_view type = geometry.attribute("GeometryType");
  if (type.empty()) type = geometry.attribute("Type");
  return xdmfLower(type);
}
bool isInThree(const XmlElement& geometry) { return geometryType(geometry) == "x_y_z"; }

enum class GridKind : std::uint8_t { kUniform, kTemporal, kParts, kOther };

GridKind kindOfGrid(const XmlElement& grid) {
  const std::string type = xdmfLower(grid.attribute("GridType"));
  if (type.empty() || type == "uniform") return GridKind::kUniform;
  if (type == "tree") return GridKind::kParts;
  if (type != "collection") return GridKind::kOther;
  return xdmfLower(grid.attribute("CollectionType")) == "temporal" ? GridKind::kTemporal
                                                                   : GridKind::kParts;
}

/// Whether a grid has an attribute that an older one of its series and time has, or both have none.
bool isWrittenAgain(const XmlElement& older, const XmlElement& grid) {
  const auto before = attributesOf(older), now = attributesOf(grid);
  return std::ranges::any_of(now, [&](std::string_view name) { return before.contains(name); }) ||
         (before.empty() && now.empty());
}

}  // namespace

Result<XdmfFile> XdmfFile::open(const std::filesystem::path& path) {
  Result<std::unique_ptr<XmlElement>> root = readXml(path);
  if (!root) return std::unexpected(root.error());
  const std::string name = path.string();
  if (!*root || (*root)->name != "Xdmf")
    return fail(ErrorCode::kBadInput,
                name + ": it does not begin with <Xdmf>; export the mesh again");
  XdmfFile out(path, std::move(*root));
  if (Status done = out.addSteps(); !done) return std::unexpected(done.error());
  return out;
}

Status XdmfFile::addSteps() {
  const XmlElement* domain = root_->child("Domain");
  if (!domain) return items_.bad("it has no <Domain>");
  std::map<double, Step> steps;
  std::vector<const XmlElement*> others;
  bool isSeries = false;
  for (const auto& grid : domain->children) {
    if (grid->name != "Grid") continue;
    const bool isTemporal = kindOfGrid(*grid) == GridKind::kTemporal;
    if (!isTemporal) {
      others.push_back(grid.get());
      continue;
    }
    isSeries = true;
    if (Status done = addCollection(*grid, steps); !done) return done;
  }
  if (!isSeries) {
    if (others.empty()) return items_.bad("it has no <Grid>");
    const Result<double> time = timeOf(*others.front(), 0, std::nullopt);
    if (!time) return std::unexpected(time.error());
    Step& step = steps[*time];
    for (const XmlElement* grid : others)
      if (Status done = addGrid(*grid, step); !done) return done;
    if (!others.front()->child("Time")) {
      steps_.push_back(std::move(step));
      steps.clear();
    }
  }
  if (isSeries && steps.empty()) return items_.bad("its collection has no <Grid>");
  for (auto& [time, step] : steps) {
    times_.push_back(time);
    steps_.push_back(std::move(step));
  }
  for (const Step& step : steps_)
    for (const Part& part : step)
      if (Status done = look(part); !done) return done;
  return {};
}

/// Decides whether the part is read here, is for meshio, or is refused, since meshio would read it
/// wrong.
Status XdmfFile::look(const Part& part) {
  const auto lookAt = [&](const XmlElement* element) -> Status {
    if (!element) {
      isUnderstood_ = false;
      return {};
    }
    const auto found = items_.itemsOf(*element);
    for (const XmlElement* item : found) {
      if (const std::string why = items_.refusalOf(item); !why.empty())
        return items_.bad("<" + element->name + "> has " + why + ", which is not read");
      isUnderstood_ = isUnderstood_ && items_.isReadable(item);
    }
    const bool isApart = element == part.geometry && isInThree(*element);
    isUnderstood_ = isUnderstood_ && found.size() == (isApart ? 3u : 1u);
    return {};
  };
  for (const XmlElement* element : {part.topology, part.geometry})
    if (Status done = lookAt(element); !done) return done;
  for (const XmlElement* attribute : part.attributes)
    if (Status done = lookAt(attribute); !done) return done;
  if (!part.topology || !part.geometry) return {};
  const std::string type(topologyType(*part.topology));
  const std::string geometry = geometryType(*part.geometry);
  if (!geometry.empty() && geometry != "xyz" && geometry != "x_y_z")
    return items_.bad("a <Geometry> is of type " + geometry.substr(0, 40) +
                      ", which is not read: XYZ and X_Y_Z are");
  if (!part.topology->attribute("Order").empty())
    return items_.bad("a <Topology> has an Order of the nodes of its cells, which is not read");
  if (xdmfLower(type).ends_with("mesh"))
    return items_.bad("a <Topology> of type " + type.substr(0, 40) +
                      " is a structured grid, which is not read");
  isUnderstood_ = isUnderstood_ && (isMixed(*part.topology) || kindOf(type));
  return {};
}

Result<std::vector<double>> XdmfFile::timesOf(const XmlElement& collection, std::size_t grids) {
  const XmlElement* time = collection.child("Time");
  if (!time) return std::vector<double>();
  const std::string type = xdmfLower(time->attribute("TimeType"));
  const auto items = items_.itemsOf(*time);
  const bool isList = type == "list", isSlab = type == "hyperslab";
  if (!isList && !isSlab)
    return items_.bad("the <Time> of its collection is of type '" +
                      std::string(time->attribute("TimeType")).substr(0, 40) +
                      "', which says no time of each grid; give each <Grid> its <Time Value>");
  if (items.size() != 1 || !items_.isReadable(items[0]) ||
      xdmfLower(items[0]->attribute("Format")) == "hdf")
    return items_.bad("the <Time> of its collection has no list of numbers in the XML");
  Result<XdmfNumbers> numbers = items_.fromText(*items[0]);
  if (!numbers) return std::unexpected(numbers.error());
  std::vector<double>& values = numbers->values;
  if (isSlab) {  // the first time, the step, and how many
    if (values.size() != 3 || values[2] != static_cast<double>(grids))
      return items_.bad("the <Time> of its collection is no first time, step and the number of " +
                        std::to_string(grids) + " grids");
    const double first = values[0], step = values[1];
    values.clear();
    for (std::size_t i = 0; i < grids; ++i) values.push_back(first + static_cast<double>(i) * step);
  }
  if (values.size() != grids)
    return items_.bad("the <Time> of its collection has " + std::to_string(values.size()) +
                      " times for " + std::to_string(grids) + " grids");
  if (!std::ranges::all_of(values, [](double t) { return std::isfinite(t); }))
    return items_.bad("the <Time> of its collection has a time that is not finite");
  return std::move(values);
}

Status XdmfFile::addCollection(const XmlElement& collection, std::map<double, Step>& steps) {
  std::map<double, std::vector<const XmlElement*>> grids;
  std::size_t number = 0, leftOut = 0;
  std::vector<double> repeated;
  const auto count = std::ranges::count_if(collection.children,
                                           [](const auto& child) { return child->name == "Grid"; });
  const auto times = timesOf(collection, static_cast<std::size_t>(count));
  if (!times) return std::unexpected(times.error());
  for (const auto& grid : collection.children) {
    if (grid->name != "Grid") continue;
    const std::optional<double> listed =
        times->empty() ? std::nullopt : std::optional((*times)[number]);
    const Result<double> time = timeOf(*grid, number++, listed);
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
    for (const XmlElement* grid : ofTime) {
      Step parts;
      if (Status done = addGrid(*grid, parts); !done) return done;
      if (Status done = merge(std::move(parts), steps[time]); !done) return done;
    }
  if (leftOut > 0)
    notes_.push_back("grids left out, because later ones of their series have the same time: " +
                     std::to_string(leftOut) + ", at time " + shownTimes(repeated));
  return {};
}

/// Grids of one time may each have some of its attributes.
Status XdmfFile::merge(Step&& parts, Step& into) {
  if (into.empty()) {
    into = std::move(parts);
    return {};
  }
  if (into.size() != parts.size())
    return items_.bad("grids of the same time have different numbers of parts");
  for (std::size_t i = 0; i < into.size(); ++i) {
    std::ranges::copy(parts[i].attributes, std::back_inserter(into[i].attributes));
    if (!into[i].topology) into[i].topology = parts[i].topology;
    if (!into[i].geometry) into[i].geometry = parts[i].geometry;
  }
  return {};
}

Result<double> XdmfFile::timeOf(const XmlElement& grid, std::size_t number,
                                std::optional<double> listed) const {
  const XmlElement* at = grid.child("Time");
  if (!at) return listed.value_or(static_cast<double>(number));
  const std::string_view text = at->attribute("Value");
  if (const auto time = timeIn(text)) return *time;
  const bool isThere = at->attributes.contains("Value");
  return fail(
      ErrorCode::kBadInput,
      path_.string() + ": the <Time> of its <Grid> number " + std::to_string(number) +
          (isThere ? " is \"" + std::string(text) + "\", which is no number" : " has no Value") +
          "; give it its time, a number such as 0.5");
}

/// Grids within grids are parts of one mesh.
Status XdmfFile::addGrid(const XmlElement& grid, Step& step) {
  switch (kindOfGrid(grid)) {
    case GridKind::kUniform: step.push_back(partOf(grid)); return {};
    case GridKind::kParts:
      for (const auto& child : grid.children)
        if (child->name == "Grid")
          if (Status done = addGrid(*child, step); !done) return done;
      return {};
    case GridKind::kTemporal:
      return items_.bad("a series of steps is within a <Grid> of another kind, which is not read");
    default:
      return items_.bad("a <Grid> is of GridType '" +
                        std::string(grid.attribute("GridType")).substr(0, 40) +
                        "', which is not read");
  }
}

XdmfFile::Part XdmfFile::partOf(const XmlElement& grid) {
  Part out;
  out.name = grid.attribute("Name");
  for (const auto& child : grid.children) {
    if (child->name == "Topology" && !out.topology) out.topology = child.get();
    if (child->name == "Geometry" && !out.geometry) out.geometry = child.get();
    if (child->name == "Attribute") out.attributes.push_back(child.get());
    if (child->name.ends_with("include")) include(*child, out);
  }
  if (out.topology) out.topology = items_.resolved(*out.topology);
  if (out.geometry) out.geometry = items_.resolved(*out.geometry);
  return out;
}

/// xpointer(PATH/*[self::Topology or self::Geometry]): the parts of another grid.
void XdmfFile::include(const XmlElement& element, Part& part) {
  std::string_view pointer = xdmfTrimmed(element.attribute("xpointer"));
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
  if (which.contains("self::Topology") && !part.topology) part.topology = grid->child("Topology");
  if (which.contains("self::Geometry") && !part.geometry) part.geometry = grid->child("Geometry");
}

Result<XdmfNumbers> XdmfFile::numbersOf(const XmlElement& element) {
  const auto items = items_.itemsOf(element);
  if (items.empty() || !items[0])
    return items_.bad("an element <" + element.name + "> has no DataItem");
  return items_.numbersOf(*items[0]);
}

/// The three coordinates one by one, or in three items.
Result<XdmfNumbers> XdmfFile::coordinatesOf(const XmlElement& geometry) {
  if (!isInThree(geometry)) {
    Result<XdmfNumbers> points = numbersOf(geometry);
    if (!points) return points;
    // a list of numbers without columns is one of triples, too
    if (points->columns != 3 && (points->columns != 1 || points->values.size() % 3 != 0))
      return items_.bad("its points have " + std::to_string(points->columns) +
                        " coordinates, not 3");
    return points;
  }
  XdmfNumbers out;
  std::size_t axis = 0;
  for (const XmlElement* item : items_.itemsOf(geometry)) {
    const Result<XdmfNumbers> numbers = items_.numbersOf(*item);
    if (!numbers) return numbers;
    if (axis == 0) {
      out.type = numbers->type;
      out.values.resize(3 * numbers->values.size());
    }
    if (numbers->type != out.type) out.type = "float64";
    if (3 * numbers->values.size() != out.values.size())
      return items_.bad("its points have " + std::to_string(out.values.size() / 3) + " x, but " +
                        std::to_string(numbers->values.size()) + " y or z");
    for (std::size_t i = 0; i < numbers->values.size(); ++i)
      out.values[3 * i + axis] = numbers->values[i];
    ++axis;
  }
  return out;
}

Status XdmfFile::addCells(const XmlElement& topology, CellMesh& out,
                          std::vector<std::uint64_t>& rows, std::uint64_t& cells,
                          ReadReport& report) {
  const Result<XdmfNumbers> numbers = numbersOf(topology);
  if (!numbers) return std::unexpected(numbers.error());
  const std::vector<double>& values = numbers->values;
  const Kind* one = isMixed(topology) ? nullptr : kindOf(topologyType(topology));
  std::int64_t offset = 0;
  if (const std::string_view base = topology.attribute("BaseOffset"); !base.empty()) {
    const auto number = numberIn<std::int32_t>(base);
    if (!number)
      return items_.bad("a <Topology> has BaseOffset '" + std::string(base.substr(0, 20)) +
                        "', which is no number");
    offset = *number;
  }
  const double lowest = static_cast<double>(offset),
               highest = lowest + static_cast<double>(out.points.size());
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
        return items_.bad("cell " + std::to_string(cells) +
                          " is of a kind that is not read: " + std::to_string(number));
      }
    }
    if (nodes > values.size() - at) return items_.bad("the list of cells ends within one");
    if (!kind || kind->type == kNoVolume) {
      ++report.ignoredCells;
      at += nodes;
      continue;
    }
    ids.clear();
    for (const std::size_t end = at + nodes; at < end; ++at) {
      const bool isThere = values[at] >= lowest && values[at] < highest;
      ids.push_back(isThere ? static_cast<VertexId>(values[at] - lowest) : kGhost);
    }
    out.addCell(kind->type, ids);
    rows.push_back(cells);
  }
  std::string_view told = topology.attribute("NumberOfElements");
  if (told.empty()) told = topology.attribute("Dimensions");
  if (const auto count = numberIn<std::uint64_t>(told.substr(0, xdmfTrimmed(told).find(' ')));
      !told.empty() && count != cells)
    return items_.bad("its topology says " + std::string(told.substr(0, 40)) +
                      " cells, but lists " + std::to_string(cells));
  return {};
}

Result<CellMesh> XdmfFile::read(std::size_t step, const ReadOptions& options, ReadReport& report) {
  const Step& parts = steps_[step];
  if (parts.size() == 1) return read(parts.front(), options.fields, report);
  std::set<std::string> names;
  for (const Part& part : parts) names.insert(part.name);
  const bool haveNames = names.size() == parts.size() && !names.contains("");
  std::vector<CellMesh> blocks;
  for (const Part& part : parts) {
    Result<CellMesh> block = read(part, options.fields, report);
    if (!block) return block;
    blocks.push_back(std::move(*block));
    if (haveNames) nameBlock(part.name, static_cast<std::int32_t>(blocks.size()), blocks.back());
  }
  return joinBlocks(std::move(blocks), options, report);
}

Result<CellMesh> XdmfFile::read(const Part& from, const FieldNames& fields, ReadReport& report) {
  CellMesh out;
  const Result<XdmfNumbers> points = coordinatesOf(*from.geometry);
  if (!points) return std::unexpected(points.error());
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
    Result<XdmfNumbers> values = numbersOf(*attribute);
    if (!values) return std::unexpected(values.error());
    const std::uint64_t tuples = ofCells ? cells : out.points.size();
    if (tuples == 0 || values->values.size() % tuples != 0 || values->values.empty())
      return items_.bad("its field " + name + " has " + std::to_string(values->values.size()) +
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
