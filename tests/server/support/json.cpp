#include "tests/server/support/json.h"

#include <nlohmann/json.hpp>
#include <ostream>

namespace qtet::test {

using nlohmann::json;

Json Json::parse(std::string_view text) { return Json(json::parse(text).dump()); }

Json Json::ofString(std::string_view value) { return Json(json(value).dump()); }

Json Json::operator[](std::string_view key) const {
  const json value = json::parse(text_);
  const auto at = value.find(std::string(key));
  return at == value.end() ? Json() : Json(at->dump());
}

Json Json::operator[](std::size_t index) const { return Json(json::parse(text_).at(index).dump()); }

std::size_t Json::size() const { return json::parse(text_).size(); }

std::string Json::string() const { return json::parse(text_).get<std::string>(); }

std::uint64_t Json::count() const { return json::parse(text_).get<std::uint64_t>(); }

double Json::number() const { return json::parse(text_).get<double>(); }

std::ostream& operator<<(std::ostream& out, const Json& value) { return out << value.text_; }

}  // namespace qtet::test
