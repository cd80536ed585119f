// The version of qtet: of tools, servers and libraries alike.
#pragma once

#include <string>

namespace qtet {

/// "1.2.3", as CMakeLists.txt says.
[[nodiscard]] std::string version();

}  // namespace qtet
