// A LevelError as JSON, both ways (FORMAT.md, "Known error"). For .cpp files only: it drags nlohmann-json in.
#pragma once

#include <tuple>
#include <utility>

#include "proto/json_reader.h"
#include "proto/level_error.h"

namespace qtet {

[[nodiscard]] inline nlohmann::ordered_json toJson(const LevelError& error) {
  const auto distance = [](const OneSidedDistance& d) { return nlohmann::ordered_json{{"mean", d.mean}, {"max", d.max}}; };
  nlohmann::ordered_json out = {{"boundary", {{"toLevel", distance(error.toLevel)}, {"toOriginal", distance(error.toOriginal)}}},
                                {"volumeKept", error.volumeKept},
                                {"fields", nlohmann::ordered_json::array()}};
  for (const FieldError& field : error.fields) out["fields"].push_back({{"rms", field.rms}, {"max", field.max}});
  return out;
}

/// Errors: what is missing, negative, no number, a mean or rms above its maximum, another number of fields than `fields`.
[[nodiscard]] inline LevelError readLevelError(const JsonCursor& json, std::size_t fields) {
  const auto magnitude = [](const JsonCursor& cursor) {
    const double out = cursor.number();
    if (out < 0) cursor.fail("must not be below 0");
    return out;
  };
  // Of a mean or rms and a maximum: the first cannot be the larger one.
  const auto pair = [&](const JsonCursor& cursor, const char* average) {
    const double low = magnitude(cursor[average]), high = magnitude(cursor["max"]);
    if (low > high) cursor[average].fail("is above the max beside it");
    return std::pair{low, high};
  };
  LevelError out;
  const JsonCursor boundary = json["boundary"];
  std::tie(out.toLevel.mean, out.toLevel.max) = pair(boundary["toLevel"], "mean");
  std::tie(out.toOriginal.mean, out.toOriginal.max) = pair(boundary["toOriginal"], "mean");
  out.volumeKept = magnitude(json["volumeKept"]);
  for (const JsonCursor& field : json["fields"].items(fields, fields)) {
    const auto [rms, max] = pair(field, "rms");
    out.fields.push_back({rms, max});
  }
  return out;
}

}  // namespace qtet
