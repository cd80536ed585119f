#include "proto/manifest.h"

#include <cassert>
#include <cmath>
#include <limits>

#include "proto/field_key.h"
#include "proto/field_keys.h"
#include "proto/field_list.h"
#include "proto/json_reader.h"
#include "proto/level_error_json.h"

namespace qtet {

std::string fieldKey(const Manifest& manifest, std::size_t f) {
  const ManifestField& field = manifest.fields[f];
  return fieldOfKey(manifest, field.name) == f ? field.name.text()
                                               : field.association + ":" + field.name;
}

std::string firstField(const Manifest& manifest) {
  return manifest.fields.empty() ? ""
                                 : fieldKey(manifest, manifest.opening.value_or(Opening{}).field);
}

std::optional<std::uint32_t> fieldOfKey(const Manifest& manifest, std::string_view key) {
  return fieldOfKey(manifest.fields, key);
}

Error noSuchField(const Manifest& manifest, std::string_view key) {
  const FieldKeys all(manifest.fields);
  std::vector<std::string> keys;
  for (std::size_t f = 0; f < all.size(); ++f) keys.push_back(all.keyOf(f));
  return {ErrorCode::kNotFound,
          "the log has no field '" + std::string(key) + "'; it has: " + fieldList(keys)};
}

bool mayBeLabel(const ManifestField& field) {
  return field.association == "cell" && field.components == 1 && !field.type.starts_with("float") &&
         field.step == 1;
}

std::string_view unitOf(const Manifest& manifest, const FieldName& name) {
  const std::string_view series = name.withoutTime();
  if (const auto at = manifest.units.find(series); at != manifest.units.end()) return at->second;
  const std::size_t open = series.rfind(" [");
  if (open == std::string_view::npos || open == 0 || !series.ends_with(']')) return {};
  return series.substr(open + 2, series.size() - open - 3);
}

const LabelNames* labelNamesOf(const Manifest& manifest, std::size_t f) {
  const ManifestField& field = manifest.fields[f];
  if (!mayBeLabel(field)) return nullptr;
  const auto at = manifest.labels.find(field.name.withoutTime());
  return at == manifest.labels.end() ? nullptr : &at->second;
}

std::vector<bool> labelsAmong(const Manifest& manifest) {
  std::vector<bool> out(manifest.fields.size());
  for (std::size_t f = 0; f < out.size(); ++f) out[f] = labelNamesOf(manifest, f) != nullptr;
  return out;
}

std::string_view timeUnit(const Manifest& manifest) {
  const auto at = manifest.units.find("");
  return at == manifest.units.end() ? std::string_view() : at->second;
}

std::array<double, 6> focusCorners(const Manifest& manifest) {
  assert(manifest.focus);
  std::array<double, 6> out{};
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double share =
        std::ldexp(manifest.focus->at(i), -std::numeric_limits<Focus::value_type>::digits);
    out[i] = manifest.latticeOrigin[i % 3] +
             std::ldexp(manifest.latticeStep * share, manifest.latticeBits);
  }
  return out;
}

Json openingJson(const Manifest& manifest) {
  assert(manifest.opening && manifest.opening->field < manifest.fields.size());
  const auto& [field, cut] = *manifest.opening;
  Json out = {{"field", fieldKey(manifest, field)}};
  if (cut) out["cut"] = std::string(1, static_cast<char>('x' + *cut));
  return out;
}

std::string manifestToJson(const Manifest& manifest) {
  Json out;
  out["generator"] = manifest.generator;
  out["source"] = manifest.source;
  out["lattice"] = {{"bits", manifest.latticeBits},
                    {"step", manifest.latticeStep},
                    {"origin", manifest.latticeOrigin}};
  if (manifest.focus) out["focus"] = focusCorners(manifest);
  if (manifest.opening) out["opening"] = openingJson(manifest);
  if (const auto unit = timeUnit(manifest); !unit.empty()) out["timeUnit"] = unit;
  out["fields"] = Json::array();
  for (const ManifestField& f : manifest.fields)
    out["fields"].push_back({{"name", f.name.text()},
                             {"components", f.components},
                             {"type", f.type},
                             {"association", f.association},
                             {"bits", f.bits},
                             {"step", f.step},
                             {"minimum", f.minimum},
                             {"range", f.range}});
  for (std::size_t f = 0; f < manifest.fields.size(); ++f) {
    if (manifest.fields[f].hasMissing) out["fields"][f]["gaps"] = true;
    if (const auto unit = unitOf(manifest, manifest.fields[f].name); !unit.empty())
      out["fields"][f]["unit"] = unit;
  }
  if (!manifest.labels.empty()) out["labels"] = toJson(manifest.labels);
  if (manifest.original)
    out["original"] = {{"tetrahedra", manifest.original->tetrahedra},
                       {"vertices", manifest.original->vertices}};
  const std::vector<bool> isLabel = labelsAmong(manifest);
  out["levels"] = Json::array();
  for (const ManifestLevel& l : manifest.levels) {
    out["levels"].push_back({{"level", l.level},
                             {"tetrahedra", l.tetrahedra},
                             {"vertices", l.vertices},
                             {"boundaryTriangles", l.boundaryTriangles},
                             {"chunk", l.chunk}});
    if (l.error) out["levels"].back()["error"] = toJson(*l.error, isLabel);
  }
  return dumpJson(out);
}

}  // namespace qtet
