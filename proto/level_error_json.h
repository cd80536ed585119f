// What both the manifest and other reports hold, as JSON: a LevelError (FORMAT.md, "Known error"),
// and the names of labels. For .cpp files only, because it includes nlohmann-json.
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
  for (std::size_t f = 0; f < error.fields.size(); ++f) {
    const auto& [rms, max] = error.fields[f];
    if (isLabel[f])
      out["fields"].push_back({{"wrong", rms}});
    else
      out["fields"].push_back({{"rms", rms}, {"max", max}});
  }
  return out;
}

}  // namespace qtet
