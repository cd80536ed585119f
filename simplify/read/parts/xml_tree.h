// An XML document in memory, and the paths by which its elements name one another.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"

namespace qtet {

struct XmlElement {
  std::string name;
  std::map<std::string, std::string, std::less<>> attributes;
  std::string text;  ///< that of the element itself
  std::vector<std::unique_ptr<XmlElement>> children;

  [[nodiscard]] std::string_view attribute(std::string_view key) const {
    const auto at = attributes.find(key);
    return at == attributes.end() ? std::string_view() : std::string_view(at->second);
  }
  [[nodiscard]] const XmlElement* child(std::string_view called) const;
};

/// Reads the whole file. Entities that it declares are refused: a few of them may stand for
/// gigabytes. Errors: io, bad-input (no XML; too deep, too many elements), with the line.
[[nodiscard]] Result<std::unique_ptr<XmlElement>> readXml(const std::filesystem::path& path);

/// The first element that a path of XPath 1.0 means: names behind / or //, each with conditions
/// [@KEY='VALUE'] or [NUMBER]. nullptr: there is none, or the path has other parts.
[[nodiscard]] const XmlElement* firstAt(const XmlElement& root, std::string_view path);

}  // namespace qtet
