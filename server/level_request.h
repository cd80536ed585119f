// A level that somebody has to make before it can be sent, and what names the result.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/content_coding.h"
#include "server/served_mesh.h"

namespace qtet {

enum class LevelForm : std::uint8_t { kVtu, kGlb, kDrc, kPng };

struct LevelRequest {
  MeshPointer mesh{};
  std::uint32_t level = 0;
  LevelForm form = LevelForm::kVtu;
  std::vector<std::uint32_t> fields{};  ///< indices into the manifest's, ascending, each once
  ContentCoding coding = ContentCoding::kIdentity;

  /// The same for the same bytes, with one version of this program: hexadecimal, of the log's digest and everything else here.
  [[nodiscard]] std::string key() const;
};

/// "vtu", "glb", "drc", "png".
[[nodiscard]] std::string_view formName(LevelForm form);
[[nodiscard]] std::optional<LevelForm> formOfName(std::string_view name);

}  // namespace qtet
