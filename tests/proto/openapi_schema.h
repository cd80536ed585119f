// Whether a JSON value is what a schema of proto/openapi.json says: the few keywords that it uses.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace qtet::test {

class OpenapiSchemas {
 public:
  /// Reads proto/openapi.json. Throws what nlohmann-json throws.
  OpenapiSchemas();

  /// Empty, or what is wrong and where. A member that the schema does not name is wrong, too.
  /// Members of these names need not be whole: a document shortens them.
  [[nodiscard]] std::string complaint(const std::string& schema, const nlohmann::json& value,
                                      const std::set<std::string>& shortened = {}) const;

 private:
  nlohmann::json schemas_;
};

}  // namespace qtet::test
