#include "simplify/read/vtu/vtu_label_names.h"

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "codec/files/vtu_writer.h"
#include "proto/limits.h"
#include "simplify/read/vtu/vtu_numbers.h"

namespace qtet {

Status readVtuLabelNames(const VtuFile& file, const VtuDocument& document, CellMesh& mesh) {
  std::map<std::string, MeshField*, std::less<>> fields;
  for (MeshField& field : mesh.fields)
    if (isCellField(field)) fields.emplace(field.name, &field);
  for (const VtuArray& array : document.labelNames) {
    const std::string_view text = array.name;
    // the field's name may have the sign, too
    for (std::size_t sign = text.find(kLabelNameSign); sign != std::string_view::npos;
         sign = text.find(kLabelNameSign, sign + 1)) {
      const auto field = fields.find(text.substr(0, sign));
      if (field == fields.end()) continue;
      const std::string_view name = text.substr(sign + 1);
      LabelNames& names = field->second->labelNames;
      if (name.empty() || name.size() > kMaxNameBytes || names.size() == kMaxLabelNames) break;
      const Status done =
          readIntegers(file, document, array, {1, 0, 1}, [&](std::span<const std::int64_t> value) {
            if (!value.empty() && std::in_range<std::int32_t>(value.front()))
              names.emplace(static_cast<std::int32_t>(value.front()), name);
          });
      if (!done) return done;
      break;
    }
  }
  return {};
}

}  // namespace qtet
