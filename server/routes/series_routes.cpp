#include "server/routes/series_routes.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "proto/series.h"
#include "server/routes/level_answer.h"

namespace qtet {
namespace {

/// Numbers of the fields that `key` means, ascending: a series, of points before of cells; else the
/// one field; else an instant that is alone.
std::vector<std::uint32_t> fieldsOfSeries(const ServedMesh& mesh, std::string_view key) {
  const FieldKeys& keys = mesh.keys();
  std::vector<std::uint32_t> out;
  if (const auto series = keys.seriesOfKey(key)) {
    for (const std::size_t f : mesh.manifest.series[*series].fields)
      out.push_back(static_cast<std::uint32_t>(f));
    std::ranges::sort(out);
  } else if (const auto one = keys.fieldOfKey(key)) {
    out = {*one};
  } else if (const auto meant = keys.fieldsOfKey(key); !meant.empty()) {
    out = {meant.front()};
  }
  return out;
}

OrRefusal<std::array<double, 3>> pointOf(const RequestTarget& target) {
  std::array<double, 3> out{};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::string name(1, "xyz"[a]);
    const std::optional<std::string> text = target.parameter(name);
    const std::optional<double> x = text ? parseFinite(*text) : std::nullopt;
    if (!x)
      return badRequest(
          name +
          (text ? " is '" + *text + "', which is no finite number" : std::string(" is missing")) +
          "; series takes a point in the mesh's own coordinates, like x=0.5&y=1&z=0");
    out[a] = *x;
  }
  return out;
}

OrRefusal<std::uint32_t> namedLevel(const ServedMesh& mesh, const std::string& text) {
  if (!parseNumber<std::uint32_t>(text))
    return badRequest("level is '" + text + "'; give a whole number, like level=3");
  const auto level = parseIndex(text);
  if (!level || *level >= mesh.manifest.levels.size())
    return notFound("there is no level " + text + "; this mesh has " + levelsText(mesh));
  return *level;
}

/// The coarsest level at which no field's known error is above `bound`; the last where there is
/// none.
std::uint32_t levelWithin(const Manifest& manifest, std::span<const std::uint32_t> fields,
                          double bound) {
  const auto found = std::ranges::find_if(manifest.levels, [&](const ManifestLevel& level) {
    return level.error && std::ranges::all_of(fields, [&](std::uint32_t f) {
             return level.error->fields[f].rms <= bound;
           });
  });
  return (found == manifest.levels.end() ? manifest.levels.back() : *found).level;
}

OrRefusal<std::uint32_t> chosenLevel(const RequestTarget& target, const ServedMesh& mesh,
                                     std::span<const std::uint32_t> fields) {
  const auto level = target.parameter("level"), error = target.parameter("error");
  if (level && error) return badRequest("level and error exclude each other; give one of them");
  if (level) return namedLevel(mesh, *level);
  const std::optional<double> bound = error ? parseFinite(*error) : kDefaultSeriesError;
  if (!bound || *bound < 0)
    return badRequest("error is '" + *error +
                      "'; give a fraction of the field's range from 0 on, like error=0.01");
  return levelWithin(mesh.manifest, fields, *bound);
}

OrRefusal<LevelForm> formOf(const RequestTarget& target) {
  const std::string format = target.parameter("format").value_or("json");
  if (format == "json") return LevelForm::kJson;
  if (format == "csv") return LevelForm::kCsv;
  return badRequest("format is '" + format + "'; give json or csv");
}

OrRefusal<LevelRequest> seriesOfTarget(const RequestTarget& target, const MeshPointer& mesh) {
  const OrRefusal<std::array<double, 3>> point = pointOf(target);
  if (!point) return std::unexpected(point.error());
  const OrRefusal<LevelForm> form = formOf(target);
  if (!form) return std::unexpected(form.error());
  const std::optional<std::string> name = target.parameter("field");
  if (!name) return badRequest("field is missing; name a series or a field, like field=T");
  std::vector<std::uint32_t> fields = fieldsOfSeries(*mesh, *name);
  if (fields.empty()) return notFound("this mesh has no series and no field '" + *name + "'");
  const OrRefusal<std::uint32_t> level = chosenLevel(target, *mesh, fields);
  if (!level) return std::unexpected(level.error());
  LevelRequest out{mesh, *level, *form, std::move(fields)};
  out.point = *point;
  return out;
}

}  // namespace

Answer routeSeries(const RequestView& request, const RequestTarget& target, const NamedLog& log) {
  OrRefusal<LevelRequest> wanted = seriesOfTarget(target, log.mesh);
  if (!wanted) return wanted.error();
  Resource resource = resourceOf(*wanted, log.name + "-series");
  chooseCodingOf(*wanted, resource, request);
  return toBeMade(request, resource, std::move(*wanted));
}

}  // namespace qtet
