#include "simplify/read/parts/xml_tree.h"

#include <expat.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>
#include <set>
#include <utility>

#include "simplify/read/options/xml_place.h"

namespace qtet {
namespace {

/// Elements within elements. Real files have six.
constexpr std::size_t kMaxDepth = 64;
/// Elements of a file: a hundred thousand steps with ten fields each.
constexpr std::size_t kMaxElements = 4'000'000;
/// Bytes that are read at once.
constexpr std::size_t kChunkBytes = std::size_t{1} << 16;

/// Builds the tree while expat parses.
class Builder {
 public:
  Builder() : parser_(XML_ParserCreate(nullptr), XML_ParserFree) {
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), onStart, onEnd);
    XML_SetCharacterDataHandler(parser_.get(), onText);
    XML_SetEntityDeclHandler(parser_.get(), onEntity);
  }

  Result<std::unique_ptr<XmlElement>> read(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::vector<char> chunk(kChunkBytes);
    for (bool isLast = false; !isLast;) {
      file.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
      isLast = !file;
      if (file.bad() || !file.is_open())
        return fail(ErrorCode::kIo, "cannot read " + path.string());
      if (XML_Parse(parser_.get(), chunk.data(), static_cast<int>(file.gcount()), isLast) ==
          XML_STATUS_OK)
        continue;
      return fail(ErrorCode::kBadInput,
                  path.string() + ", line " + std::to_string(xmlLine(parser_.get())) + ": " +
                      (wrong_ ? wrong_ : XML_ErrorString(XML_GetErrorCode(parser_.get()))) +
                      "; export the mesh again");
    }
    return std::move(root_);
  }

 private:
  static void onStart(void* self, const char* name, const char** pairs) {
    static_cast<Builder*>(self)->start(name, pairs);
  }
  static void onEnd(void* self, const char*) { static_cast<Builder*>(self)->open_.pop_back(); }
  static void onText(void* self, const char* text, int length) {
    auto& open = static_cast<Builder*>(self)->open_;
    if (!open.empty()) open.back()->text.append(text, static_cast<std::size_t>(length));
  }
  static void onEntity(void* self, const char*, int, const char*, int, const char*, const char*,
                       const char*, const char*) {
    static_cast<Builder*>(self)->stop("it declares an entity, which is not read");
  }

  void start(const char* name, const char** pairs) {
    if (open_.size() >= kMaxDepth) stop("its elements are too deep");
    if (++elements_ > kMaxElements) stop("it has too many elements");
    auto element = std::make_unique<XmlElement>();
    element->name = name;
    for (; pairs[0]; pairs += 2) element->attributes.emplace(pairs[0], pairs[1]);
    XmlElement* opened = element.get();
    (open_.empty() ? root_ : open_.back()->children.emplace_back()) = std::move(element);
    open_.push_back(opened);
  }
  void stop(const char* why) {
    wrong_ = why;
    XML_StopParser(parser_.get(), XML_FALSE);
  }

  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
  std::unique_ptr<XmlElement> root_;
  std::vector<XmlElement*> open_;
  std::size_t elements_ = 0;
  const char* wrong_ = nullptr;
};

/// One part of a path: a name, with its conditions.
struct Part {
  bool isAnywhereBelow = false;
  std::string_view name;
  std::vector<std::pair<std::string_view, std::string_view>> attributes;
  std::size_t number = 0;  ///< from 1 on; 0: any
};

/// The part at the beginning of the path, which it leaves; nullopt: it is another kind of part.
std::optional<Part> takePart(std::string_view& path) {
  Part out;
  if (!path.starts_with('/')) return std::nullopt;
  path.remove_prefix(1);
  if (path.starts_with('/')) out.isAnywhereBelow = true, path.remove_prefix(1);
  const std::size_t end = std::min(path.find_first_of("/["), path.size());
  out.name = path.substr(0, end);
  path.remove_prefix(end);
  while (path.starts_with('[')) {
    const std::size_t close = path.find(']');
    if (close == std::string_view::npos) return std::nullopt;
    std::string_view inside = path.substr(1, close - 1);
    path.remove_prefix(close + 1);
    if (inside.starts_with('@')) {
      const std::size_t equals = inside.find('=');
      if (equals == std::string_view::npos || inside.size() < equals + 3) return std::nullopt;
      out.attributes.emplace_back(inside.substr(1, equals - 1),
                                  inside.substr(equals + 2, inside.size() - equals - 3));
    } else if (std::from_chars(inside.data(), inside.data() + inside.size(), out.number).ptr !=
                   inside.data() + inside.size() ||
               out.number == 0) {
      return std::nullopt;
    }
  }
  return out.name.empty() ? std::nullopt : std::optional(out);
}

bool fits(const XmlElement& element, const Part& part) {
  return element.name == part.name && std::ranges::all_of(part.attributes, [&](const auto& wanted) {
           return element.attribute(wanted.first) == wanted.second;
         });
}

/// Elements in the order in which they came, each once. Within // of another // they come again for
/// each way that leads to them.
class Matches {
 public:
  void add(const XmlElement& element) {
    if (seen_.insert(&element).second) list_.push_back(&element);
  }
  [[nodiscard]] std::vector<const XmlElement*>& list() { return list_; }

 private:
  std::set<const XmlElement*> seen_;
  std::vector<const XmlElement*> list_;
};

/// The children that the part means, and with // those of all below, in the document's order.
void addMatches(const XmlElement& element, const Part& part, Matches& out) {
  std::size_t number = 0;
  for (const auto& child : element.children) {
    if (fits(*child, part) && (++number == part.number || part.number == 0)) out.add(*child);
    if (part.isAnywhereBelow) addMatches(*child, part, out);
  }
}

}  // namespace

const XmlElement* XmlElement::child(std::string_view called) const {
  const auto at =
      std::ranges::find_if(children, [&](const auto& each) { return each->name == called; });
  return at == children.end() ? nullptr : at->get();
}

Result<std::unique_ptr<XmlElement>> readXml(const std::filesystem::path& path) {
  return Builder().read(path);
}

const XmlElement* firstAt(const XmlElement& root, std::string_view path) {
  // the document itself is above its root
  std::vector<const XmlElement*> at;
  bool isFirst = true;
  while (!path.empty()) {
    const std::optional<Part> part = takePart(path);
    if (!part) return nullptr;
    Matches next;
    if (std::exchange(isFirst, false)) {
      if (fits(root, *part) && part->number <= 1) next.add(root);
      if (part->isAnywhereBelow) addMatches(root, *part, next);
    }
    for (const XmlElement* element : at) addMatches(*element, *part, next);
    at = std::move(next.list());
    if (at.empty()) return nullptr;
  }
  return at.empty() ? nullptr : at.front();
}

}  // namespace qtet
