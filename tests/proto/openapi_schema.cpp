#include "tests/proto/openapi_schema.h"

#include <algorithm>
#include <fstream>
#include <regex>

#include "tests/support/paths/test_paths.h"

namespace qtet::test {
namespace {

using Json = nlohmann::json;

/// `type` is a name, or an array of them, one of which is enough.
bool isOfType(const Json& type, const Json& value) {
  if (type.is_array())
    return std::ranges::any_of(type, [&](const Json& one) { return isOfType(one, value); });
  if (type == "null") return value.is_null();
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "integer") return value.is_number_integer();
  return type == "number" && value.is_number();
}

class Check {
 public:
  Check(const Json& schemas, const std::set<std::string>& shortened)
      : schemas_(schemas), shortened_(shortened) {}

  void value(const Json& given, const Json& value, const std::string& at) {
    const Json& schema = given.contains("$ref") ? referenced(given) : given;
    if (schema.contains("enum") && std::ranges::find(schema["enum"], value) == schema["enum"].end())
      return blame(at, "is none of " + schema["enum"].dump());
    if (schema.contains("type") && !isOfType(schema["type"], value))
      return blame(at, "is no " + schema["type"].dump());
    if (value.is_number()) number(schema, value, at);
    if (value.is_string()) string(schema, value, at);
    if (value.is_array()) array(schema, value, at);
    if (value.is_object()) object(schema, value, at);
  }
  [[nodiscard]] const std::string& complaint() const { return complaint_; }

 private:
  [[nodiscard]] const Json& referenced(const Json& schema) const {
    const auto reference = schema["$ref"].get<std::string>();
    return schemas_.at(reference.substr(reference.rfind('/') + 1));
  }

  void number(const Json& schema, const Json& value, const std::string& at) {
    const auto x = value.get<double>();
    if ((schema.contains("minimum") && x < schema["minimum"].get<double>()) ||
        (schema.contains("maximum") && x > schema["maximum"].get<double>()) ||
        (schema.contains("exclusiveMinimum") && x <= schema["exclusiveMinimum"].get<double>()))
      blame(at, "is out of range");
  }

  void string(const Json& schema, const Json& value, const std::string& at) {
    const auto text = value.get<std::string>();
    if (text.size() < schema.value("minLength", std::size_t{0})) blame(at, "is too short");
    if (schema.contains("pattern") &&
        !std::regex_search(text, std::regex(schema["pattern"].get<std::string>())))
      blame(at, "is not of the pattern");
  }

  void array(const Json& schema, const Json& value, const std::string& at) {
    if (value.size() < schema.value("minItems", std::size_t{0}) ||
        value.size() > schema.value("maxItems", value.size()))
      blame(at, "has too few or too many items");
    for (std::size_t i = 0; i < value.size() && schema.contains("items"); ++i)
      this->value(schema["items"], value[i], at + "/" + std::to_string(i));
  }

  void object(const Json& schema, const Json& value, const std::string& at) {
    if (schema.contains("required") && !shortened_.contains(at.substr(at.rfind('/') + 1)))
      for (const Json& name : schema["required"])
        if (!value.contains(name)) blame(at + "/" + name.get<std::string>(), "is missing");
    const Json known = schema.value("properties", Json::object());
    const Json others = schema.value("additionalProperties", Json());
    for (const auto& [name, member] : value.items()) {
      if (known.contains(name))
        this->value(known[name], member, at + "/" + name);
      else if (others.is_object())
        this->value(others, member, at + "/" + name);
      else
        blame(at + "/" + name, "is no member that there is");
    }
  }

  // The first is enough.
  void blame(const std::string& at, const std::string& what) {
    if (complaint_.empty()) complaint_ = at + " " + what;
  }

  const Json& schemas_;
  const std::set<std::string>& shortened_;
  std::string complaint_;
};

}  // namespace

OpenapiSchemas::OpenapiSchemas() {
  std::ifstream file(testing::kSourceFolder + std::string("/proto/openapi.json"));
  schemas_ = Json::parse(file).at("components").at("schemas");
}

std::string OpenapiSchemas::complaint(const std::string& schema, const Json& value,
                                      const std::set<std::string>& shortened) const {
  Check check(schemas_, shortened);
  check.value(schemas_.at(schema), value, "");
  return check.complaint();
}

}  // namespace qtet::test
