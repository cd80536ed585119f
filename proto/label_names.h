// The names that a file gives to values of a label, such as those of materials.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace qtet {

/// By value; no name is empty.
using LabelNames = std::map<std::int32_t, std::string>;

}  // namespace qtet
