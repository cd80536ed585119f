// Where an expat parser is. Its functions for this changed their names with expat 2.9.
#pragma once

#include <expat.h>

#include <algorithm>
#include <cstdint>

namespace qtet {

#if XML_MAJOR_VERSION > 2 || XML_MINOR_VERSION >= 9
/// Counts from 1.
[[nodiscard]] inline std::uint64_t xmlLine(XML_Parser parser) {
  return XML_GetCurrentLineNumber64(parser);
}
/// Where the present event begins; 0 before the first.
[[nodiscard]] inline std::uint64_t xmlByte(XML_Parser parser) {
  return static_cast<std::uint64_t>(
      std::max<std::int64_t>(0, static_cast<std::int64_t>(XML_GetCurrentByteIndex64(parser))));
}
/// Bytes of the present event.
[[nodiscard]] inline std::uint64_t xmlBytes(XML_Parser parser) {
  return static_cast<std::uint64_t>(XML_GetCurrentByteCount64(parser));
}
#else
[[nodiscard]] inline std::uint64_t xmlLine(XML_Parser parser) {
  return XML_GetCurrentLineNumber(parser);
}
[[nodiscard]] inline std::uint64_t xmlByte(XML_Parser parser) {
  return static_cast<std::uint64_t>(std::max<XML_Index>(0, XML_GetCurrentByteIndex(parser)));
}
[[nodiscard]] inline std::uint64_t xmlBytes(XML_Parser parser) {
  return static_cast<std::uint64_t>(XML_GetCurrentByteCount(parser));
}
#endif

}  // namespace qtet
