#include "server/store/series_maker.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "codec/mesh/mesh.h"
#include "codec/refine/level_fields.h"
#include "codec/refine/refiner.h"
#include "proto/field_name.h"
#include "proto/number_text.h"
#include "server/store/cell_at_point.h"

namespace qtet {
namespace {

/// The values of one field at the point, one a component; NaN where one is missing.
struct Instant {
  std::optional<double> time;
  std::vector<double> values;
};

/// Text of a value of a field of this type; `missing` where it is none.
std::string valueText(double value, const std::string& type, const char* missing) {
  if (!std::isfinite(value)) return missing;
  const auto rounded = static_cast<float>(value);
  return type == "float32" && std::isfinite(rounded) ? shortestText(rounded) : shortestText(value);
}

Status stopped() {
  return fail(ErrorCode::kIo, "stopped, because nobody waits for the values any more");
}

std::unexpected<Error> isOutside(const LevelRequest& request, std::span<const LatticePoint> points,
                                 const Lattice& lattice) {
  const auto [low, high] = boxOf(points);
  const auto text = [](const std::array<double, 3>& p) {
    return "(" + shortestText(p[0]) + ", " + shortestText(p[1]) + ", " + shortestText(p[2]) + ")";
  };
  return fail(ErrorCode::kNotFound,
              "the point " + text(*request.point) + " lies in no cell of level " +
                  std::to_string(request.level) + ", whose box is from " +
                  text(lattice.position(low)) + " to " + text(lattice.position(high)) +
                  "; give a point inside the mesh, or a finer level");
}

/// A field's values in the cell: a point field's are interpolated, and missing where one of a
/// corner that counts is.
std::vector<double> valuesAt(const ManifestField& field, std::span<const std::int32_t> integers,
                             const PointInCell& place, const Tetrahedron& corners) {
  const FieldInfo info{.name = {}, .step = field.step, .minimum = field.minimum};
  std::vector<double> out(field.components);
  for (std::size_t c = 0; c < out.size(); ++c) {
    const auto at = [&](std::size_t element) {
      return info.value(c, integers[element * field.components + c]);
    };
    if (field.association == "cell") {
      out[c] = at(place.cell);
      continue;
    }
    for (std::size_t i = 0; i < corners.size(); ++i)
      if (place.weights[i] > 0) out[c] += place.weights[i] * at(corners[i]);
  }
  return out;
}

std::string jsonText(const LevelRequest& request, const std::string& name, CellId cell,
                     const std::vector<Instant>& instants) {
  const ManifestField& field = request.mesh->manifest.fields[request.fields.front()];
  const std::array<double, 3>& p = *request.point;
  std::string out = "{\"field\":" + nlohmann::json(name).dump() + ",\"association\":\"" +
                    field.association + "\",\"components\":" + std::to_string(field.components) +
                    ",\"point\":[" + shortestText(p[0]) + "," + shortestText(p[1]) + "," +
                    shortestText(p[2]) + "],\"level\":" + std::to_string(request.level) +
                    ",\"tetrahedron\":" + std::to_string(cell) + ",\"times\":";
  if (instants.front().time) {
    out += '[';
    for (const Instant& instant : instants)
      out += (&instant == instants.data() ? "" : ",") + shortestText(*instant.time);
    out += ']';
  } else {
    out += "null";
  }
  out += ",\"values\":[";
  for (const Instant& instant : instants) {
    out += &instant == instants.data() ? "[" : ",[";
    for (std::size_t c = 0; c < instant.values.size(); ++c)
      out += (c == 0 ? "" : ",") + valueText(instant.values[c], field.type, "null");
    out += ']';
  }
  return out + "]}";
}

/// As RFC 4180 has it: in quotes where a character of it means something else.
/// A name is a stranger's. Behind an apostrophe no spreadsheet takes it for a formula (OWASP, "CSV
/// Injection").
std::string csvCell(const std::string& text) {
  const bool looksLikeFormula = text.find_first_of("=+-@\t\r") == 0;
  if (!looksLikeFormula && text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = looksLikeFormula ? "\"'" : "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

std::string csvText(const LevelRequest& request, const std::string& name,
                    const std::vector<Instant>& instants) {
  const ManifestField& field = request.mesh->manifest.fields[request.fields.front()];
  std::string out = "time";
  for (std::uint32_t c = 0; c < field.components; ++c)
    out += "," + csvCell(field.components == 1 ? name : name + "_" + std::to_string(c));
  out += "\r\n";
  for (const Instant& instant : instants) {
    if (instant.time) out += shortestText(*instant.time);
    for (const double value : instant.values) out += "," + valueText(value, field.type, "");
    out += "\r\n";
  }
  return out;
}

}  // namespace

// A mesh at a level. The values of all of `whole` are there. Fields with too many values are
// decoded again for each point, at its place alone.
struct SeriesMaker::Kept {
  Kept(MeshPointer of, std::uint32_t at) : mesh(std::move(of)), level(at) {}

  [[nodiscard]] const LogFile& log() const { return mesh->log; }
  Status decode(std::uint32_t field, const std::stop_token& stop);
  /// Bytes of the values of these fields, and of the differences that they are made from.
  [[nodiscard]] std::uint64_t bytesOf(std::span<const std::uint32_t> fields) const;
  /// All values of the fields and their parents.
  Status decodeWhole(const std::vector<std::uint32_t>& fields, const std::stop_token& stop);
  /// Decodes the fields and their parents at these elements, one after the other; parents have
  /// smaller numbers. Each is shown to `take` when it is there, and forgotten once none of the rest
  /// is predicted from it.
  Status decodeOnlyAt(std::span<const std::uint32_t> elements,
                      const std::vector<std::uint32_t>& fields, const std::stop_token& stop,
                      const std::function<void(std::uint32_t field)>& take);

  const MeshPointer mesh;
  const std::uint32_t level;
  Refiner refiner{mesh->log.index()};
  std::vector<std::uint32_t> whole;  // ascending
  bool onlyAt = false;               // the refiner decodes no whole field any more
};

Status SeriesMaker::Kept::decode(std::uint32_t field, const std::stop_token& stop) {
  for (std::uint32_t chunk = 0; chunk < refiner.chunksApplied(); ++chunk) {
    if (stop.stop_requested()) return stopped();
    if (Status s = applyFieldBlock(log(), refiner, chunk, field); !s) return s;
  }
  return {};
}

std::uint64_t SeriesMaker::Kept::bytesOf(std::span<const std::uint32_t> fields) const {
  std::uint64_t sum = 0;
  for (const std::uint32_t f : fields) {
    const FieldShape& shape = log().fields()[f];
    const bool ofPoints = shape.association == Association::kPoint;
    const std::uint64_t elements = ofPoints ? refiner.points().size() : refiner.tetrahedra().size();
    const std::uint64_t copies = shape.prediction.isNone() ? 1 : 2;
    // a lifted block keeps a byte beside each value
    sum += (copies * sizeof(std::int32_t) + (ofPoints ? 1 : 0)) * elements * shape.components;
  }
  return sum;
}

Status SeriesMaker::Kept::decodeWhole(const std::vector<std::uint32_t>& fields,
                                      const std::stop_token& stop) {
  for (const std::uint32_t f : whole)
    if (!std::ranges::binary_search(fields, f)) refiner.forgetField(f);
  for (const std::uint32_t f : fields)
    if (!std::ranges::binary_search(whole, f))
      if (Status s = decode(f, stop); !s) return s;
  whole = fields;
  return {};
}

Status SeriesMaker::Kept::decodeOnlyAt(std::span<const std::uint32_t> elements,
                                       const std::vector<std::uint32_t>& fields,
                                       const std::stop_token& stop,
                                       const std::function<void(std::uint32_t field)>& take) {
  onlyAt = true;
  for (const std::uint32_t f : std::exchange(whole, {})) refiner.forgetField(f);
  refiner.fieldsOnlyAt(log().fields()[fields.back()].association, elements);
  LevelFields decoded(log(), refiner, fields, stop);
  for (const std::uint32_t f : fields)
    if (!decoded.integers(f).empty()) take(f);
  return decoded.status();
}

SeriesMaker::SeriesMaker(std::uint64_t keptValueBytes) : keptValueBytes_(keptValueBytes) {}

SeriesMaker::~SeriesMaker() = default;

void SeriesMaker::forget() { kept_ = nullptr; }

Result<Bytes> SeriesMaker::make(const LevelRequest& request, const std::stop_token& stop) {
  assert(request.point && !request.fields.empty());
  assert(request.form == LevelForm::kJson || request.form == LevelForm::kCsv);
  const Manifest& manifest = request.mesh->manifest;
  const Lattice lattice{manifest.latticeBits, manifest.latticeStep, manifest.latticeOrigin};
  // After an error nothing half decoded is kept.
  std::unique_ptr<Kept> kept = std::move(kept_);
  const auto isOther = [&] {
    return !kept || kept->mesh != request.mesh || kept->level != request.level;
  };
  const std::vector<std::uint32_t> fields = withParents(request.mesh->log.fields(), request.fields);
  if (isOther() || (kept->onlyAt && kept->bytesOf(fields) <= keptValueBytes_)) {
    kept = nullptr;  // before there are two
    kept = std::make_unique<Kept>(request.mesh, request.level);
    if (Status s = refineToLevel(request.mesh->log, kept->refiner, request.level, {}, stop); !s)
      return std::unexpected(s.error());
  }
  const Refiner& refiner = kept->refiner;
  std::array<double, 3> point{};
  for (std::size_t a = 0; a < 3; ++a)
    point[a] = ((*request.point)[a] - lattice.origin[a]) / lattice.step;
  const std::optional<PointInCell> place =
      cellAtPoint(refiner.points(), refiner.tetrahedra(), point,
                  nearStepsOf(refiner.points(), manifest.levels[request.level].error));
  if (!place) {
    auto out = isOutside(request, refiner.points(), lattice);
    kept_ = std::move(kept);
    return out;
  }

  const Tetrahedron& corners = refiner.tetrahedra()[place->cell];
  std::string name;
  std::vector<Instant> instants;
  const auto take = [&](std::uint32_t f) {
    if (!std::ranges::binary_search(request.fields, f)) return;
    const ManifestField& field = manifest.fields[f];
    const std::optional<InstantName> instant = field.name.instant();
    name = field.name.withoutTime();
    instants.push_back({instant ? std::optional(instant->time) : std::nullopt,
                        valuesAt(field, refiner.fieldValues(f), *place, corners)});
  };
  if (kept->bytesOf(fields) <= keptValueBytes_) {
    if (Status s = kept->decodeWhole(fields, stop); !s) return std::unexpected(s.error());
    std::ranges::for_each(fields, take);
  } else {
    const bool ofCells = manifest.fields[request.fields.front()].association == "cell";
    const std::span<const std::uint32_t> elements =
        ofCells ? std::span<const std::uint32_t>(&place->cell, 1) : std::span(corners);
    if (Status s = kept->decodeOnlyAt(elements, fields, stop, take); !s)
      return std::unexpected(s.error());
  }
  std::ranges::sort(instants, {}, &Instant::time);
  const std::string text = request.form == LevelForm::kCsv
                               ? csvText(request, name, instants)
                               : jsonText(request, name, place->cell, instants);
  kept_ = std::move(kept);
  return Bytes(text.begin(), text.end());
}

}  // namespace qtet
