// Fuzzes the manifest of a log with two fields and up to 256 levels. The first byte is the number
// of levels beyond the base mesh, the rest the manifest. An accepted manifest is written again and
// must say the same.
#include <cstdint>
#include <cstdlib>

#include "codec/log/log_index.h"
#include "codec/log/log_manifest.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  qtet::LogIndex index;
  index.positionBits = 16;
  index.fields = {{2, qtet::Association::kPoint}, {1, qtet::Association::kCell}};
  index.chunks.resize(2);
  index.chunks[1].firstLevel = data[0] > 0;
  index.chunks[1].lastLevel = data[0];
  index.manifest.assign(data + 1, data + size);
  const auto manifest = qtet::manifestOf(index);
  if (!manifest) return 0;
  for (std::size_t f = 0; f < manifest->fields.size(); ++f)
    if (qtet::fieldOfKey(*manifest, qtet::fieldKey(*manifest, f)) != f) std::abort();
  const std::string text = qtet::manifestToJson(*manifest);
  const auto again = qtet::manifestBlock(*manifest);
  if (!again) std::abort();
  index.manifest = *again;  // other bytes may mean the same: the range coder's last ones are free
  const auto reread = qtet::manifestOf(index);
  if (!reread || qtet::manifestToJson(*reread) != text) std::abort();
  return 0;
}
