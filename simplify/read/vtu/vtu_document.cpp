#include "simplify/read/vtu/vtu_document.h"

#include <expat.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include "codec/files/vtu_writer.h"
#include "simplify/read/options/xml_place.h"
#include "simplify/read/vtu/old_hexahedra.h"

namespace qtet {
namespace {

/// Some programs write "Ascii" or "Appended".
bool isSameWord(std::string_view a, std::string_view b) {
  const auto small = [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  };
  return std::ranges::equal(a, b, {}, small, small);
}

/// Elements within elements. VTK's files have seven.
constexpr std::size_t kMaxDepth = 64;
/// Attributes of one element. VTK's have about eight, and one more a component's name.
constexpr std::size_t kMaxAttributes = 256;
/// Bytes of one tag or comment, which the parser keeps in memory.
constexpr std::uint64_t kMaxTagBytes = std::uint64_t{1} << 20;
/// Arrays of all pieces: a thousand pieces with a thousand arrays each.
constexpr std::size_t kMaxArrays = 1'000'000;
/// Bytes that are read at once.
constexpr std::size_t kChunkBytes = std::size_t{1} << 16;
/// The highest version of the format that VTK 9 writes.
constexpr std::uint64_t kMaxVersion = 2;
/// The array that ParaView and VTK take for the time.
constexpr const char* kTimeName = "TimeValue";
/// VTK counts in 64 bits with a sign.
constexpr std::uint64_t kMaxCount = ~std::uint64_t{0} >> 1;

/// Points of one grid, which an extent states without a byte for each.
constexpr std::uint64_t kMaxExtentPoints = std::uint64_t{1} << 32;
/// Points that an extent may state for each byte of the file: more than LZMA makes of a byte.
constexpr std::uint64_t kMaxPointsPerByte = 8192;

constexpr std::array<std::pair<std::string_view, GridKind>, 4> kGrids{{
    {"UnstructuredGrid", GridKind::kUnstructured},
    {"StructuredGrid", GridKind::kStructured},
    {"RectilinearGrid", GridKind::kRectilinear},
    {"ImageData", GridKind::kImage},
}};

constexpr std::array<std::pair<std::string_view, VtuNumber>, 12> kTypes{{
    {"Int8", VtuNumber::kInt8},
    {"UInt8", VtuNumber::kUInt8},
    {"Int16", VtuNumber::kInt16},
    {"UInt16", VtuNumber::kUInt16},
    {"Int32", VtuNumber::kInt32},
    {"UInt32", VtuNumber::kUInt32},
    {"Int64", VtuNumber::kInt64},
    {"UInt64", VtuNumber::kUInt64},
    {"Float32", VtuNumber::kFloat32},
    {"Float64", VtuNumber::kFloat64},
    {"Bit", VtuNumber::kBit},
    {"String", VtuNumber::kText},
}};

/// An element's attributes, as the parser gives them.
class Attributes {
 public:
  explicit Attributes(const char** pairs) : pairs_(pairs) {}
  [[nodiscard]] std::size_t count() const {
    std::size_t n = 0;
    while (pairs_[2 * n]) ++n;
    return n;
  }
  /// VTK takes an attribute without a value for none.
  [[nodiscard]] std::optional<std::string_view> operator[](std::string_view name) const {
    for (const char** pair = pairs_; *pair; pair += 2)
      if (name == pair[0] && pair[1][0] != 0) return std::string_view(pair[1]);
    return std::nullopt;
  }
  [[nodiscard]] std::string text(std::string_view name) const {
    return std::string((*this)[name].value_or(""));
  }

 private:
  const char** pairs_;
};

class DocumentParser {
 public:
  explicit DocumentParser(const VtuFile& file) : file_(file), parser_(XML_ParserCreate(nullptr)) {}

  Result<VtuDocument> read() {
    if (!parser_) return fail(ErrorCode::kIo, "no memory for the XML of " + file_.path().string());
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(
        parser_.get(),
        [](void* self, const char* name, const char** attributes) {
          static_cast<DocumentParser*>(self)->start(name, Attributes(attributes));
        },
        [](void* self, const char*) { static_cast<DocumentParser*>(self)->end(); });
    XML_SetStartDoctypeDeclHandler(
        parser_.get(), [](void* self, const char*, const char*, const char*, int) {
          static_cast<DocumentParser*>(self)->refuse(
              "it declares a document type, which no mesh needs; remove the <!DOCTYPE ...>");
        });
    if (Status done = parse(); !done) return std::unexpected(done.error());
    if (grid_ == Grid::kNone)
      return file_.bad("it holds no <UnstructuredGrid> or other grid; export the mesh again");
    if (out_.pieces.empty()) out_.pieces.push_back(std::move(implicit_));
    return std::move(out_);
  }

 private:
  struct Free {
    void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
  };
  /// The first grid is read.
  enum class Grid : std::uint8_t { kNone, kInside, kBehind };
  enum class Section : std::uint8_t {
    kNone,
    kPoints,
    kCoordinates,
    kCells,
    kPointData,
    kCellData,
    kFieldData
  };

  Status parse() {
    std::vector<char> chunk(kChunkBytes);
    for (std::uint64_t at = 0; !isDone_;) {
      const std::size_t bytes =
          static_cast<std::size_t>(std::min<std::uint64_t>(kChunkBytes, file_.size() - at));
      if (Status read = file_.read(at, std::as_writable_bytes(std::span(chunk).first(bytes)));
          !read)
        return read;
      at += bytes;
      const bool isLast = at == file_.size();
      const auto status =
          XML_Parse(parser_.get(), chunk.data(), static_cast<int>(bytes), isLast ? 1 : 0);
      if (error_) return std::unexpected(*error_);
      if (isDone_) break;
      if (status != XML_STATUS_OK) {
        const XML_Error code = XML_GetErrorCode(parser_.get());
        return file_.bad("line " + std::to_string(line()) + ": it is not well-formed XML (" +
                             XML_ErrorString(code) + "); the file is damaged, export it again",
                         byte());
      }
      if (isLast) break;
      // the parser keeps what it has no event for yet
      if (at - byte() > kMaxTagBytes + kChunkBytes)
        return fail(ErrorCode::kLimitExceeded,
                    file_.path().string() + ": line " + std::to_string(line()) +
                        ": a tag or comment has more than " + std::to_string(kMaxTagBytes) +
                        " bytes; the file is damaged, export it again",
                    byte());
    }
    return {};
  }

  [[nodiscard]] std::uint64_t line() const { return xmlLine(parser_.get()); }
  /// Where the present event begins; 0 before the first.
  [[nodiscard]] std::uint64_t byte() const { return xmlByte(parser_.get()); }
  [[nodiscard]] std::uint64_t byteBehind() const { return byte() + xmlBytes(parser_.get()); }

  void refuse(const std::string& what, ErrorCode code = ErrorCode::kBadInput) {
    if (error_) return;
    error_ = Error{code, file_.path().string() + ": line " + std::to_string(line()) + ": " + what,
                   byte()};
    XML_StopParser(parser_.get(), XML_FALSE);
  }

  void start(std::string_view name, const Attributes& attributes) {
    if (error_ || isDone_) return;
    if (depth_ == kMaxDepth || attributes.count() > kMaxAttributes)
      return refuse("elements are nested deeper than " + std::to_string(kMaxDepth) +
                        ", or one has more than " + std::to_string(kMaxAttributes) +
                        " attributes; the file is damaged, export it again",
                    ErrorCode::kLimitExceeded);
    const std::size_t depth = depth_++;
    if (array_ && array_->end == 0) array_->end = byte();  // a child ends the array's text
    if (depth == 0) return startRoot(name, attributes);
    if (depth == 1) {
      const auto grid = std::ranges::find(kGrids, name, [](const auto& g) { return g.first; });
      if (grid != kGrids.end() && grid_ == Grid::kNone) return startGrid(grid->second, attributes);
      if (name == "AppendedData") startAppended(attributes);
      return;
    }
    if (grid_ != Grid::kInside) return;
    if (depth == 2 && name == "Piece") return startPiece(attributes);
    if (depth == (isInPiece_ ? 3u : 2u)) return startSection(name, attributes);
    if (section_ != Section::kNone && depth == (isInPiece_ ? 4u : 3u)) startArray(name, attributes);
  }

  void end() {
    if (error_ || isDone_) return;
    const std::size_t depth = --depth_;
    if (array_ && depth == arrayDepth_) {
      if (array_->end == 0) array_->end = std::max(array_->begin, byte());
      arrays_.push_back(std::move(*array_));
      array_.reset();
    }
    if (section_ != Section::kNone && depth == (isInPiece_ ? 3u : 2u)) endSection();
    if (depth == 2) isInPiece_ = false;
    if (depth == 1 && grid_ == Grid::kInside) grid_ = Grid::kBehind;
  }

  void startRoot(std::string_view name, const Attributes& attributes) {
    if (name != "VTKFile")
      return refuse("the file begins with <" + std::string(name.substr(0, 40)) +
                    ">, not <VTKFile>; export the mesh as .vtu");
    const std::string version = attributes.text("version");
    std::uint64_t major = 0;
    std::from_chars(version.data(), version.data() + version.size(), major);
    if (major > kMaxVersion)
      return refuse("the format's version is " + version + "; versions below " +
                    std::to_string(kMaxVersion + 1) + " are read: export it for an older VTK");
    out_.hasOldHexahedra = isOlderVersion(version, kNewXmlHexahedra);
    out_.isBigEndian = choice(attributes, "byte_order",
                              std::array<std::string_view, 2>{"LittleEndian", "BigEndian"}) == 1;
    out_.wordBytes =
        choice(attributes, "header_type", std::array<std::string_view, 2>{"UInt32", "UInt64"}) == 1
            ? 8
            : 4;
    constexpr std::array<std::string_view, 3> kCompressors{
        "vtkZLibDataCompressor", "vtkLZ4DataCompressor", "vtkLZMADataCompressor"};
    if (attributes["compressor"])
      out_.compressor =
          static_cast<VtuCompressor>(1 + choice(attributes, "compressor", kCompressors));
  }

  /// Which of the values the attribute has. One that is missing has the first.
  template <std::size_t N>
  std::size_t choice(const Attributes& attributes, const char* name,
                     const std::array<std::string_view, N>& values) {
    const auto value = attributes[name];
    if (!value) return 0;
    const auto at =
        std::ranges::find_if(values, [&](std::string_view v) { return isSameWord(v, *value); });
    if (at != values.end()) return static_cast<std::size_t>(at - values.begin());
    std::string known;
    for (const std::string_view v : values) known += (known.empty() ? "" : ", ") + std::string(v);
    refuse(std::string(name) + " is " + quoted(*value) + ", not one of " + known +
           "; export the mesh again");
    return 0;
  }

  void startGrid(GridKind kind, const Attributes& attributes) {
    grid_ = Grid::kInside;
    out_.kind = kind;
    out_.hasTimeSteps = attributes["TimeValues"].has_value();
    if (kind == GridKind::kImage) {
      readNumbers(attributes, "Origin", out_.origin);
      readNumbers(attributes, "Spacing", out_.spacing);
      readNumbers(attributes, "Direction", out_.direction);
    }
    if (attributes["NumberOfPoints"]) readCounts(attributes, implicit_);
  }

  void startPiece(const Attributes& attributes) {
    isInPiece_ = true;
    readCounts(attributes, out_.pieces.emplace_back());
  }

  void readCounts(const Attributes& attributes, VtuPiece& piece) {
    piece.line = line();
    if (out_.kind != GridKind::kUnstructured) return readExtent(attributes, piece);
    piece.points = count(attributes, "NumberOfPoints", "<Piece>");
    piece.cells = count(attributes, "NumberOfCells", "<Piece>");
  }

  /// The counts of points and cells between the first and the last point of each axis. An axis with
  /// one point has no cells of its own: the cells are flat.
  void readExtent(const Attributes& attributes, VtuPiece& piece) {
    if (!attributes["Extent"])
      return refuse("<Piece> has no Extent; the file is damaged, export it again");
    if (!readNumbers(attributes, "Extent", piece.extent)) return;
    piece.points = piece.cells = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t last = piece.extent[2 * axis + 1], first = piece.extent[2 * axis];
      const auto points = static_cast<std::uint64_t>(std::max<std::int64_t>(0, last - first + 1));
      if (piece.points > 0 && points > kMaxExtentPoints / piece.points)
        return refuse("Extent states more than 2^32 points; the file is damaged, export it again");
      piece.points *= points;
      piece.cells *= std::max<std::uint64_t>(1, points) - (points > 1 ? 1 : 0);
    }
    if (piece.points == 0) piece.cells = 0;
    if (piece.points / kMaxPointsPerByte > file_.size())
      refuse("Extent states " + std::to_string(piece.points) + " points, which a file of " +
             std::to_string(file_.size()) + " bytes cannot hold; it is damaged, export it again");
  }

  /// The attribute's numbers, between blanks; a missing one leaves them. False: they are wrong.
  template <class T, std::size_t N>
  bool readNumbers(const Attributes& attributes, const char* name, std::array<T, N>& out) {
    const auto value = attributes[name];
    if (!value) return true;
    constexpr std::string_view kBlanks = " \t\r\n";
    std::string_view left = *value;
    for (T& number : out) {
      left.remove_prefix(std::min(left.find_first_not_of(kBlanks), left.size()));
      const auto read = std::from_chars(left.data(), left.data() + left.size(), number);
      bool isNumber = read.ec == std::errc{};
      if constexpr (std::is_floating_point_v<T>) isNumber = isNumber && std::isfinite(number);
      if (!isNumber) {
        refuse(std::string(name) + " is " + quoted(*value) + ", not " + std::to_string(N) +
               " numbers; the file is damaged, export it again");
        return false;
      }
      left.remove_prefix(static_cast<std::size_t>(read.ptr - left.data()));
    }
    return true;
  }

  static std::string quoted(std::string_view value) {
    constexpr std::size_t kShown = 40;
    return "'" + std::string(value.substr(0, kShown)) + "'";
  }

  /// A number of things, without sign.
  std::uint64_t count(const Attributes& attributes, const char* name, const std::string& of) {
    const auto value = attributes[name];
    if (!value) {
      refuse(of + " has no " + name + "; the file is damaged, export it again");
      return 0;
    }
    constexpr std::string_view kBlanks = " \t\r\n";
    std::string_view digits = *value;
    digits.remove_prefix(std::min(digits.find_first_not_of(kBlanks), digits.size()));
    digits = digits.substr(0, digits.find_last_not_of(kBlanks) + 1);
    std::uint64_t number = 0;
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (digits.empty() || read.ec != std::errc() || read.ptr != digits.data() + digits.size() ||
        number > kMaxCount) {
      refuse(std::string(name) + " of " + of + " is " + quoted(*value) +
             ", which is no number from 0 to 2^63 - 1; the file is damaged, export it again");
      return 0;
    }
    return number;
  }

  VtuPiece& piece() { return isInPiece_ ? out_.pieces.back() : implicit_; }

  void startSection(std::string_view name, const Attributes& attributes) {
    constexpr std::array<std::pair<std::string_view, Section>, 6> kSections{
        {{"Points", Section::kPoints},
         {"Coordinates", Section::kCoordinates},
         {"Cells", Section::kCells},
         {"PointData", Section::kPointData},
         {"CellData", Section::kCellData},
         {"FieldData", Section::kFieldData}}};
    const std::span sections(kSections);
    const auto at = std::ranges::find(sections, name, [](const auto& s) { return s.first; });
    section_ = at == sections.end() ? Section::kNone : at->second;
    sectionName_ = name;
    arrays_.clear();
    VtuFields* fields = fieldsOf(section_);
    if (!fields) return;
    fields->globalIds = attributes.text("GlobalIds");
    fields->degrees = attributes.text("HigherOrderDegrees");
    fields->weights = attributes.text("RationalWeights");
  }

  VtuFields* fieldsOf(Section section) {
    if (section == Section::kPointData) return &piece().pointFields;
    return section == Section::kCellData ? &piece().cellFields : nullptr;
  }

  void endSection() {
    if (VtuFields* fields = fieldsOf(section_))
      fields->arrays = std::move(arrays_);
    else if (section_ == Section::kPoints && arrays_.size() == 1)
      piece().coordinates = std::move(arrays_.front());
    else if (section_ == Section::kCoordinates)
      piece().axisCoordinates = std::move(arrays_);
    else if (section_ == Section::kCells && !arrays_.empty())
      piece().cellArrays = std::move(arrays_);
    else if (section_ == Section::kFieldData && !isInPiece_)
      takeFileData();
    arrays_.clear();
    section_ = Section::kNone;
  }

  void takeFileData() {
    for (VtuArray& array : arrays_) {
      if (array.name != kTimeName)
        out_.labelNames.push_back(std::move(array));
      else if (!out_.time)
        out_.time = std::move(array);
    }
  }

  void startArray(std::string_view name, const Attributes& attributes) {
    // the time and the names of labels alone count of the whole file's data
    const std::string called = attributes.text("Name"), kind = attributes.text("type");
    const bool isLabelName = called.contains(kLabelNameSign) &&
                             attributes.text("NumberOfTuples") == "1" &&
                             (kind.starts_with("Int") || kind.starts_with("UInt"));
    if (section_ == Section::kFieldData &&
        (name != "DataArray" || (called != kTimeName && !isLabelName)))
      return;
    const std::string of = "<" + std::string(name.substr(0, 40)) + "> in <" + sectionName_ + ">";
    if (name != "DataArray" && name != "Array")
      return refuse(of + " is no array; the file is damaged, export it again");
    if (++arrayCount_ > kMaxArrays)
      return refuse("it has more than " + std::to_string(kMaxArrays) + " arrays",
                    ErrorCode::kLimitExceeded);
    if (attributes["TimeStep"]) out_.hasTimeSteps = true;
    const bool isField = section_ == Section::kPointData || section_ == Section::kCellData;
    if (isField && !attributes["Name"]) return refuse(of + " has no Name; export the mesh again");
    arrayDepth_ = depth_ - 1;
    array_.emplace();
    array_->name = attributes.text("Name");
    array_->parent = sectionName_;
    array_->line = line();
    array_->isIdType = attributes.text("IdType") == "1";
    const std::span types(kTypes);
    const auto type = std::ranges::find(types, std::string_view(attributes["type"].value_or("")),
                                        [](const auto& t) { return t.first; });
    if (type == types.end())
      return refuse("type of " + of + " is " + quoted(attributes.text("type")) +
                    ", which is none of VTK's; the file is damaged, export it again");
    array_->type = type->second;
    if (attributes["NumberOfComponents"]) readComponents(attributes, of);
    readPlace(attributes, of);
  }

  void readComponents(const Attributes& attributes, const std::string& of) {
    const std::uint64_t components = count(attributes, "NumberOfComponents", of);
    constexpr std::uint64_t kMax = ~std::uint32_t{0} >> 1;
    if (components > kMax)
      return refuse("NumberOfComponents of " + of + " is " + std::to_string(components) +
                    "; at most 2147483647 are allowed");
    array_->components = std::max(1u, static_cast<std::uint32_t>(components));
  }

  void readPlace(const Attributes& attributes, const std::string& of) {
    if (attributes["offset"]) {
      array_->place = VtuArray::Place::kAppended;
      array_->begin = count(attributes, "offset", of);
      array_->end = array_->begin;
      return;
    }
    constexpr std::array<std::string_view, 3> kFormats{"ascii", "binary", "appended"};
    const std::size_t format = choice(attributes, "format", kFormats);
    if (format == 2) return refuse(of + " is appended, and has no offset; export the mesh again");
    array_->place = format == 1 ? VtuArray::Place::kInline : VtuArray::Place::kAscii;
    array_->begin = byteBehind();
  }

  /// The parser ends here: no XML follows its underscore.
  void startAppended(const Attributes& attributes) {
    constexpr std::array<std::string_view, 2> kEncodings{"base64", "raw"};
    out_.appendedIsBase64 = choice(attributes, "encoding", kEncodings) == 0;
    if (error_) return;
    std::uint64_t at = byteBehind();
    std::byte c{' '};
    for (; at < file_.size() && at < byteBehind() + kMaxTagBytes; ++at) {
      if (Status read = file_.read(at, std::span(&c, 1)); !read) {
        error_ = read.error();
        break;
      }
      if (c > std::byte{' '}) break;
    }
    if (!error_ && c != std::byte{'_'})
      return refuse(
          "<AppendedData> does not begin with an underscore; the file is damaged, export "
          "it again");
    out_.appendedBegin = at + 1;
    isDone_ = true;
    XML_StopParser(parser_.get(), XML_FALSE);
  }

  const VtuFile& file_;
  std::unique_ptr<std::remove_pointer_t<XML_Parser>, Free> parser_;
  VtuDocument out_;
  VtuPiece implicit_;  ///< a grid without <Piece> is one itself
  std::optional<Error> error_;
  bool isDone_ = false, isInPiece_ = false;
  Grid grid_ = Grid::kNone;
  std::size_t depth_ = 0, arrayDepth_ = 0, arrayCount_ = 0;
  Section section_ = Section::kNone;
  std::string sectionName_;
  std::optional<VtuArray> array_;  ///< within whose tags the parser is
  std::vector<VtuArray> arrays_;   ///< of the section
};

}  // namespace

std::uint32_t bytesOf(VtuNumber type) {
  switch (type) {
    case VtuNumber::kInt8:
    case VtuNumber::kUInt8: return 1;
    case VtuNumber::kInt16:
    case VtuNumber::kUInt16: return 2;
    case VtuNumber::kInt32:
    case VtuNumber::kUInt32:
    case VtuNumber::kFloat32: return 4;
    case VtuNumber::kInt64:
    case VtuNumber::kUInt64:
    case VtuNumber::kFloat64: return 8;
    default: return 0;
  }
}

std::string VtuArray::called() const {
  return "line " + std::to_string(line) + ": the array " +
         (name.empty() ? "without a name" : name.substr(0, 80)) + " of <" + parent + ">";
}

Result<VtuDocument> readVtuDocument(const VtuFile& file) { return DocumentParser(file).read(); }

}  // namespace qtet
