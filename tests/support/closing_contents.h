// The content of closing blocks, as bytes to compare with another decoder's.
#pragma once

#include <map>
#include <string>

#include "proto/bytes.h"

namespace qtet {
class LogFile;
class Refiner;
}  // namespace qtet

namespace qtet::testing {

/// By "KIND/FIELD" of the kinds 1 to 4: slots of points; slots of cells and then their vertices
/// (u32); exact numbers (float64). REQUIRES `finest` has all chunks and fields of a sound log.
[[nodiscard]] std::map<std::string, Bytes> closingContents(const LogFile& log,
                                                           const Refiner& finest);

}  // namespace qtet::testing
