// A LevelError (FORMAT.md, "Known error") and the names of labels as JSON. For .cpp files only,
// because it includes nlohmann-json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "proto/level_error.h"
#include "proto/manifest.h"

namespace qtet {

/// {"1": "steel", "2": "oil"}
[[nodiscard]] inline nlohmann::ordered_json toJson(const LabelNames& names) {
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  for (const auto& [value, name] : names) out[std::to_string(value)] = name;
  return out;
}

/// By field, once for all instants of a series: {"Material": {"1": "steel", "2": "oil"}}
[[nodiscard]] inline nlohmann::ordered_json toJson(const Labels& labels) {
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  for (const auto& [field, names] : labels) out[field] = toJson(names);
  return out;
}

[[nodiscard]] inline nlohmann::ordered_json fieldErrorJson(const FieldError& error, bool isLabel) {
  if (isLabel) return {{"wrong", error.rms}};
  return {{"rms", error.rms}, {"max", error.max}};
}

/// `isLabel`: which of the error's fields are labels.
[[nodiscard]] inline nlohmann::ordered_json toJson(const LevelError& error,
                                                   const std::vector<bool>& isLabel) {
  const auto distance = [](const OneSidedDistance& d) {
    return nlohmann::ordered_json{{"mean", d.mean}, {"max", d.max}};
  };
  nlohmann::ordered_json out = {
      {"boundary",
       {{"toLevel", distance(error.toLevel)}, {"toOriginal", distance(error.toOriginal)}}},
      {"volumeLost", error.volumeLost},
      {"volumeGained", error.volumeGained},
      {"fields", nlohmann::ordered_json::array()}};
  for (std::size_t f = 0; f < error.fields.size(); ++f)
    out["fields"].push_back(fieldErrorJson(error.fields[f], isLabel[f]));
  return out;
}

}  // namespace qtet
