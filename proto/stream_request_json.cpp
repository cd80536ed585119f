#include "proto/stream_request_json.h"

#include <cassert>

#include "proto/limits.h"

namespace qtet {
namespace {

/// The largest integer that JSON keeps exactly in every language.
constexpr std::uint64_t kMaxInteger = (std::uint64_t{1} << 53) - 1;

constexpr const char* kSpaceFirst = "space";
constexpr const char* kTimeFirst = "time";

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
  out.chunks = json.optional("chunks").count32(0, kMaxChunks);
  for (const auto& [name, field] : json.optional("fields").members(kMaxRequestFields)) {
    out.fields.emplace_back(name, field.count32(0, kMaxChunks));
    if (out.fields.back().second > out.chunks)
      field.fail("is above the chunks of the mesh; a field never runs ahead of its mesh");
  }
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
    ++found, out = FieldErrorTarget{readError(error), json["field"].name()};
  if (const JsonCursor error = json.optional("boundaryError"); error.present())
    ++found, out = BoundaryErrorTarget{readError(error)};
  if (found != 1)
    json.fail("must have one of level, bytes, tetrahedra, error (with field) and boundaryError");
  return out;
}

std::optional<StreamTime> readStreamTime(const JsonCursor& json) {
  if (!json.present() || json.isNull()) return std::nullopt;
  StreamTime out;
  out.at = json["at"].number();
  out.ahead = json.optional("ahead").count32(0, kMaxAhead);
  const JsonCursor first = json.optional("first");
  const std::string name = first.present() ? first.text(kMaxNameBytes) : kSpaceFirst;
  if (name != kSpaceFirst && name != kTimeFirst) first.fail("must be 'space' or 'time'");
  if (name == kTimeFirst) out.first = StreamTime::First::kTime;
  return out;
}

Json toJson(const StreamTime& time) {
  assert(std::isfinite(time.at));
  return {{"at", time.at},
          {"ahead", time.ahead},
          {"first", time.first == StreamTime::First::kTime ? kTimeFirst : kSpaceFirst}};
}

Json toJson(const Have& have) {
  assert(have.chunks <= kMaxChunks && have.fields.size() <= kMaxRequestFields);
  Json out = {{"chunks", have.chunks}, {"fields", Json::object()}};
  for (const auto& [name, chunks] : have.fields) {
    assert(chunks <= have.chunks);
    out["fields"][name] = chunks;
  }
  return out;
}

Json toJson(const Target& target) { return std::visit(TargetToJson{}, target); }

}  // namespace qtet
