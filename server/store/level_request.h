// A level that somebody has to make before it can be sent, and what names the result.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/store/served_mesh.h"
#include "server/wire/content_coding.h"

namespace qtet {

/// The kinds of file of codec/files/mesh_file.h, the poster, and the values of a series at a
/// point.
enum class LevelForm : std::uint8_t {
  kVtu,
  kVtk,
  kMsh,
  kObj,
  kGlb,
  kDrc,
  kUsda,
  kWebp,
  kJson,
  kCsv,
};

struct LevelRequest {
  MeshPointer mesh{};
  std::uint32_t level = 0;
  LevelForm form = LevelForm::kVtu;
  std::vector<std::uint32_t> fields{};  ///< indices into the manifest's, ascending, each once
  ContentCoding coding = ContentCoding::kIdentity;
  std::vector<std::string> names{};  ///< the fields' in the file; empty: the manifest's
  /// Where the values are, in the mesh's own coordinates; of kJson and kCsv alone.
  std::optional<std::array<double, 3>> point{};

  /// The same for the same bytes, with one version of this program: hexadecimal, of the log's
  /// digest and everything else here.
  [[nodiscard]] std::string key() const;
};

/// The ending without its dot.
[[nodiscard]] std::string_view formName(LevelForm form);
[[nodiscard]] std::optional<LevelForm> formOfName(std::string_view name);
/// Whether it is one of codec/files/mesh_file.h.
[[nodiscard]] bool isMeshFile(LevelForm form);

}  // namespace qtet
