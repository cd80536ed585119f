// A LevelError as JSON (FORMAT.md, "Known error"). For .cpp files only, because it includes
// nlohmann-json.
#pragma once

#include <nlohmann/json.hpp>

#include "proto/level_error.h"

namespace qtet {

[[nodiscard]] inline nlohmann::ordered_json toJson(const LevelError& error) {
  const auto distance = [](const OneSidedDistance& d) {
    return nlohmann::ordered_json{{"mean", d.mean}, {"max", d.max}};
  };
  nlohmann::ordered_json out = {
      {"boundary",
       {{"toLevel", distance(error.toLevel)}, {"toOriginal", distance(error.toOriginal)}}},
      {"volumeLost", error.volumeLost},
      {"volumeGained", error.volumeGained},
      {"fields", nlohmann::ordered_json::array()}};
  for (const FieldError& field : error.fields)
    out["fields"].push_back({{"rms", field.rms}, {"max", field.max}});
  return out;
}

}  // namespace qtet
