#include "codec/log_manifest.h"

#include <string>

namespace qtet {
namespace {

Status agree(const Manifest& manifest, const LogIndex& index) {
  const auto contradiction = [](const std::string& what) {
    return fail(ErrorCode::kBadValue, "manifest and chunk table contradict each other in " + what + "; build the log again");
  };
  if ((manifest.layout == "regions") != (index.layout == Layout::kRegions)) return contradiction("the layout");
  if (manifest.latticeBits != index.positionBits) return contradiction("the bits of the lattice");
  if (manifest.fields.size() != index.fields.size()) return contradiction("the number of fields");
  for (std::size_t f = 0; f < manifest.fields.size(); ++f) {
    if (manifest.fields[f].components != index.fields[f].components) return contradiction("the components of field " + manifest.fields[f].name);
    if ((manifest.fields[f].association == "cell") != (index.fields[f].association == Association::kCell))
      return contradiction("the association of field " + manifest.fields[f].name);
    if (manifest.fields[f].gaps != index.fields[f].gaps) return contradiction("the gaps of field " + manifest.fields[f].name);
  }
  if (index.chunks.empty() || manifest.levels.size() != std::size_t{index.chunks.back().lastLevel} + 1) return contradiction("the number of levels");
  for (const ManifestLevel& level : manifest.levels)
    if (level.chunk >= index.chunks.size()) return contradiction("the chunk of level " + std::to_string(level.level));
  return {};
}

}  // namespace

Result<Manifest> manifestOf(const LogIndex& index) {
  Result<Manifest> manifest = manifestFromJson(index.manifest);
  if (!manifest) return manifest;
  if (Status agreed = agree(*manifest, index); !agreed) return std::unexpected(agreed.error());
  return manifest;
}

}  // namespace qtet
