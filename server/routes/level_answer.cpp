#include "server/routes/level_answer.h"

#include <cassert>
#include <cmath>

#include "server/http/content_disposition.h"
#include "server/http/http_resource.h"
#include "server/store/level_memory.h"

namespace qtet {
namespace {

std::string_view mediaType(LevelForm form) {
  switch (form) {
    case LevelForm::kVtu: return "application/vnd.vtk.vtu+xml";
    case LevelForm::kGlb: return "model/gltf-binary";
    case LevelForm::kObj: return "model/obj";
    case LevelForm::kUsda: return "model/vnd.usda";
    case LevelForm::kWebp: return "image/webp";
    case LevelForm::kJson: return "application/json";
    case LevelForm::kCsv: return "text/csv";
    default: return "application/octet-stream";
  }
}

/// Whether it is looked at, not saved.
bool isShown(LevelForm form) { return form == LevelForm::kWebp || form == LevelForm::kJson; }

/// Whether the form is compressed already and is sent as it is.
bool isCompressed(LevelForm form) { return form == LevelForm::kGlb || form == LevelForm::kDrc; }

}  // namespace

std::optional<std::uint32_t> parseIndex(std::string_view text) {
  if (text.starts_with('0') && text != "0") return std::nullopt;
  return parseNumber<std::uint32_t>(text);
}

std::optional<double> parseFinite(std::string_view text) {
  const auto out = parseNumber<double>(text);
  return out && std::isfinite(*out) ? out : std::nullopt;
}

std::string levelsText(const ServedMesh& mesh) {
  return "the levels 0 to " + std::to_string(mesh.manifest.levels.size() - 1);
}

Resource resourceOf(const LevelRequest& wanted, const std::string& name) {
  assert(wanted.mesh && wanted.level < wanted.mesh->manifest.levels.size());
  Resource out{{'"' + wanted.key() + '"', wanted.mesh->modified},
               std::string(mediaType(wanted.form)),
               kForEver};
  out.headers.add(
      "Content-Disposition",
      contentDisposition(isShown(wanted.form) ? Disposition::kInline : Disposition::kAttachment,
                         name + "." + std::string(formName(wanted.form))));
  becomeEmbeddable(out);
  return out;
}

void chooseCodingOf(LevelRequest& wanted, Resource& resource, const RequestView& request) {
  if (isCompressed(wanted.form) || fileBytesOf(wanted) > limits::kMaxCodedLevelBytes) return;
  wanted.coding = chooseCoding(request.acceptEncoding.value_or(""), true, true);
  becomeVariant(resource, wanted.coding);
}

Answer toBeMade(const RequestView& request, const Resource& resource, LevelRequest wanted) {
  if (std::optional<Reply> early = conditionalReply(request, resource)) return std::move(*early);
  Reply out = beginReply(200, resource);
  out.headers.add("Accept-Ranges", "bytes");
  out.body = std::monostate();
  return {std::move(out), std::move(wanted)};
}

}  // namespace qtet
