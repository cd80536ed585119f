#include "simplify/read/vtu/vtu_label_names.h"

#include <string>
#include <utility>

#include "codec/files/vtu_writer.h"
#include "proto/limits.h"
#include "simplify/read/vtu/vtu_numbers.h"

namespace qtet {

Status readVtuLabelNames(const VtuFile& file, const VtuDocument& document, CellMesh& mesh) {
  for (const VtuArray& array : document.labelNames)
    for (MeshField& field : mesh.fields) {
      const std::string before = field.name + kLabelNameSign;
      if (!isCellField(field) || !array.name.starts_with(before) || array.name == before ||
          array.name.size() - before.size() > kMaxNameBytes || bytesOf(array.type) == 0 ||
          field.labelNames.size() == kMaxLabelNames)
        continue;
      const Status done =
          readIntegers(file, document, array, {1, 0, 1}, [&](std::span<const std::int64_t> value) {
            if (!value.empty() && std::in_range<std::int32_t>(value.front()))
              field.labelNames.emplace(static_cast<std::int32_t>(value.front()),
                                       array.name.substr(before.size()));
          });
      if (!done) return done;
    }
  return {};
}

}  // namespace qtet
