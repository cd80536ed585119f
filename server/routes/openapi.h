// The description of this server's HTTP interface, proto/openapi.json, as it was when the program
// was built.
#pragma once

#include <string>

namespace qtet {

[[nodiscard]] std::string openApiJson();

}  // namespace qtet
