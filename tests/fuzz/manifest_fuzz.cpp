// Fuzzes the manifest of a log: what is accepted is written and read again and must be the same text.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "proto/manifest.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto manifest = qtet::manifestFromJson({reinterpret_cast<const char*>(data), size});
  if (!manifest) return 0;
  for (std::size_t f = 0; f < manifest->fields.size(); ++f)
    if (qtet::fieldOfKey(*manifest, qtet::fieldKey(*manifest, f)) != f) std::abort();
  const std::string text = qtet::manifestToJson(*manifest);
  const auto again = qtet::manifestFromJson(text);
  if (!again || qtet::manifestToJson(*again) != text) std::abort();
  return 0;
}
