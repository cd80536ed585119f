#include "proto/stream_request_json.h"

#include "proto/limits.h"

namespace qtet {
namespace {

/// The largest integer that JSON keeps exactly in every language.
constexpr std::uint64_t kMaxInteger = (std::uint64_t{1} << 53) - 1;

std::string readName(const JsonCursor& json) {
  std::string out = json.text(kMaxNameBytes);
  if (json.present() && out.empty()) json.fail("must not be empty");
  return out;
}

template <std::size_t N>
std::array<double, N> readNumbers(const JsonCursor& json) {
  std::array<double, N> out{};
  const auto items = json.items(N, N);
  for (std::size_t i = 0; i < items.size(); ++i) out[i] = items[i].number();
  return out;
}

std::vector<Plane> readPlanes(const JsonCursor& json, std::size_t most) {
  std::vector<Plane> out;
  for (const JsonCursor& plane : json.items(0, most)) out.push_back(readNumbers<4>(plane));
  return out;
}

std::vector<ChunkRange> readRanges(const JsonCursor& json, std::uint32_t leading) {
  std::vector<ChunkRange> out;
  std::uint32_t least = leading + 1;
  for (const JsonCursor& item : json.items(0, kMaxChunkRanges)) {
    const auto ends = item.items(2, 2);
    if (ends.size() != 2) break;  // the error is set
    const ChunkRange range{ends[0].count32(0, kMaxChunks), ends[1].count32(0, kMaxChunks)};
    if (range.first < least || range.end <= range.first)
      item.fail("must be [first, end) behind the leading chunks and the range before it");
    least = range.end;
    if (!out.empty() && out.back().end == range.first) {
      out.back().end = range.end;
    } else {
      out.push_back(range);
    }
  }
  return out;
}

HeldChunks readHeld(const JsonCursor& json) {
  HeldChunks out;
  out.leading = json.optional("chunks").count32(0, kMaxChunks);
  out.ranges = readRanges(json.optional("ranges"), out.leading);
  return out;
}

HeldChunks readFieldHeld(const JsonCursor& json, const HeldChunks& mesh) {
  const HeldChunks out = json.isObject() ? readHeld(json) : HeldChunks{json.count32(0, kMaxChunks)};
  bool within = out.leading <= mesh.leading;
  for (const ChunkRange& range : out.ranges) within = within && mesh.holds(range);
  if (!within)
    json.fail("is not within the chunks of the mesh; a field never runs ahead of its mesh");
  return out;
}

Json heldToJson(const HeldChunks& held) {
  Json out = {{"chunks", held.leading}};
  if (!held.ranges.empty()) out["ranges"] = Json::array();
  for (const ChunkRange& r : held.ranges) out["ranges"].push_back({r.first, r.end});
  return out;
}

struct TargetToJson {
  Json operator()(const EverythingTarget&) const { return nullptr; }
  Json operator()(const LevelTarget& t) const { return {{"level", t.level}}; }
  Json operator()(const BytesTarget& t) const { return {{"bytes", t.bytes}}; }
  Json operator()(const TetrahedraTarget& t) const { return {{"tetrahedra", t.tetrahedra}}; }
  Json operator()(const FieldErrorTarget& t) const {
    return {{"error", t.error}, {"field", t.field}};
  }
  Json operator()(const BoundaryErrorTarget& t) const { return {{"boundaryError", t.error}}; }
};

double readError(const JsonCursor& json) {
  const double out = json.number();
  if (out < 0) json.fail("must not be below 0");
  return out;
}

}  // namespace

Have readHave(const JsonCursor& json) {
  Have out;
  out.mesh = readHeld(json);
  for (const auto& [name, held] : json.optional("fields").members(kMaxFields))
    out.fields.emplace_back(name, readFieldHeld(held, out.mesh));
  return out;
}

Target readTarget(const JsonCursor& json) {
  Target out;
  if (!json.present() || json.isNull()) return out;
  int found = 0;
  if (const JsonCursor level = json.optional("level"); level.present())
    ++found, out = LevelTarget{level.count32(0, kMaxLevels)};
  if (const JsonCursor bytes = json.optional("bytes"); bytes.present())
    ++found, out = BytesTarget{bytes.count(0, kMaxInteger)};
  if (const JsonCursor cells = json.optional("tetrahedra"); cells.present())
    ++found, out = TetrahedraTarget{cells.count(0, kMaxInteger)};
  if (const JsonCursor error = json.optional("error"); error.present())
    ++found, out = FieldErrorTarget{readError(error), readName(json["field"])};
  if (const JsonCursor error = json.optional("boundaryError"); error.present())
    ++found, out = BoundaryErrorTarget{readError(error)};
  if (found != 1)
    json.fail("must have one of level, bytes, tetrahedra, error (with field) and boundaryError");
  return out;
}

View readView(const JsonCursor& json) {
  View out;
  if (!json.present() || json.isNull()) return out;
  out.frustum = readPlanes(json.optional("frustum"), kMaxFrustumPlanes);
  out.planes = readPlanes(json.optional("planes"), kMaxClipPlanes);
  if (const JsonCursor box = json.optional("box"); box.present()) {
    const auto corners = readNumbers<6>(box);
    for (std::size_t a = 0; a < 3; ++a)
      if (corners[a] > corners[a + 3]) box.fail("must be the least corner and then the greatest");
    out.box = corners;
  }
  if (const JsonCursor isovalue = json.optional("isovalue"); isovalue.present()) {
    Isovalue asked{readName(isovalue["field"])};
    if (const JsonCursor component = isovalue.optional("component"); component.present())
      asked.component = component.count32(0, kMaxFieldComponents - 1);
    for (const JsonCursor& value : isovalue["values"].items(0, kMaxIsovalues))
      asked.values.push_back(value.number());
    out.isovalue = std::move(asked);
  }
  if (const JsonCursor point = json.optional("point"); point.present())
    out.point = readNumbers<3>(point);
  return out;
}

Json toJson(const Have& have) {
  Json out = heldToJson(have.mesh);
  out["fields"] = Json::object();
  for (const auto& [name, held] : have.fields)
    out["fields"][name] = held.ranges.empty() ? Json(held.leading) : heldToJson(held);
  return out;
}

Json toJson(const Target& target) { return std::visit(TargetToJson{}, target); }

Json toJson(const View& view) {
  Json out;  // null
  if (!view.frustum.empty()) out["frustum"] = view.frustum;
  if (!view.planes.empty()) out["planes"] = view.planes;
  if (view.box) out["box"] = *view.box;
  if (view.isovalue) {
    out["isovalue"] = {{"field", view.isovalue->field}, {"values", view.isovalue->values}};
    if (view.isovalue->component) out["isovalue"]["component"] = *view.isovalue->component;
  }
  if (view.point) out["point"] = *view.point;
  return out;
}

}  // namespace qtet
