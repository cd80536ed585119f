#include "server/routes/level_routes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <expected>
#include <numeric>

#include "codec/log/target_choice.h"
#include "codec/picture/poster.h"
#include "server/http/content_disposition.h"
#include "server/http/http_resource.h"
#include "server/store/preview.h"

namespace qtet {
namespace {

template <class T>
using OrRefusal = std::expected<T, Reply>;

std::unexpected<Reply> badRequest(std::string_view detail) {
  return std::unexpected(problem(400, "bad-request", detail));
}
std::unexpected<Reply> notFound(std::string_view detail) {
  return std::unexpected(problem(404, "not-found", detail));
}

/// A whole text as a number; no sign, no leading zero for whole ones.
template <class T>
std::optional<T> parseNumber(std::string_view text) {
  T out{};
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (ec != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return out;
}

std::string_view mediaType(LevelForm form) {
  switch (form) {
    case LevelForm::kVtu: return "application/vnd.vtk.vtu+xml";
    case LevelForm::kGlb: return "model/gltf-binary";
    case LevelForm::kObj: return "model/obj";
    case LevelForm::kUsda: return "model/vnd.usda";
    case LevelForm::kPng: return "image/png";
    case LevelForm::kWebp: return "image/webp";
    default: return "application/octet-stream";
  }
}

/// Whether it is looked at, not saved.
bool isPicture(LevelForm form) { return form == LevelForm::kPng || form == LevelForm::kWebp; }

/// Whether the form is compressed already and is sent as it is.
bool isCompressed(LevelForm form) { return form == LevelForm::kGlb || form == LevelForm::kDrc; }

Result<std::uint32_t> levelOf(const ServedMesh& mesh, const Target& target) {
  return levelFor(target, mesh.manifest, mesh.log.index());
}

/// "NAME:E" as the coarsest level at which the field's rms error (or that of "boundary", its
/// distance) is at most E.
OrRefusal<std::uint32_t> levelOfError(const ServedMesh& mesh, const std::string& text) {
  const std::size_t colon = text.rfind(':');
  const auto bound = colon == std::string::npos
                         ? std::nullopt
                         : parseNumber<double>(std::string_view(text).substr(colon + 1));
  if (!bound || !(*bound >= 0) || !std::isfinite(*bound))
    return badRequest(
        "error is NAME:E, a field or 'boundary' and a fraction of its range or of the diagonal, "
        "like error=boundary:0.01");
  const std::string name = text.substr(0, colon);
  const bool isField = fieldOfKey(mesh.manifest, name).has_value();
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
  const auto level = parseNumber<std::uint32_t>(name);
  const bool canonical = name == "0" || !name.starts_with('0');
  if (!level || !canonical || *level >= mesh.manifest.levels.size())
    return notFound("there is no such level; this mesh has the levels 0 to " +
                    std::to_string(mesh.manifest.levels.size() - 1) + ", and fit.vtu?tets=N");
  return *level;
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
  for (std::string_view rest = *text; !rest.empty();) {
    const std::string_view name = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(name.size() + 1, rest.size()));
    const auto field = fieldOfKey(mesh.manifest, name);
    if (!field) return notFound("this mesh has no field '" + std::string(name) + "'");
    out.push_back(*field);
  }
  std::ranges::sort(out);
  const auto twice = std::ranges::unique(out);
  out.erase(twice.begin(), twice.end());
  return out;
}

std::string canonicalPath(const LevelRequest& level) {
  return "/v1/logs/" + level.mesh->log.digest() + "/levels/" + std::to_string(level.level) + "." +
         std::string(formName(level.form));
}

/// The digest's own bytes decide, so the answer may be kept for ever; the version of this program
/// is part of the tag.
Resource resourceOf(const LevelRequest& wanted, const std::string& name) {
  Resource out{{'"' + wanted.key() + '"', wanted.mesh->modified},
               std::string(mediaType(wanted.form)),
               kForEver};
  out.headers.add(
      "Content-Disposition",
      contentDisposition(isPicture(wanted.form) ? Disposition::kInline : Disposition::kAttachment,
                         name + "." + std::string(formName(wanted.form))));
  becomeEmbeddable(out);
  return out;
}

Answer toBeMade(const RequestView& request, const Resource& resource, LevelRequest wanted) {
  if (std::optional<Reply> early = conditionalReply(request, resource)) return std::move(*early);
  Reply out = beginReply(200, resource);
  out.headers.add("Accept-Ranges", "bytes");
  out.body = std::monostate();
  return {std::move(out), std::move(wanted)};
}

}  // namespace

Answer routeLevel(const RequestView& request, const RequestTarget& target, const NamedLog& log,
                  std::string_view name) {
  const MeshPointer& mesh = log.mesh;
  const std::size_t dot = std::min(name.find('.'), name.size());
  const auto form = formOfName(name.substr(std::min(dot + 1, name.size())));
  if (!form || isPicture(*form))
    return problem(404, "not-found",
                   "a level is to be had as {k}.vtu, .vtk, .msh, .usda, and its boundary as "
                   "{k}.glb, .drc, .obj");
  const OrRefusal<std::uint32_t> level = levelOfName(name.substr(0, dot), target, *mesh);
  if (!level) return level.error();
  const OrRefusal<std::vector<std::uint32_t>> fields = wantedFields(target, *mesh);
  if (!fields) return fields.error();
  LevelRequest wanted{mesh, *level, *form, *fields};

  Resource resource = resourceOf(wanted, log.name + "-level-" + std::to_string(*level));
  if (name.starts_with("fit.")) resource.headers.add("Content-Location", canonicalPath(wanted));
  if (!isCompressed(*form)) {
    wanted.coding = chooseCoding(request.acceptEncoding.value_or(""), true, true);
    becomeVariant(resource, wanted.coding);
  }
  return toBeMade(request, resource, std::move(wanted));
}

Answer routePreview(const RequestView& request, const RequestTarget& target, const NamedLog& log) {
  const MeshPointer& mesh = log.mesh;
  const Manifest& manifest = mesh->manifest;
  const auto small = [](const ManifestLevel& level) {
    return level.boundaryTriangles <= kMaxPreviewTriangles;
  };
  const auto finest = std::find_if(manifest.levels.rbegin(), manifest.levels.rend(), small);
  LevelRequest wanted{mesh, finest == manifest.levels.rend() ? 0 : finest->level, LevelForm::kPng};
  if (const std::optional<std::string> name = target.parameter("field"); name && !name->empty()) {
    const auto field = fieldOfKey(manifest, *name);
    if (!field || manifest.fields[*field].association != "point")
      return problem(404, "not-found", "this mesh has no field of points '" + *name + "'");
    wanted.fields = {*field};
  } else if (!name) {
    const auto first = std::ranges::find(manifest.fields, "point", &ManifestField::association);
    if (first != manifest.fields.end())
      wanted.fields = {static_cast<std::uint32_t>(first - manifest.fields.begin())};
  }
  const Resource resource = resourceOf(wanted, log.name + "-preview");
  return toBeMade(request, resource, std::move(wanted));
}

Answer routePoster(const RequestView& request, const NamedLog& log) {
  const Manifest& manifest = log.mesh->manifest;
  LevelRequest wanted{log.mesh, posterLevel(manifest), LevelForm::kWebp, posterFields(manifest)};
  const Resource resource = resourceOf(wanted, log.name + "-poster");
  return toBeMade(request, resource, std::move(wanted));
}

}  // namespace qtet
