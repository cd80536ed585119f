#include "server/routes/level_routes.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "codec/files/field_limits.h"
#include "codec/log/target_choice.h"
#include "codec/picture/poster.h"
#include "server/http/unwritable_level.h"
#include "server/routes/level_answer.h"
#include "server/routes/level_time.h"

namespace qtet {
namespace {

Result<std::uint32_t> levelOf(const ServedMesh& mesh, const Target& target) {
  return levelFor(target, mesh.manifest, mesh.log.index());
}

/// "NAME:E" as the coarsest level at which the field's rms error (or that of "boundary", its
/// distance) is at most E.
OrRefusal<std::uint32_t> levelOfError(const ServedMesh& mesh, const std::string& text) {
  const std::size_t colon = text.rfind(':');
  const auto bound = colon == std::string::npos
                         ? std::nullopt
                         : parseFinite(std::string_view(text).substr(colon + 1));
  if (!bound || *bound < 0)
    return badRequest(
        "error is NAME:E, a field or 'boundary' and a fraction of its range or of the diagonal, "
        "like error=boundary:0.01");
  const std::string name = text.substr(0, colon);
  const bool isField = mesh.keys().fieldOfKey(name).has_value();
  if (!isField && name != "boundary") return notFound("this mesh has no field '" + name + "'");
  const auto level = isField ? levelOf(mesh, FieldErrorTarget{*bound, name})
                             : levelOf(mesh, BoundaryErrorTarget{*bound});
  if (!level) return notFound(level.error().message);
  return *level;
}

OrRefusal<std::uint32_t> fittingLevel(const RequestTarget& target, const ServedMesh& mesh) {
  const auto tets = target.parameter("tets"), bytes = target.parameter("bytes"),
             error = target.parameter("error");
  if (tets.has_value() + bytes.has_value() + error.has_value() != 1)
    return badRequest("levels/fit needs one of tets=N, bytes=N and error=NAME:E");
  if (error) return levelOfError(mesh, *error);
  const auto most = parseNumber<std::uint64_t>(tets ? *tets : *bytes);
  if (!most) return badRequest("tets and bytes are whole numbers");
  return *(tets ? levelOf(mesh, TetrahedraTarget{*most}) : levelOf(mesh, BytesTarget{*most}));
}

OrRefusal<std::uint32_t> levelOfName(std::string_view name, const RequestTarget& target,
                                     const ServedMesh& mesh) {
  if (name == "fit") return fittingLevel(target, mesh);
  const auto level = parseIndex(name);
  if (!level || *level >= mesh.manifest.levels.size())
    return notFound("there is no such level; this mesh has " + levelsText(mesh) +
                    ", and fit.vtu?tets=N");
  return *level;
}

/// The one field of that name, else every instant of the series.
std::vector<std::uint32_t> fieldsNamed(const FieldKeys& keys, std::string_view name) {
  const auto one = keys.fieldOfKey(name);
  return one ? std::vector{*one} : keys.fieldsOfKey(name);
}

/// `fields=A,B` as indices; absent means all, empty none.
OrRefusal<std::vector<std::uint32_t>> wantedFields(const RequestTarget& target,
                                                   const ServedMesh& mesh) {
  const std::optional<std::string> text = target.parameter("fields");
  std::vector<std::uint32_t> out;
  if (!text) {
    out.resize(mesh.manifest.fields.size());
    std::iota(out.begin(), out.end(), 0u);
    return out;
  }
  std::set<std::string_view> names;
  for (std::string_view rest = *text; !rest.empty();) {
    const std::string_view name = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(name.size() + 1, rest.size()));
    if (!names.insert(name).second) continue;  // a series again and again would be a long list
    const std::vector<std::uint32_t> meant = fieldsNamed(mesh.keys(), name);
    if (meant.empty()) return notFound("this mesh has no field '" + std::string(name) + "'");
    out.insert(out.end(), meant.begin(), meant.end());
  }
  std::ranges::sort(out);
  const auto twice = std::ranges::unique(out);
  out.erase(twice.begin(), twice.end());
  return out;
}

/// The fields that the file would hold.
std::vector<FieldOutline> outlinesOf(const LevelRequest& level) {
  std::vector<FieldOutline> out;
  for (std::size_t i = 0; i < level.fields.size(); ++i) {
    const ManifestField& field = level.mesh->manifest.fields[level.fields[i]];
    out.push_back({level.names.empty() ? field.name.text() : level.names[i], field.components,
                   field.association == "cell"});
  }
  return out;
}

std::string canonicalPath(const LevelRequest& level) {
  return "/v1/logs/" + level.mesh->log.digest() + "/levels/" + std::to_string(level.level) + "." +
         std::string(formName(level.form));
}

}  // namespace

Answer routeLevel(const RequestView& request, const RequestTarget& target, const NamedLog& log,
                  std::string_view name) {
  const MeshPointer& mesh = log.mesh;
  const std::size_t dot = std::min(name.find('.'), name.size());
  const auto form = formOfName(name.substr(std::min(dot + 1, name.size())));
  if (!form || !isMeshFile(*form))
    return problem(404, "not-found",
                   "a level is to be had as {k}.vtu, .vtk, .msh, .usda, and its boundary as "
                   "{k}.glb, .drc, .obj");
  const OrRefusal<std::uint32_t> level = levelOfName(name.substr(0, dot), target, *mesh);
  if (!level) return level.error();
  const OrRefusal<std::vector<std::uint32_t>> fields = wantedFields(target, *mesh);
  if (!fields) return fields.error();
  LevelRequest wanted{mesh, *level, *form, *fields};
  if (const std::optional<std::string> time = target.parameter("time")) {
    OrRefusal<LevelRequest> instant = atTime(std::move(wanted), *time);
    if (!instant) return instant.error();
    wanted = std::move(*instant);
  }
  // Before a job decodes the level for nothing, and before a kept file of an older version is sent.
  if (const Status checked = canHold("." + std::string(formName(*form)), outlinesOf(wanted));
      !checked)
    return unwritableLevel(checked.error());

  Resource resource = resourceOf(wanted, log.name + "-level-" + std::to_string(*level));
  if (name.starts_with("fit.")) resource.headers.add("Content-Location", canonicalPath(wanted));
  chooseCodingOf(wanted, resource, request);
  return toBeMade(request, resource, std::move(wanted));
}

Answer routePoster(const RequestView& request, const NamedLog& log) {
  const Manifest& manifest = log.mesh->manifest;
  LevelRequest wanted{log.mesh, posterLevel(manifest), LevelForm::kWebp, posterFields(manifest)};
  const Resource resource = resourceOf(wanted, log.name + "-poster");
  return toBeMade(request, resource, std::move(wanted));
}

}  // namespace qtet
