#include "simplify/read/abaqus/read_model.h"

#include <algorithm>
#include <array>
#include <set>

#include "simplify/read/abaqus/abaqus_lines.h"
#include "simplify/read/abaqus/mesh_blocks.h"

namespace qtet {
namespace {

/// Keywords that make nodes or elements in ways that are not read.
constexpr auto kRefused = std::to_array<std::string_view>(
    {"ELCOPY", "IMPORT", "NCOPY", "NFILL", "NMAP", "SYMMETRICMODELGENERATION"});

class ModelReader {
 public:
  ModelReader(const std::filesystem::path& path, std::chrono::seconds patience)
      : lines_(path, patience) {}

  Result<AbaqusModel> read() {
    lines_.next();
    while (!lines_.ended()) {
      const std::string name = lines_.isKeyword() ? lines_.keyword().name : "";
      // the mesh is complete before the first step
      if (name == "STEP") break;
      if (!readBlock(name)) lines_.next();
    }
    if (!lines_.failed() && current_ != 0)
      lines_.fail(ErrorCode::kTruncated,
                  "the file ends within a part or instance: it was cut off; copy or export it "
                  "again");
    if (lines_.failed()) return lines_.error();
    model_.bytes = lines_.bytes();
    model_.time = lines_.time();
    return std::move(model_);
  }

 private:
  AbaqusPart& part() { return model_.parts[current_]; }

  /// False: the keyword is to be skipped. Otherwise the line is the next keyword.
  bool readBlock(const std::string& name) {
    if (name.empty()) return false;
    if (name == "NODE")
      readNodes(lines_, part());
    else if (name == "ELEMENT")
      readElements(lines_, part(), model_.ignoredCells);
    else if (name == "ELSET")
      readSet();
    else if (name == "INSTANCE")
      readInstance();
    else if (name == "SYSTEM")
      readSystem(lines_, part());
    else if (name == "NGEN")
      generateNodes(lines_, part(), generatedNodes_);
    else if (name == "ELGEN")
      generateElements(lines_, part(), generatedElements_);
    else
      return readLine(name);
    return true;
  }

  /// Keywords without data that count. Always false.
  bool readLine(const std::string& name) {
    if (name == "PART") {
      beginPart();
    } else if (name == "ENDPART" || name == "ENDINSTANCE") {
      current_ = 0;
    } else if (name.ends_with("SECTION")) {
      readSection();
    } else if (std::ranges::find(kRefused, name) != kRefused.end()) {
      lines_.fail("*" + name + " is not read; write the nodes and elements themselves");
    }
    return false;
  }

  std::string parameter(const char* name) {
    const std::string* value = lines_.keyword().find(name);
    return value ? *value : "";
  }

  void beginPart() {
    const std::string name = parameter("NAME");
    if (name.empty() || !partNumbers_.emplace(abaqusName(name), model_.parts.size()).second)
      return lines_.fail("*PART has no NAME, or that of an earlier part");
    current_ = model_.parts.size();
    model_.parts.emplace_back().name = name;
  }

  /// An instance takes its nodes from a part, or has nodes of its own up to *END INSTANCE.
  void readInstance() {
    const std::string name = parameter("NAME"), of = abaqusName(parameter("PART"));
    if (name.empty() || !instances_.insert(abaqusName(name)).second)
      return lines_.fail("*INSTANCE has no NAME, or that of an earlier instance");
    if (lines_.keyword().find("LIBRARY"))
      return lines_.fail("*INSTANCE with LIBRARY is not read: its mesh is in another file");
    const auto at = partNumbers_.find(of);
    if (!of.empty() && at == partNumbers_.end())
      return lines_.fail("there is no part " + of + " before its instance " + name);
    std::vector<double> shift, turn;
    while (nextDataLine(lines_)) {
      std::vector<double>& numbers = shift.empty() ? shift : turn;
      const std::size_t count = shift.empty() ? 3 : 7;
      if (!turn.empty() || lines_.fields().size() > count)
        return lines_.fail(
            "an instance has a line of 3 numbers that move it, and one of 7 that "
            "turn it");
      for (std::size_t k = 0; k < count; ++k) numbers.push_back(lines_.real(k, "a number"));
    }
    if (shift.empty()) shift.assign(3, 0);
    const auto placement = instanceAt({shift[0], shift[1], shift[2]}, turn);
    if (!placement) return lines_.fail("the instance " + name + " is turned round no axis");
    if (of.empty()) {
      current_ = model_.parts.size();
      model_.parts.emplace_back().name = name;
    }
    model_.instances.push_back({name, of.empty() ? current_ : at->second, *placement});
    // nodes and sets within an instance of a part: those of the assembly
    if (!of.empty()) current_ = 0;
  }

  void readSection() {
    const std::string set = parameter("ELSET"), material = parameter("MATERIAL");
    if (!set.empty() && !material.empty()) part().sections.push_back({abaqusName(set), material});
  }

  void readSet() {
    const std::string name = parameter("ELSET");
    if (name.empty()) return lines_.fail("*ELSET has no name: ELSET=NAME is missing");
    const bool isGenerated = lines_.keyword().find("GENERATE") != nullptr;
    AbaqusSet& set = part().set(name);
    set.isInternal |= lines_.keyword().find("INTERNAL") != nullptr;
    std::vector<AbaqusSetPiece>& pieces = set.pieces;
    const std::string instance = abaqusName(parameter("INSTANCE"));
    if (const std::string* input = lines_.keyword().find("INPUT")) lines_.include(*input);
    pieces.push_back({instance, {}, {}});
    while (nextDataLine(lines_)) {
      if (isGenerated)
        addRange(pieces.back());
      else
        for (const std::string_view field : lines_.fields()) addMember(pieces, instance, field);
    }
  }

  void addRange(AbaqusSetPiece& piece) {
    const std::uint32_t first = lines_.id(0, "an element's number"),
                        last = lines_.id(1, "an element's number"),
                        step = lines_.id(2, "an increment");
    piece.ranges.push_back({first, std::max(first, last), std::max(step, 1U)});
  }

  /// A number or a set's name, before which the instance may stand: "Part-1-1.12".
  static void addMember(std::vector<AbaqusSetPiece>& pieces, const std::string& instance,
                        std::string_view field) {
    const std::size_t dot = field.find('.');
    const bool isNamed = dot != std::string_view::npos;
    const std::string of = isNamed ? abaqusName(field.substr(0, dot)) : instance;
    if (isNamed) field.remove_prefix(dot + 1);
    if (field.empty()) return;
    if (pieces.back().instance != of) pieces.push_back({of, {}, {}});
    if (const auto number = plainInteger<std::uint32_t>(field))
      pieces.back().ranges.push_back({*number, *number, 1});
    else
      pieces.back().names.push_back(abaqusName(field));
  }

  AbaqusLines lines_;
  AbaqusModel model_;
  std::size_t current_ = 0;  ///< of the parts
  std::map<std::string, std::size_t> partNumbers_;
  std::set<std::string> instances_;
  std::uint64_t generatedNodes_ = 0, generatedElements_ = 0;
};

}  // namespace

AbaqusSet& AbaqusPart::set(const std::string& named) {
  const auto [at, isNew] = setNumbers.try_emplace(abaqusName(named), sets.size());
  if (isNew) sets.push_back({named, false, {}});
  return sets[at->second];
}

Result<AbaqusModel> readAbaqusModel(const std::filesystem::path& path,
                                    std::chrono::seconds patience) {
  return ModelReader(path, patience).read();
}

}  // namespace qtet
