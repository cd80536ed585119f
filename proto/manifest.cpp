#include "proto/manifest.h"

#include <algorithm>
#include <set>
#include <utility>

#include "proto/json_reader.h"
#include "proto/level_error_json.h"
#include "proto/limits.h"

namespace qtet {
namespace {

constexpr std::array kFieldTypes = {"float32", "float64", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64"};

template <class Words>
std::string oneOf(const JsonCursor& cursor, const Words& words) {
  std::string out = cursor.text(kMaxNameBytes);
  if (cursor.present() && std::ranges::find(words, out) == std::end(words))
    cursor.fail("is '" + out + "', which is none of the known words");
  return out;
}

double positive(const JsonCursor& cursor) {
  const double out = cursor.number();
  if (cursor.present() && !(out > 0)) cursor.fail("must be above 0");
  return out;
}

ManifestField readField(const JsonCursor& json) {
  ManifestField out;
  out.name = json["name"].text(kMaxNameBytes);
  if (out.name.empty()) json["name"].fail("must not be empty");
  out.components = json["components"].count32(1, kMaxFieldComponents);
  out.type = oneOf(json["type"], kFieldTypes);
  out.association = oneOf(json["association"], std::array{"point", "cell"});
  out.bits = static_cast<int>(json["bits"].count32(kMinFieldBits, kMaxFieldBits));
  out.step = positive(json["step"]);
  for (const JsonCursor& value : json["minimum"].items(out.components, out.components)) out.minimum.push_back(value.number());
  const auto range = json["range"].items(2, 2);
  for (std::size_t i = 0; i < range.size(); ++i) out.range[i] = range[i].number();
  if (const JsonCursor gaps = json.optional("gaps"); gaps.present()) out.gaps = gaps.boolean();
  return out;
}

ManifestLevel readLevel(const JsonCursor& json, std::uint32_t number, std::uint32_t leastChunk, std::size_t fields) {
  ManifestLevel out;
  out.level = json["level"].count32(number, number);
  out.tetrahedra = json["tetrahedra"].count32(0, kMaxElements);
  out.vertices = json["vertices"].count32(0, kMaxElements);
  out.boundaryTriangles = json["boundaryTriangles"].count32(0, kMaxElements);
  out.chunk = json["chunk"].count32(leastChunk, kMaxChunks - 1);
  if (const JsonCursor error = json.optional("error"); error.present()) out.error = readLevelError(error, fields);
  return out;
}

void readFields(const JsonCursor& json, Manifest& out) {
  std::set<std::pair<std::string, std::string>> names;
  for (const JsonCursor& item : json.items(0, kMaxFields)) {
    const ManifestField& field = out.fields.emplace_back(readField(item));
    if (!names.emplace(field.association, field.name).second) item["name"].fail("stands twice; a field is asked for by its name");
  }
}

void readLevels(const JsonCursor& json, Manifest& out) {
  std::uint32_t chunk = 0;
  for (const JsonCursor& item : json.items(1, kMaxLevels)) {
    out.levels.push_back(readLevel(item, static_cast<std::uint32_t>(out.levels.size()), chunk, out.fields.size()));
    chunk = out.levels.back().chunk;
  }
}

}  // namespace

std::string fieldKey(const Manifest& manifest, std::size_t f) {
  const ManifestField& field = manifest.fields[f];
  return fieldOfKey(manifest, field.name) == f ? field.name : field.association + ":" + field.name;
}

std::optional<std::uint32_t> fieldOfKey(const Manifest& manifest, std::string_view key) {
  const auto find = [&](std::string_view association, std::string_view name) -> std::optional<std::uint32_t> {
    for (std::uint32_t f = 0; f < manifest.fields.size(); ++f)
      if (manifest.fields[f].association == association && manifest.fields[f].name == name) return f;
    return std::nullopt;
  };
  for (const std::string_view association : {"point", "cell"})
    if (const auto f = find(association, key)) return f;
  const std::size_t colon = key.find(':');
  return colon == std::string_view::npos ? std::nullopt : find(key.substr(0, colon), key.substr(colon + 1));
}

std::string manifestToJson(const Manifest& manifest) {
  Json out;
  out["generator"] = manifest.generator;
  out["layout"] = manifest.layout;
  out["source"] = manifest.source;
  out["lattice"] = {{"bits", manifest.latticeBits}, {"step", manifest.latticeStep}, {"origin", manifest.latticeOrigin}};
  out["fields"] = Json::array();
  for (const ManifestField& f : manifest.fields)
    out["fields"].push_back({{"name", f.name},
                             {"components", f.components},
                             {"type", f.type},
                             {"association", f.association},
                             {"bits", f.bits},
                             {"step", f.step},
                             {"minimum", f.minimum},
                             {"range", f.range}});
  for (std::size_t f = 0; f < manifest.fields.size(); ++f)
    if (manifest.fields[f].gaps) out["fields"][f]["gaps"] = true;
  out["levels"] = Json::array();
  for (const ManifestLevel& l : manifest.levels) {
    out["levels"].push_back({{"level", l.level},
                             {"tetrahedra", l.tetrahedra},
                             {"vertices", l.vertices},
                             {"boundaryTriangles", l.boundaryTriangles},
                             {"chunk", l.chunk}});
    if (l.error) out["levels"].back()["error"] = toJson(*l.error);
  }
  return dumpJson(out);
}

Result<Manifest> manifestFromJson(std::string_view json) {
  if (json.size() > kMaxManifestBytes)
    return fail(ErrorCode::kLimitExceeded, "the manifest is " + std::to_string(json.size()) + " bytes long; at most " +
                                               std::to_string(kMaxManifestBytes) + " are read");
  const Json document = Json::parse(json, nullptr, false);
  if (document.is_discarded()) return fail(ErrorCode::kBadValue, "the manifest is not JSON; fetch or copy the file again");

  Manifest out;
  std::optional<Error> error;
  const JsonCursor root(&document, "", &error);
  out.generator = root["generator"].text(kMaxNameBytes);
  out.layout = oneOf(root["layout"], std::array{"stream", "regions"});
  out.source = root["source"].text(kMaxNameBytes);
  const JsonCursor lattice = root["lattice"];
  out.latticeBits = static_cast<int>(lattice["bits"].count32(kMinPositionBits, kMaxPositionBits));
  out.latticeStep = positive(lattice["step"]);
  const auto origin = lattice["origin"].items(3, 3);
  for (std::size_t i = 0; i < origin.size(); ++i) out.latticeOrigin[i] = origin[i].number();
  readFields(root["fields"], out);
  readLevels(root["levels"], out);
  if (error) return fail(error->code, "manifest: " + error->message);
  return out;
}

}  // namespace qtet
